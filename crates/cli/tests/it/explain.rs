//! `kirkas explain`: a picture says itself how its pixels came about.

use crate::common::{EVERYTHING, Folder};
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn a_picture_is_explained_exactly_as_it_was_made() {
    let f = Folder::with_scene("explain", EVERYTHING);
    let exact = "The picture holds exactly this pixel.";
    for (name, options) in [
        ("whitted.exr", &["--integrator", "whitted", "--spp", "4"][..]),
        ("path.exr", &["--integrator", "path", "--spp", "5", "--seed", "9", "-D", "integrator.max_depth=3"]),
        ("spectral.exr", &["--color", "spectral", "--integrator", "path", "--spp", "3", "--light-groups"]),
        ("integers.exr", &["--samples", "2..6", "--size", "33x21"]),
        ("kd.exr", &["--accel", "kd_tree", "--spp", "2", "--camera", "main"]),
    ] {
        f.ok(&[&["render", "scene.toml", "-o", name], options].concat());
        let told = f.ok(&["explain", name, "--pixel", "11,9"]).stdout;
        assert!(told.ends_with(&format!("{exact}\n")), "{name}: {told}");
        assert!(told.contains("pixel 11,9") && told.contains("camera -> "), "{told}");
        let e = json(&f.ok(&["explain", name, "--pixel", "11,9", "-o", "-"]).stdout);
        assert_eq!(e["pixel"], serde_json::json!([11, 9]));
        let sums: Vec<i128> = (0..3).map(|c| e["sums"][c].as_str().unwrap().parse().unwrap()).collect();
        let of_trees = |c: usize| -> i128 {
            let trees = e["trees"].as_array().unwrap();
            trees.iter().map(|t| t["sums"][c].as_str().unwrap().parse::<i128>().unwrap()).sum()
        };
        assert_eq!(sums, (0..3).map(of_trees).collect::<Vec<_>>());
    }
    // Of a picture, a part of its samples.
    assert!(f.ok(&["explain", "path.exr", "--pixel", "11,9", "--sample", "4"]).stdout.contains("not all samples"));
    // A PNG knows its scene too, but its light only coarsely.
    f.ok(&["render", "scene.toml", "-o", "a.png", "--spp", "2"]);
    assert!(f.ok(&["explain", "a.png", "--pixel", "1,1"]).stdout.contains("was not compared"));
    // The page.
    f.ok(&["explain", "path.exr", "--pixel", "11,9", "-o", "pixel.html"]);
    let html = std::fs::read_to_string(f.path("pixel.html")).unwrap();
    assert!(html.starts_with("<!doctype html>") && html.contains("data:image/png;base64,") && html.len() < 5_000_000);
    // The pixels most worth it.
    let worst = f.ok(&["explain", "path.exr", "--worst", "2"]).stdout;
    assert_eq!(worst.lines().filter(|l| l.starts_with("pixel ")).count(), 2, "{worst}");
    assert!(f.ok(&["explain", "scene.toml", "--spp", "2", "--worst", "1", "--quiet"]).stdout.contains("noise of"));
}

#[test]
fn what_cannot_be_explained_is_said() {
    let f = Folder::with_scene("explain_errors", EVERYTHING);
    f.ok(&["render", "scene.toml", "-o", "a.exr", "--spp", "2"]);
    let says = |args: &[&str], what: &str| {
        let run = f.run(args);
        assert_eq!(run.code, Some(2), "{args:?}: {}", run.stderr);
        assert!(run.stderr.contains(what), "{args:?}: {}", run.stderr);
    };
    says(&["explain", "a.exr", "--pixel", "4000,1"], "there is no pixel 4000,1");
    says(&["explain", "a.exr", "--pixel", "1"], "write X,Y");
    says(&["explain", "a.exr"], "--pixel");
    says(&["explain", "a.exr", "--pixel", "1,1", "--sample", "2"], "samples 2..3 were not taken");
    says(&["explain", "a.exr", "--pixel", "1,1", "-D", "film.width=3"], "a picture says itself");
    says(&["explain", "a.exr", "--pixel", "1,1", "-o", "a.txt"], "no extension of an explanation");
    says(&["explain", "missing.exr", "--pixel", "1,1"], "there is no file");
    // The scene is another one now.
    let changed = std::fs::read_to_string(f.path("scene.toml")).unwrap() + "\n# changed\n";
    std::fs::write(f.path("scene.toml"), changed).unwrap();
    says(&["explain", "a.exr", "--pixel", "1,1"], "`scene.toml`");
    says(&["explain", "a.exr", "--pixel", "1,1"], "is not the one of");
}
