//! # torus
//!
//! A ring of round section.
//!
//! ## Parameters
//! - `center` (point, scene units, default `[0, 0, 0]`).
//! - `axis` (direction, default `[0, 1, 0]`): what it turns about; any length but 0.
//! - `major_radius` (above 0, scene units, default 1): from the centre to the middle of the tube.
//! - `minor_radius` (above 0, scene units, default 0.25): of the tube; at most `major_radius`.
//!
//! Texture: `u` runs once around the axis, `v` once around the tube, from the outer equator over the top.
//!
//! ## Example
//! ```toml
//! [objects.ring]
//! type = "torus"
//! axis = [0, 0, 1]
//! major_radius = 1
//! minor_radius = 0.2
//! ```
//!
//! ## Limits
//! As a light it must not be scaled unevenly.
//!
//! ## References
//! Roots of the quartic: Yuksel, "High-Performance Polynomial Root Finding for Graphics", 2022.

use super::analytic::{
    Canonical, CenteredLine, Crossings, Local, degenerate, frame_around, place, similarity_scale, turn, unit_vector,
};
use super::polynomial::quartic_roots;
use super::{Part, ShapeInput};
use core::f64::consts::{PI, TAU};
use kirkas_geometry::elementary::{cos, sin};
use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "torus",
    doc: "A ring of round section.",
    params: &[
        ParamSpec::vector("center", [0.0; 3], "Its centre.").unit("scene units"),
        ParamSpec::vector("axis", [0.0, 1.0, 0.0], "What it turns about."),
        ParamSpec::number("major_radius", 1.0, "From the centre to the middle of the tube.")
            .unit("scene units")
            .range(POSITIVE),
        ParamSpec::number("minor_radius", 0.25, "Radius of the tube.").unit("scene units").range(POSITIVE),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let axis = unit_vector(input, "axis")?;
    let center = DVec3::from_array(input.params.vector("center"));
    let major = input.params.number("major_radius");
    let tube = input.params.number("minor_radius") / major;
    if tube > 1.0 {
        let what = "the tube would cut through itself".into();
        return Err(degenerate(input, "minor_radius", what, "more than `major_radius`")
            .help("make `minor_radius` at most `major_radius`"));
    }
    place(Torus { tube }, DAffine3 { matrix3: frame_around(axis) * major, translation: center }, input)
}

/// Canonical: about the z axis, major radius 1.
struct Torus {
    /// Minor radius.
    tube: f64,
}

impl Torus {
    /// Where the tube's middle passes `p`, and `p` from there: outward and up.
    fn around_tube(p: DVec3) -> (DVec3, f64) {
        let r = (p.x * p.x + p.y * p.y).sqrt();
        let ring = if r > 0.0 { DVec3::new(p.x / r, p.y / r, 0.0) } else { DVec3::X };
        (ring, r - 1.0)
    }
}

impl Canonical for Torus {
    const FLAT: bool = false;

    fn support(&self, n: DVec3) -> f64 {
        (n.x * n.x + n.y * n.y).sqrt() + self.tube * n.length()
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        let line = CenteredLine::new(o, d);
        let (o, d) = (line.o, line.d);

        // Clip to the bounding sphere and the slab |z| <= tube, a little generously, so that both ends are outside.
        let k = self.tube;
        let reach2 = (1.0 + k) * (1.0 + k) * 1.001 - o.length_squared();
        if reach2 <= 0.0 {
            return found;
        }
        let (mut first, mut last) = (-reach2.sqrt(), reach2.sqrt());
        let half = 1.001 * k;
        if d.z != 0.0 {
            let (a, b) = ((-half - o.z) / d.z, (half - o.z) / d.z);
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        } else if o.z.abs() > half {
            return found;
        }
        if first >= last {
            return found;
        }

        // Solve (|p|^2 + 1 - k^2)^2 = 4 (x^2 + y^2) for p = middle + s d, where the line's middle piece is.
        let shift = 0.5 * (first + last);
        let m = line.at(shift);
        let md = m.dot(d);
        // |m|^2 + 1 - k^2 = 2 + (distance terms): kept apart from the 2 x^2 it is compared with for thin tubes.
        let sum = m.length_squared() + (1.0 - k) * (1.0 + k);
        let quartic = [
            sum * sum - 4.0 * (m.x * m.x + m.y * m.y),
            4.0 * sum * md - 8.0 * (m.x * d.x + m.y * d.y),
            2.0 * sum + 4.0 * md * md - 4.0 * (d.x * d.x + d.y * d.y),
            4.0 * md,
            1.0,
        ];
        let (roots, n) = quartic_roots(&quartic, first - shift, last - shift);
        let mut previous = f64::NEG_INFINITY;
        for &root in &roots[..n] {
            let s = self.polished(&line, root + shift).max(previous);
            previous = s;
            found.push(line.t(s), 0);
        }
        found
    }

    fn project(&self, p: DVec3, _face: u8) -> DVec3 {
        let (ring, out) = Self::around_tube(p);
        let from_middle = DVec3::new(ring.x * out, ring.y * out, p.z);
        ring + from_middle.try_normalize().unwrap_or(ring) * self.tube
    }

    fn local(&self, p: DVec3, _face: u8) -> Local {
        let (ring, out) = Self::around_tube(p);
        let tangent = DVec3::new(-p.y, p.x, 0.0) * TAU;
        Local { normal: DVec3::new(ring.x * out, ring.y * out, p.z), uv: [turn(p.y, p.x), turn(p.z, out)], tangent }
    }

    fn bitangent(&self, p: DVec3, _face: u8) -> DVec3 {
        let (ring, out) = Self::around_tube(p);
        (DVec3::Z * out - ring * p.z) * TAU
    }

    fn curvature(&self, _face: u8) -> f64 {
        0.5 / self.tube
    }

    fn area(&self, m: &DMat3) -> Option<f64> {
        let scale = similarity_scale(m)?;
        Some(4.0 * PI * PI * self.tube * scale * scale)
    }

    fn sample(&self, _m: &DMat3, u: (f64, f64)) -> (DVec3, u8) {
        // The area within angle a of the tube is (a + tube sin a) / (2 pi), which rises: solve by Newton within bounds.
        let target = TAU * u.1;
        let (mut low, mut high) = (0.0, TAU);
        let mut a = target;
        for _ in 0..60 {
            let error = a + self.tube * sin(a) - target;
            if error < 0.0 {
                low = a;
            } else {
                high = a;
            }
            let newton = a - error / (1.0 + self.tube * cos(a));
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            let settled = (next - a).abs() < 1e-15;
            a = next;
            if settled {
                break;
            }
        }
        let ring = DVec3::new(cos(TAU * u.0), sin(TAU * u.0), 0.0);
        (ring * (1.0 + self.tube * cos(a)) + DVec3::Z * (self.tube * sin(a)), 0)
    }
}

impl Torus {
    /// Two Newton steps on the distance to the tube's middle, which loses less than the quartic for thin tubes.
    fn polished(&self, line: &CenteredLine, s: f64) -> f64 {
        let mut s = s;
        for _ in 0..2 {
            let p = line.at(s);
            let r = (p.x * p.x + p.y * p.y).sqrt();
            let out = r - 1.0;
            let from_middle = (out * out + p.z * p.z).sqrt();
            let slope = (out * (p.x * line.d.x + p.y * line.d.y) / r + p.z * line.d.z) / from_middle;
            let step = (from_middle - self.tube) / slope;
            // At grazing incidence the quartic knows better.
            if !(step.abs() < 1e-6 * self.tube && slope.abs() > 1e-3) {
                break;
            }
            s -= step;
        }
        s
    }
}
