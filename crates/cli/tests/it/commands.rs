//! The other commands, exit codes and data on stdout.

use crate::common::{BALL, EVERYTHING, Folder, bits};
use std::process::Stdio;

#[test]
fn stats_are_one_json_object_with_the_promised_keys() {
    let f = Folder::with_scene("stats", EVERYTHING);
    f.ok(&["render", "scene.toml", "-o", "a.png", "--stats", "s.json", "--threads", "2"]);
    let s: serde_json::Value = serde_json::from_slice(&std::fs::read(f.path("s.json")).unwrap()).unwrap();
    assert_eq!(s["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!((s["seed"].as_i64(), s["spp"].as_i64()), (Some(0), Some(8)));
    assert_eq!(s["size"], serde_json::json!([40, 36]));
    assert_eq!(s["scene_hash"].as_str().unwrap().len(), 64);
    assert_eq!(s["argv"][1], "render");
    assert_eq!(s["nan_samples"], 0);
    assert!(s["warnings"].is_array());
    for key in ["load", "build", "render", "total"] {
        assert!(s["seconds"][key].as_f64().unwrap() >= 0.0, "{key}");
    }
    let rays = |key: &str| s["rays"][key].as_u64().unwrap();
    assert_eq!(rays("camera"), 40 * 36 * 8);
    for key in ["reflected", "refracted", "glossy", "shadow"] {
        assert!(rays(key) > 0, "{key}");
    }
    assert_eq!(rays("total"), ["camera", "reflected", "refracted", "glossy", "shadow"].map(rays).iter().sum::<u64>());
    assert!(s["rays_per_second"].as_f64().unwrap() > 0.0);
    assert!(s["peak_rss_bytes"].is_null() || s["peak_rss_bytes"].as_u64().unwrap() > 1 << 20);
    let cost = |key: &str| s["cost"][key].as_f64().unwrap();
    assert_eq!((cost("time_rays_per_pixel"), cost("aperture_rays_per_pixel")), (8.0, 8.0));
    assert!(cost("ray_tree_size") > 1.0 && cost("shadow_rays_per_pixel") > 1.0 && cost("glossy_rays_per_pixel") > 0.0);
    assert!(cost("primitives_tested_per_ray") > 0.0 && cost("nodes_visited_per_ray") >= 0.0);
    let product: f64 = s["cost"]["factors"].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).product();
    assert!((product / cost("product_seconds") - 1.0).abs() < 1e-6);
    assert!((product / cost("render_seconds") - 1.0).abs() < 1e-6);
}

#[test]
fn diff_says_one_number_and_exits_3_over_max() {
    let f = Folder::with_scene("diff", BALL);
    f.ok(&["render", "scene.toml", "-o", "a.exr", "-o", "a.png", "-o", "a.hdr"]);
    f.ok(&["render", "scene.toml", "-o", "b.exr", "-o", "b.png", "--seed", "1"]);
    f.ok(&["render", "scene.toml", "-o", "small.png", "--size", "8x8"]);
    for metric in ["mae", "mse", "rmse", "mrse", "flip"] {
        assert_eq!(f.ok(&["diff", "a.exr", "a.exr", "--metric", metric, "--max", "0"]).stdout, format!("{metric} 0\n"));
        let done = f.ok(&["diff", "a.png", "b.png", "--metric", metric]);
        let value: f64 = done.stdout.trim().strip_prefix(&format!("{metric} ")).unwrap().parse().unwrap();
        assert!(value > 0.0 && done.stdout.lines().count() == 1);
        let over = f.run(&["diff", "a.png", "b.png", "--metric", metric, "--max", "1e-9", "-o", "heat.png"]);
        assert_eq!(over.code, Some(3));
        assert!(f.path("heat.png").exists());
    }
    assert_eq!(f.run(&["diff", "a.exr", "a.hdr", "--max", "0.05"]).code, Some(0));
    assert_eq!(f.run(&["diff", "a.png", "small.png"]).code, Some(2));
    assert!(f.ok(&["diff", "a.png", "b.png", "--verbose"]).stdout.contains("pixels within 3/255: "));
}

#[test]
fn check_counts_and_is_strict_when_asked() {
    let f = Folder::with_scene("check", BALL).file("odd.toml", BALL.to_string() + ODD_LAMP);
    let done = f.ok(&["check", "scene.toml", "--strict"]);
    assert!(done.stdout.starts_with("scene.toml: no errors, no warnings\n"), "{}", done.stdout);
    assert!(done.stdout.contains("objects                1\n"), "{}", done.stdout);
    assert_eq!(done.stderr, "");
    let odd = f.ok(&["check", "odd.toml"]);
    assert!(
        odd.stdout.starts_with("odd.toml: no errors, 1 warning\n") && odd.stderr.contains("lights nothing"),
        "{}",
        odd.stderr
    );
    assert_eq!(f.run(&["check", "odd.toml", "--strict"]).code, Some(2));
    let bad = f.run(&["check", "scene.toml", "-D", "objects.ball.material=rad"]);
    assert_eq!(bad.code, Some(2));
    assert!(bad.stdout.starts_with("scene.toml: 1 error, no warnings\n"), "{}", bad.stdout);
}

/// A shape that cannot be sampled as a light.
const ODD_LAMP: &str = "
[materials.shine]
type = \"emitter\"
[objects.sheet]
type = \"plane\"
material = \"shine\"
";

const TETRAHEDRON: &str = "v 0 1 0\nv 1 -1 0\nv -1 -1 0\nv 0 -1 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";

#[test]
fn convert_writes_a_scene_of_the_same_picture() {
    let scene = BALL.replace("type = \"sphere\"", "type = \"mesh\"\nfile = \"meshes/t.obj\"");
    let f = Folder::new("convert").file("in/scene.toml", &scene).file("in/meshes/t.obj", TETRAHEDRON);
    f.ok(&["render", "in/scene.toml", "-o", "a.exr", "-D", "film.width=20"]);
    f.ok(&["convert", "in/scene.toml", "out.toml", "-D", "film.width=20"]);
    let text = std::fs::read_to_string(f.path("out.toml")).unwrap();
    assert!(text.contains("file = \"in/meshes/t.obj\""), "{text}");
    f.ok(&["render", "out.toml", "-o", "b.exr"]);
    assert_eq!(bits(&f.exr("a.exr")), bits(&f.exr("b.exr")));

    // Twice is once.
    f.ok(&["convert", "out.toml", "again.toml"]);
    assert_eq!(std::fs::read_to_string(f.path("again.toml")).unwrap(), text);
}

#[test]
fn a_bare_mesh_and_a_course_scene_render_and_convert() {
    let course = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }\n\
        Lights { numLights 1 DirectionalLight { direction 0 0 -1 color 0.5 0.5 0.5 } }\n\
        Background { color 0.2 0 0.6 ambientLight 0 0 0 }\n\
        Materials { numMaterials 1 PhongMaterial { diffuseColor 1 1 1 } }\n\
        Group { numObjects 1 MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }\n";
    let f = Folder::new("formats").file("t.obj", TETRAHEDRON).file("course.txt", course);
    for scene in ["t.obj", "course.txt"] {
        f.ok(&["render", scene, "-o", "a.exr", "-o", "a.png", "--size", "40x30", "--spp", "1"]);
        f.ok(&["convert", scene, "converted.toml"]);
        f.ok(&["render", "converted.toml", "-o", "b.exr", "--size", "40x30", "--spp", "1"]);
        assert_eq!(bits(&f.exr("a.exr")), bits(&f.exr("b.exr")), "{scene}");
    }
    // The course's pictures are plain numbers: 0.2 * 255 = 51.
    let corner = kirkas_images::read_png(&std::fs::read(f.path("a.png")).unwrap()).unwrap().raw()[0];
    assert_eq!(corner, [51.0 / 255.0, 0.0, 153.0 / 255.0, 1.0]);
}

