//! Packets of rays that truly run together, as those of cameras do, answer as single rays.

use crate::agreement;
use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{Ray, Vec3};
use std::sync::Arc;

/// Pixels across.
const SIZE: u32 = 24;

/// Pixels in tiles of 8 x 8, so that 64 in a row are neighbours; from -1 to 1.
fn pixels() -> impl Iterator<Item = (f32, f32)> {
    let at = |k: u32| (k as f32 + 0.5) / SIZE as f32 * 2.0 - 1.0;
    let tiles = SIZE / 8;
    (0..SIZE * SIZE).map(move |i| {
        let (tile, p) = (i / 64, i % 64);
        (at(tile % tiles * 8 + p % 8), at(tile / tiles * 8 + p / 8))
    })
}

/// Two directions across a third.
fn across(forward: Vec3) -> (Vec3, Vec3) {
    let other = if forward.x.abs() > forward.y.abs() { Vec3::Y } else { Vec3::X };
    let right = forward.cross(other).normalize();
    (right, right.cross(forward))
}

/// A pinhole camera.
fn pinhole(from: Vec3, forward: Vec3, width: f32) -> Vec<Ray> {
    let (right, up) = across(forward);
    pixels().map(|(x, y)| Ray::new(from, forward + (right * x + up * y) * width)).collect()
}

/// Parallel rays.
fn orthographic(from: Vec3, forward: Vec3, width: f32) -> Vec<Ray> {
    let (right, up) = across(forward);
    pixels().map(|(x, y)| Ray::new(from + (right * x + up * y) * width, forward)).collect()
}

/// Cameras of all kinds that look at something between -2 and 2.
fn views(r: &mut Random, corners: &[Vec3]) -> Vec<Vec<Ray>> {
    let corner = |r: &mut Random| corners[r.below(corners.len() as u32) as usize];
    let from = r.cube().normalize() * 5.0;
    let (a, b) = (corner(r), corner(r));
    let mut views = vec![
        pinhole(from, -from * 0.2, 0.5),
        pinhole(r.cube(), r.cube().normalize(), 1.0),
        // Along an axis: rays at both sides of it, some with a direction of 0 or nearly so.
        pinhole(Vec3::new(0.5, 0.5, 6.0), -Vec3::Z, 0.4),
        pinhole(Vec3::X * -6.0, Vec3::X, 0.4),
        pinhole(Vec3::Y * 1e3, -Vec3::Y, 2e-3),
        // From a corner towards others, all of a packet nearly along one edge.
        pinhole(a, b - a + Vec3::splat(1e-9), 1e-4),
        pinhole(a * 2.0 - b, b - a + Vec3::splat(1e-9), 1e-7),
        orthographic(Vec3::new(0.0, 0.0, 5.0), -Vec3::Z, 2.0),
        orthographic(Vec3::new(-4.0, -4.0, -4.0), Vec3::new(1.0, 1.25, 0.75), 2.5),
        orthographic(b * 2.0 - a, a - b + Vec3::splat(1e-9), 0.3),
    ];
    let mut limited = pinhole(from, -from * 0.2, 0.5);
    for ray in &mut limited {
        (ray.t_min, ray.t_max, ray.time) = (2.0 + r.unit(), 5.0 + r.unit(), r.unit());
    }
    views.push(limited);
    views
}

fn check(scene: &SceneGeometry, corners: &[Vec3], r: &mut Random) -> usize {
    let reference = build(AccelKind::Bvh2, scene);
    let kinds = [AccelKind::Bvh8, AccelKind::Bvh8Best, AccelKind::Bvh8Compact];
    let (fast, portable) = (kinds.map(|k| build(k, scene)), kinds.map(|k| build(k, scene).portable()));
    let mut hits = 0;
    for (i, rays) in views(r, corners).iter().enumerate() {
        let query = if i % 3 == 1 { Query::filtered(&Coin) } else { Query::ALL };
        let mut expected = vec![None; rays.len()];
        reference.closest_hits(rays, query, &mut expected, &mut Counters::default());
        fast.iter().chain(&portable).for_each(|accel| assert_same_batches(accel, rays, query, &expected));
        hits += expected.iter().flatten().count();
    }
    hits
}

