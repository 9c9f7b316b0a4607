//! The closest point of all surfaces, against brute force, closed forms and random points of the surfaces.

use crate::agreement::{point, scene_of_everything};
use crate::common::*;
use crate::solids;
use kirkas_accel::*;
use kirkas_geometry::transform::rotation;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, DMat3, DVec3, Ray, Vec3};
use std::sync::Arc;

fn to_bits(hit: Option<PointHit>) -> Option<([u32; 6], PrimitiveId)> {
    hit.map(|h| {
        let [x, y, z] = h.position.to_array();
        ([h.distance, x, y, z, h.u, h.v].map(f32::to_bits), h.id())
    })
}

#[test]
fn every_structure_finds_the_point_that_brute_force_finds() {
    let mut found = 0;
    for seed in 0..60 {
        let r = &mut Random::new(seed);
        let (scene, _) = scene_of_everything(r, [2, 10, 60][seed as usize % 3]);
        let accels = AccelKind::ALL.map(|(kind, _)| build(kind, &scene));
        for _ in 0..60 {
            let far = [1.0, 1.0, 1e3, 1e-3][r.below(4) as usize];
            let query = PointQuery {
                time: r.unit(),
                mask: [u32::MAX, 1, 2][r.below(3) as usize],
                ..PointQuery::new(point(r) * far, [f32::INFINITY, 0.3][r.below(2) as usize])
            };
            let expected = accels[0].closest_point(&query);
            for accel in &accels {
                assert_eq!(to_bits(accel.closest_point(&query)), to_bits(expected), "{:?} {query:?}", accel.kind());
            }
            assert!(expected.is_none_or(|h| h.distance <= query.max_distance));
            found += usize::from(expected.is_some());
        }
    }
    assert!(found > 2000, "{found}");
}

#[test]
fn no_point_of_a_surface_is_closer_than_the_closest() {
    let r = &mut Random::new(12);
    for _ in 0..3000 {
        let seed = u64::from(r.bits());
        let of = |k: u64| solids::shape_and_point(&mut Random(seed, k), 1.0).0;
        let shape = of(0);
        let accel = build(AccelKind::BruteForce, &world(vec![shape.clone()]));
        let from = r.cube() * 2.0;
        let hit = accel.closest_point(&PointQuery::new(from, f32::INFINITY)).unwrap();
        assert!(((hit.position - from).length() - hit.distance).abs() < 1e-5);
        // Rays from all around towards the point's neighbourhood meet nothing nearer.
        for _ in 0..20 {
            let ray = Ray::new(from, hit.position + r.cube() * 0.3 - from);
            if let Some(met) = closest(&accel, &ray) {
                assert!((ray.at(met.t) - from).length() > hit.distance - 1e-5, "{hit:?} {met:?}");
            }
        }
    }
}

#[test]
fn closed_forms() {
    let of = |shape: Shape, from: Vec3| {
        let accel = build(AccelKind::BruteForce, &world(vec![shape]));
        let hit = accel.closest_point(&PointQuery::new(from, f32::INFINITY)).unwrap();
        (hit.distance, hit.position, hit.u, hit.v)
    };
    let ball = || Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::ZERO, radius: 2.0 }]));
    assert_eq!(of(ball(), Vec3::Y * 5.0), (3.0, Vec3::Y * 2.0, 0.0, 0.0));
    assert_eq!(of(ball(), Vec3::Y * 0.5), (1.5, Vec3::Y * 2.0, 0.0, 0.0), "from inside");
    assert_eq!(of(ball(), Vec3::ZERO).0, 2.0);
    let disk = || solids::disk(Vec3::ZERO, Vec3::Z * 3.0, 2.0);
    assert_eq!(of(disk(), Vec3::new(1.0, 0.0, 4.0)), (4.0, Vec3::X, 0.5, 0.0));
    assert_eq!(of(disk(), Vec3::new(5.0, 0.0, 4.0)), (5.0, Vec3::X * 2.0, 1.0, 0.0));
    let tube = || solids::cylinder(Vec3::ZERO, Vec3::Z * 4.0, 1.0);
    assert_eq!(of(tube(), Vec3::new(3.0, 0.0, 1.0)), (2.0, Vec3::new(1.0, 0.0, 1.0), 0.25, 0.0));
    assert_eq!(of(tube(), Vec3::new(0.5, 0.0, 1.0)), (0.5, Vec3::new(1.0, 0.0, 1.0), 0.25, 0.0));
    assert_eq!(of(tube(), Vec3::new(4.0, 0.0, 8.0)), (5.0, Vec3::new(1.0, 0.0, 4.0), 1.0, 0.0));
    let capsule = || solids::curve(&[(Vec3::ZERO, 1.0), (Vec3::Z * 4.0, 1.0)]);
    assert_eq!(of(capsule(), Vec3::new(3.0, 0.0, 8.0)).0, 4.0, "a cap");
    assert_eq!(of(capsule(), Vec3::new(0.25, 0.0, 2.0)), (0.75, Vec3::new(1.0, 0.0, 2.0), 0.5, 0.0), "from inside");
    let square = || solids::quad([Vec3::ZERO, Vec3::X * 4.0, Vec3::new(4.0, 4.0, 0.0), Vec3::Y * 4.0]);
    assert_eq!(of(square(), Vec3::new(3.0, 2.0, 2.0)), (2.0, Vec3::new(3.0, 2.0, 0.0), 0.75, 0.5));
    assert_eq!(of(square(), Vec3::new(7.0, 8.0, 0.0)), (5.0, Vec3::new(4.0, 4.0, 0.0), 1.0, 1.0));
    let needle = triangles(&[[Vec3::ZERO, Vec3::X, Vec3::X * 2.0]]);
    assert_eq!(of(needle, Vec3::new(1.5, 1.0, 0.0)).0, 1.0, "without area");
}

