//! `kirkas bench`: tables, figures and faults. What the numbers are is the machine's affair.

use crate::common::{BALL, Done, EVERYTHING, Folder};
use crate::errors::said;
use kirkas_accel::AccelKind;
use serde_json::Value;

const SETS: [&str; 6] = ["primary", "ao", "diff1", "diff2", "diff2any", "random"];

/// The first words of each row below the row that begins with `head`, and the head's other words.
fn rows(done: &Done, head: &str) -> (Vec<String>, Vec<String>) {
    let words = |line: &str| line.split_whitespace().map(String::from).collect::<Vec<_>>();
    let mut lines = done.stdout.lines().skip_while(|l| !l.trim_start().starts_with(head));
    let columns = words(lines.next().unwrap());
    let rows = lines.take_while(|l| !l.is_empty()).map(|l| {
        let cells = words(l);
        assert!(cells[1..].iter().all(|c| c == "-" || c.parse::<f64>().is_ok()), "{l}");
        cells[0].clone()
    });
    (rows.collect(), columns)
}

#[test]
fn every_structure_has_a_row_in_every_table() {
    let f = Folder::with_scene("bench_rays", EVERYTHING);
    let done = f.ok(&["bench", "rays", "scene.toml", "--side", "16", "--seconds", "0", "--json", "b.json"]);
    assert_eq!(done.stderr, "");
    assert!(done.stdout.starts_with("scene.toml: 6 primitives, 1 instances; one thread\n"), "{}", done.stdout);
    assert_eq!(rows(&done, "build ms").0, AccelKind::NAMES);
    for head in ["Mrays/s", "nodes/ray", "primitives/ray"] {
        let (names, columns) = rows(&done, head);
        assert_eq!((names, &columns[1..]), (AccelKind::NAMES.map(String::from).to_vec(), &SETS.map(String::from)[..]));
    }
    let b: Value = serde_json::from_slice(&std::fs::read(f.path("b.json")).unwrap()).unwrap();
    assert_eq!((&b["side"], &b["threads"], &b["primitives"]), (&16.into(), &1.into(), &6.into()));
    assert_eq!(b["scene_hash"].as_str().unwrap().len(), 64);
    assert_eq!(b["structures"].as_array().unwrap().len(), AccelKind::NAMES.len());
    for s in b["structures"].as_array().unwrap() {
        assert!(s["build_seconds"].as_f64().unwrap() > 0.0);
        assert!(s["sah_cost"].is_number() && s["nodes"].is_number() && s["bytes_per_primitive"].is_number());
        for set in SETS {
            let r = &s["rays"][set];
            assert_eq!(r["rays"], 256, "{set}");
            assert!(r["mrays_per_second"].as_f64().unwrap() > 0.0);
            assert_eq!(r["hits"], b["structures"][0]["rays"][set]["hits"], "{set}");
        }
        // Camera rays below the horizon meet the floor, and some balls stand before the sky.
        let hits = s["rays"]["primary"]["hits"].as_u64().unwrap();
        assert!((64..256).contains(&hits), "{hits}");
    }
    // One of the six is an instance, which a ray may miss as a whole.
    let tested = b["structures"][0]["rays"]["random"]["primitives_per_ray"].as_f64().unwrap();
    assert!(b["structures"][0]["name"] == "brute_force" && (5.0..=6.0).contains(&tested), "{tested}");
}

#[test]
fn build_alone_asks_no_rays_and_json_may_go_to_stdout() {
    let f = Folder::with_scene("bench_build", BALL);
    let done = f.ok(&["bench", "build", "scene.toml", "--seconds", "0", "--accel", "bvh2,brute_force"]);
    assert_eq!(rows(&done, "build ms").0, ["bvh2", "brute_force"]);
    assert!(!done.stdout.contains("Mrays/s"));
    let done = f.ok(&["bench", "build", "scene.toml", "--seconds", "0", "--json", "-"]);
    let b: Value = serde_json::from_str(&done.stdout).unwrap();
    assert!(b["side"].is_null() && b["structures"][0].get("rays").is_none());
}

#[test]
fn brute_force_is_left_out_where_it_would_take_for_ever() {
    let f = Folder::new("bench_large");
    let scene = format!("{}/../../scenes/sphereflake.toml", env!("CARGO_MANIFEST_DIR"));
    let done = f.ok(&["bench", "build", &scene, "--seconds", "0"]);
    let (names, _) = rows(&done, "build ms");
    assert!(!names.contains(&"brute_force".into()) && names.len() == AccelKind::NAMES.len() - 1, "{names:?}");
    let done = f.ok(&["bench", "build", &scene, "--seconds", "0", "--accel", "brute_force"]);
    assert_eq!(rows(&done, "build ms").0, ["brute_force"]);
}

#[test]
fn a_parallel_view_is_measured_too() {
    let f = Folder::with_scene("bench_parallel", &BALL.replace("\"perspective\"", "\"orthographic\""));
    let done = f.ok(&["bench", "rays", "scene.toml", "--side", "8", "--seconds", "0", "--json", "-"]);
    let b: Value = serde_json::from_str(&done.stdout).unwrap();
    let hits = b["structures"][0]["rays"]["primary"]["hits"].as_u64().unwrap();
    assert!((1..64).contains(&hits), "{hits}");
}

#[test]
fn bad_benches_are_told_of() {
    let f = Folder::with_scene("bench_errors", BALL);
    let check = |name: &str, args: &[&str]| said(&f, name, &[&["bench"], args].concat());
    check("bench_unknown_accel", &["rays", "scene.toml", "--accel", "bvh2,bvh88"]);
    check("bench_bad_side", &["rays", "scene.toml", "--side", "500"]);
    check("bench_missing_scene", &["build", "sene.toml"]);
    check("bench_json_no_folder", &["build", "scene.toml", "--json", "no/b.json"]);
}
