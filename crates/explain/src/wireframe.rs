//! The scene's geometry as lines, few enough to be drawn at once: for the eye, so that rays have something to hit.

use kirkas_accel::{Geometry, Instance, SceneGeometry, Shape};
use kirkas_geometry::elementary::sin_cos;
use kirkas_geometry::{Bounds3, DAffine3, DVec3, Vec3};

/// A line from one point to another, in the world.
pub type Line = [[f32; 3]; 2];

/// At most about `most` lines. Of what has too many edges every n-th primitive is drawn.
pub fn wireframe(scene: &SceneGeometry, time: f64, most: usize) -> Vec<Line> {
    let mut parts = Vec::new();
    scene.world.iter().for_each(|g| parts.push((g, DAffine3::IDENTITY)));
    place(scene, &scene.instances, DAffine3::IDENTITY, time, &mut parts, 0);
    // Every part gets its share by the number of its lines, but the smallest are whole.
    let total: usize = parts.iter().map(|(g, _)| lines_of(&g.shape) * g.shape.len()).sum();
    let stride = total.div_ceil(most.max(1)).max(1);
    let mut lines = Vec::new();
    for (geometry, to_world) in parts {
        let n = geometry.shape.len();
        let own = if n <= WHOLE { 1 } else { stride };
        for i in (0..n).step_by(own) {
            draw(&geometry.shape, i, time, scene.shutter, &mut |a, b| {
                let at = |p: DVec3| to_world.transform_point3(p).as_vec3().to_array();
                lines.push([at(a), at(b)]);
            });
        }
    }
    // A crowd of small parts is thinned out as well.
    let thin = lines.len().div_ceil(most.max(1)).max(1);
    lines.into_iter().step_by(thin).filter(|l| l.iter().flatten().all(|v| v.is_finite())).collect()
}

/// Parts of so few primitives are drawn whole.
const WHOLE: usize = 64;
/// Instances within instances are followed so deep.
const DEPTH: usize = 16;
/// Lines of a circle.
const STEPS: usize = 24;

fn place<'a>(
    scene: &'a SceneGeometry,
    instances: &'a [Instance],
    outer: DAffine3,
    time: f64,
    parts: &mut Vec<(&'a Geometry, DAffine3)>,
    depth: usize,
) {
    for instance in instances {
        let to_world = outer * instance.outer_from_object.at(time);
        let Some(aggregate) = scene.aggregates.get(instance.aggregate).filter(|_| depth < DEPTH) else { continue };
        aggregate.geometries.iter().for_each(|g| parts.push((g, to_world)));
        place(scene, &aggregate.instances, to_world, time, parts, depth + 1);
    }
}

/// Lines that a primitive is drawn with.
fn lines_of(shape: &Shape) -> usize {
    match shape {
        Shape::Triangles { .. } | Shape::MovingTriangles { .. } => 3,
        Shape::Quads { .. } => 4,
        Shape::Curves { .. } => 1,
        Shape::Disks(_) => STEPS,
        Shape::Cylinders(_) => 2 * STEPS + 4,
        Shape::Spheres(_) => 3 * STEPS,
        Shape::User(_) => 12,
    }
}

fn draw(shape: &Shape, i: usize, time: f64, shutter: (f64, f64), line: &mut impl FnMut(DVec3, DVec3)) {
    let mut ring = |corners: &[Vec3]| {
        for (k, c) in corners.iter().enumerate() {
            line(c.as_dvec3(), corners[(k + 1) % corners.len()].as_dvec3());
        }
    };
    match shape {
        Shape::Triangles { positions, indices } => ring(&indices[i].map(|k| positions[k as usize])),
        Shape::MovingTriangles { keys, indices } => {
            let (open, close) = shutter;
            let u = if close > open { ((time - open) / (close - open)).clamp(0.0, 1.0) } else { 0.0 };
            let key = &keys[(u * (keys.len() - 1) as f64).round() as usize];
            ring(&indices[i].map(|k| key[k as usize]));
        }
        Shape::Quads { positions, indices } => ring(&indices[i].map(|k| positions[k as usize])),
        Shape::Disks(disks) => circle(disks[i].center, disks[i].normal, disks[i].radius, line),
        Shape::Cylinders(cylinders) => {
            let c = &cylinders[i];
            let axis = c.ends[1] - c.ends[0];
            c.ends.iter().for_each(|end| circle(*end, axis, c.radius, line));
            let (u, v) = across(axis);
            for side in [u, -u, v, -v] {
                let side = side * f64::from(c.radius);
                line(c.ends[0].as_dvec3() + side, c.ends[1].as_dvec3() + side);
            }
        }
        Shape::Curves { points, segments } => {
            let k = segments[i] as usize;
            line(points[k].position.as_dvec3(), points[k + 1].position.as_dvec3());
        }
        Shape::Spheres(spheres) => {
            let s = &spheres[i];
            [Vec3::X, Vec3::Y, Vec3::Z].iter().for_each(|n| circle(s.center, *n, s.radius, line));
        }
        Shape::User(user) => {
            let b = user.bounds(i as u32);
            if b.is_finite() {
                edges(&b, line);
            }
        }
    }
}

/// Two directions across `axis` and each other, unit.
fn across(axis: Vec3) -> (DVec3, DVec3) {
    let n = axis.as_dvec3().try_normalize().unwrap_or(DVec3::Z);
    let u = n.any_orthonormal_vector();
    (u, n.cross(u))
}

fn circle(center: Vec3, normal: Vec3, radius: f32, line: &mut impl FnMut(DVec3, DVec3)) {
    let (u, v) = across(normal);
    let at = |k: usize| {
        let (sin, cos) = sin_cos(k as f64 / STEPS as f64 * std::f64::consts::TAU);
        center.as_dvec3() + (u * cos + v * sin) * f64::from(radius)
    };
    (0..STEPS).for_each(|k| line(at(k), at(k + 1)));
}

fn edges(b: &Bounds3, line: &mut impl FnMut(DVec3, DVec3)) {
    let corner = |k: usize| {
        let pick = |bit: usize, axis: usize| if k >> bit & 1 == 1 { b.max[axis] } else { b.min[axis] };
        Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2)).as_dvec3()
    };
    for a in 0..8_usize {
        for bit in 0..3 {
            if a >> bit & 1 == 0 {
                line(corner(a), corner(a | 1 << bit));
            }
        }
    }
}
