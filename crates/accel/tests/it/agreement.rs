//! The tree against brute force on large random scenes of everything.

use crate::common::{Boxes, Plane, Random, assert_agreement, build, geometry, triangles, world};
use kirkas_accel::*;
use kirkas_geometry::transform::rotation;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, DMat3, Ray, Vec3};
use std::sync::Arc;

/// A coordinate that is random, on a coarse grid, zero, or of another magnitude.
fn coordinate(r: &mut Random) -> f32 {
    match r.below(8) {
        0 => 0.0,
        1..=3 => r.below(9) as f32 * 0.5 - 2.0,
        4 => (r.unit() - 0.5) * 1e-5,
        _ => r.unit() * 4.0 - 2.0,
    }
}

pub fn point(r: &mut Random) -> Vec3 {
    Vec3::new(coordinate(r), coordinate(r), coordinate(r))
}

/// Small, thin, huge, degenerate, axis-aligned and coincident ones.
fn triangle(r: &mut Random, earlier: &[[Vec3; 3]]) -> [Vec3; 3] {
    let p = point(r);
    match r.below(9) {
        0 if !earlier.is_empty() => earlier[r.below(earlier.len() as u32) as usize],
        1 => [p, p, point(r)],
        2 => [p, p + Vec3::X, p + Vec3::X * 2.0],
        3 => [p, p + Vec3::X, p + Vec3::Z],
        4 => [p * 1e4, point(r) * 1e4, p * 1e4 + Vec3::Y * 1e-3],
        5 if !earlier.is_empty() => {
            let [a, b, _] = earlier[r.below(earlier.len() as u32) as usize];
            [b, a, p]
        }
        _ => [p, p + r.cube() * 0.5, p + r.cube() * 0.5],
    }
}

fn shapes(r: &mut Random, n: usize) -> (Vec<Geometry>, Vec<Vec3>) {
    let mut soup: Vec<[Vec3; 3]> = Vec::new();
    for _ in 0..n {
        soup.push(triangle(r, &soup));
    }
    let spheres: Vec<Sphere> =
        (0..n / 4).map(|i| Sphere { center: point(r), radius: [r.unit(), 0.5, 0.0][i % 3] }).collect();
    let boxes = (0..n / 8).map(|_| Bounds3::from_corners(point(r), point(r))).collect();
    let corners = soup.concat();
    let mut all = vec![
        geometry(triangles(&soup[..n / 2])),
        geometry(Shape::Spheres(Arc::new(spheres))),
        geometry(Shape::User(Arc::new(Boxes(boxes)))),
        geometry(triangles(&soup[n / 2..])),
    ];
    if r.below(3) == 0 {
        all.push(geometry(Shape::User(Arc::new(Plane(-1.5)))));
    }
    for g in &mut all {
        g.opaque = r.below(2) == 0;
        g.mask = [u32::MAX, 1, 6][r.below(3) as usize];
    }
    (all, corners)
}

fn placement(r: &mut Random) -> DAffine3 {
    let size = kirkas_geometry::DVec3::new(0.2 + f64::from(r.unit()), 0.5, -0.3 - f64::from(r.unit()));
    let turn = rotation(r.cube().as_dvec3() + 2.0, f64::from([0.0, 90.0, r.unit() * 360.0][r.below(3) as usize]));
    DAffine3 { matrix3: turn * DMat3::from_diagonal(size), translation: point(r).as_dvec3() * 2.0 }
}

pub fn scene(r: &mut Random, n: usize) -> (SceneGeometry, Vec<Vec3>) {
    let (world, corners) = shapes(r, n);
    let aggregates: Vec<Aggregate> = (0..r.below(3)).map(|_| shapes(r, n / 4).0.into()).collect();
    let mut instances = Vec::new();
    for i in 0..aggregates.len() * 6 {
        let first = placement(r);
        let outer_from_object = match r.below(3) {
            0 => AnimatedTransform::from_keys(&[(0.0, first), (0.7, placement(r)), (1.0, first)]).unwrap(),
            _ => AnimatedTransform::still(first),
        };
        let mask = [u32::MAX, 3][r.below(2) as usize];
        instances.push(Instance { aggregate: i % aggregates.len(), outer_from_object, mask });
    }
    (SceneGeometry { world, aggregates, instances, shutter: (0.0, 1.0) }, corners)
}

