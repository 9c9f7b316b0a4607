//! Rays against cylinders, in f64: the lateral surface only, open at both ends, hit from outside and from inside. `u` runs
//! along the axis from 0 at the first end to 1 at the second, `v` is 0. One without length or radius is never hit.

use crate::disk;
use crate::local_ray::{DISTANCE_ERROR, LocalRay, without_start};
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Cylinder;
use kirkas_geometry::{Bounds3, DVec3};

/// The f32 box around the cylinder; empty when it has no length.
pub fn bounds(cylinder: &Cylinder) -> Bounds3 {
    let [a, b] = cylinder.ends.map(|p| p.as_dvec3());
    if a == b {
        return Bounds3::EMPTY;
    }
    let half = disk::across(b - a) * f64::from(cylinder.radius);
    Bounds3::around_f64(a.min(b) - half, a.max(b) + half)
}

/// Calls `visit(t, u, v)` for the crossings, nearest first, until it returns true.
pub fn intersect(cylinder: &Cylinder, ray: &PreparedRay, mut visit: impl FnMut(f32, f32, f32) -> bool) {
    let [a, b] = cylinder.ends.map(|p| p.as_dvec3());
    let (axis, radius) = (b - a, f64::from(cylinder.radius));
    let local = LocalRay::new(ray, (a + b) * 0.5);

    // Across the axis, times its length, the surface is a circle.
    let (length2, circle) = (axis.dot(axis), radius * radius * axis.dot(axis));
    let (origin, way) = (local.origin.cross(axis), local.direction.cross(axis));
    let speed2 = way.dot(way);
    let nearest = -origin.dot(way) / speed2;
    let off = origin + way * nearest;
    let reach2 = circle - off.dot(off);
    // Along the axis, or without length: NaN.
    if reach2.is_nan() || reach2 <= 0.0 {
        return;
    }
    let Some(inside) = bounds(cylinder).intersect(&ray.clipped, ray.inverse()) else { return };
    let reach = (reach2 / speed2).sqrt();
    let s = [nearest - reach, nearest + reach];
    let mut t = s.map(|s| local.t(s));
    let height = local.start.cross(axis).length() / length2.sqrt() - radius;
    if height.abs() <= DISTANCE_ERROR * (local.start.length() + radius) {
        t = without_start(t);
    }
    for (s, t) in s.into_iter().zip(t) {
        let along = (local.origin + local.direction * s).dot(axis) / length2 + 0.5;
        if (0.0..=1.0).contains(&along)
            && let Some(t) = ray.accept(t, inside)
            && visit(t, along as f32, 0.0)
        {
            return;
        }
    }
}

/// The point of the surface closest to `point`, with its `u`; `None` without length.
pub(crate) fn closest_point(cylinder: &Cylinder, point: DVec3) -> Option<(DVec3, f64)> {
    let [a, b] = cylinder.ends.map(|p| p.as_dvec3());
    let axis = b - a;
    let along = (point - a).dot(axis) / axis.dot(axis);
    if along.is_nan() {
        return None;
    }
    let out = outward(point - a, axis);
    let u = along.clamp(0.0, 1.0);
    Some((a + axis * u + out * f64::from(cylinder.radius), u))
}

/// The unit vector across `axis` towards `to`; any across where `to` lies along the axis.
pub(crate) fn outward(to: DVec3, axis: DVec3) -> DVec3 {
    let across = |v: DVec3| v - axis * (v.dot(axis) / axis.dot(axis));
    // What is left by rounding alone points anywhere; what is little more needs another pass.
    let out = across(to);
    let is_sure = out.length_squared() > 16.0 * f64::EPSILON * f64::EPSILON * to.length_squared();
    let out = if is_sure { across(out).try_normalize() } else { None };
    out.unwrap_or_else(|| axis.normalize().any_orthonormal_vector())
}
