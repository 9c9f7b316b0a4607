//! The closest point of one primitive, in world space.

use super::{PointSpace, SurfacePoint};
use crate::primitive::{corners, segment};
use crate::scene_geometry::{Disk, Shape, Sphere};
use crate::triangle::Corners;
use crate::{curve, cylinder, moving, quad};
use kirkas_geometry::DVec3;

/// `None` for what has no surface, for user shapes that do not answer, and for round and user shapes in a space that is
/// stretched unevenly.
pub(super) fn closest(shape: &Shape, primitive: u32, moment: f32, space: &PointSpace) -> Option<SurfacePoint> {
    let p = primitive as usize;
    match shape {
        Shape::Triangles { positions, indices } => Some(of_triangle(&corners(positions, indices[p]), space)),
        Shape::MovingTriangles { keys, indices } => {
            Some(of_triangle(&moving::corners(keys, indices[p], moment), space))
        }
        Shape::Quads { positions, indices } => {
            let [first, second] = quad::halves(&corners(positions, indices[p])).map(|half| of_triangle(&half, space));
            let world = space.point_in_world;
            let is_second = (second.position - world).length_squared() < (first.position - world).length_squared();
            let second = SurfacePoint { u: 1.0 - second.u, v: 1.0 - second.v, ..second };
            Some(if is_second { second } else { first })
        }
        _ if !space.is_similar => None,
        Shape::Spheres(spheres) => Some(placed((of_sphere(&spheres[p], space.point), 0.0), space)),
        Shape::Disks(disks) => Some(placed(of_disk(&disks[p], space.point), space)),
        Shape::Cylinders(all) => cylinder::closest_point(&all[p], space.point).map(|f| placed(f, space)),
        Shape::Curves { points, segments } => {
            Some(placed(curve::closest_point(&segment(points, segments[p]), space.point), space))
        }
        Shape::User(user) => {
            let found = user.closest_point(primitive, space.point)?;
            Some(SurfacePoint { position: space.to_world(found.position), ..found })
        }
    }
}

fn placed((position, u): (DVec3, f64), space: &PointSpace) -> SurfacePoint {
    SurfacePoint { position: space.to_world(position), u: u as f32, v: 0.0 }
}

fn of_sphere(sphere: &Sphere, point: DVec3) -> DVec3 {
    let center = sphere.center.as_dvec3();
    center + (point - center).try_normalize().unwrap_or(DVec3::X) * f64::from(sphere.radius)
}

fn of_disk(disk: &Disk, point: DVec3) -> (DVec3, f64) {
    let (center, normal, radius) = (disk.center.as_dvec3(), disk.normal.as_dvec3(), f64::from(disk.radius));
    let off = point - center;
    let off = off - normal * (off.dot(normal) / normal.dot(normal));
    let length = off.length();
    if length < radius { (center + off, length / radius) } else { (center + off * (radius / length.max(radius)), 1.0) }
}

/// Works on any triangle, as every place keeps a triangle one: on the corners in the world.
fn of_triangle(corners: &Corners, space: &PointSpace) -> SurfacePoint {
    let to_world = |c: [f32; 3]| space.to_world(DVec3::new(c[0].into(), c[1].into(), c[2].into()));
    let [a, b, c] = corners.map(to_world);
    let point = space.point_in_world;
    let (e1, e2, to) = (b - a, c - a, point - a);

    // The closest point of an edge, and the foot of the perpendicular where it lies within. Of a needle the foot is not sure:
    // hence the nearest of all.
    let along = |from: DVec3, edge: DVec3| {
        let s = (point - from).dot(edge) / edge.dot(edge);
        if s > 0.0 { s.min(1.0) } else { 0.0 }
    };
    let (s, t, r) = (along(a, e1), along(a, e2), along(b, c - b));
    let mut candidates = [(a, 0.0, 0.0), (a + e1 * s, s, 0.0), (a + e2 * t, 0.0, t), (b + (c - b) * r, 1.0 - r, r)];
    let normal = e1.cross(e2);
    let square = normal.dot(normal);
    let (u, v) = (to.cross(e2).dot(normal) / square, e1.cross(to).dot(normal) / square);
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
        candidates[0] = (a + e1 * u + e2 * v, u, v);
    }
    let distance2 = |p: &(DVec3, f64, f64)| (p.0 - point).length_squared();
    let nearer = |p, q| if distance2(&q) < distance2(&p) { q } else { p };
    let [first, rest @ ..] = candidates;
    let (position, u, v) = rest.into_iter().fold(first, nearer);
    SurfacePoint { position, u: u as f32, v: v as f32 }
}
