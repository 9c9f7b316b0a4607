//! One HTML file with the picture, the pixel, its ray tree in 3D and in 2D, and bars of what its light is. It loads nothing, and
//! opens anywhere.

use crate::finding::findings;
use crate::record::Explanation;
use crate::story::{stories, summary};
use crate::wireframe::wireframe;
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use kirkas_geometry::Vec3;
use kirkas_render::Scene;
use serde_json::{Value, json};

/// Lines of the scene's geometry at most.
const MOST_LINES: usize = 12_000;
/// Samples whose trees are in the page at most: the brightest, the median, and others evenly.
const MOST_SAMPLES: usize = 64;
/// Bytes of the trees at most.
const MOST_BYTES: usize = 3_500_000;

/// The page. `picture` is a PNG with its width and height in pixels, which may be fewer than the image's.
pub fn page(e: &Explanation, scene: &Scene, picture: Option<(&[u8], u32, u32)>) -> String {
    let lines = wireframe(scene.accel.scene_geometry(), f64::from(time(e)), MOST_LINES);
    let numbers: Vec<u8> = lines.iter().flatten().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let bounds = scene.accel.bounds();
    let size = if bounds.is_finite() { bounds.extent().length() } else { 0.0 };
    let data = json!({
        "explanation": shortened(e),
        "summary": summary(e),
        "findings": findings(e).iter().map(|f| json!({ "code": f.code, "text": f.text, "cure": f.cure })).collect::<Value>(),
        "stories": stories(e).iter().map(|s| json!({ "text": s.text, "share": s.share, "samples": s.samples })).collect::<Value>(),
        "lines": BASE64.encode(&numbers),
        "camera": camera(e),
        "size": size,
        "picture": picture.map(|(png, width, height)| json!({ "png": BASE64.encode(png), "width": width, "height": height })),
    });
    // Nothing in a text may end the script.
    let data = data.to_string().replace('<', "\\u003c");
    include_str!("page/page.html")
        .replace("/*STYLE*/", include_str!("page/page.css"))
        .replace("/*SCRIPT*/", include_str!("page/page.js"))
        .replace("/*DATA*/", &data)
}

fn time(e: &Explanation) -> f32 {
    e.trees.iter().flat_map(|s| &s.rays).map(|r| r.time).next().unwrap_or(0.0)
}

/// Where the pixel's rays start, and whither they go, on average.
fn camera(e: &Explanation) -> Value {
    let first = || e.trees.iter().filter_map(|s| s.rays.first());
    let sum =
        |of: fn(&crate::record::Node) -> [f32; 3]| first().fold(Vec3::ZERO, |all, n| all + Vec3::from_array(of(n)));
    let count = first().count().max(1) as f32;
    json!({
        "origin": (sum(|n| n.origin) / count).to_array(),
        "direction": sum(|n| n.direction).normalize_or_zero().to_array(),
    })
}

/// With as many trees as fit.
fn shortened(e: &Explanation) -> Value {
    let mut short = e.clone();
    let whole = e.trees.len();
    let stride = whole.div_ceil(MOST_SAMPLES).max(1);
    short.trees = e.trees.iter().step_by(stride).cloned().collect();
    let mut value = short.to_json();
    while value.to_string().len() > MOST_BYTES && short.trees.len() > 1 {
        let half = short.trees.len().div_ceil(2);
        short.trees = short.trees.into_iter().step_by(2).take(half).collect();
        value = short.to_json();
    }
    value["all_samples"] = json!(whole);
    value
}
