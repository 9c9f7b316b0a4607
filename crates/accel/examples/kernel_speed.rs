//! How fast one thread builds and traces: a displaced sphere of a million triangles, and a flake of 66,430 spheres.
//! `cargo run --release -p kirkas-accel --example kernel_speed [kind [side]]`, by default `bvh8` and 708: the sphere has
//! `2 side^2` triangles. Bench noise is 5-10 %; compare within one run only.

use kirkas_accel::{Accel, AccelKind, Counters, Geometry, Hit, Query, SceneGeometry, Serial, Shape, Sphere};
use kirkas_geometry::elementary::sin_cos_f32;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::warp::square_to_cosine_hemisphere;
use kirkas_geometry::{Frame, Ray, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;
use std::sync::OnceLock;
use std::time::Instant;

const SIDE: usize = 1024;

fn main() {
    let kind =
        std::env::args().nth(1).map_or(AccelKind::Bvh8, |name| AccelKind::parse(&name).expect("a structure's name"));
    let side = std::env::args().nth(2).map_or(708, |side| side.parse().expect("a number"));
    report(kind, "displaced sphere", displaced_sphere(side));
    report(kind, "sphereflake", sphereflake(5));
}

/// Seconds this thread has computed (so that a busy machine distorts little), or of the clock where that is not known.
fn seconds() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    let ran = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = ran.and_then(|s| s.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.get_or_init(Instant::now).elapsed().as_secs_f64(), |n| n * 1e-9)
}

fn report(kind: AccelKind, name: &str, shape: Shape) {
    let world = vec![Geometry { shape, opaque: true, mask: u32::MAX }];
    let scene = SceneGeometry { world, ..SceneGeometry::default() };
    let mut best = f64::INFINITY;
    let mut accel = None;
    for _ in 0..3 {
        drop(accel.take());
        let start = seconds();
        accel = Some(Accel::build(kind, scene.clone(), &Serial).expect("a sound scene"));
        best = best.min(seconds() - start);
    }
    let mut accel = accel.expect("built");
    if kind.name().starts_with("bvh8") {
        let mut file = Vec::new();
        accel.save(&mut file).expect("room in memory");
        let start = seconds();
        accel = Accel::load(scene.clone(), &mut &file[..]).expect("what was saved");
        let loaded = seconds();
        accel.refit(scene.clone()).expect("the same scene");
        println!("{name}: load {:.3} s, refit {:.3} s", loaded - start, seconds() - loaded);
    }
    let s = accel.statistics();
    println!("{name}: {} primitives, build {best:.3} s", s.primitives);
    println!("  nodes {}, {} MB, SAH cost {:.2}, depth {}", s.nodes, s.bytes >> 20, s.sah_cost, s.depth);

    let camera = camera_rays();
    let hits = trace("primary", &accel, &camera);
    let bounced = bounce(&accel, &camera, &hits);
    trace("diffuse", &accel, &bounced);
    occlude("diffuse any", &accel, &bounced);
}

fn trace(name: &str, accel: &Accel, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    let mut best = f64::INFINITY;
    let mut counters = Counters::default();
    for _ in 0..3 {
        counters = Counters::default();
        let start = seconds();
        accel.closest_hits(rays, Query::ALL, &mut hits, &mut counters);
        best = best.min(seconds() - start);
    }
    let found = hits.iter().flatten().count();
    line(name, best, &counters, found);
    counters = Counters::default();
    let start = seconds();
    accel.closest_hits_coherent(rays, Query::ALL, &mut hits, &mut counters);
    line("  in packets", seconds() - start, &counters, found);
    counters = Counters::default();
    let start = seconds();
    for (i, (ray, hit)) in rays.iter().zip(&mut hits).enumerate() {
        *hit = accel.closest_hit(ray, Query::ALL, i, &mut counters);
    }
    line("  one by one", seconds() - start, &counters, found);
    hits
}

fn occlude(name: &str, accel: &Accel, rays: &[Ray]) {
    let mut occluded = vec![false; rays.len()];
    let mut counters = Counters::default();
    let start = seconds();
    accel.any_hits(rays, Query::ALL, &mut occluded, &mut counters);
    line(name, seconds() - start, &counters, occluded.iter().filter(|o| **o).count());
}