#[test]
fn schema_and_completions_go_to_stdout() {
    let f = Folder::new("schema");
    let schema: serde_json::Value = serde_json::from_str(&f.ok(&["schema"]).stdout).unwrap();
    assert!(schema["properties"]["materials"].is_object());
    f.ok(&["schema", "-o", "s.json"]);
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&std::fs::read(f.path("s.json")).unwrap()).unwrap(), schema);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(f.ok(&["completions", shell]).stdout.contains("kirkas"), "{shell}");
    }
}

#[test]
fn a_closed_pipe_is_no_problem() {
    let f = Folder::with_scene("pipe", BALL);
    for args in [&["schema"][..], &["completions", "bash"], &["check", "scene.toml"], &["--help"]] {
        let mut child = f.command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let done = child.wait_with_output().unwrap();
        assert_eq!((done.status.code(), String::from_utf8_lossy(&done.stderr).as_ref()), (Some(0), ""), "{args:?}");
    }
}

#[test]
fn every_command_has_help_with_an_example() {
    let f = Folder::new("help");
    for command in ["render", "check", "convert", "diff", "merge", "schema", "completions"] {
        let help = f.ok(&[command, "--help"]).stdout;
        assert!(help.contains("Example") && help.contains(&format!("  kirkas {command} ")), "{help}");
    }
    assert_eq!(f.run(&[]).code, Some(2));
    assert_eq!(f.run(&["explain"]).code, Some(2));
    assert_eq!(f.run(&["render", "x.toml", "--frames", "0..3"]).code, Some(2));
}

#[test]
fn quiet_is_quiet_and_progress_is_for_terminals() {
    let f = Folder::with_scene("quiet", &(BALL.to_string() + ODD_LAMP));
    assert_eq!(f.ok(&["render", "scene.toml", "-o", "a.png", "--quiet"]).stderr, "");
    let loud = f.ok(&["render", "scene.toml", "-o", "a.png"]);
    assert_eq!(loud.stdout, "");
    assert!(loud.stderr.contains("lights nothing") && !loud.stderr.contains('%'), "{}", loud.stderr);
}
