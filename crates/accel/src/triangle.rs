//! Rays against triangles: watertight edge tests, exact distances.
//!
//! The corners are sheared into the space in which the ray is the z axis; the ray hits when the origin lies inside the
//! resulting 2D triangle (Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection"). An edge's function is
//! `fl(fl(p) - fl(q))`, of which the sign is never wrong (it may be 0), since rounding is monotone; it depends only on the
//! two ends, each rounded the same way for every triangle; and 0 counts as inside. So a closed mesh stays closed: it is
//! the exact test of a mesh whose corners moved by at most 6 roundings. Our deviation: `t` comes from the plane, in f64,
//! because then a ray that starts off a surface, however little, never meets that surface or its coplanar neighbours.

use crate::prepared_ray::{PreparedRay, clamp};
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use kirkas_geometry::{Bounds3, DVec3, Vec3};

/// Three corners.
pub type Corners = [[f32; 3]; 3];

/// The bounds that are part of the definition of a hit: grown by what the edge test may move a corner sideways.
#[inline]
pub fn bounds(corners: &Corners) -> Bounds3 {
    let mut b = Bounds3 { min: Vec3::ZERO, max: Vec3::ZERO };
    let mut size = 0.0_f32;
    for k in 0..3 {
        let [x, y, z] = corners.map(|c| c[k]);
        b.min[k] = least(least(x, y), z);
        b.max[k] = -least(least(-x, -y), -z);
        size = -least(-size, b.min[k] - b.max[k]);
    }
    let grow = size * (8.0 * UNIT_ROUNDOFF);
    for k in 0..3 {
        // At least one step of the coordinate itself, lest the growth be rounded away.
        b.min[k] -= grow + b.min[k].abs() * (2.0 * UNIT_ROUNDOFF);
        b.max[k] += grow + b.max[k].abs() * (2.0 * UNIT_ROUNDOFF);
    }
    b
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The crossing `(t, u, v)` of a ray and a triangle; `u` and `v` weigh corners 1 and 2. Two-sided.
#[inline(always)]
pub fn intersect(corners: &Corners, ray: &PreparedRay) -> Option<(f32, f32, f32)> {
    let [kx, ky, kz] = ray.axes.map(|k| k.min(2));
    let [ox, oy, oz] = ray.sheared_origin;
    let sheared = |c: &[f32; 3]| {
        let z = c[kz] - oz;
        ((c[kx] - ox) - ray.shear[0] * z, (c[ky] - oy) - ray.shear[1] * z)
    };
    let (a, b, c) = (sheared(&corners[0]), sheared(&corners[1]), sheared(&corners[2]));
    let weights = [c.0 * b.1 - c.1 * b.0, a.0 * c.1 - a.1 * c.0, b.0 * a.1 - b.1 * a.0];
    let negative = weights[0] < 0.0 || weights[1] < 0.0 || weights[2] < 0.0;
    let positive = weights[0] > 0.0 || weights[1] > 0.0 || weights[2] > 0.0;
    if negative && positive {
        return None;
    }
    crossing(corners, ray, weights, [a, b, c])
}

/// What follows once the edges are passed, which is seldom.
#[inline(never)]
fn crossing(
    corners: &Corners,
    ray: &PreparedRay,
    weights: [f32; 3],
    sheared: [(f32, f32); 3],
) -> Option<(f32, f32, f32)> {
    let (u, v) = barycentric(weights, sheared)?;
    Some((distance(corners, ray)?, u, v))
}

/// Weights of corners 1 and 2. Where f32 overflows or underflows, the signs are decided in f64, where they are exact.
#[inline]
fn barycentric(weights: [f32; 3], [a, b, c]: [(f32, f32); 3]) -> Option<(f32, f32)> {
    let total = weights[0] + weights[1] + weights[2];
    if total.is_normal() {
        return Some((weights[1] / total, weights[2] / total));
    }
    let edge = |p: (f32, f32), q: (f32, f32)| f64::from(p.0) * f64::from(q.1) - f64::from(p.1) * f64::from(q.0);
    let w = [edge(c, b), edge(a, c), edge(b, a)];
    let one_sided = w.iter().all(|x| *x >= 0.0) || w.iter().all(|x| *x <= 0.0);
    let total = w[0] + w[1] + w[2];
    (one_sided && total != 0.0).then(|| ((w[1] / total) as f32, (w[2] / total) as f32))
}

/// Where the ray meets the triangle's plane, clamped into the triangle's bounds.
#[inline]
fn distance(corners: &Corners, ray: &PreparedRay) -> Option<f32> {
    let inside = bounds(corners).intersect(&ray.clipped, ray.inverse)?;
    let [p, q, r] = corners.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
    let (e1, e2) = (q - p, r - p);
    let normal = e1.cross(e2);
    let to_plane = p - ray.clipped.origin.as_dvec3();
    let (height, speed) = (normal.dot(to_plane), normal.dot(ray.clipped.direction.as_dvec3()));
    // Rays that start on the plane, as far as f64 can tell, do not meet it.
    let sum = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
    if height.abs() <= HEIGHT_ERROR * sum(to_plane) * sum(e1) * sum(e2) {
        return None;
    }
    // Parallel to the plane: infinite, and so not admitted.
    let t = height / speed;
    if !(t > f64::from(ray.t_min) && t < f64::from(ray.t_max)) {
        return None;
    }
    let t = clamp(t as f32, inside);
    ray.admits(t).then_some(t)
}

/// Bound on the error of `height`: 8 roundings in f64.
const HEIGHT_ERROR: f64 = 8.0 * f64::EPSILON * 0.5;
