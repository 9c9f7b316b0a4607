//! `--stats`: what a render cost, as counted, in one JSON object.

use kirkas_images::Texts;
use kirkas_render::{Film, Prepared, Statistics};
use kirkas_scene::Diagnostic;
use serde_json::{Value, json};
use std::ops::Range;

/// Seconds, by what they were spent on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seconds {
    /// Reading and parsing; in a film, the first frame bears it.
    pub load: f64,
    /// Compiling and building what finds hits.
    pub build: f64,
    /// Moving rays.
    pub render: f64,
    /// From the start of the program, or from the end of the frame before, to the last file.
    pub total: f64,
}

/// The whole object.
pub fn stats_json(
    texts: &Texts,
    prepared: &Prepared,
    film: &Film,
    samples: &Range<u32>,
    counted: &Statistics,
    seconds: Seconds,
    warnings: &[Diagnostic],
) -> Value {
    let text = |name: &str| texts.get(name).cloned().unwrap_or_default();
    let crop = film.layout.crop;
    let invalid = film.tiles.iter().flat_map(|t| &t.invalid);
    let shown: Vec<Value> =
        warnings.iter().map(|w| json!({ "code": w.code, "message": w.message, "help": w.help })).collect();
    json!({
        "version": text("kirkas.version"),
        "argv": std::env::args_os().map(|a| a.to_string_lossy().into_owned()).collect::<Vec<_>>(),
        "scene": text("kirkas.scene"),
        "scene_hash": text("kirkas.scene_hash"),
        "seed": prepared.seed,
        "frame": prepared.frame,
        "spp": samples.end - samples.start,
        "samples": text("kirkas.samples"),
        "size": [film.layout.size.0, film.layout.size.1],
        "crop": [crop.x0, crop.y0, crop.x1, crop.y1],
        "threads": rayon::current_num_threads(),
        "seconds": {
            "load": seconds.load, "build": seconds.build, "render": seconds.render, "total": seconds.total,
        },
        "rays": {
            "camera": counted.camera_rays,
            "reflected": counted.reflected_rays,
            "refracted": counted.refracted_rays,
            "glossy": counted.glossy_rays,
            "diffuse": counted.diffuse_rays,
            "photon": counted.photon_rays,
            "shadow": counted.shadow_rays,
            "total": counted.rays(),
        },
        "rays_per_second": ratio(counted.rays() as f64, seconds.render),
        "samples_per_second": ratio(counted.samples as f64, seconds.render),
        "cost": cost(prepared, film, counted, seconds.render),
        "peak_rss_bytes": peak_rss_bytes(),
        "nan_samples": film.invalid_samples(),
        "nan_locations": invalid.map(|s| json!({ "x": s.x, "y": s.y, "sample": s.sample })).collect::<Vec<_>>(),
        "adaptive": prepared.target.map(|target| {
            let c = film.convergence();
            json!({ "error": target.error, "blocks": c.blocks, "open_blocks": c.open, "mean_samples": c.mean_samples })
        }),
        "warnings": shown,
    })
}

/// The factors of the course's formula: cost = height x width x primitives x intersection x size of ray tree x shadow rays
/// x supersamples x glossy rays x temporal samples x aperture samples. A factor of which nothing was counted is 1 in the product.
fn cost(prepared: &Prepared, film: &Film, c: &Statistics, seconds: f64) -> Value {
    let pixels = film.layout.crop.area() as f64;
    let per_pixel = |n: u64| ratio(n as f64, pixels);
    let rays = c.rays() as f64;
    let tests = c.search.primitives_tested as f64;
    let supersamples = per_pixel(c.camera_rays);
    // Rays of the tree: all but the shadow rays, one for each camera ray at least.
    let tree = ratio((c.rays() - c.shadow_rays) as f64, c.camera_rays as f64);
    let tree_without_glossy = ratio((c.rays() - c.shadow_rays - c.glossy_rays) as f64, c.camera_rays as f64);
    let glossy = ratio(tree, tree_without_glossy).max(1.0);
    // With the ray that asks for them.
    let shadow = ratio(rays, rays - c.shadow_rays as f64).max(1.0);
    let primitives_per_ray = ratio(tests, rays);
    let seconds_per_test = ratio(seconds, tests);
    let product = pixels * primitives_per_ray * seconds_per_test * tree_without_glossy * shadow * supersamples * glossy;
    let primitives = prepared.scene.accel.statistics().primitives;
    json!({
        "height": film.layout.crop.height(),
        "width": film.layout.crop.width(),
        "primitives": primitives,
        "primitives_tested_per_ray": primitives_per_ray,
        "nodes_visited_per_ray": ratio(c.search.nodes_visited as f64, rays),
        "seconds_per_intersection": seconds_per_test,
        "ray_tree_size": tree,
        "supersamples": supersamples,
        "shadow_rays_per_pixel": per_pixel(c.shadow_rays),
        "glossy_rays_per_pixel": per_pixel(c.glossy_rays),
        "time_rays_per_pixel": per_pixel(c.time_samples),
        "aperture_rays_per_pixel": per_pixel(c.lens_samples),
        "factors": {
            "pixels": pixels,
            "primitives_tested_per_ray": primitives_per_ray,
            "seconds_per_intersection": seconds_per_test,
            "ray_tree": tree_without_glossy,
            "shadow": shadow,
            "supersamples": supersamples,
            "glossy": glossy,
            // Times and places on the lens ride on the supersamples: no ray is spent on them alone.
            "temporal": 1.0,
            "aperture": 1.0,
        },
        "product_seconds": product,
        "render_seconds": seconds,
        "seconds_without_accelerator": product * ratio(primitives as f64, primitives_per_ray).max(1.0),
    })
}

/// 0 where there is nothing to divide by.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// The most memory this process held, where the system tells.
fn peak_rss_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|k| k * 1024)
}