#[test]
fn distances_are_those_of_the_world() {
    let place = |stretch: DVec3| {
        let matrix3 = rotation(DVec3::Z, 90.0) * DMat3::from_diagonal(stretch);
        AnimatedTransform::still(DAffine3 { matrix3, translation: DVec3::new(0.0, 0.0, 10.0) })
    };
    let scene = |shape: Shape, stretch: DVec3| SceneGeometry {
        aggregates: vec![
            vec![geometry(shape)].into(),
            Aggregate {
                geometries: vec![],
                instances: vec![Instance { aggregate: 0, outer_from_object: place(stretch), mask: u32::MAX }],
            },
        ],
        instances: vec![Instance { aggregate: 1, outer_from_object: place(DVec3::splat(2.0)), mask: 4 }],
        ..SceneGeometry::default()
    };
    let ball = || Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]));
    let tri = triangles(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    for (kind, _) in AccelKind::ALL {
        let ask = |scene: &SceneGeometry, x: f32| {
            let query = PointQuery { mask: 4, ..PointQuery::new(Vec3::new(x, 0.0, 30.0), 100.0) };
            build(kind, scene).closest_point(&query)
        };
        // At z = 10 + 2 * 10, with radius 2 * 3.
        let hit = ask(&scene(ball(), DVec3::splat(3.0)), 9.0).unwrap();
        assert_eq!((hit.distance, hit.instance.iter().collect::<Vec<_>>()), (3.0, vec![0, 0]));
        assert_eq!(ask(&scene(ball(), DVec3::new(3.0, 3.0, 1.0)), 9.0), None, "round and stretched unevenly");
        // Turned by half: the corner (1, 0, 0) goes to (-2 * 5, 0, 30).
        let hit = ask(&scene(tri.clone(), DVec3::new(5.0, 1.0, 1.0)), -13.0).unwrap();
        assert_eq!((hit.distance, hit.u, hit.v), (3.0, 1.0, 0.0));
        let query = PointQuery { mask: 3, ..PointQuery::new(Vec3::ZERO, 100.0) };
        assert_eq!(build(kind, &scene(ball(), DVec3::ONE)).closest_point(&query), None, "the mask");
    }
}

/// Balls as a user may bring them.
struct OwnBall(Vec3, f32);

impl UserShape for OwnBall {
    fn len(&self) -> usize {
        1
    }
    fn bounds(&self, _: u32) -> Bounds3 {
        Bounds3 { min: self.0 - self.1, max: self.0 + self.1 }
    }
    fn intersect(&self, _: u32, _: &Ray, _: &mut dyn FnMut(f32, f32, f32) -> bool) {}
    fn closest_point(&self, _: u32, point: DVec3) -> Option<SurfacePoint> {
        let center = self.0.as_dvec3();
        let position = center + (point - center).normalize() * f64::from(self.1);
        Some(SurfacePoint { position, u: 0.25, v: 0.5 })
    }
}

#[test]
fn user_shapes_take_part_when_they_can() {
    for (kind, _) in AccelKind::ALL {
        let boxes = Shape::User(Arc::new(Boxes(vec![Bounds3::from_corners(Vec3::ZERO, Vec3::ONE)])));
        let accel = build(kind, &world(vec![boxes, Shape::User(Arc::new(OwnBall(Vec3::X * 8.0, 1.0)))]));
        let hit = accel.closest_point(&PointQuery::new(Vec3::ZERO, 10.0)).unwrap();
        assert_eq!((hit.distance, hit.geometry, hit.u, hit.v), (7.0, 1, 0.25, 0.5));
        assert_eq!(accel.closest_point(&PointQuery::new(Vec3::ZERO, 7.0)), None, "closer than, not as close as");
        assert_eq!(accel.closest_point(&PointQuery::new(Vec3::NAN, 10.0)), None);
    }
}
