//! Rays against spheres, in f64 (Haines, Günther & Akenine-Möller 2019, "Precision Improvements for Ray/Sphere
//! Intersection", Ray Tracing Gems, chapter 7): the discriminant from the ray's distance to the center, the two roots
//! without cancellation.

use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Sphere;
use kirkas_geometry::{Bounds3, DVec3};

/// The smallest f32 box around the sphere.
#[inline]
pub fn bounds(sphere: &Sphere) -> Bounds3 {
    let (center, radius) = (sphere.center.as_dvec3(), DVec3::splat(f64::from(sphere.radius)));
    Bounds3::around_f64(center - radius, center + radius)
}

/// Calls `visit(t)` for the crossings, nearest first, until it returns true.
#[inline]
pub fn intersect(sphere: &Sphere, ray: &PreparedRay, mut visit: impl FnMut(f32) -> bool) {
    let d = ray.clipped.direction.as_dvec3();
    let to_origin = ray.clipped.origin.as_dvec3() - sphere.center.as_dvec3();
    let radius2 = f64::from(sphere.radius) * f64::from(sphere.radius);
    let a = d.dot(d);
    let half_b = -d.dot(to_origin);
    let nearest = to_origin + d * (half_b / a);
    let reach2 = radius2 - nearest.dot(nearest);
    if reach2.is_nan() || reach2 <= 0.0 {
        return;
    }
    let Some(inside) = bounds(sphere).intersect(&ray.clipped, ray.inverse()) else { return };
    let c = to_origin.dot(to_origin) - radius2;
    let q = half_b + (a * reach2).sqrt().copysign(half_b);
    let (t0, t1) = if half_b < 0.0 { (q / a, c / q) } else { (c / q, q / a) };
    for t in [t0, t1] {
        if ray.accept(t, inside).is_some_and(&mut visit) {
            return;
        }
    }
}
