//! Looks for rays that escape from closed meshes, and for hits that a structure loses: `cargo xtask leaks [COUNT]`.
//! COUNT rays (10^8) start inside a ball of triangles, a displaced sphere and, where `KIRKAS_DATA` has one, the bunny, and go
//! through `bvh8` and `bvh8_best` in batches, on all cores; none may get out. A hundredth as many, 10^6 at least, go from
//! anywhere through every kind of tree of eight and must hit what they hit in `bvh2`.

use kirkas_accel::*;
use kirkas_geometry::elementary::sin_cos_f32;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Ray, Vec3};
use std::f32::consts::PI;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

/// Rays that a thread answers at once.
const BATCH: u64 = 1 << 14;

/// Vertices, faces, and a ball that lies wholly inside.
struct Mesh {
    name: &'static str,
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    inside: (Vec3, f32),
}

fn main() -> ExitCode {
    let count: u64 = std::env::args().nth(1).map_or(100_000_000, |n| n.parse().expect("COUNT is a number"));
    let meshes: Vec<Mesh> = [Some(ball(128)), Some(displaced_sphere(708)), bunny()].into_iter().flatten().collect();
    let each = count / (2 * meshes.len() as u64);
    let mut faults = 0;
    for mesh in &meshes {
        let shape =
            Shape::Triangles { positions: Arc::new(mesh.positions.clone()), indices: Arc::new(mesh.indices.clone()) };
        let scene =
            SceneGeometry { world: vec![Geometry { shape, opaque: true, mask: u32::MAX }], ..Default::default() };
        let build = |kind| Accel::build(kind, scene.clone(), &Serial).expect("a sound mesh");
        let reference = build(AccelKind::Bvh2);
        for kind in [AccelKind::Bvh8, AccelKind::Bvh8Best, AccelKind::Bvh8Fast, AccelKind::Bvh8Compact] {
            let accel = build(kind);
            if matches!(kind, AccelKind::Bvh8 | AccelKind::Bvh8Best) {
                let leaks = on_all_cores(each, &|seed, rays| escaped(&accel, mesh, seed, rays));
                println!("{}: {}: {each} rays from inside, {leaks} escaped", mesh.name, kind.name());
                faults += leaks;
            }
            let compared = (count / 100).max(1_000_000);
            let lost = on_all_cores(compared, &|seed, rays| lost(&accel, &reference, seed, rays));
            println!("{}: {}: {compared} rays from anywhere, {lost} other than in bvh2", mesh.name, kind.name());
            faults += lost;
        }
    }
    if faults == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Sum up what `job(seed, rays)` counts, over batches of rays.
fn on_all_cores(count: u64, job: &(dyn Fn(u64, u64) -> u64 + Sync)) -> u64 {
    let (next, sum) = (AtomicU64::new(0), AtomicU64::new(0));
    thread::scope(|s| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            s.spawn(|| {
                loop {
                    let first = next.fetch_add(BATCH, Ordering::Relaxed);
                    if first >= count {
                        return;
                    }
                    sum.fetch_add(job(first, BATCH.min(count - first)), Ordering::Relaxed);
                }
            });
        }
    });
    sum.into_inner()
}

/// In the cube `[-1, 1)^3`.
fn cube(seed: u64, which: u64) -> Vec3 {
    let number = |k: u64| unit_f32(combine(combine(seed, which), k) as u32) * 2.0 - 1.0;
    Vec3::new(number(1), number(2), number(3))
}

/// From inside: anywhere, along axes, to vertices, to points of edges.
fn escaped(accel: &Accel, mesh: &Mesh, first: u64, count: u64) -> u64 {
    let pick = |seed: u64| {
        let face = mesh.indices[combine(seed, 9) as usize % mesh.indices.len()];
        face.map(|i| mesh.positions[i as usize])
    };
    let one = |seed: u64| {
        let origin = mesh.inside.0 + cube(seed, 1) * (mesh.inside.1 * 0.57);
        let [a, b, _] = pick(seed);
        let direction = match seed % 8 {
            0 => a - origin,
            1 => a.lerp(b, unit_f32(combine(seed, 4) as u32)) - origin,
            2 => [Vec3::X, -Vec3::Y, Vec3::Z, Vec3::new(0.0, 1.0, -1.0)][combine(seed, 5) as usize % 4],
            _ => cube(seed, 2),
        };
        Ray::new(origin, direction)
    };
    let rays: Vec<Ray> = (first..first + count).map(one).filter(|r| r.direction != Vec3::ZERO).collect();
    let mut hits = vec![None; rays.len()];
    accel.closest_hits(&rays, Query::ALL, &mut hits, &mut Counters::default());
    hits.iter().filter(|hit| hit.is_none()).count() as u64
}

