//! How time grows with the scene: the displaced sphere over sizes, next to what theory promises.

use crate::clock::Clock;
use crate::embree::Embree;
use crate::kirkas;
use crate::options::Options;
use crate::rays;
use crate::report::{RayRow, Row};
use crate::scenes;
use kirkas_accel::Serial;
use serde_json::{Value, json};

/// A size, and one ray set through it.
#[derive(Clone, Debug)]
pub struct GrowthRow {
    triangles: usize,
    /// Of the whole build, on one thread.
    build_seconds: f64,
    row: RayRow,
}

/// Build and trace spheres of the sizes that the options name.
pub fn measure(options: &Options, embree: Option<&Embree>) -> Result<Vec<GrowthRow>, String> {
    let mut rows = Vec::new();
    for size in &options.sizes {
        let Some(scene) = scenes::load(&format!("sphere-{size}"))? else { continue };
        let n = scene.indices.len();
        println!("\n{n} triangles");
        let mut builds = Vec::new();
        for &kind in &options.accels {
            let mut built = Ok(());
            let seconds = Clock::Process.seconds(|| built = kirkas::build(kind, &scene, &Serial).map(drop));
            built?;
            let per_step = seconds * 1e9 / (n as f64 * (n as f64).log2());
            println!("  {:14} build {seconds:8.3} s, {per_step:6.2} ns per n log2 n", kind.name());
            builds.push((kind.name(), seconds));
        }
        for row in rays::measure(&scene, options, embree)? {
            let build_seconds = builds.iter().find(|b| b.0 == row.accel).map_or(f64::NAN, |b| b.1);
            rows.push(GrowthRow { triangles: n, build_seconds, row });
        }
    }
    Ok(rows)
}

impl Row for GrowthRow {
    fn json(&self) -> Value {
        let mut value = self.row.json();
        let n = self.triangles as f64;
        value["triangles"] = json!(self.triangles);
        value["build_seconds"] = json!(self.build_seconds);
        value["build_ns_per_n_log_n"] = json!(self.build_seconds * 1e9 / (n * n.log2()));
        value
    }
}
