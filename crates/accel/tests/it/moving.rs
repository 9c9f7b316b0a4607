//! Moving triangles against still ones at sampled times, and their boxes.

use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{Bounds3, Ray, Vec3};
use std::sync::Arc;

fn keys(r: &mut Random, count: usize, vertices: usize) -> Vec<Vec<Vec3>> {
    let scale = [1.0, 1e-20, 1e20][r.below(3) as usize];
    (0..count).map(|_| (0..vertices).map(|_| r.cube() * scale).collect()).collect()
}

fn indices(r: &mut Random, count: usize, vertices: u32) -> Vec<[u32; 3]> {
    (0..count).map(|_| [r.below(vertices), r.below(vertices), r.below(vertices)]).collect()
}

#[test]
fn moving_triangles_are_at_each_time_the_triangles_of_that_time() {
    let mut hits = 0;
    for seed in 0..24 {
        let r = &mut Random::new(seed);
        let count = 2 + r.below(4) as usize;
        let keys = keys(r, count, 30);
        let size = keys[0][0].abs().max_element().max(keys[0][1].abs().max_element());
        let (positions, indices) = (keys.clone(), Arc::new(indices(r, 40, 30)));
        let mut scene = world(vec![Shape::MovingTriangles { keys: Arc::new(keys), indices: indices.clone() }]);
        scene.shutter = (2.0, 6.0);
        for k in [0.0, 0.1, 1.0 / 3.0, 0.5, 0.77, 1.0] {
            let at = positions.len() as f32 - 1.0;
            let key = ((k * at) as usize).min(positions.len() - 2);
            let part = k * at - key as f32;
            let between = positions[key].iter().zip(&positions[key + 1]).map(|(a, b)| *a * (1.0 - part) + *b * part);
            let still = Shape::Triangles { positions: Arc::new(between.collect()), indices: indices.clone() };
            let still = build(AccelKind::BruteForce, &world(vec![still]));
            let rays: Vec<Ray> =
                (0..40).map(|_| Ray::new(r.cube() * 2.0 * size, r.cube()).at_time(2.0 + 4.0 * k)).collect();
            hits += assert_agreement(&scene, &rays);
            let moving = build(AccelKind::Bvh2, &scene);
            for ray in &rays {
                // The time is rounded on its way: only exact ones give the same bits.
                if (2.0 + 4.0 * k - 2.0) / 4.0 == k {
                    assert_eq!(bits(closest(&moving, ray)), bits(closest(&still, ray)), "{k} {ray:?}");
                }
            }
            let before = closest(&moving, &rays[0].at_time(-5.0));
            assert_eq!(bits(before), bits(closest(&moving, &rays[0].at_time(2.0))), "times are clamped");
        }
    }
    assert!(hits > 1200, "{hits}");
}

#[test]
fn boxes_of_what_moves_hold_it_at_every_moment() {
    let holds = |outer: &Bounds3, inner: &Bounds3| outer.union(*inner) == *outer;
    for seed in 0..300 {
        let r = &mut Random::new(seed);
        let count = 2 + r.below(5) as usize;
        let mut keys = keys(r, count, 3);
        if seed % 2 == 0 {
            // Nearly at rest: what rounding moves stands out of the boxes at the keys.
            let first = keys[0].clone();
            keys.iter_mut().for_each(|k| k.clone_from(&first));
        }
        let index = [0, 1, 2];
        let all = moving::bounds(&keys, index);
        let [open, close] = moving::linear_bounds(&keys, index);
        for k in 0..=200 {
            let moment = k as f32 / 200.0;
            let now = moving::bounds_at(&keys, index, moment);
            assert!(holds(&all, &now), "{all:?} {now:?}");
            let between = |a: Vec3, b: Vec3| a * (1.0 - moment) + b * moment;
            let linear = Bounds3 { min: between(open.min, close.min), max: between(open.max, close.max) };
            assert!(holds(&linear, &now), "{linear:?} {now:?}");
        }
    }
}

#[test]
fn a_closed_mesh_that_moves_stays_closed() {
    let (positions, indices) = crate::meshes::ball(2);
    let r = &mut Random::new(3);
    let moved = positions.iter().map(|p| *p * Vec3::new(1.5, 0.7, 1.1) + r.cube() * 0.05).collect();
    let keys = Arc::new(vec![positions.clone(), moved, positions]);
    let mut scene = world(vec![Shape::MovingTriangles { keys, indices: Arc::new(indices) }]);
    scene.shutter = (0.0, 1.0);
    let accel = build(AccelKind::Bvh2, &scene);
    for _ in 0..20_000 {
        let ray = Ray::new(r.cube() * 0.2, r.cube()).at_time(r.unit());
        assert!(closest(&accel, &ray).is_some(), "{ray:?}");
    }
}

#[test]
fn trees_of_what_rests_and_moves_equal_brute_force() {
    let mut hits = 0;
    for seed in 0..16 {
        let r = &mut Random::new(seed);
        let everything = crate::agreement::scene(r, [3, 9, 40, 150][seed as usize % 4]);
        let (scene, corners) = crate::refit::with_motion(everything, r);
        let rays: Vec<Ray> = (0..150).map(|_| crate::agreement::ray(r, &corners)).collect();
        hits += assert_agreement(&scene, &rays);
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn a_ray_meets_boxes_of_its_own_time() {
    let (positions, indices) = crate::meshes::ball(5);
    let far = positions.iter().map(|p| *p + Vec3::new(20.0, 1.0, 0.0)).collect();
    let still = Shape::Triangles { positions: Arc::new(positions.clone()), indices: Arc::new(indices.clone()) };
    let moving = Shape::MovingTriangles { keys: Arc::new(vec![positions, far]), indices: Arc::new(indices) };
    let mut scene = world(vec![moving]);
    scene.shutter = (0.0, 1.0);
    let cost = |accel: &Accel, scale: f32| {
        let (r, c) = (&mut Random::new(1), &mut Counters::default());
        let mut hits = 0;
        for _ in 0..2000 {
            let (time, from) = (r.unit(), r.cube() * 3.0);
            let origin = Vec3::new(20.0, 1.0, 0.0) * time * scale + from;
            let ray = Ray::new(origin, r.cube() - from).at_time(time);
            hits += usize::from(accel.closest_hit(&ray, Query::ALL, 0, c).is_some());
        }
        assert!(hits > 1000, "{hits}");
        (c.nodes_visited as f64 / 2000.0, c.primitives_tested as f64 / 2000.0)
    };
    let rest = cost(&build(AccelKind::Bvh8Compact, &world(vec![still])), 0.0);
    for kind in [AccelKind::Bvh8, AccelKind::Bvh8Fast, AccelKind::Bvh8Best, AccelKind::Bvh8Compact] {
        let moved = cost(&build(kind, &scene), 1.0);
        assert!(moved.0 < 1.5 * rest.0 && moved.1 < 1.5 * rest.1, "{kind:?}: {moved:?}, at rest {rest:?}");
    }
    let swept = cost(&build(AccelKind::Bvh2, &scene), 1.0);
    println!(
        "at rest {rest:?}, boxes that move {:?}, swept boxes {swept:?}",
        cost(&build(AccelKind::Bvh8, &scene), 1.0)
    );
}
