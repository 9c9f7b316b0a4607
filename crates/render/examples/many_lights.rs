//! What many lights cost: the same total power from ten lamps and from ten thousand, chosen by tree, by power and evenly.
//!
//! `cargo run --release -p kirkas-render --example many_lights`. Noise is the relative variance of a pixel over seeds, the
//! greatest 0.1 % of pixels left out; cost is time times noise, which is in proportion to the time to any given error.

use kirkas_formats::{FormatAssets, load};
use kirkas_render::film::fixed;
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, Prepared, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_testkit::Random;
use std::fmt::Write;
use std::time::Instant;

const SEEDS: u64 = 6;
const SIZE: u32 = 96;
const SAMPLES: u32 = 16;

fn main() {
    println!("{:>9} {:8} {:>9} {:>10} {:>10}", "emitters", "chosen", "seconds", "noise", "cost");
    let mut costs = Vec::new();
    for (count, selection) in
        [(10, "tree"), (10, "power"), (10, "uniform"), (10_000, "tree"), (10_000, "power"), (10_000, "uniform")]
    {
        let (seconds, noise) = measure(count, selection);
        println!("{count:>9} {selection:8} {seconds:>9.3} {noise:>10.5} {:>10.5}", seconds * noise);
        costs.push(seconds * noise);
    }
    println!("10,000 by tree over 10 by tree: {:.2} (at most 2)", costs[3] / costs[0]);
    println!("10,000 by tree over evenly:     {:.4} (at most 0.1)", costs[3] / costs[5]);
}

/// Mean seconds of a render and the noise of its pixels.
fn measure(count: u32, selection: &str) -> (f64, f64) {
    let (mut seconds, mut runs) = (0.0, Vec::new());
    for seed in 0..SEEDS {
        let p = compile(&scene(count, selection, seed));
        let mut film = Film::new(p.film.clone());
        let start = Instant::now();
        p.renderer(256).render(&mut film, 0..SAMPLES, &Undisturbed);
        seconds += start.elapsed().as_secs_f64() / SEEDS as f64;
        runs.push(luminances(&film));
    }
    let n = SEEDS as f64;
    let noise = |i: usize| {
        let mean = runs.iter().map(|r| r[i]).sum::<f64>() / n;
        let variance = runs.iter().map(|r| (r[i] - mean) * (r[i] - mean)).sum::<f64>() / (n - 1.0);
        if mean > 0.0 { variance / (mean * mean) } else { 0.0 }
    };
    let mut all: Vec<f64> = (0..runs[0].len()).map(noise).collect();
    all.sort_by(f64::total_cmp);
    let kept = &all[..all.len() - all.len() / 1000];
    (seconds, kept.iter().sum::<f64>() / kept.len() as f64)
}

/// A floor with blocks under a cloud of small lamps, 1 kW together.
fn scene(count: u32, selection: &str, seed: u64) -> String {
    let mut s = format!(
        "[film]\nwidth = {SIZE}\nheight = {SIZE}\nfilter = \"box\"\n[sampler]\nseed = {seed}\n\
         [integrator]\ntype = \"path\"\nmax_depth = 2\nlight_selection = \"{selection}\"\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0, 9, 16]\nlook_at = [0, 0.5, 0]\nfov = 45\n\
         [materials.white]\ntype = \"lambert\"\nreflectance = 0.6\n\
         [materials.lamp]\ntype = \"emitter\"\nunit = \"W\"\nradiance = 1\nintensity = {}\n\
         [objects.floor]\ntype = \"plane\"\nmaterial = \"white\"\n",
        1000.0 / f64::from(count)
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
    for i in 0..count {
        let [x, y, z] = [within(-8.0, 8.0), within(1.2, 3.0), within(-8.0, 8.0)];
        let corners = [[x, y, z], [x + 0.04, y, z], [x, y, z + 0.04]];
        writeln!(
            s,
            "[objects.lamp{i}]\ntype = \"triangle\"\nvertices = {corners:?}\nmaterial = \"lamp\"\nvisible = false"
        )
        .expect("text grows");
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