fn line(name: &str, seconds: f64, c: &Counters, found: usize) {
    let rays = c.rays as f64;
    println!(
        "  {name:12} {:6.2} Mrays/s  {:5.1} nodes/ray  {:5.2} primitives/ray  {:4.1} % hit",
        rays / seconds * 1e-6,
        c.nodes_visited as f64 / rays,
        c.primitives_tested as f64 / rays,
        found as f64 / rays * 100.0
    );
}

/// A pinhole camera, in blocks of 8 by 8 rays.
fn camera_rays() -> Vec<Ray> {
    let mut rays = Vec::with_capacity(SIDE * SIDE);
    for block in 0..SIDE * SIDE / 64 {
        for i in 0..64 {
            let x = (block % (SIDE / 8)) * 8 + i % 8;
            let y = (block / (SIDE / 8)) * 8 + i / 8;
            let at = |p: usize| (p as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
            rays.push(Ray::new(Vec3::new(0.3, 0.4, 3.5), Vec3::new(at(x) * 0.4, at(y) * 0.4, -1.0)));
        }
    }
    rays
}

/// Cosine-distributed rays from the hits, on the side that was hit.
fn bounce(accel: &Accel, rays: &[Ray], hits: &[Option<Hit>]) -> Vec<Ray> {
    let shape = &accel.scene_geometry().world[0].shape;
    let random = |i: usize, k: u64| unit_f32(combine(i as u64, k) as u32);
    let bounce = |(i, (ray, hit)): (usize, (&Ray, &Option<Hit>))| {
        let hit = (*hit)?;
        let p = ray.at(hit.t);
        let normal = match shape {
            Shape::Triangles { positions, indices } => {
                let [a, b, c] = indices[hit.primitive as usize].map(|k| positions[k as usize]);
                (b - a).cross(c - a).normalize()
            }
            Shape::Spheres(s) => (p - s[hit.primitive as usize].center).normalize(),
            _ => return None,
        };
        let frame = Frame::from_z(if normal.dot(ray.direction) > 0.0 { -normal } else { normal });
        let direction = frame.to_world(square_to_cosine_hemisphere((random(i, 1), random(i, 2))));
        Some(Ray::new(p + frame.z * 1e-5, direction))
    };
    rays.iter().zip(hits).enumerate().filter_map(bounce).collect()
}

fn displaced_sphere(n: usize) -> Shape {
    let mut positions = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (st, ct) = sin_cos_f32(PI * i as f32 / n as f32);
            let (sp, cp) = sin_cos_f32(2.0 * PI * j as f32 / n as f32);
            let d = Vec3::new(st * cp, ct, st * sp);
            let bump = sin_cos_f32(d.x * 40.0).0 * sin_cos_f32(d.y * 37.0).0 * sin_cos_f32(d.z * 43.0).0;
            positions.push(d * (1.0 + 0.05 * bump));
        }
    }
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let quad = |i, j| [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]];
    let indices = (0..n * n).flat_map(|k| quad(k / n, k % n)).collect();
    Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) }
}

/// Eric Haines's flake: nine balls of a third of the size on every ball.
fn sphereflake(levels: u32) -> Shape {
    let mut spheres = Vec::new();
    grow(Vec3::ZERO, 0.7, Frame::from_z(Vec3::Y), levels, &mut spheres);
    Shape::Spheres(Arc::new(spheres))
}

fn grow(center: Vec3, radius: f32, frame: Frame, levels: u32, out: &mut Vec<Sphere>) {
    out.push(Sphere { center, radius });
    if levels == 0 {
        return;
    }
    for i in 0..9 {
        let (polar, turn) =
            if i < 6 { (PI * 0.5, i as f32 * PI / 3.0) } else { (PI / 6.0, (i as f32 + 0.25) * PI / 1.5) };
        let ((st, ct), (sp, cp)) = (sin_cos_f32(polar), sin_cos_f32(turn));
        let z = frame.to_world(Vec3::new(st * cp, st * sp, ct)).normalize();
        grow(center + z * (radius * 4.0 / 3.0), radius / 3.0, Frame::from_z(z), levels - 1, out);
    }
}