pub fn ray(r: &mut Random, corners: &[Vec3]) -> Ray {
    let corner = |r: &mut Random| corners[r.below(corners.len() as u32) as usize];
    let origin = match r.below(4) {
        0 => corner(r),
        1 => r.cube() * 1e3,
        _ => point(r) * 2.0,
    };
    let direction = match r.below(5) {
        0 => [Vec3::X, -Vec3::Y, Vec3::Z, Vec3::new(1.0, -0.0, 1.0), Vec3::new(-0.0, -2.0, 0.0)][r.below(5) as usize],
        1 => corner(r) - origin,
        2 => corner(r).lerp(corner(r), 0.5) - origin,
        3 => r.cube() * 1e-6,
        _ => r.cube(),
    };
    let (t_min, t_max) = [(0.0, f32::INFINITY), (0.0, f32::INFINITY), (0.1, 1.0), (-2.0, 5.0)][r.below(4) as usize];
    Ray { origin, direction, t_min, t_max, time: r.unit() * 1.4 - 0.2, mask: [u32::MAX, 1, 2][r.below(3) as usize] }
}

#[test]
fn the_tree_equals_brute_force_on_scenes_of_everything() {
    let (mut rays_cast, mut hits) = (0, 0);
    for seed in 0..60 {
        let r = &mut Random::new(seed);
        let n = [1, 3, 9, 40, 300][seed as usize % 5];
        let (scene, corners) = scene(r, n);
        let rays: Vec<Ray> = (0..600).map(|_| ray(r, &corners)).collect();
        hits += assert_agreement(&scene, &rays);
        rays_cast += 2 * rays.len();
    }
    assert!(hits * 4 > rays_cast && hits < rays_cast, "{hits} of {rays_cast}");
}

#[test]
fn the_tree_equals_brute_force_at_every_scale() {
    for scale in [1e-18_f32, 1e-6, 1e6, 1e15, 1e30] {
        let r = &mut Random::new(77);
        let mut soup: Vec<[Vec3; 3]> = Vec::new();
        for _ in 0..200 {
            soup.push(triangle(r, &soup));
        }
        let corners: Vec<Vec3> = soup.concat();
        let soup: Vec<_> = soup.iter().map(|t| t.map(|p| p * scale)).collect();
        let balls = (0..20).map(|_| Sphere { center: r.cube() * scale, radius: r.unit() * 0.2 * scale }).collect();
        let scene = crate::common::world(vec![triangles(&soup), Shape::Spheres(Arc::new(balls))]);
        let rays: Vec<Ray> =
            (0..1200).map(|_| ray(r, &corners)).map(|q| Ray { origin: q.origin * scale, ..q }).collect();
        assert_agreement(&scene, &rays);
    }
}

#[test]
fn an_axis_aligned_grid_is_hit_on_every_line_and_crossing() {
    let mut soup = Vec::new();
    for (i, j) in (0..64).map(|k| ((k % 8) as f32, (k / 8) as f32)) {
        let p = |x: f32, y: f32| Vec3::new(i + x, j + y, 2.0);
        soup.push([p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)]);
        soup.push([p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)]);
    }
    let scene = crate::common::world(vec![triangles(&soup)]);
    let at = |k: u32| Vec3::new((k % 33) as f32 * 0.25, (k / 33) as f32 * 0.25, 0.0);
    let up: Vec<Ray> = (0..33 * 33).map(|k| Ray::new(at(k), Vec3::Z)).collect();
    assert_eq!(assert_agreement(&scene, &up), 2 * up.len());
    let within: Vec<Ray> = (0..33 * 33).map(|k| Ray::new(at(k) + Vec3::new(-9.0, 0.0, 2.0), Vec3::X)).collect();
    assert_eq!(assert_agreement(&scene, &within), 0, "rays within the plane");
}

/// Disks, cylinders, curves, quads and moving triangles, many of them degenerate or coincident.
pub fn solids(r: &mut Random, n: usize) -> Vec<Geometry> {
    let radius = |r: &mut Random| [0.0, r.unit() * 0.4, 0.25][r.below(3) as usize];
    let normal = |r: &mut Random| [Vec3::X, r.cube(), Vec3::Z * -1e-9][r.below(3) as usize];
    let points: Vec<Vec3> = (0..n).map(|_| point(r)).collect();
    let curve_points = points.iter().map(|&position| CurvePoint { position, radius: radius(r) }).collect();
    let disks = points.iter().map(|&center| Disk { center, normal: normal(r), radius: radius(r) }).collect();
    let cylinders = points.iter().map(|&a| Cylinder { ends: [a, a + normal(r)], radius: radius(r) }).collect();
    let index = |r: &mut Random| r.below(n as u32);
    let quads = (0..n).map(|_| [index(r), index(r), index(r), index(r)]).collect();
    let faces = (0..n).map(|_| [index(r), index(r), index(r)]).collect();
    let keys = vec![points.clone(), points.iter().rev().copied().collect(), points.clone()];
    [
        Shape::Disks(Arc::new(disks)),
        Shape::Cylinders(Arc::new(cylinders)),
        Shape::Curves { points: Arc::new(curve_points), segments: Arc::new((0..n as u32 - 1).collect()) },
        Shape::Quads { positions: Arc::new(points), indices: Arc::new(quads) },
        Shape::MovingTriangles { keys: Arc::new(keys), indices: Arc::new(faces) },
    ]
    .map(|shape| Geometry { opaque: r.below(2) == 0, ..geometry(shape) })
    .into()
}

