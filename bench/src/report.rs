//! Rows: printed while they are measured, and written as JSON.

use crate::clock::Median;
use serde_json::{Value, json};
use std::path::Path;

/// What can be written.
pub trait Row {
    /// One object.
    fn json(&self) -> Value;
}

/// A ray set through a scene, in one mode. Speeds are in millions of rays per second.
#[derive(Clone, Debug)]
pub struct RayRow {
    /// Name of the scene.
    pub scene: String,
    /// Name of the ray set.
    pub rays: &'static str,
    /// How rays were handed over: single, packet or batch. Embree answers a batch ray by ray.
    pub mode: &'static str,
    /// Name of our structure.
    pub accel: &'static str,
    /// Number of rays.
    pub count: usize,
    /// Ours.
    pub kirkas: Median,
    /// Theirs, built at high quality.
    pub embree: Option<Median>,
    /// Theirs at high quality in the watertight mode; ours is always watertight.
    pub embree_robust: Option<Median>,
    /// Theirs as it is without asking.
    pub embree_default: Option<Median>,
    /// The part of the hits that agree with `embree`, 0 to 1.
    pub agreement: Option<f64>,
    /// Whether that is enough.
    pub hits_equal: Option<bool>,
    /// Inner nodes that our rays visit.
    pub nodes_per_ray: f64,
    /// Triangles that our rays test.
    pub primitives_per_ray: f64,
}

impl RayRow {
    /// Ours over theirs.
    pub fn ratio(&self) -> Option<f64> {
        self.embree.map(|e| self.kirkas.value / e.value)
    }

    fn robust_ratio(&self) -> Option<f64> {
        self.embree_robust.map(|e| self.kirkas.value / e.value)
    }

    /// One line of the table.
    pub fn print(&self) {
        let speed = |m: Option<Median>| m.map_or(" ".repeat(13), |m| format!("{:6.2} ±{:5.2}", m.value, m.deviation));
        let ratio = |r: Option<f64>| r.map_or(" ".repeat(5), |r| format!("{r:5.2}"));
        let speeds = format!("{} {} {}", speed(Some(self.kirkas)), speed(self.embree), speed(self.embree_robust));
        let cost = format!("{:5.1} nodes {:5.1} triangles", self.nodes_per_ray, self.primitives_per_ray);
        let agreement = self.agreement.map_or(String::new(), |a| format!("{:8.4} % agree", a * 100.0));
        println!(
            "  {:9}{:7}{:14}{speeds}  x{} x{}  {cost} {agreement}",
            self.rays,
            self.mode,
            self.accel,
            ratio(self.ratio()),
            ratio(self.robust_ratio())
        );
    }
}

/// What the columns of the ray table are.
pub const RAY_HEAD: &str = "  rays     mode   structure      kirkas ±MAD   Embree high   high+robust  ratio to each    (Mrays/s; visits per ray)";

impl Row for RayRow {
    fn json(&self) -> Value {
        json!({
            "scene": self.scene, "rays": self.rays, "mode": self.mode, "accel": self.accel, "count": self.count,
            "kirkas_mrays": self.kirkas.value, "kirkas_deviation": self.kirkas.deviation,
            "embree": "high", "embree_mrays": self.embree.map(|m| m.value),
            "embree_deviation": self.embree.map(|m| m.deviation),
            "embree_robust_mrays": self.embree_robust.map(|m| m.value),
            "embree_default_mrays": self.embree_default.map(|m| m.value),
            "ratio": self.ratio(), "ratio_robust": self.robust_ratio(),
            "agreement": self.agreement, "hits_equal": self.hits_equal,
            "nodes_per_ray": self.nodes_per_ray, "primitives_per_ray": self.primitives_per_ray,
        })
    }
}

/// Print the geometric mean of the ratios over all scenes, per ray set, mode and structure.
pub fn geometric_means(rows: &[RayRow]) {
    let mut seen = Vec::new();
    for row in rows.iter().filter(|r| r.embree.is_some()) {
        let key = (row.rays, row.mode, row.accel);
        if seen.contains(&key) {
            continue;
        }
        if seen.is_empty() {
            println!("\ngeometric mean of the ratios to Embree high, and to high+robust");
        }
        seen.push(key);
        let same = || rows.iter().filter(|r| (r.rays, r.mode, r.accel) == key);
        let [high, robust] = [RayRow::ratio, RayRow::robust_ratio].map(|f| geometric_mean(same().filter_map(f)));
        println!("  {:9}{:7}{:14} x{high:5.2} x{robust:5.2}  over {} scenes", key.0, key.1, key.2, same().count());
    }
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, n), v| (sum + v.ln(), n + 1));
    (sum / f64::from(count)).exp()
}

/// Write all rows as one array; does nothing without a file.
pub fn write<R: Row>(file: Option<&Path>, rows: &[R]) -> Result<(), String> {
    let Some(file) = file else { return Ok(()) };
    let lines: Vec<String> = rows.iter().map(|r| format!("  {}", r.json())).collect();
    std::fs::write(file, format!("[\n{}\n]\n", lines.join(",\n"))).map_err(|e| format!("{}: {e}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_as_fast_and_half_as_fast_make_one() {
        assert!((geometric_mean([2.0, 0.5].into_iter()) - 1.0).abs() < 1e-12);
    }
}
