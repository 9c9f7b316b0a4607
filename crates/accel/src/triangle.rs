//! Rays against triangles: watertight edge tests, exact distances.
//!
//! The corners are sheared into the space in which the ray is the z axis; the ray hits when the origin lies inside the
//! resulting 2D triangle (Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection"). An edge's function is
//! `fl(fl(p) - fl(q))`, of which the sign is never wrong (it may be 0), since rounding is monotone; it depends only on the
//! two ends, each rounded the same way for every triangle; and 0 counts as inside. So a closed mesh stays closed: it is
//! the exact test of a mesh whose corners moved by at most 6 roundings. Our deviation: `t` comes from the plane, in f64,
//! because then a ray that starts off a surface, however little, never meets that surface or its coplanar neighbours.

use crate::prepared_ray::{PreparedRay, clamp};
use kirkas_geometry::bounds::pad_far;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use kirkas_geometry::{Bounds3, Vec3};

/// Three corners.
pub type Corners = [[f32; 3]; 3];

/// The bounds that are part of the definition of a hit: grown by what the edge test may move a corner sideways.
#[inline]
pub fn bounds(corners: &Corners) -> Bounds3 {
    let (low, high) = grown(&corners.map(to_lanes));
    Bounds3 { min: Vec3::new(low[0], low[1], low[2]), max: Vec3::new(high[0], high[1], high[2]) }
}

/// x, y, z and an idle lane, so that the compiler takes them at once.
type Lanes<T> = [T; 4];

#[inline(always)]
fn to_lanes([x, y, z]: [f32; 3]) -> Lanes<f32> {
    [x, y, z, 0.0]
}

#[inline(always)]
fn each<T: Copy, U>(a: Lanes<T>, b: Lanes<T>, f: impl Fn(T, T) -> U) -> Lanes<U> {
    [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])]
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// How far the edge test may move a point of the triangle sideways, along each axis.
pub(crate) fn growth(corners: &Corners) -> f32 {
    span(&corners.map(to_lanes)).2
}

/// The lowest and the highest of each coordinate, and the growth.
#[inline(always)]
fn span(c: &[Lanes<f32>; 3]) -> (Lanes<f32>, Lanes<f32>, f32) {
    let low = each(each(c[0], c[1], least), c[2], least);
    let high = each(each(c[0], c[1], most), c[2], most);
    let size = each(high, low, |h, l| h - l);
    (low, high, most(most(size[0], size[1]), size[2]) * (8.0 * UNIT_ROUNDOFF))
}

/// The lowest and the highest corner of [`bounds`].
#[inline(always)]
fn grown(c: &[Lanes<f32>; 3]) -> (Lanes<f32>, Lanes<f32>) {
    let (low, high, grow) = span(c);
    // At least one step of the coordinate itself, lest the growth be rounded away.
    let more = |x: f32| grow + x.abs() * (2.0 * UNIT_ROUNDOFF);
    (low.map(|x| x - more(x)), high.map(|x| x + more(x)))
}

/// The crossing `(t, u, v)` of a ray and a triangle; `u` and `v` weigh corners 1 and 2. Two-sided.
#[inline(always)]
pub fn intersect(corners: &Corners, ray: &PreparedRay) -> Option<(f32, f32, f32)> {
    let weights = weights(&sheared(corners, ray));
    let negative = weights[0] < 0.0 || weights[1] < 0.0 || weights[2] < 0.0;
    let positive = weights[0] > 0.0 || weights[1] > 0.0 || weights[2] > 0.0;
    if negative && positive {
        return None;
    }
    later(corners, ray, weights)
}

/// The corners, seen along the ray.
#[inline(always)]
fn sheared(corners: &Corners, ray: &PreparedRay) -> [(f32, f32); 3] {
    let [kx, ky, kz] = ray.axes.map(|k| k as usize);
    let [ox, oy, oz] = ray.sheared_origin;
    corners.map(|c| {
        let c = to_lanes(c);
        let z = c[kz & 3] - oz;
        ((c[kx & 3] - ox) - ray.shear[0] * z, (c[ky & 3] - oy) - ray.shear[1] * z)
    })
}

/// The edges' functions: weights of the corners opposite.
#[inline(always)]
fn weights([a, b, c]: &[(f32, f32); 3]) -> [f32; 3] {
    [c.0 * b.1 - c.1 * b.0, a.0 * c.1 - a.1 * c.0, b.0 * a.1 - b.1 * a.0]
}

#[inline(never)]
fn later(corners: &Corners, ray: &PreparedRay, weights: [f32; 3]) -> Option<(f32, f32, f32)> {
    crossing(corners, ray, weights)
}

