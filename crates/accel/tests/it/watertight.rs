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
