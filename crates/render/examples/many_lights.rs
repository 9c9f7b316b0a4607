//! What many lights cost: the same total power from ten lamps and from ten thousand, chosen by tree, by power and evenly.
//!
//! `cargo run --release -p kirkas-render --example many_lights [-- panes|mesh|balls|wide-balls]`: triangles of 4 cm; the same in one mesh; balls that together
//! have the surface of ten of 2 cm radius, however many they are; balls of 2 cm, thousands of which hide each other.
//! Seconds are of processor time, the least of some renders, the cases taking turns. Noise is the relative variance of a pixel
//! over seeds, the greatest 0.1 % of pixels left out; cost is time times noise, which is in proportion to the time to any given
//! error.

use kirkas_formats::{FormatAssets, load};
use kirkas_render::film::fixed;
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, Prepared, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_testkit::Random;
use std::fmt::Write;

const CASES: [(u32, &str); 6] =
    [(10, "tree"), (10, "power"), (10, "uniform"), (10_000, "tree"), (10_000, "power"), (10_000, "uniform")];
const SEEDS: u64 = 6;
const SIZE: u32 = 96;
const SAMPLES: u32 = 16;

/// What the lamps are.
#[derive(Clone, Copy)]
enum Shape {
    Panes,
    Mesh,
    Balls,
    WideBalls,
}

fn main() {
    let shape = match std::env::args().nth(1).as_deref() {
        Some("mesh") => Shape::Mesh,
        Some("balls") => Shape::Balls,
        Some("wide-balls") => Shape::WideBalls,
        _ => Shape::Panes,
    };
    let mut seconds = [f64::INFINITY; CASES.len()];
    let mut runs: [Vec<Vec<f64>>; CASES.len()] = Default::default();
    for seed in 0..SEEDS {
        for (i, (count, selection)) in CASES.into_iter().enumerate() {
            let p = compile(&scene(shape, count, selection, seed));
            let mut film = Film::new(p.film.clone());
            let start = processor_seconds();
            p.renderer(256).render(&mut film, 0..SAMPLES, &Undisturbed);
            seconds[i] = seconds[i].min(processor_seconds() - start);
            runs[i].push(luminances(&film));
        }
    }
    println!("{:>9} {:8} {:>9} {:>10} {:>10}", "emitters", "chosen", "seconds", "noise", "cost");
    let costs: Vec<f64> = (0..CASES.len()).map(|i| seconds[i] * noise(&runs[i])).collect();
    for (i, (count, selection)) in CASES.into_iter().enumerate() {
        println!("{count:>9} {selection:8} {:>9.3} {:>10.5} {:>10.5}", seconds[i], noise(&runs[i]), costs[i]);
    }
    println!("10,000 by tree over 10 by tree: {:.2} (at most 2)", costs[3] / costs[0]);
    println!("10,000 by tree over evenly:     {:.4} (at most 0.1)", costs[3] / costs[5]);
}

/// What all threads of this process have taken of the processor, where the system tells (Linux); else the time.
fn processor_seconds() -> f64 {
    let thread = |stat: std::path::PathBuf| {
        let text = std::fs::read_to_string(stat).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    };
    match std::fs::read_dir("/proc/self/task") {
        Ok(tasks) => tasks.flatten().filter_map(|t| thread(t.path().join("schedstat"))).sum::<f64>() * 1e-9,
        Err(_) => std::time::UNIX_EPOCH.elapsed().map_or(0.0, |t| t.as_secs_f64()),
    }
}

/// The mean relative variance of a pixel over runs.
fn noise(runs: &[Vec<f64>]) -> f64 {
    let n = runs.len() as f64;
    let of_pixel = |i: usize| {
        let mean = runs.iter().map(|r| r[i]).sum::<f64>() / n;
        let variance = runs.iter().map(|r| (r[i] - mean) * (r[i] - mean)).sum::<f64>() / (n - 1.0);
        if mean > 0.0 { variance / (mean * mean) } else { 0.0 }
    };
    let mut all: Vec<f64> = (0..runs[0].len()).map(of_pixel).collect();
    all.sort_by(f64::total_cmp);
    let kept = &all[..all.len() - all.len() / 1000];
    kept.iter().sum::<f64>() / kept.len() as f64
}

