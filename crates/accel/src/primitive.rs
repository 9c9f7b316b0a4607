//! One primitive of any shape: its bounds and its crossings. Brute force is a loop over this; trees call the same tests.

use crate::prepared_ray::{PreparedRay, clamp};
use crate::scene_geometry::{Shape, UserShape};
use crate::triangle::Corners;
use crate::{sphere, triangle};
use kirkas_geometry::{Bounds3, Ray, Vec3};

/// The corners of a triangle.
#[inline]
pub(crate) fn corners(positions: &[Vec3], index: [u32; 3]) -> Corners {
    index.map(|i| positions[i as usize].to_array())
}

/// The bounds that are part of the definition of a hit.
#[inline]
pub(crate) fn bounds(shape: &Shape, primitive: u32) -> Bounds3 {
    match shape {
        Shape::Triangles { positions, indices } => triangle::bounds(&corners(positions, indices[primitive as usize])),
        Shape::Spheres(spheres) => sphere::bounds(&spheres[primitive as usize]),
        Shape::User(user) => user.bounds(primitive),
    }
}

/// Calls `visit(t, u, v)` for each crossing, nearest first, until it returns true.
pub(crate) fn intersect(
    shape: &Shape,
    primitive: u32,
    ray: &PreparedRay,
    mut visit: impl FnMut(f32, f32, f32) -> bool,
) {
    match shape {
        Shape::Triangles { positions, indices } => {
            if let Some((t, u, v)) = triangle::intersect(&corners(positions, indices[primitive as usize]), ray) {
                visit(t, u, v);
            }
        }
        Shape::Spheres(spheres) => sphere::intersect(&spheres[primitive as usize], ray, |t| visit(t, 0.0, 0.0)),
        Shape::User(user) => intersect_user(&**user, primitive, ray, visit),
    }
}

/// A user shape's crossings, held to the definition of a hit.
pub(crate) fn intersect_user(
    user: &dyn UserShape,
    primitive: u32,
    ray: &PreparedRay,
    mut visit: impl FnMut(f32, f32, f32) -> bool,
) {
    let Some(inside) = user.bounds(primitive).intersect(&ray.clipped, ray.inverse) else { return };
    let open = Ray { t_min: ray.t_min, t_max: ray.t_max, ..ray.clipped };
    user.intersect(primitive, &open, &mut |t, u, v| {
        let clamped = clamp(t, inside);
        ray.admits(t) && ray.admits(clamped) && visit(clamped, u, v)
    });
}
