//! The whole bench on tiny scenes: the rows must be there and sound.

use kirkas_bench::embree::Embree;
use kirkas_bench::options::Options;
use serde_json::Value;
use std::path::Path;

/// Run with the options of `line`; gives the rows of rays or growth, and those of builds.
fn run(name: &str, line: &str) -> (Options, Vec<Value>, Vec<Value>) {
    let folder = std::env::temp_dir().join(format!("kirkas-bench-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let json = folder.join("kernel.json");
    let line = format!("--quick --side 8 --passes 1 {line} --json {}", json.display());
    let options = Options::parse(&line.split(' ').map(str::to_string).collect::<Vec<_>>()).expect("sound");
    kirkas_bench::run(&options).expect("measured");
    let (rays, builds) = (rows(&json), rows(&json.with_extension("builds.json")));
    std::fs::remove_dir_all(&folder).expect("removed");
    (options, rays, builds)
}

fn rows(file: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|_| "[]".into());
    serde_json::from_str(&text).expect("an array of rows")
}

#[test]
fn every_set_and_mode_has_a_row_with_our_speed_and_no_embree() {
    let (options, rays, builds) = run("rows", "--scene sphere-200 --no-embree");
    // Six sets singly and in a batch, and camera rays in packets.
    assert_eq!(rays.len(), 13 * options.accels.len());
    for row in &rays {
        assert_eq!(row["scene"], "sphere-200");
        assert!(row["rays"].is_string() && row["mode"].is_string() && row["accel"].is_string(), "{row}");
        assert!(row["kirkas_mrays"].as_f64().is_some_and(|m| m > 0.0), "{row}");
        for absent in ["embree_mrays", "ratio", "hits_equal"] {
            assert!(row.get(absent).expect("the key is there").is_null(), "{row}");
        }
    }
    assert_eq!(builds.len(), 2 * options.built.len());
    assert!(builds.iter().all(|b| b["mode"] == "build" && b["kirkas_mtris"].as_f64().is_some_and(|m| m > 0.0)));
}

#[test]
fn hits_agree_with_embree_where_it_is_installed() {
    if let Err(why) = Embree::load() {
        println!("skipped: hits_agree_with_embree_where_it_is_installed ({why})");
        return;
    }
    let (_, rays, builds) = run("embree", "--scene sphere-2k --side 64");
    for row in &rays {
        assert_eq!(row["hits_equal"], true, "{row}");
        assert!(row["ratio"].as_f64().is_some_and(|r| r > 0.0), "{row}");
    }
    assert!(builds.iter().all(|b| b["embree_bytes_per_triangle"].as_f64().is_some_and(|b| b > 8.0)), "{builds:?}");
}

#[test]
fn growth_has_a_row_for_every_size() {
    let (options, rows, _) = run("growth", "--sizes 1e2..1e3 --set diff1 --no-embree");
    // Singly and in a batch, for two sizes.
    assert_eq!(rows.len(), 2 * 2 * options.accels.len());
    let is_sound = |r: &Value| r["triangles"].as_u64() > Some(90) && r["build_ns_per_n_log_n"].as_f64() > Some(0.0);
    assert!(rows.iter().all(is_sound), "{rows:?}");
}
