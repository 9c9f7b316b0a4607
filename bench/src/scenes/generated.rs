//! Scenes that need no files.

use super::{Scene, Soup};
use kirkas_accel::ray_sets::Pinhole;
use kirkas_geometry::elementary::sin_cos_f32;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Bounds3, Vec3};
use std::f32::consts::PI;

/// A bumpy sphere of radius 1 and about `count` triangles.
pub fn sphere(count: usize) -> Soup {
    let n = (count as f64 / 2.0).sqrt().round() as usize;
    let mut soup = Soup::default();
    for i in 0..=n {
        for j in 0..=n {
            let (st, ct) = sin_cos_f32(PI * i as f32 / n as f32);
            let (sp, cp) = sin_cos_f32(2.0 * PI * j as f32 / n as f32);
            let d = Vec3::new(st * cp, ct, st * sp);
            let bump = sin_cos_f32(d.x * 40.0).0 * sin_cos_f32(d.y * 37.0).0 * sin_cos_f32(d.z * 43.0).0;
            soup.positions.push(d * (1.0 + 0.05 * bump));
        }
    }
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let quad = |i, j| [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]];
    soup.indices = (0..n * n).flat_map(|k| quad(k / n, k % n)).collect();
    soup
}

/// The bumpy sphere in a box of side 4 that is open towards the camera.
pub fn sphere_in_a_box(name: &str, count: usize) -> Scene {
    let mut soup = sphere(count);
    for (axis, side) in [(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0), (2, -1.0)] {
        soup.quad([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| {
            let mut p = Vec3::ZERO;
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (2.0 * side, 2.0 * u, 2.0 * v);
            p
        }));
    }
    soup.into_scene(name, Pinhole::look_at(Vec3::new(0.3, 0.4, 3.5), Vec3::ZERO, 0.4))
}

/// The small thing in the stadium: `soup`, made 0.3 wide, on a field within stands of 12,000 thin triangles, 20 to 60 long,
/// that run diagonally, so that their boxes are large and overlap.
pub fn stadium(name: &str, mut soup: Soup) -> Scene {
    let bounds = Bounds3::around(soup.positions.iter().copied());
    let scale = 0.3 / bounds.extent().max_element();
    let floor = bounds.center().with_y(bounds.min.y);
    for p in &mut soup.positions {
        *p = (*p - floor) * scale;
    }
    for i in 0..12_000 {
        let random = |k: u64| unit_f32(combine(combine(0x57ad, i), k) as u32);
        let signed = |k: u64| random(k) * 2.0 - 1.0;
        let diagonal = |k: u64| (0.6 + 0.4 * random(k)) * if random(k + 1) < 0.5 { -1.0 } else { 1.0 };
        let half = 10.0 + 20.0 * random(6);
        let along = Vec3::new(diagonal(0), 0.6 * diagonal(2), diagonal(4)).normalize() * half;
        let across = along.cross(Vec3::new(signed(7), signed(8), signed(9))).normalize() * 0.02;
        let (sin, cos) = sin_cos_f32(2.0 * PI * random(10));
        let away = 50.0 + 40.0 * random(11);
        let middle = Vec3::new(away * cos, 20.0 + 20.0 * random(12), away * sin);
        soup.add([middle - along - across, middle + along, middle - along + across], [[0, 1, 2]]);
    }
    let field = [(-120.0, -120.0), (120.0, -120.0), (120.0, 120.0), (-120.0, 120.0)];
    soup.quad(field.map(|(x, z)| Vec3::new(x, 0.0, z)));
    soup.into_scene(name, Pinhole::look_at(Vec3::new(0.2, 0.4, 0.6), Vec3::new(0.0, 0.14, 0.0), 0.3))
}
