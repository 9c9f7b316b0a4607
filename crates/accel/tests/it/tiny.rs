//! A walk through every part of the code on scenes so small that an interpreter can check each step: `cargo xtask sanitize`.

use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Ray, Vec3};
use std::sync::Arc;

fn scene(r: &mut Random) -> SceneGeometry {
    let soup: Vec<[Vec3; 3]> =
        (0..14).map(|_| (r.cube(), r.cube() * 0.5, r.cube())).map(|(p, a, b)| [p, p + a, p + b]).collect();
    let balls = (0..4).map(|_| Sphere { center: r.cube(), radius: 0.2 }).collect();
    let keys = (0..2).map(|_| (0..12).map(|_| r.cube()).collect()).collect();
    let indices = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let moving = Shape::MovingTriangles { keys: Arc::new(keys), indices: Arc::new(indices) };
    let instance = |x: f64| Instance {
        aggregate: 0,
        outer_from_object: AnimatedTransform::still(DAffine3::from_translation(DVec3::X * x)),
        mask: u32::MAX,
    };
    SceneGeometry {
        world: vec![geometry(triangles(&soup)), geometry(Shape::User(Arc::new(Plane(-1.0))))],
        aggregates: vec![
            vec![geometry(triangles(&soup[..9])), geometry(Shape::Spheres(Arc::new(balls))), geometry(moving)].into(),
        ],
        instances: vec![instance(-2.0), instance(2.0)],
        shutter: (0.0, 1.0),
    }
}

#[test]
fn tiny_scenes_are_searched_in_every_way() {
    let r = &mut Random::new(5);
    let scene = scene(r);
    let camera = (0..64).map(|i| {
        Ray::new(Vec3::new(1.0, 2.0, 5.0), Vec3::new((i % 8) as f32 * 0.01 - 0.3, (i / 8) as f32 * 0.01 - 0.5, -1.0))
    });
    let random = (0..6).map(|_| Ray::new(r.cube() * 3.0, r.cube()).at_time(r.unit()));
    let rays: Vec<Ray> = camera.chain(random).collect();
    let brute = build(AccelKind::BruteForce, &scene);
    let expected: Vec<Option<Hit>> = rays.iter().map(|ray| closest(&brute, ray)).collect();
    assert!(expected.iter().flatten().count() > 5);
    let mut still = scene.clone();
    still.aggregates[0].geometries.pop();
    // An interpreter is slow: it walks through what has unsafe code.
    let searched = |name: &str| !cfg!(miri) || ["bvh8", "bvh8_best", "bvh8_compact"].contains(&name);
    for (kind, name) in AccelKind::ALL.into_iter().filter(|(_, name)| searched(name)) {
        // Without what moves, packets stay together.
        assert_same_batches(&build(kind, &still), &rays, Query::ALL, &{
            let brute = build(AccelKind::BruteForce, &still);
            rays.iter().map(|ray| closest(&brute, ray)).collect::<Vec<_>>()
        });
        let mut accel = Accel::build(kind, scene.clone(), &Threads).unwrap();
        assert_same_batches(&accel, &rays, Query::ALL, &expected);
        let near = PointQuery::new(Vec3::ONE, f32::INFINITY);
        assert_eq!(accel.closest_point(&near).map(|p| p.id()), brute.closest_point(&near).map(|p| p.id()));
        if name.starts_with("bvh8") {
            let mut file = Vec::new();
            accel.save(&mut file).unwrap();
            accel = Accel::load(scene.clone(), &mut &file[..]).unwrap();
            accel.refit(scene.clone()).unwrap();
        }
        for (ray, expected) in rays.iter().zip(&expected) {
            assert_eq!(bits(closest(&accel, ray)), bits(*expected), "{name} {ray:?}");
        }
    }
}
