//! What `bench` measured, as tables for people and as JSON for programs.

use kirkas_accel::{Counters, Statistics};
use serde_json::{Map, Value, json};

/// One structure.
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Seconds to build it.
    pub build: f64,
    /// What it looks like.
    pub statistics: Statistics,
    /// What it did for each set of rays.
    pub answers: Vec<Answers>,
}

/// What a structure did for a set of rays.
pub struct Answers {
    /// The set.
    pub set: &'static str,
    /// How many.
    pub rays: usize,
    /// How many hit something.
    pub hits: usize,
    /// Seconds for all.
    pub seconds: f64,
    /// What the search did for all.
    pub counters: Counters,
}

impl Answers {
    fn mega_rays_per_second(&self) -> Option<f64> {
        ratio(self.rays as f64 / 1e6, self.seconds)
    }

    fn nodes_per_ray(&self) -> Option<f64> {
        ratio(self.counters.nodes_visited as f64, self.rays as f64)
    }

    fn primitives_per_ray(&self) -> Option<f64> {
        ratio(self.counters.primitives_tested as f64, self.rays as f64)
    }
}

/// A figure of a set of rays, and its name.
type Figure = (&'static str, fn(&Answers) -> Option<f64>);

const FIGURES: [Figure; 3] = [
    ("Mrays/s", Answers::mega_rays_per_second),
    ("nodes/ray", Answers::nodes_per_ray),
    ("primitives/ray", Answers::primitives_per_ray),
];

/// Tables with a row for each structure.
pub fn table(title: &str, rows: &[Row]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let s = &first.statistics;
    let mut out = format!("{title}: {} primitives, {} instances; one thread\n", s.primitives, s.instances);
    let head = ["", "build ms", "SAH cost", "nodes", "depth", "bytes/primitive"];
    let cells = rows.iter().map(|row| {
        let s = &row.statistics;
        let bytes = ratio(s.bytes as f64, s.primitives as f64);
        let numbers =
            [number(Some(row.build * 1e3)), number(Some(s.sah_cost)), s.nodes.to_string(), s.depth.to_string()];
        [vec![row.name.to_string()], numbers.to_vec(), vec![number(bytes)]].concat()
    });
    out += &aligned(head.map(String::from).to_vec(), cells.collect());
    for (name, figure) in FIGURES.iter().filter(|_| !first.answers.is_empty()) {
        let sets = first.answers.iter().map(|a| a.set.to_string());
        let head = std::iter::once(name.to_string()).chain(sets).collect();
        let cells = rows.iter().map(|row| {
            let numbers = row.answers.iter().map(|a| number(figure(a)));
            std::iter::once(row.name.to_string()).chain(numbers).collect()
        });
        out += &aligned(head, cells.collect());
    }
    out
}

/// The same, and a little more.
pub fn json(title: &str, scene_hash: &str, side: Option<u32>, rows: &[Row]) -> Value {
    let structure = |row: &Row| {
        let s = &row.statistics;
        let mut value = json!({
            "name": row.name,
            "build_seconds": row.build,
            "sah_cost": s.sah_cost,
            "nodes": s.nodes,
            "depth": s.depth,
            "bytes": s.bytes,
            "bytes_per_primitive": ratio(s.bytes as f64, s.primitives as f64),
        });
        if side.is_some() {
            value["rays"] = row.answers.iter().map(|a| (a.set.to_string(), answers(a))).collect::<Map<_, _>>().into();
        }
        value
    };
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scene": title,
        "scene_hash": scene_hash,
        "threads": 1,
        "side": side,
        "primitives": rows.first().map(|r| r.statistics.primitives),
        "instances": rows.first().map(|r| r.statistics.instances),
        "structures": rows.iter().map(structure).collect::<Vec<_>>(),
    })
}

fn answers(a: &Answers) -> Value {
    json!({
        "rays": a.rays,
        "hits": a.hits,
        "seconds": a.seconds,
        "mrays_per_second": a.mega_rays_per_second(),
        "nodes_per_ray": a.nodes_per_ray(),
        "primitives_per_ray": a.primitives_per_ray(),
    })
}

/// Columns as wide as their widest cell: the first from the left, all others from the right.
fn aligned(head: Vec<String>, rows: Vec<Vec<String>>) -> String {
    let lines: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    let width = |column: usize| lines.iter().map(|l| l[column].len()).max().unwrap_or(0);
    let mut out = String::from("\n");
    for line in &lines {
        let cells = line.iter().enumerate().map(|(i, cell)| match i {
            0 => format!("{cell:<w$}", w = width(0)),
            _ => format!("  {cell:>w$}", w = width(i).max(7)),
        });
        out += &(cells.collect::<String>() + "\n");
    }
    out
}

/// Three digits behind the point, fewer for large numbers; a dash for none.
fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        Some(v) if v >= 1000.0 => format!("{v:.0}"),
        Some(v) if v >= 100.0 => format!("{v:.1}"),
        Some(v) if v >= 10.0 => format!("{v:.2}"),
        Some(v) => format!("{v:.3}"),
    }
}

/// None where there is nothing to divide by.
fn ratio(a: f64, b: f64) -> Option<f64> {
    (b > 0.0).then(|| a / b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_what_was_not_measured_is_a_dash() {
        let answers = |seconds| Answers { set: "ao", rays: 2_000_000, hits: 1, seconds, counters: Counters::default() };
        let row = |name, seconds| Row {
            name,
            build: 0.5,
            statistics: Statistics::default(),
            answers: vec![answers(seconds)],
        };
        let text = table("a.toml", &[row("bvh2", 1.0), row("brute_force", 16.0)]);
        let expected = "a.toml: 0 primitives, 0 instances; one thread

             build ms  SAH cost    nodes    depth  bytes/primitive
bvh2            500.0     0.000        0        0                -
brute_force     500.0     0.000        0        0                -

Mrays/s           ao
bvh2           2.000
brute_force    0.125

nodes/ray         ao
bvh2           0.000
brute_force    0.000

primitives/ray       ao
bvh2              0.000
brute_force       0.000
";
        assert_eq!(text, expected);
    }
}
