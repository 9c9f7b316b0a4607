//! Builds: triangles per second on one and two threads, memory, and the expected cost of a ray.

use crate::clock::{Clock, Median, median};
use crate::embree::{Embree, Quality};
use crate::kirkas::{self, Threads};
use crate::options::Options;
use crate::report::Row;
use crate::scenes::Scene;
use kirkas_accel::{AccelKind, Statistics};
use serde_json::{Value, json};

/// One structure of ours beside the one of theirs that is meant for the same.
#[derive(Clone, Debug)]
pub struct BuildRow {
    scene: String,
    accel: &'static str,
    quality: Quality,
    threads: usize,
    triangles: usize,
    /// Millions of triangles per second.
    kirkas: Median,
    embree: Option<Median>,
    statistics: Statistics,
    embree_bytes: Option<f64>,
}

/// The quality of theirs to stand beside a structure of ours.
fn quality(kind: AccelKind) -> Quality {
    match kind.name() {
        "bvh8_fast" => Quality::LOW,
        "bvh8_best" => Quality::HIGH,
        "bvh8_compact" => Quality::COMPACT,
        _ => Quality::MEDIUM,
    }
}

/// Build a scene with every structure on one and two threads.
pub fn measure(scene: &Scene, options: &Options, embree: Option<&Embree>) -> Result<Vec<BuildRow>, String> {
    println!(
        "  build           threads  kirkas ±MAD   Embree        quality        ratio, Mtris/s; bytes per triangle"
    );
    let mut rows = Vec::new();
    for threads in [1, 2] {
        let pool = Threads::new(threads)?;
        // One thread computes while the build runs, whichever it is.
        let clock = if threads == 1 { Clock::Process } else { Clock::Wall };
        let prepared = embree.map(|e| e.prepare(scene, threads, options.isa.as_deref())).transpose()?;
        for &kind in &options.built {
            let (mut ours, mut theirs) = (Vec::new(), Vec::new());
            let (mut statistics, mut embree_bytes) = (Statistics::default(), None);
            let triangles = scene.indices.len() as f64;
            for _ in 0..options.build_passes {
                let mut built = None;
                let seconds = clock.seconds(|| built = Some(pool.run(|| kirkas::build(kind, scene, &pool))));
                statistics = built.transpose()?.map(|a| a.statistics()).unwrap_or_default();
                ours.push(triangles / seconds * 1e-6);
                if let Some(prepared) = &prepared {
                    let mut built = None;
                    let seconds = clock.seconds(|| built = Some(prepared.build(quality(kind))));
                    embree_bytes = built.transpose()?.map(|b| b.bytes as f64 / triangles);
                    theirs.push(triangles / seconds * 1e-6);
                }
            }
            let row = BuildRow {
                scene: scene.name.clone(),
                accel: kind.name(),
                quality: quality(kind),
                threads,
                triangles: scene.indices.len(),
                kirkas: median(&ours),
                embree: (!theirs.is_empty()).then(|| median(&theirs)),
                statistics,
                embree_bytes,
            };
            row.print();
            rows.push(row);
        }
    }
    Ok(rows)
}

impl BuildRow {
    fn ratio(&self) -> Option<f64> {
        self.embree.map(|e| self.kirkas.value / e.value)
    }

    fn bytes(&self) -> f64 {
        self.statistics.bytes as f64 / self.triangles as f64
    }

    fn print(&self) {
        let speed = |m: Option<Median>| m.map_or(" ".repeat(13), |m| format!("{:6.2} ±{:5.2}", m.value, m.deviation));
        let ratio = self.ratio().map_or(" ".repeat(5), |r| format!("{r:5.2}"));
        let theirs = self.embree_bytes.map_or(String::new(), |b| format!(" to {b:.1}"));
        let (bytes, cost) = (self.bytes(), self.statistics.sah_cost);
        let speeds = format!("{} {}", speed(Some(self.kirkas)), speed(self.embree));
        let (accel, threads, quality) = (self.accel, self.threads, self.quality.name);
        println!("  {accel:16}{threads:7}  {speeds}  {quality:14} x{ratio}  {bytes:.1}{theirs}  cost {cost:.2}");
    }
}

impl Row for BuildRow {
    fn json(&self) -> Value {
        json!({
            "scene": self.scene, "mode": "build", "accel": self.accel, "embree": self.quality.name,
            "threads": self.threads, "triangles": self.triangles,
            "kirkas_mtris": self.kirkas.value, "kirkas_deviation": self.kirkas.deviation,
            "embree_mtris": self.embree.map(|m| m.value), "embree_deviation": self.embree.map(|m| m.deviation),
            "ratio": self.ratio(),
            "kirkas_bytes_per_triangle": self.bytes(), "embree_bytes_per_triangle": self.embree_bytes,
            "sah_cost": self.statistics.sah_cost, "nodes": self.statistics.nodes, "depth": self.statistics.depth,
        })
    }
}
