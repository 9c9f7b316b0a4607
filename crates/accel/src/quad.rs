//! Rays against quads. A quad with corners 0 to 3 is the two triangles (0, 1, 3) and (2, 3, 1), flat or not. `u` runs from
//! corner 0 to 1 (and from 3 to 2), `v` from corner 0 to 3 (and from 1 to 2); both are continuous across the fold.

use crate::prepared_ray::PreparedRay;
use crate::triangle::{self, Corners};
use kirkas_geometry::{Bounds3, DVec3};

/// The two triangles.
#[inline]
pub(crate) fn halves([a, b, c, d]: &[[f32; 3]; 4]) -> [Corners; 2] {
    [[*a, *b, *d], [*c, *d, *b]]
}

/// The bounds that are part of the definition of a hit.
pub fn bounds(corners: &[[f32; 3]; 4]) -> Bounds3 {
    let [first, second] = halves(corners);
    triangle::bounds(&first).union(triangle::bounds(&second))
}

/// Calls `visit(t, u, v)` for the crossings, nearest first, until it returns true. Through the fold itself a ray passes once.
pub fn intersect(corners: &[[f32; 3]; 4], ray: &PreparedRay, mut visit: impl FnMut(f32, f32, f32) -> bool) {
    let halves = halves(corners);
    let first = triangle::intersect(&halves[0], ray);
    let second = triangle::intersect(&halves[1], ray).map(|(t, u, v)| (t, 1.0 - u, 1.0 - v));
    match (first, second) {
        (Some(a), Some(b)) => {
            let [near, far] = if b.0 < a.0 { [b, a] } else { [a, b] };
            // Halves that face alike overlap in nothing but the fold.
            let is_one = faces(&halves[0], ray) == faces(&halves[1], ray);
            if !visit(near.0, near.1, near.2) && !is_one {
                visit(far.0, far.1, far.2);
            }
        }
        (Some((t, u, v)), None) | (None, Some((t, u, v))) => {
            visit(t, u, v);
        }
        (None, None) => {}
    }
}

/// True when the ray runs with the triangle's normal.
fn faces(corners: &Corners, ray: &PreparedRay) -> bool {
    let [a, b, c] = corners.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
    (b - a).cross(c - a).dot(ray.clipped.direction.as_dvec3()) > 0.0
}
