//! What cylinder and cone share: the solid between two coaxial circles.
//!
//! Canonical: base circle of radius 1 in the plane z = 0, top circle of radius `top` in the plane z = `height`. A line meets
//! this convex solid in one interval or not at all, so a closed frustum is always crossed twice.

use super::analytic::{Canonical, CenteredLine, Crossings, Local, similarity_scale, turn};
use super::quadratic;
use core::f64::consts::{PI, TAU};
use kirkas_geometry::elementary::{cos, sin};
use kirkas_geometry::{DMat3, DVec3};

const SIDE: u8 = 0;
const BASE: u8 = 1;
const TOP: u8 = 2;

/// The solid between two coaxial circles, or only its side.
pub struct Frustum {
    /// Radius at the top, in radii of the base.
    pub top: f64,
    /// In radii of the base.
    pub height: f64,
    /// Closed by two disks.
    pub caps: bool,
}

impl Frustum {
    /// Change of radius per height.
    fn slope(&self) -> f64 {
        (self.top - 1.0) / self.height
    }

    /// Areas of side, base and top.
    fn areas(&self) -> [f64; 3] {
        let widening = self.top - 1.0;
        let slant = (self.height * self.height + widening * widening).sqrt();
        let caps = if self.caps { PI } else { 0.0 };
        [PI * (1.0 + self.top) * slant, caps, caps * self.top * self.top]
    }
}

impl Canonical for Frustum {
    const FLAT: bool = false;

    fn support(&self, n: DVec3) -> f64 {
        let across = (n.x * n.x + n.y * n.y).sqrt();
        across.max(self.top * across + self.height * n.z)
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        let line = CenteredLine::new(o, d);
        let (o, d) = (line.o, line.d);

        // Clip to the bounding sphere, generously, and to the slab between base and top.
        let widest = self.top.max(1.0);
        let reach2 = widest * widest + self.height * self.height;
        if o.length_squared() > reach2 {
            return found;
        }
        let reach = 2.0 * reach2.sqrt();
        let (mut first, mut first_face, mut last, mut last_face) = (-reach, SIDE, reach, SIDE);
        if d.z != 0.0 {
            let (base, top) = (-o.z / d.z, (self.height - o.z) / d.z);
            let (near, near_face, far, far_face) =
                if d.z > 0.0 { (base, BASE, top, TOP) } else { (top, TOP, base, BASE) };
            if near > first {
                (first, first_face) = (near, near_face);
            }
            if far < last {
                (last, last_face) = (far, far_face);
            }
        } else if o.z < 0.0 || o.z > self.height {
            return found;
        }
        if first >= last {
            return found;
        }

        // Cut the rest where x^2 + y^2 = (1 + slope z)^2 and keep what is inside.
        let (w, dw) = (1.0 + self.slope() * o.z, self.slope() * d.z);
        let a = d.x * d.x + d.y * d.y - dw * dw;
        let b = o.x * d.x + o.y * d.y - w * dw;
        let c = o.x * o.x + o.y * o.y - w * w;
        let inside = |s: f64| (a * s + 2.0 * b) * s + c < 0.0;
        let mut knots = [last; 4];
        knots[0] = first;
        let mut n = 1;
        if let Some((r0, r1)) = quadratic::roots(a, b, c) {
            for r in [r0, r1] {
                if r > knots[n - 1] && r < last {
                    knots[n] = r;
                    n += 1;
                }
            }
        }
        let is_in = |i: &usize| inside(0.5 * (knots[*i] + knots[i + 1]));
        let Some(enter) = (0..n).find(is_in) else { return found };
        let leave = (enter..n).rev().find(is_in).unwrap_or(enter);

        let enter_face = if enter == 0 { first_face } else { SIDE };
        let leave_face = if leave == n - 1 { last_face } else { SIDE };
        if self.caps || enter_face == SIDE {
            found.push(line.t(knots[enter]), enter_face);
        }
        if self.caps || leave_face == SIDE {
            found.push(line.t(knots[leave + 1]), leave_face);
        }
        found
    }