#[test]
fn packets_of_camera_rays_answer_as_single_rays() {
    let mut hits = 0;
    for seed in 0..6 {
        let r = &mut Random::new(seed);
        let (scene, corners) = agreement::scene_of_everything(r, [9, 40, 200][seed as usize % 3]);
        hits += check(&scene, &corners, r);
    }
    let r = &mut Random::new(77);
    let (positions, indices) = crate::meshes::ball(4);
    let mesh = Shape::Triangles { positions: Arc::new(positions.clone()), indices: Arc::new(indices) };
    hits += check(&world(vec![mesh]), &positions, r);
    let p = |i: u32, x: u32, y: u32| {
        Vec3::new((i % 8 + x) as f32, (i / 8 + y) as f32, 0.0) * 0.25 - Vec3::new(1.0, 1.0, 0.0)
    };
    let grid: Vec<_> =
        (0..64).flat_map(|i| [[p(i, 0, 0), p(i, 1, 0), p(i, 1, 1)], [p(i, 0, 0), p(i, 1, 1), p(i, 0, 1)]]).collect();
    hits += check(&world(vec![triangles(&grid)]), &grid.concat(), r);
    let soup: Vec<_> = (0..3000)
        .map(|_| (r.cube() * 2.0, r.cube() * 0.2, r.cube() * 0.2))
        .map(|(p, a, b)| [p, p + a, p + b])
        .collect();
    hits += check(&world(vec![triangles(&soup)]), &soup.concat(), r);
    assert!(hits > 15_000, "{hits}");
}

/// Else the tests above would test batches only.
#[test]
fn camera_rays_go_down_the_tree_together() {
    let (positions, indices) = crate::meshes::ball(4);
    let scene = world(vec![Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) }]);
    let rays = pinhole(Vec3::new(2.0, 3.0, 4.0), Vec3::new(-2.0, -3.0, -4.0), 0.1);
    for accel in [build(AccelKind::Bvh8, &scene), build(AccelKind::Bvh8, &scene).portable()] {
        let (mut alone, mut together) = (Counters::default(), Counters::default());
        let mut hits = vec![None; rays.len()];
        accel.closest_hits(&rays, Query::ALL, &mut hits, &mut alone);
        accel.closest_hits_coherent(&rays, Query::ALL, &mut hits, &mut together);
        assert!(4 * together.nodes_visited < alone.nodes_visited, "{together:?} {alone:?}");
    }
}

/// Packets of all cameras, in which each ray has an interval, a mask and a time of its own. Some rays can hit nothing.
fn motley(r: &mut Random, corners: &[Vec3]) -> Vec<Ray> {
    let mut rays = views(r, corners).concat();
    for ray in &mut rays {
        let far = (ray.origin.length() + 2.0) / ray.direction.length();
        (ray.mask, ray.time) = (1 << r.below(3) | 8, r.unit());
        (ray.t_min, ray.t_max) = (far * 0.5 * r.unit(), far * (0.3 + r.unit()));
        match r.below(400) {
            0 => ray.t_min = f32::NAN,
            1 => ray.t_max = f32::NAN,
            2 => (ray.t_min, ray.t_max) = (f32::NEG_INFINITY, f32::NEG_INFINITY),
            3 => (ray.t_min, ray.t_max) = (f32::NEG_INFINITY, f32::INFINITY),
            4 => (ray.t_min, ray.t_max) = (1.0, 1.0),
            5 => ray.mask = 0,
            _ => {}
        }
    }
    rays
}

#[test]
fn each_ray_of_a_packet_keeps_its_own_terms() {
    let (mut hits, mut seen, mut left_out) = (0, 0, 0);
    for seed in 0..8 {
        let r = &mut Random::new(900 + seed);
        let (mut scene, corners) = agreement::scene_of_everything(r, [9, 40, 200][seed as usize % 3]);
        // What moves would send the rays elsewhere.
        scene.world.retain(|g| !matches!(g.shape, Shape::MovingTriangles { .. }));
        let twice =
            scene.world.iter().filter(|g| matches!(g.shape, Shape::Triangles { .. })).cloned().collect::<Vec<_>>();
        scene.world.extend(twice);
        for g in &mut scene.world {
            (g.mask, g.opaque) = ([1, 2, 4, 6, 9, 12, u32::MAX][r.below(7) as usize], r.below(2) == 0);
        }
        let rays = motley(r, &corners);
        let brute = build(AccelKind::BruteForce, &scene);
        let answer = |query: Query| -> Vec<Option<Hit>> {
            let c = &mut Counters::default();
            rays.iter().enumerate().map(|(i, ray)| brute.closest_hit(ray, query, i, c)).collect()
        };
        let first = answer(Query::ALL);
        let excluded: Vec<_> = first.iter().map(|hit| hit.filter(|_| r.below(2) == 0).map(|hit| hit.id())).collect();
        left_out += excluded.iter().flatten().count();
        let queries = [Query::ALL, Query::filtered(&Coin), Query::filtered(&Coin).excluding(&excluded[..2000])];
        for (kind, query) in [AccelKind::Bvh8, AccelKind::Bvh8Best, AccelKind::Bvh8Compact].into_iter().zip(queries) {
            let expected = answer(query);
            for accel in [build(kind, &scene), build(kind, &scene).portable()] {
                assert_same_batches(&accel, &rays, query, &expected);
            }
            (hits, seen) = (hits + expected.iter().flatten().count(), seen + rays.len());
        }
    }
    assert!(hits > seen / 20 && hits < seen && left_out > 1000, "{hits} of {seen}, {left_out}");
}

