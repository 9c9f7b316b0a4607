//! A hash of all that a structure depends on: a saved tree fits no other scene.

use crate::checksum::Checksum;
use crate::scene_geometry::{Geometry, Instance, SceneGeometry, Shape};
use kirkas_geometry::Vec3;

/// Of shapes, places and shutter. Masks and opacity are free to change; user shapes count by their bounds.
pub(crate) fn of(scene: &SceneGeometry) -> u64 {
    let mut c = Checksum::new();
    for time in [scene.shutter.0, scene.shutter.1] {
        c.word(time.to_bits());
    }
    level(&mut c, &scene.world, &scene.instances);
    c.word(scene.aggregates.len() as u64);
    for aggregate in &scene.aggregates {
        level(&mut c, &aggregate.geometries, &aggregate.instances);
    }
    c.value()
}

fn level(c: &mut Checksum, geometries: &[Geometry], instances: &[Instance]) {
    c.word(geometries.len() as u64);
    geometries.iter().for_each(|g| shape(c, &g.shape));
    c.word(instances.len() as u64);
    for instance in instances {
        c.word(instance.aggregate as u64);
        instance.outer_from_object.numbers().for_each(|n| c.word(n.to_bits()));
    }
}

fn shape(c: &mut Checksum, shape: &Shape) {
    let bits = |v: &Vec3| v.to_array().map(f32::to_bits);
    match shape {
        Shape::Triangles { positions, indices } => {
            c.word(1);
            c.all(positions.iter().flat_map(bits));
            c.all(indices.as_flattened().iter().copied());
        }
        Shape::MovingTriangles { keys, indices } => {
            c.word(2);
            c.word(keys.len() as u64);
            keys.iter().for_each(|positions| c.all(positions.iter().flat_map(bits)));
            c.all(indices.as_flattened().iter().copied());
        }
        Shape::Quads { positions, indices } => {
            c.word(3);
            c.all(positions.iter().flat_map(bits));
            c.all(indices.as_flattened().iter().copied());
        }
        Shape::Disks(disks) => {
            c.word(4);
            let round = |d: &crate::Disk| [d.center, d.normal, Vec3::splat(d.radius)];
            c.all(disks.iter().flat_map(round).flat_map(|v| bits(&v)));
        }
        Shape::Cylinders(all) => {
            c.word(5);
            let round = |d: &crate::Cylinder| [d.ends[0], d.ends[1], Vec3::splat(d.radius)];
            c.all(all.iter().flat_map(round).flat_map(|v| bits(&v)));
        }
        Shape::Curves { points, segments } => {
            c.word(6);
            let point = |p: &crate::CurvePoint| [p.position, Vec3::splat(p.radius)];
            c.all(points.iter().flat_map(point).flat_map(|v| bits(&v)));
            c.all(segments.iter().copied());
        }
        Shape::Spheres(spheres) => {
            c.word(7);
            let ball = |s: &crate::Sphere| [s.center, Vec3::splat(s.radius)];
            c.all(spheres.iter().flat_map(ball).flat_map(|v| bits(&v)));
        }
        Shape::User(user) => {
            c.word(8);
            let boxes = (0..user.len()).map(|i| user.bounds(i as u32));
            c.all(boxes.flat_map(|b| [b.min, b.max]).flat_map(|v| bits(&v)));
        }
    }
}