/// A floor with blocks under a cloud of small lamps, 1 kW together.
fn scene(shape: Shape, count: u32, selection: &str, seed: u64) -> String {
    let mut s = format!(
        "[film]\nwidth = {SIZE}\nheight = {SIZE}\nfilter = \"box\"\n[sampler]\nseed = {seed}\n\
         [integrator]\ntype = \"path\"\nmax_depth = 2\nlight_selection = \"{selection}\"\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0, 9, 16]\nlook_at = [0, 0.5, 0]\nfov = 45\n\
         [materials.white]\ntype = \"lambert\"\nreflectance = 0.6\n\
         [materials.lamp]\ntype = \"emitter\"\nunit = \"W\"\nradiance = 1\nintensity = {}\n\
         [objects.floor]\ntype = \"plane\"\nmaterial = \"white\"\n",
        if let Shape::Mesh = shape { 1000.0 } else { 1000.0 / f64::from(count) }
    );
    let mut random = Random::new(1);
    let mut within = |low: f64, high: f64| low + (high - low) * f64::from(random.number());
    for i in 0..30 {
        let (x, z, h) = (within(-8.0, 7.0), within(-8.0, 7.0), within(0.2, 1.0));
        writeln!(
            s,
            "[objects.block{i}]\ntype = \"box\"\nmin = [{x}, 0, {z}]\nmax = [{}, {h}, {}]\nmaterial = \"white\"",
            x + 0.6,
            z + 0.6
        )
        .expect("text grows");
    }
    let mut vertices = String::new();
    for i in 0..count {
        let [x, y, z] = [within(-8.0, 8.0), within(1.2, 3.0), within(-8.0, 8.0)];
        let ball = |radius: f64| format!("type = \"sphere\"\nradius = {radius}\ncenter = [{x}, {y}, {z}]");
        let corners = [[x, y, z], [x + 0.04, y, z], [x, y, z + 0.04]];
        let body = match shape {
            Shape::Mesh => {
                corners.iter().for_each(|c| write!(vertices, "{c:?},").expect("text grows"));
                continue;
            }
            Shape::Panes => format!("type = \"triangle\"\nvertices = {corners:?}"),
            Shape::Balls => ball(0.02 * (10.0 / f64::from(count)).sqrt()),
            Shape::WideBalls => ball(0.02),
        };
        writeln!(s, "[objects.lamp{i}]\n{body}\nmaterial = \"lamp\"\nvisible = false").expect("text grows");
    }
    if let Shape::Mesh = shape {
        let faces: Vec<u32> = (0..3 * count).collect();
        let body = format!("type = \"mesh\"\nvertices = [{vertices}]\nfaces = {faces:?}");
        writeln!(s, "[objects.lamps]\n{body}\nmaterial = \"lamp\"\nvisible = false").expect("text grows");
    }
    s
}

fn compile(toml: &str) -> Prepared {
    let files = MemoryFiles([("scene.toml".to_string(), toml.as_bytes().to_vec())].into());
    let access = FileAccess::new(Box::new(files), Limits::default());
    let description = load(&access, "scene.toml").expect("the scene is sound");
    let assets = FormatAssets::new(&access, &description.sources);
    prepare(&description, &assets, &Options::default()).unwrap_or_else(|e| panic!("{e:?}"))
}

fn luminances(film: &Film) -> Vec<f64> {
    let planes = film.layout.planes();
    film.pixels()
        .map(|(_, _, tile, i)| {
            let sums = (0..planes).fold([0.0; 3], |s, p| {
                let c = tile.sums[i * planes + p].map(fixed::to_f64);
                [s[0] + c[0], s[1] + c[1], s[2] + c[2]]
            });
            0.2126 * sums[0] + 0.7152 * sums[1] + 0.0722 * sums[2]
        })
        .collect()
}
