//! Closed meshes stay closed, also for rays aimed at their edges and vertices.

use crate::common::{Random, build, closest, world};
use crate::meshes::{Mesh, ball, cube, mapped};
use kirkas_accel::{Accel, AccelKind, Shape};
use kirkas_geometry::{Ray, Vec3};
use std::sync::Arc;

fn accel(mesh: &Mesh) -> Accel {
    let shape = Shape::Triangles { positions: Arc::new(mesh.0.clone()), indices: Arc::new(mesh.1.clone()) };
    build(AccelKind::Bvh2, &world(vec![shape]))
}

/// Rays from around `inside` at vertices, along edges' points and anywhere; how many find nothing.
fn escapes(mesh: &Mesh, inside: Vec3, wander: f32, rays: usize, seed: u64) -> usize {
    let accel = accel(mesh);
    let r = &mut Random::new(seed);
    let mut escaped = 0;
    for i in 0..rays {
        let origin = if i % 16 < 3 { inside } else { inside + r.cube() * wander };
        let f = mesh.1[r.below(mesh.1.len() as u32) as usize].map(|k| mesh.0[k as usize]);
        let direction = match i % 3 {
            0 => f[0] - origin,
            1 => f[0].lerp(f[1], [0.5, 0.25, r.unit()][i % 7 % 3]) - origin,
            _ => r.cube(),
        };
        if direction != Vec3::ZERO && closest(&accel, &Ray::new(origin, direction)).is_none() {
            escaped += 1;
        }
    }
    escaped
}

#[test]
fn nothing_escapes_from_a_ball() {
    assert_eq!(escapes(&ball(4), Vec3::ZERO, 0.5, 1_000_000, 1), 0);
}

#[test]
fn nothing_escapes_from_a_cube_of_twelve_triangles() {
    assert_eq!(escapes(&cube(), Vec3::ZERO, 0.999, 600_000, 2), 0);
}

#[test]
fn nothing_escapes_whatever_the_scale_the_place_and_the_shape() {
    let (ball, cube) = (ball(3), cube());
    for (i, mesh) in [ball, cube].iter().enumerate() {
        for scale in [1e-18_f32, 1e-6, 1.0, 1e6, 1e12] {
            let stretch = Vec3::new(1.0, 0.01, 30.0) * scale;
            for offset in [Vec3::ZERO, Vec3::new(500.0, -3.0, 0.25) * scale] {
                let m = mapped(mesh, |p| p * stretch + offset);
                assert_eq!(
                    escapes(&m, offset, 0.005 * scale, 60_000, 3 + i as u64),
                    0,
                    "scale {scale} offset {offset}"
                );
            }
        }
    }
}

/// Each face of the cube in `n` by `n` squares of uneven sizes, joined to its neighbours.
fn gridded_cube(n: usize) -> Mesh {
    let tick = |i: usize| {
        if i == n { 1.0 } else { (i as f32 / n as f32 - 0.5) * 2.0 + 0.1 * ((i * i) as f32).sin() / n as f32 }
    };
    let tick = |i: usize| if i == 0 { -1.0 } else { tick(i) };
    let mut mesh: Mesh = (Vec::new(), Vec::new());
    for (face, i, j) in (0..6 * n * n).map(|k| (k / (n * n), k / n % n, k % n)) {
        let corner = |a: usize, b: usize| {
            let (u, v, w) = (tick(i + a), tick(j + b), if face % 2 == 0 { 1.0 } else { -1.0 });
            [Vec3::new(u, v, w), Vec3::new(w, u, v), Vec3::new(v, w, u)][face / 2] * Vec3::new(0.7, 1.3, 2.9)
        };
        let first = mesh.0.len() as u32;
        mesh.0.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        mesh.1.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

#[test]
fn small_faces_whose_edges_are_the_edges_of_their_boxes_leave_no_gap() {
    assert_eq!(escapes(&gridded_cube(48), Vec3::new(0.1, 0.2, 0.3), 0.5, 600_000, 7), 0);
}

#[test]
fn large_faces_leave_no_gap_to_rays_that_start_close_to_their_edges() {
    let mesh = mapped(&cube(), |p| p * Vec3::new(0.7, 1.3, 2.9));
    let accel = accel(&mesh);
    let r = &mut Random::new(8);
    for _ in 0..600_000 {
        let f = mesh.1[r.below(12) as usize].map(|k| mesh.0[k as usize]);
        let near = 10_f32.powi(-(r.below(6) as i32) - 1);
        let target = f[0].lerp(f[1], 0.1 + 0.8 * r.unit());
        let origin =
            (target + r.cube() * near).clamp(Vec3::new(-0.6999, -1.2999, -2.8999), Vec3::new(0.6999, 1.2999, 2.8999));
        if origin != target {
            let ray = Ray::new(origin, target - origin);
            assert!(closest(&accel, &ray).is_some(), "{ray:?}");
        }
    }
}
