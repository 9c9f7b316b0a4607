//! Trees that were refitted answer as trees that were built anew.

use crate::agreement;
use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, DVec3, Ray, Vec3};
use proptest::prelude::*;
use std::sync::Arc;

const REFITTABLE: [AccelKind; 5] =
    [AccelKind::BruteForce, AccelKind::Bvh8, AccelKind::Bvh8Fast, AccelKind::Bvh8Best, AccelKind::Bvh8Compact];

/// Every vertex, ball, box and place elsewhere; a few far away.
fn moved(scene: &SceneGeometry, r: &mut Random) -> SceneGeometry {
    let mut scene = scene.clone();
    let far = [0.3, 3.0][r.below(2) as usize];
    let mut shift = |p: &mut Vec3| *p += r.cube() * far;
    let mut geometries = |all: &mut Vec<Geometry>| {
        for g in all {
            match &mut g.shape {
                Shape::Triangles { positions, .. } => Arc::make_mut(positions).iter_mut().for_each(&mut shift),
                Shape::MovingTriangles { keys, .. } => {
                    Arc::make_mut(keys).iter_mut().flatten().for_each(&mut shift);
                }
                Shape::Spheres(balls) => Arc::make_mut(balls).iter_mut().for_each(|b| shift(&mut b.center)),
                Shape::User(user) if user.is_empty() => {}
                Shape::User(user) if user.bounds(0).is_finite() => {
                    let moved = |i: usize| {
                        let (mut a, mut b) = (user.bounds(i as u32).min, user.bounds(i as u32).max);
                        shift(&mut a);
                        shift(&mut b);
                        Bounds3::from_corners(a, b)
                    };
                    g.shape = Shape::User(Arc::new(Boxes((0..user.len()).map(moved).collect())));
                }
                Shape::User(user) => *user = Arc::new(Plane(-1.25)),
                _ => {}
            }
        }
    };
    geometries(&mut scene.world);
    scene.aggregates.iter_mut().for_each(|a| geometries(&mut a.geometries));
    for i in &mut scene.instances {
        let mut by = Vec3::ZERO;
        shift(&mut by);
        let by = AnimatedTransform::still(DAffine3::from_translation(by.as_dvec3()));
        i.outer_from_object = i.outer_from_object.within(&by);
    }
    scene
}

/// With triangles that move.
pub fn with_motion((mut scene, corners): (SceneGeometry, Vec<Vec3>), r: &mut Random) -> (SceneGeometry, Vec<Vec3>) {
    let count = 2 + r.below(3) as usize;
    let keys: Vec<Vec<Vec3>> =
        (0..count).map(|_| corners.iter().map(|c| *c * 0.2 + r.cube() * 2.0).collect()).collect();
    let indices = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let moving = Shape::MovingTriangles { keys: Arc::new(keys), indices: Arc::new(indices) };
    if let Some(a) = scene.aggregates.first_mut() {
        a.geometries.push(geometry(moving.clone()));
    }
    scene.world.push(geometry(moving));
    (scene, corners)
}

