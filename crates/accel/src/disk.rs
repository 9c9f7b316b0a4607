//! Rays against disks, in f64: the plane's crossing, then the distance from the center. `u` is that distance over the
//! radius, `v` is 0. The rim itself is not hit, nor is a disk by a ray that starts in its plane or runs within it.

use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Disk;
use kirkas_geometry::{Bounds3, DVec3};

/// The f32 box around the disk.
pub fn bounds(disk: &Disk) -> Bounds3 {
    let half = across(disk.normal.as_dvec3()) * f64::from(disk.radius);
    let center = disk.center.as_dvec3();
    Bounds3::around_f64(center - half, center + half)
}

/// Half the box of a disk of radius 1 whose normal has any length: the sine of the angle to each axis.
pub(crate) fn across(normal: DVec3) -> DVec3 {
    let square = normal * normal;
    let rest = DVec3::new(square.y + square.z, square.z + square.x, square.x + square.y);
    let sine = |x: f64| (x / (square.x + rest.x)).sqrt() * (1.0 + 4.0 * f64::EPSILON);
    DVec3::new(sine(rest.x), sine(rest.y), sine(rest.z))
}

/// The crossing `(t, u, v)`. Two-sided.
pub fn intersect(disk: &Disk, ray: &PreparedRay) -> Option<(f32, f32, f32)> {
    let (normal, direction) = (disk.normal.as_dvec3(), ray.clipped.direction.as_dvec3());
    let to_center = disk.center.as_dvec3() - ray.clipped.origin.as_dvec3();
    let height = normal.dot(to_center);
    // Rays that start on the plane, as far as f64 can tell, do not meet it.
    let sum = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
    if height.abs() <= HEIGHT_ERROR * sum(to_center) * sum(normal) {
        return None;
    }
    // Parallel to the plane: infinite, and so not accepted.
    let t = height / normal.dot(direction);
    let off = direction * t - to_center;
    let radius = f64::from(disk.radius);
    let square = off.dot(off);
    // NaN is not within.
    if square.is_nan() || square >= radius * radius {
        return None;
    }
    let inside = bounds(disk).intersect(&ray.clipped, ray.inverse())?;
    Some((ray.accept(t, inside)?, (square.sqrt() / radius) as f32, 0.0))
}

/// Bound on the error of `height`: 5 roundings in f64.
const HEIGHT_ERROR: f64 = 5.0 * f64::EPSILON * 0.5;
