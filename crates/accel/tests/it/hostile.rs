//! Rays that mean harm to structures of cells and spheres: that graze triangles beside their edges, run within
//! the planes where cells end, come from near and far, and begin and end anywhere.

use crate::common::{Random, bits, build, closest, triangles, world};
use kirkas_accel::{Accel, AccelKind, SceneGeometry, Shape, Sphere};
use kirkas_geometry::{Ray, Vec3};
use std::sync::Arc;

const RAYS: usize = 10_000;

/// Slivers, copies, axis-aligned ones and others; `size` of most, in a scene of size 2 around `center`.
fn soup(r: &mut Random, n: usize, size: f32, center: Vec3) -> Vec<[Vec3; 3]> {
    let mut all: Vec<[Vec3; 3]> = Vec::new();
    for i in 0..n {
        let (p, a, b) = (center + r.cube(), r.cube() * size, r.cube() * size);
        all.push(match r.below(10) {
            0 => [p, p + a * 4.0, p + a * 2.0 + b * 1e-5],
            1 => [p, p + a, p + b].map(|c| Vec3::new(c.x, c.y, p.z)),
            2 => [p, p + a, p + b].map(|c| Vec3::new(p.x, (c.y * 16.0).round() / 16.0, (c.z * 16.0).round() / 16.0)),
            3 if i > 0 => all[r.below(i as u32) as usize],
            4 if i > 0 => {
                let [a, b, _] = all[r.below(i as u32) as usize];
                [b, a, p]
            }
            5 if i % 8 == 0 => [p, p + a / size, p + b / size],
            _ => [p, p + a, p + b],
        });
    }
    all
}

fn pick<T: Copy>(r: &mut Random, from: &[T]) -> T {
    from[r.below(from.len() as u32) as usize]
}

/// A ray that means harm to one of the triangles.
fn hostile(r: &mut Random, soup: &[[Vec3; 3]]) -> Ray {
    let [a, b, c] = pick(r, soup);
    let on_edge = [a, a.lerp(b, r.unit()), b.lerp(c, 0.5)][r.below(3) as usize];
    let within = (b - a) * (r.unit() * 2.0 - 1.0) + (c - a) * (r.unit() * 2.0 - 1.0);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let direction = match r.below(6) {
        // Grazing.
        0..=2 => within.normalize_or_zero() + normal * pick(r, &[0.0, 1e-7, -1e-6, 1e-5, 1e-4, -1e-3, 1e-2]),
        // Along an axis: within the planes that end cells.
        3 => pick(r, &[Vec3::X, -Vec3::Y, Vec3::Z, Vec3::new(-0.0, 1.0, -1e-30)]),
        4 => pick(r, &[a, b, c]) - pick(r, soup)[0],
        _ => r.cube(),
    } * pick(r, &[1.0, 1.0, 1e-3, 1e3]);
    let back = pick(r, &[0.0, 0.3, 1.0, 4.0, 30.0, 1e3, 1e5]) / direction.length().max(1e-30);
    let beside = r.cube() * pick(r, &[0.0, 0.0, 1e-7, 1e-6, 1e-5]);
    let origin = on_edge + beside - direction * back;
    let (t_min, t_max) =
        pick(r, &[(0.0, f32::INFINITY), (0.0, f32::INFINITY), (back * 0.999, back * 1.001), (-9e9, back)]);
    Ray { origin, direction, t_min, t_max, ..Ray::new(origin, direction) }
}

fn others(scene: &SceneGeometry) -> Vec<Accel> {
    let others = AccelKind::ALL.into_iter().filter(|(kind, _)| *kind != AccelKind::BruteForce);
    others.map(|(kind, _)| build(kind, scene)).collect()
}

fn assert_same(scene: &SceneGeometry, rays: impl Iterator<Item = Ray>) -> usize {
    let (brute, others) = (build(AccelKind::BruteForce, scene), others(scene));
    let hit = |ray: Ray| {
        let expected = closest(&brute, &ray);
        for other in &others {
            let got = closest(other, &ray);
            let kind = other.kind().name();
            assert_eq!(bits(got), bits(expected), "\n{ray:?}\n {kind} {got:?}\n brute {expected:?}");
        }
        expected.is_some()
    };
    rays.map(hit).filter(|hit| *hit).count()
}

#[test]
fn no_structure_loses_a_hit_to_hostile_rays() {
    let mut hits = 0;
    for seed in 0..20 {
        let r = &mut Random::new(seed);
        let (size, center) = (pick(r, &[0.03, 0.1, 0.4]), pick(r, &[Vec3::ZERO, Vec3::new(3.0, -500.0, 0.1)]));
        let soup = soup(r, 250, size, center);
        let ball = |_| Sphere { center: center + r.cube(), radius: r.unit() * size };
        let balls = Shape::Spheres(Arc::new((0..30).map(ball).collect()));
        let scene = world(vec![triangles(&soup), balls]);
        hits += assert_same(&scene, (0..RAYS).map(|_| hostile(r, &soup)));
    }
    assert!(hits > 3 * RAYS, "{hits}");
}