fn check(seed: u64, n: usize) {
    let r = &mut Random::new(seed);
    let (mut scene, mut corners) = agreement::scene(r, n);
    if seed.is_multiple_of(2) {
        (scene, corners) = with_motion((scene, corners), r);
    }
    let then = moved(&scene, r);
    let rays: Vec<Ray> = (0..150).map(|_| agreement::ray(r, &corners)).collect();
    for kind in REFITTABLE {
        let mut accel = build(kind, &scene);
        accel.refit(then.clone()).unwrap();
        accel.validate().unwrap();
        let fresh = build(kind, &then);
        assert_eq!(accel.bounds(), fresh.bounds());
        let c = &mut Counters::default();
        let mut batch = vec![None; rays.len()];
        accel.closest_hits(&rays, Query::ALL, &mut batch, c);
        let mut packets = batch.clone();
        accel.closest_hits_coherent(&rays, Query::ALL, &mut packets, c);
        for (i, ray) in rays.iter().enumerate() {
            let expected = bits(closest(&fresh, ray));
            assert_eq!(bits(closest(&accel, ray)), expected, "{kind:?} {ray:?}");
            assert_eq!((bits(batch[i]), bits(packets[i])), (expected, expected), "{kind:?} {ray:?}");
            assert_eq!(accel.any_hit(ray, Query::ALL, i, c), expected.is_some());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_refitted_tree_answers_as_one_built_anew(seed: u64, n in prop_oneof![Just(4_usize), 9..60_usize, Just(300)]) {
        check(seed, n);
    }
}

#[test]
fn a_tree_can_be_refitted_again_and_again_and_be_saved() {
    let (positions, indices) = crate::meshes::ball(3);
    let indices = Arc::new(indices);
    let at = |k: f32| {
        let stretched = positions.iter().map(|p| *p * Vec3::new(1.0 + k, 1.0, 1.0 / (1.0 + k)) + Vec3::Y * k);
        world(vec![Shape::Triangles { positions: Arc::new(stretched.collect()), indices: indices.clone() }])
    };
    for kind in REFITTABLE {
        let mut accel = build(kind, &at(0.0));
        for k in [3.0, 0.1, -0.5, 0.0] {
            accel.refit(at(k)).unwrap();
            accel.validate().unwrap();
        }
        if kind != AccelKind::BruteForce {
            let mut file = Vec::new();
            accel.save(&mut file).unwrap();
            accel = Accel::load(at(0.0), &mut &file[..]).unwrap();
        }
        let (r, fresh) = (&mut Random::new(1), build(kind, &at(0.0)));
        for _ in 0..500 {
            let ray = Ray::new(r.cube() * 3.0, r.cube());
            assert_eq!(bits(closest(&accel, &ray)), bits(closest(&fresh, &ray)));
        }
    }
}

#[test]
fn another_topology_is_refused_and_leaves_all_as_it_was() {
    let corners = |x: f32| [Vec3::X * x, Vec3::Y, Vec3::Z];
    let at = |x: f64| AnimatedTransform::still(DAffine3::from_translation(DVec3::X * x));
    let instance = |aggregate| Instance { aggregate, outer_from_object: at(3.0), mask: u32::MAX };
    let scene = SceneGeometry {
        world: vec![geometry(triangles(&[corners(1.0), corners(2.0)])), geometry(Shape::User(Arc::new(Plane(-9.0))))],
        aggregates: vec![vec![geometry(triangles(&[corners(1.0)]))].into(), vec![geometry(triangles(&[]))].into()],
        instances: vec![instance(0)],
        shutter: (0.0, 1.0),
    };
    let mut accel = build(AccelKind::Bvh8, &scene);
    let mut refusal = |change: fn(&mut SceneGeometry)| {
        let mut other = scene.clone();
        change(&mut other);
        let text = accel.refit(other).unwrap_err().to_string();
        accel.validate().unwrap();
        assert!(Arc::ptr_eq(
            match &accel.scene_geometry().world[0].shape {
                Shape::Triangles { positions, .. } => positions,
                _ => unreachable!(),
            },
            match &scene.world[0].shape {
                Shape::Triangles { positions, .. } => positions,
                _ => unreachable!(),
            },
        ));
        text
    };
    assert_eq!(
        refusal(|s| {
            s.world.pop();
        }),
        "the number of geometries of the world changed; build anew"
    );
    assert_eq!(refusal(|s| s.world.swap(0, 1)), "the primitives of the world changed; build anew");
    let longer =
        |s: &mut SceneGeometry| s.aggregates[0].geometries[0].shape = triangles(&[[Vec3::X, Vec3::Y, Vec3::Z]; 2]);
    assert_eq!(refusal(longer), "the primitives of aggregate 0 changed; build anew");
    assert_eq!(refusal(|s| s.instances[0].aggregate = 1), "the instances of the world changed; build anew");
    assert_eq!(
        refusal(|s| s.aggregates.push(Aggregate::default())),
        "the number of aggregates of the world changed; build anew"
    );
    let bounded = |s: &mut SceneGeometry| {
        s.world[1].shape = Shape::User(Arc::new(Boxes(vec![Bounds3::from_corners(Vec3::ZERO, Vec3::ONE)])));
    };
    assert_eq!(refusal(bounded), "what has bounds of the world changed; build anew");
    assert_eq!(refusal(|s| s.shutter.0 = f64::NAN), "the shutter cannot be open from NaN to 1");
    let text = build(AccelKind::Grid, &scene).refit(scene.clone()).unwrap_err().to_string();
    assert_eq!(text, "a grid cannot be refitted; brute_force and the bvh8 kinds can");
}