#[test]
fn odd_rays_among_others_find_what_they_find_alone() {
    let r = &mut Random::new(31);
    let (positions, indices) = crate::meshes::ball(3);
    let scene = world(vec![Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) }]);
    let brute = build(AccelKind::BruteForce, &scene);
    let odd = [
        Ray::new(Vec3::new(0.1, 0.2, 5.0), -Vec3::Z),
        Ray::new(Vec3::new(0.1, 0.2, 5.0), Vec3::new(0.0, -0.0, -1e-40)),
        Ray::new(Vec3::new(0.1, 0.2, 5.0), Vec3::new(1e-42, 1e-42, -1.0)),
        Ray::new(Vec3::ZERO, Vec3::ZERO),
        Ray::new(Vec3::ZERO, Vec3::splat(1e30)),
        Ray::new(Vec3::splat(-1e30), Vec3::ONE),
        Ray::new(Vec3::splat(-3e38), Vec3::splat(3e38)),
        Ray::new(Vec3::splat(f32::NAN), Vec3::ONE),
        Ray::new(Vec3::splat(-2.0), Vec3::splat(f32::NAN)),
        Ray::new(Vec3::splat(-2.0), Vec3::splat(f32::INFINITY)),
        Ray::new(Vec3::splat(-2.0), Vec3::splat(1e-20)),
    ];
    let mut hits = 0;
    for strange in odd {
        for mut rays in views(r, &[Vec3::X, Vec3::Y, Vec3::splat(0.5)]) {
            rays.truncate(64 + r.below(65) as usize);
            let place = r.below(rays.len() as u32) as usize;
            rays[place] = strange;
            let expected: Vec<Option<Hit>> = rays.iter().map(|ray| closest(&brute, ray)).collect();
            for accel in [build(AccelKind::Bvh8Best, &scene), build(AccelKind::Bvh8Best, &scene).portable()] {
                assert_same_batches(&accel, &rays, Query::ALL, &expected);
            }
            hits += expected.iter().flatten().count();
        }
    }
    assert!(hits > 2000, "{hits}");
}

/// Seen from far away or close by, sizes at which the products of the edge test over- and underflow among them.
#[test]
fn packets_see_small_and_large_worlds_alike() {
    let mut hits = 0;
    for (k, size) in [1e-25f32, 1e-15, 1e-6, 1.0, 1e6, 1e12, 3e18].into_iter().enumerate() {
        let r = &mut Random::new(60 + k as u64);
        let soup: Vec<_> = (0..400)
            .map(|_| (r.cube() * size, r.cube() * size * 0.3, r.cube() * size * 0.3))
            .map(|(p, a, b)| [p, p + a, p + b])
            .collect();
        let scene = world(vec![triangles(&soup)]);
        let brute = build(AccelKind::BruteForce, &scene);
        let accels = [
            build(AccelKind::Bvh8, &scene),
            build(AccelKind::Bvh8Best, &scene),
            build(AccelKind::Bvh8, &scene).portable(),
        ];
        for (distance, width) in [(3.0, 0.5), (0.0, 1.0), (300.0, 0.004), (3e4, 4e-5)] {
            let forward = r.cube().normalize();
            let from = -forward * size * distance;
            let slanted = orthographic(from, forward * size, size).into_iter();
            let rays: Vec<Ray> = pinhole(from, forward, width).into_iter().chain(slanted).collect();
            let expected: Vec<Option<Hit>> = rays.iter().map(|ray| closest(&brute, ray)).collect();
            for accel in &accels {
                assert_same_batches(accel, &rays, Query::ALL, &expected);
            }
            hits += expected.iter().flatten().count();
        }
    }
    assert!(hits > 5000, "{hits}");
}
