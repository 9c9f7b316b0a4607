//! Rays against round linear curves, in f64. A segment is the hull of two balls: a cone that touches both, and the caps that
//! the balls leave over (Han, Wald, Usher et al. 2019, "Ray Tracing Generalized Tube Primitives"; here by the envelope's
//! quadric). `u` runs along the segment, 0 on the first ball's cap and 1 on the second's; `v` is 0.
//!
//! The hull is convex, so a ray's first and last crossing of cone and balls are its entry and its exit, and no joint can
//! leak. Neighbouring segments share a ball; each has its own entry and exit there.

use crate::cylinder;
use crate::local_ray::{DISTANCE_ERROR, LocalRay, without_start};
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::CurvePoint;
use crate::sphere;
use kirkas_geometry::{Bounds3, DVec3};

/// The smallest f32 box around the two balls.
pub fn bounds(ends: &[CurvePoint; 2]) -> Bounds3 {
    let [a, b] = ends.map(|p| sphere::bounds(&p.ball()));
    a.union(b)
}

/// Calls `visit(t, u, v)` for the crossings, nearest first, until it returns true. Without thickness there are none.
pub fn intersect(ends: &[CurvePoint; 2], ray: &PreparedRay, mut visit: impl FnMut(f32, f32, f32) -> bool) {
    let cone = Cone::new(ends);
    let local = LocalRay::new(ray, cone.a + cone.axis * 0.5);
    // Most rays pass the ball around the whole by.
    let reach = cone.axis.length() * 0.5 + f64::from(ends[0].radius.max(ends[1].radius));
    if local.origin.length_squared() > reach * reach * 1.000_001 {
        return;
    }
    let Some(s) = cone.crossings(&local) else { return };
    let Some(inside) = bounds(ends).intersect(&ray.clipped, ray.inverse()) else { return };
    let mut t = s.map(|s| local.t(s));
    let start = local.start + cone.axis * 0.5;
    let near = cone.closest(start);
    let height = (start - near.center).length() - near.radius;
    if height.abs() <= DISTANCE_ERROR * (local.start.length() + near.radius) {
        t = without_start(t);
    }
    for (s, t) in s.into_iter().zip(t) {
        if let Some(t) = ray.accept(t, inside) {
            let u = cone.u(local.origin + local.direction * s + cone.axis * 0.5);
            if visit(t, u as f32, 0.0) {
                return;
            }
        }
    }
}

/// The point of the surface closest to `point`, with its `u`.
pub(crate) fn closest_point(ends: &[CurvePoint; 2], point: DVec3) -> (DVec3, f64) {
    let cone = Cone::new(ends);
    let near = cone.closest(point - cone.a);
    let out = point - cone.a - near.center;
    (cone.a + near.center + out.try_normalize().unwrap_or(near.out) * near.radius, near.u)
}

/// Across the surface, outwards, at a point of it; of any length.
pub(crate) fn outward(ends: &[CurvePoint; 2], point: DVec3) -> DVec3 {
    let cone = Cone::new(ends);
    point - cone.a - cone.closest(point - cone.a).center
}

/// A segment; positions are relative to `a`.
struct Cone {
    a: DVec3,
    axis: DVec3,
    /// At `a`, and how much larger at the other end.
    radius: f64,
    growth: f64,
    /// `|axis|^2 - growth^2`: where it is not positive, one ball holds the other.
    k: f64,
}

/// The ball of a segment that a point is closest to.
struct Ball {
    center: DVec3,
    radius: f64,
    u: f64,
    /// Where its center itself is closest to the surface.
    out: DVec3,
}

impl Cone {
    fn new([a, b]: &[CurvePoint; 2]) -> Self {
        let axis = b.position.as_dvec3() - a.position.as_dvec3();
        let (radius, growth) = (f64::from(a.radius), f64::from(b.radius) - f64::from(a.radius));
        Cone { a: a.position.as_dvec3(), axis, radius, growth, k: axis.dot(axis) - growth * growth }
    }

    /// Which ball touches the surface at `point`: 0 is the first.
    fn u(&self, point: DVec3) -> f64 {
        if self.k <= 0.0 {
            return if self.growth > 0.0 { 1.0 } else { 0.0 };
        }
        ((point.dot(self.axis) + self.radius * self.growth) / self.k).clamp(0.0, 1.0)
    }

    /// Entry and exit.
    fn crossings(&self, local: &LocalRay) -> Option<[f64; 2]> {
        let end = self.radius + self.growth;
        if self.radius == 0.0 && end == 0.0 {
            return None;
        }
        let balls = [(self.axis * -0.5, self.radius), (self.axis * 0.5, end)];
        let caps = balls.into_iter().filter_map(|(center, radius)| local.through_ball(center, radius)).flatten();
        let all = caps.chain(self.lateral(local).into_iter().flatten());
        let [near, far] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], s| [a.min(s), b.max(s)]);
        (near < far).then_some([near, far])
    }

    /// Where the ray meets the cone between the circles on which it touches the balls. The envelope of the balls is
    /// `k (|p|^2 - r^2) = (p.axis + r growth)^2`.
    fn lateral(&self, local: &LocalRay) -> [Option<f64>; 2] {
        if self.k <= 0.0 {
            return [None; 2];
        }
        let (r, g, axis) = (self.radius, self.growth, self.axis);
        let (o, d) = (local.origin + axis * 0.5, local.direction);
        let (o_across, d_across) = (o.cross(axis), d.cross(axis));
        let a = d_across.dot(d_across) - g * g;
        let half_b = o_across.dot(d_across) - g * g * o.dot(d) - r * g * d.dot(axis);
        let c = o_across.dot(o_across) - g * g * o.dot(o) - axis.dot(axis) * r * r - 2.0 * r * g * o.dot(axis);
        let root = (half_b * half_b - a * c).sqrt();
        let q = -(half_b + root.copysign(half_b));
        let between = |s: &f64| {
            let u = ((o + d * *s).dot(axis) + r * g) / self.k;
            (0.0..=1.0).contains(&u)
        };
        [q / a, c / q].map(|s| Some(s).filter(between))
    }

    /// The ball of the segment to which `point` is closest: its own distance is the segment's.
    fn closest(&self, point: DVec3) -> Ball {
        let length2 = self.axis.dot(self.axis);
        let (u, out) = if self.k <= 0.0 {
            (if self.growth > 0.0 { 1.0 } else { 0.0 }, DVec3::X)
        } else {
            // The ball's center lies as far along as the point, and farther by the cone's slope times the distance from
            // the axis.
            let length = length2.sqrt();
            let side = cylinder::outward(point, self.axis);
            let away = point.dot(side).max(0.0);
            let along = point.dot(self.axis) / length2 + away * self.growth / (length * self.k.sqrt());
            (along.clamp(0.0, 1.0), side * (self.k / length2).sqrt() - self.axis * (self.growth / length2))
        };
        Ball { center: self.axis * u, radius: self.radius + self.growth * u, u, out }
    }
}