/// Answers that differ from those of the reference, one by one, in batches, in packets or as shadow rays.
fn lost(accel: &Accel, reference: &Accel, first: u64, count: u64) -> u64 {
    let bounds = reference.bounds();
    let anywhere = |seed: u64, which| bounds.center() + cube(seed, which) * bounds.extent();
    let one = |seed: u64| {
        let (from, to) = (anywhere(seed, 6), anywhere(seed, 7));
        // Some in groups that run together.
        let group = seed / 64;
        if group.is_multiple_of(2) {
            Ray::new(from, to - from)
        } else {
            Ray::new(anywhere(group, 8), to * 0.01 + anywhere(group, 6) * 0.5 - anywhere(group, 8))
        }
    };
    let rays: Vec<Ray> = (first..first + count).map(one).collect();
    let c = &mut Counters::default();
    let (mut expected, mut hits) = (vec![None; rays.len()], vec![None; rays.len()]);
    let (mut packets, mut blocked) = (vec![None; rays.len()], vec![false; rays.len()]);
    reference.closest_hits(&rays, Query::ALL, &mut expected, c);
    accel.closest_hits(&rays, Query::ALL, &mut hits, c);
    accel.closest_hits_coherent(&rays, Query::ALL, &mut packets, c);
    accel.any_hits(&rays, Query::ALL, &mut blocked, c);
    let differs =
        |i: &usize| hits[*i] != expected[*i] || packets[*i] != expected[*i] || blocked[*i] != expected[*i].is_some();
    (0..rays.len()).filter(differs).count() as u64
}

/// The unit sphere.
fn ball(side: usize) -> Mesh {
    let mut mesh = sphere("ball", side, |_| 1.0);
    mesh.inside = (Vec3::ZERO, 0.99);
    mesh
}

/// A sphere with waves.
fn displaced_sphere(side: usize) -> Mesh {
    let wave = |p: Vec3| {
        let s = |x: f32| sin_cos_f32(x).0;
        1.0 + 0.05 * s(13.0 * p.x) * s(17.0 * p.y) * s(11.0 * p.z) + 0.004 * s(97.0 * p.x + 83.0 * p.y)
    };
    let mut mesh = sphere("displaced sphere", side, wave);
    mesh.inside = (Vec3::ZERO, 0.9);
    mesh
}

/// `side` rings of `side` quads, closed at both poles: neighbours share their vertices.
fn sphere(name: &'static str, side: usize, radius: impl Fn(Vec3) -> f32) -> Mesh {
    let (mut positions, mut indices) = (vec![Vec3::Y, -Vec3::Y], Vec::new());
    for ring in 1..side {
        for k in 0..side {
            let (sin, cos) = sin_cos_f32(PI * ring as f32 / side as f32);
            let (y, x) = sin_cos_f32(2.0 * PI * k as f32 / side as f32);
            positions.push(Vec3::new(sin * x, cos, sin * y));
        }
    }
    let at = |ring: usize, k: usize| match ring {
        0 => 0,
        _ if ring == side => 1,
        _ => 2 + ((ring - 1) * side + k % side) as u32,
    };
    for ring in 0..side {
        for k in 0..side {
            let [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)];
            indices.extend([[a, b, c], [b, d, c]].into_iter().filter(|f| f[0] != f[1] && f[1] != f[2] && f[0] != f[2]));
        }
    }
    positions.iter_mut().for_each(|p| *p = p.normalize() * radius(p.normalize()));
    Mesh { name, positions, indices, inside: (Vec3::ZERO, 0.0) }
}

/// The course's bunny, if it has no holes.
fn bunny() -> Option<Mesh> {
    let data = std::path::PathBuf::from(std::env::var_os("KIRKAS_DATA")?);
    let found = std::fs::read_to_string(data.join("mit6837/2004/Assignment6/bunny_5k.obj"));
    let Ok(text) = found else {
        println!("skipped: the bunny (KIRKAS_DATA has no mit6837/2004/Assignment6/bunny_5k.obj)");
        return None;
    };
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let all: Vec<f32> = words.filter_map(|w| w.parse().ok()).collect();
                positions.push(Vec3::from_slice(&all));
            }
            Some("f") => {
                let all: Vec<u32> = words.filter_map(|w| w.split('/').next()?.parse().ok()).collect();
                indices.extend((2..all.len()).map(|k| [all[0] - 1, all[k - 1] - 1, all[k] - 1]));
            }
            _ => {}
        }
    }
    let mut edges: Vec<(u32, u32)> =
        indices.iter().flat_map(|f: &[u32; 3]| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])]).collect();
    edges.sort_unstable();
    let closed = edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok());
    if !closed {
        println!("skipped: the bunny (it has holes)");
        return None;
    }
    let middle = positions.iter().sum::<Vec3>() / positions.len() as f32;
    let near = positions.iter().map(|p| p.distance(middle)).fold(f32::INFINITY, f32::min);
    Some(Mesh { name: "bunny", positions, indices, inside: (middle, near * 0.5) })
}
