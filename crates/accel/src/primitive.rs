//! One primitive of any shape: its bounds and its crossings. Brute force is a loop over this; trees call the same tests.

use crate::prepared_ray::{PreparedRay, clamp};
use crate::scene_geometry::{CurvePoint, Shape, UserShape};
use crate::triangle::Corners;
use crate::{curve, cylinder, disk, moving, quad, sphere, triangle};
use kirkas_geometry::{Bounds3, Ray, Vec3};

/// The corners of a triangle or quad.
#[inline]
pub(crate) fn corners<const N: usize>(positions: &[Vec3], index: [u32; N]) -> [[f32; 3]; N] {
    index.map(|i| positions[i as usize].to_array())
}

/// The ends of a curve's segment.
#[inline]
pub(crate) fn segment(points: &[CurvePoint], first: u32) -> [CurvePoint; 2] {
    [points[first as usize], points[first as usize + 1]]
}

/// The bounds that are part of the definition of a hit; of what moves, a box around those at all times.
#[inline]
pub(crate) fn bounds(shape: &Shape, primitive: u32) -> Bounds3 {
    let p = primitive as usize;
    match shape {
        Shape::Triangles { positions, indices } => triangle::bounds(&corners(positions, indices[p])),
        Shape::MovingTriangles { keys, indices } => moving::bounds(keys, indices[p]),
        Shape::Quads { positions, indices } => quad::bounds(&corners(positions, indices[p])),
        Shape::Disks(disks) => disk::bounds(&disks[p]),
        Shape::Cylinders(cylinders) => cylinder::bounds(&cylinders[p]),
        Shape::Curves { points, segments } => curve::bounds(&segment(points, segments[p])),
        Shape::Spheres(spheres) => sphere::bounds(&spheres[p]),
        Shape::User(user) => user.bounds(primitive),
    }
}

/// Calls `visit(t, u, v)` for each crossing, nearest first, until it returns true. `shutter` is the scene's.
pub(crate) fn intersect(
    shape: &Shape,
    primitive: u32,
    ray: &PreparedRay,
    shutter: (f64, f64),
    mut visit: impl FnMut(f32, f32, f32) -> bool,
) {
    let p = primitive as usize;
    let mut one = |crossing: Option<(f32, f32, f32)>| {
        if let Some((t, u, v)) = crossing {
            visit(t, u, v);
        }
    };
    match shape {
        Shape::Triangles { positions, indices } => one(triangle::intersect(&corners(positions, indices[p]), ray)),
        Shape::MovingTriangles { keys, indices } => one(intersect_moving(keys, indices[p], ray, shutter)),
        Shape::Quads { positions, indices } => quad::intersect(&corners(positions, indices[p]), ray, visit),
        Shape::Disks(disks) => one(disk::intersect(&disks[p], ray)),
        Shape::Cylinders(cylinders) => cylinder::intersect(&cylinders[p], ray, visit),
        Shape::Curves { points, segments } => curve::intersect(&segment(points, segments[p]), ray, visit),
        Shape::Spheres(spheres) => sphere::intersect(&spheres[p], ray, |t| visit(t, 0.0, 0.0)),
        Shape::User(user) => intersect_user(&**user, primitive, ray, visit),
    }
}

/// The triangle of the ray's time.
fn intersect_moving(
    keys: &[Vec<Vec3>],
    index: [u32; 3],
    ray: &PreparedRay,
    shutter: (f64, f64),
) -> Option<(f32, f32, f32)> {
    let corners: Corners = moving::corners(keys, index, moving::moment(ray.clipped.time, shutter));
    triangle::intersect(&corners, ray)
}

/// A user shape's crossings, held to the definition of a hit.
fn intersect_user(
    user: &dyn UserShape,
    primitive: u32,
    ray: &PreparedRay,
    mut visit: impl FnMut(f32, f32, f32) -> bool,
) {
    let Some(inside) = user.bounds(primitive).intersect(&ray.clipped, ray.inverse()) else { return };
    let open = Ray { t_min: ray.t_min, t_max: ray.t_max, ..ray.clipped };
    user.intersect(primitive, &open, &mut |t, u, v| {
        let clamped = clamp(t, inside);
        ray.admits(t) && ray.admits(clamped) && visit(clamped, u, v)
    });
}