    fn project(&self, p: DVec3, face: u8) -> DVec3 {
        let across = (p.x * p.x + p.y * p.y).sqrt();
        let onto = |radius: f64, z: f64| {
            let scale = if across > 0.0 { radius / across } else { 0.0 };
            if across > 0.0 { DVec3::new(p.x * scale, p.y * scale, z) } else { DVec3::new(radius, 0.0, z) }
        };
        match face {
            SIDE => {
                // The foot of the perpendicular onto the slanted line in the plane of the axis and `p`.
                let m = self.slope();
                let z = ((p.z + m * (across - 1.0)) / (1.0 + m * m)).clamp(0.0, self.height);
                onto(1.0 + m * z, z)
            }
            BASE => onto(across.min(1.0), 0.0),
            _ => onto(across.min(self.top), self.height),
        }
    }

    fn local(&self, p: DVec3, face: u8) -> Local {
        match face {
            SIDE => {
                let radius = (p.x * p.x + p.y * p.y).sqrt();
                let (c, s) = if radius > 0.0 { (p.x / radius, p.y / radius) } else { (1.0, 0.0) };
                Local {
                    normal: DVec3::new(c, s, -self.slope()),
                    uv: [turn(p.y, p.x), p.z / self.height],
                    tangent: DVec3::new(-p.y, p.x, 0.0) * TAU,
                }
            }
            // Seen from outside, u goes right and v goes up.
            BASE => Local {
                normal: DVec3::NEG_Z,
                uv: [0.5 - 0.5 * p.x, 0.5 + 0.5 * p.y],
                tangent: DVec3::new(-2.0, 0.0, 0.0),
            },
            _ => {
                let r = self.top.max(f64::MIN_POSITIVE);
                Local {
                    normal: DVec3::Z,
                    uv: [0.5 + 0.5 * (p.x / r), 0.5 + 0.5 * (p.y / r)],
                    tangent: DVec3::new(2.0 * r, 0.0, 0.0),
                }
            }
        }
    }

    fn bitangent(&self, p: DVec3, face: u8) -> DVec3 {
        match face {
            SIDE => {
                let radius = (p.x * p.x + p.y * p.y).sqrt();
                let outward = if radius > 0.0 { DVec3::new(p.x, p.y, 0.0) / radius } else { DVec3::X };
                (outward * self.slope() + DVec3::Z) * self.height
            }
            BASE => DVec3::new(0.0, 2.0, 0.0),
            _ => DVec3::new(0.0, 2.0 * self.top.max(f64::MIN_POSITIVE), 0.0),
        }
    }

    fn curvature(&self, face: u8) -> f64 {
        if face == SIDE { 1.0 / (1.0 + self.top) } else { 0.0 }
    }

    fn area(&self, m: &DMat3) -> Option<f64> {
        let scale = similarity_scale(m)?;
        Some(self.areas().iter().sum::<f64>() * scale * scale)
    }

    fn sample(&self, _m: &DMat3, u: (f64, f64)) -> (DVec3, u8) {
        let areas = self.areas();
        let mut rest = u.0 * areas.iter().sum::<f64>();
        let mut face = TOP;
        for (i, &area) in areas.iter().enumerate() {
            if rest < area || (i as u8 == SIDE && !self.caps) {
                face = i as u8;
                break;
            }
            rest -= area;
        }
        let s = (rest / areas[face as usize]).clamp(0.0, 1.0);
        let (y, x) = (sin(TAU * u.1), cos(TAU * u.1));
        let p = match face {
            SIDE => {
                // Radius squared is linear in the area.
                let radius = (1.0 + (self.top * self.top - 1.0) * s).max(0.0).sqrt();
                let along = (self.top + 1.0) * s / (radius + 1.0);
                DVec3::new(radius * x, radius * y, self.height * along.min(1.0))
            }
            BASE => DVec3::new(s.sqrt() * x, s.sqrt() * y, 0.0),
            _ => DVec3::new(self.top * s.sqrt() * x, self.top * s.sqrt() * y, self.height),
        };
        (p, face)
    }
}
