//! The whole bench on a tiny scene, without Embree: the rows must be there and sound.

use kirkas_bench::options::Options;
use serde_json::Value;

fn rows(file: &std::path::Path) -> Vec<Value> {
    let text = std::fs::read_to_string(file).expect("written");
    serde_json::from_str(&text).expect("an array of rows")
}

#[test]
fn every_set_and_mode_has_a_row_with_our_speed_and_no_embree() {
    let folder = std::env::temp_dir().join(format!("kirkas-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let json = folder.join("kernel.json");
    let line = format!("--quick --scene sphere-200 --side 8 --passes 1 --no-embree --json {}", json.display());
    let options = Options::parse(&line.split(' ').map(str::to_string).collect::<Vec<_>>()).expect("sound");
    kirkas_bench::run(&options).expect("measured");

    let (rays, builds) = (rows(&json), rows(&json.with_extension("builds.json")));
    std::fs::remove_dir_all(&folder).expect("removed");
    // Six sets singly and in a batch, and camera rays in packets.
    assert_eq!(rays.len(), 13 * options.accels.len());
    for row in &rays {
        assert_eq!(row["scene"], "sphere-200");
        assert!(row["rays"].is_string() && row["mode"].is_string() && row["accel"].is_string(), "{row}");
        assert!(row["kirkas_mrays"].as_f64().expect("a number") > 0.0, "{row}");
        for absent in ["embree_mrays", "ratio", "hits_equal"] {
            assert!(row.get(absent).expect("the key is there").is_null(), "{row}");
        }
    }
    assert_eq!(builds.len(), 2 * options.built.len());
    assert!(builds.iter().all(|b| b["mode"] == "build" && b["kirkas_mtris"].as_f64().is_some_and(|m| m > 0.0)));
}