/// What follows once the edges are passed, which is seldom: not all weights that are not 0 have one sign.
#[inline(always)]
pub(crate) fn crossing(corners: &Corners, ray: &PreparedRay, weights: [f32; 3]) -> Option<(f32, f32, f32)> {
    let t = distance(corners, ray)?;
    let (u, v) = barycentric(weights, || (*corners, *ray))?;
    Some((t, u, v))
}

/// Weights of corners 1 and 2, whose sum with that of corner 0 is 1.
#[inline(always)]
pub(crate) fn barycentric(weights: [f32; 3], of: impl FnOnce() -> (Corners, PreparedRay)) -> Option<(f32, f32)> {
    let total = weights[0] + weights[1] + weights[2];
    if total.is_normal() {
        return Some((weights[1] / total, weights[2] / total));
    }
    let (corners, ray) = of();
    decide(&sheared(&corners, &ray))
}

/// Weights of corners 1 and 2 where f32 overflows or underflows: in f64 the signs are exact.
#[cold]
fn decide(&[a, b, c]: &[(f32, f32); 3]) -> Option<(f32, f32)> {
    let edge = |p: (f32, f32), q: (f32, f32)| f64::from(p.0) * f64::from(q.1) - f64::from(p.1) * f64::from(q.0);
    let w = [edge(c, b), edge(a, c), edge(b, a)];
    let one_sided = w.iter().all(|x| *x >= 0.0) || w.iter().all(|x| *x <= 0.0);
    let total = w[0] + w[1] + w[2];
    (one_sided && total != 0.0).then(|| ((w[1] / total) as f32, (w[2] / total) as f32))
}

/// Where the ray meets the triangle's plane, clamped into the triangle's bounds.
#[inline(always)]
fn distance(corners: &Corners, ray: &PreparedRay) -> Option<f32> {
    let lanes = corners.map(to_lanes);
    let wide = |a: Lanes<f32>| a.map(f64::from);
    let minus = |a, b| each(a, b, |a: f64, b: f64| a - b);
    let [p, q, r] = lanes.map(wide);
    let (e1, e2) = (minus(q, p), minus(r, p));
    let normal = cross(e1, e2);
    let o = ray.clipped.origin;
    let d = ray.clipped.direction;
    let to_plane = minus(p, wide([o.x, o.y, o.z, 0.0]));
    let (height, speed) = (dot(normal, to_plane), dot(normal, wide([d.x, d.y, d.z, 0.0])));
    // Parallel to the plane: infinite, and so not admitted.
    let t = height / speed;
    if !(t > f64::from(ray.t_min) && t < f64::from(ray.t_max)) {
        return None;
    }
    // Rays that start on the plane, as far as f64 can tell, do not meet it.
    let sum = |v: Lanes<f64>| v[0].abs() + v[1].abs() + v[2].abs();
    if height.abs() <= HEIGHT_ERROR * sum(to_plane) * sum(e1) * sum(e2) {
        return None;
    }
    let inside = within(&grown(&lanes), ray)?;
    let t = clamp(t as f32, inside);
    ray.admits(t).then_some(t)
}

#[inline(always)]
fn cross(a: Lanes<f64>, b: Lanes<f64>) -> Lanes<f64> {
    let turned = |v: Lanes<f64>| [v[1], v[2], v[0], 0.0];
    let (a1, a2, b1, b2) = (turned(a), turned(turned(a)), turned(b), turned(turned(b)));
    each(each(a1, b2, |a, b| a * b), each(b1, a2, |b, a| b * a), |x, y| x - y)
}

#[inline(always)]
fn dot(a: Lanes<f64>, b: Lanes<f64>) -> f64 {
    let p = each(a, b, |a, b| a * b);
    p[0] + p[1] + p[2]
}

/// [`Bounds3::intersect`], three axes at once.
#[inline(always)]
fn within((low, high): &(Lanes<f32>, Lanes<f32>), ray: &PreparedRay) -> Option<(f32, f32)> {
    let origin = to_lanes(ray.clipped.origin.to_array());
    let inverse = ray.inverse;
    let at = |plane: &Lanes<f32>| each(each(*plane, origin, |p, o| p - o), inverse, |x, i| x * i);
    let (to_low, to_high) = (at(low), at(high));
    let (mut near, mut far) = (ray.clipped.t_min, f32::INFINITY);
    for k in 0..3 {
        let is_negative = ray.is_negative[k] != 0;
        let (enter, leave) = if is_negative { (to_high[k], to_low[k]) } else { (to_low[k], to_high[k]) };
        near = most(enter, near);
        far = least(leave, far);
    }
    let far = least(ray.clipped.t_max, pad_far(far));
    (near <= far).then_some((near, far))
}

/// Bound on the error of `height`: 8 roundings in f64.
pub(crate) const HEIGHT_ERROR: f64 = 8.0 * f64::EPSILON * 0.5;