/// A scene of every shape, in the world and in instances, with points to aim at.
pub fn scene_of_everything(r: &mut Random, n: usize) -> (SceneGeometry, Vec<Vec3>) {
    let (mut scene, corners) = scene(r, n);
    scene.world.extend(solids(r, n));
    for a in &mut scene.aggregates {
        a.geometries.extend(solids(r, 6));
    }
    (scene, corners)
}

#[test]
fn every_structure_equals_brute_force_on_every_shape() {
    let (mut rays_cast, mut hits) = (0, 0);
    for seed in 0..30 {
        let r = &mut Random::new(500 + seed);
        let (scene, corners) = scene_of_everything(r, [2, 9, 40][seed as usize % 3]);
        let rays: Vec<Ray> = (0..500).map(|_| ray(r, &corners)).collect();
        hits += assert_agreement(&scene, &rays);
        rays_cast += 2 * rays.len();
    }
    assert!(hits * 5 > rays_cast && hits < rays_cast, "{hits} of {rays_cast}");
}

/// On every platform, natively or as wasm: a changed hash is a changed definition of a hit (or fused arithmetic).
#[test]
fn hits_have_the_same_bits_everywhere() {
    let mut hash = 0;
    for seed in 0..20 {
        let r = &mut Random::new(1000 + seed);
        let (scene, corners) = scene(r, 60);
        let accel = crate::common::build(AccelKind::Bvh2, &scene);
        for _ in 0..500 {
            let hit = crate::common::closest(&accel, &ray(r, &corners));
            let ids = hit.map_or([7; 3], |h| [h.instance.outermost(), h.geometry, h.primitive]);
            let numbers = hit.map_or([7; 3], |h| [h.t, h.u, h.v].map(f32::to_bits));
            hash = numbers.iter().chain(&ids).fold(hash, |h, &b| kirkas_geometry::hash::combine(h, b.into()));
        }
    }
    assert_eq!(format!("{hash:016x}"), "b995c732affcaec6");
}

/// Long thin diagonals among small triangles: what the builders cut into parts.
#[test]
fn triangles_in_parts_are_hit_like_whole_ones() {
    let r = &mut Random::new(77);
    let mut corners = Vec::new();
    for _ in 0..150 {
        let (middle, along) = (r.cube(), r.cube());
        let across = along.any_orthogonal_vector() * 0.002;
        corners.push([middle - along, middle + along, middle - along + across]);
    }
    for _ in 0..4000 {
        let (p, a, b) = (r.cube(), r.cube(), r.cube());
        corners.push([p, p + a * 0.01, p + b * 0.01]);
    }
    let scene = world(vec![triangles(&corners)]);
    let whole = build(AccelKind::Bvh8Fast, &scene).statistics().bytes;
    let parts = [AccelKind::Bvh8, AccelKind::Bvh8Best].map(|kind| build(kind, &scene).statistics().bytes);
    assert!(parts.iter().all(|bytes| bytes * 20 > whole * 21), "{parts:?} where whole triangles take {whole}");
    let rays: Vec<Ray> = (0..4000)
        .map(|i| {
            // Half of them at an edge of a long one.
            let [a, b, c] = corners[r.below(150) as usize];
            let (u, v) = (r.unit(), r.unit() * if i % 4 == 0 { 1e-6 } else { 1.0 });
            let origin = r.cube() * 2.0;
            let target = if i % 2 == 0 { a + (b - a) * u + (c - a) * (v * (1.0 - u)) } else { r.cube() };
            Ray::new(origin, target - origin)
        })
        .collect();
    let hits = assert_agreement(&scene, &rays);
    assert!(hits > 2000, "{hits}");
}
