//! What is wrong in a command: one snapshot for each kind, none of them a panic, nothing overwritten.

use crate::common::{BALL, Folder};
use crate::errors::said;

macro_rules! faulty_renders {
    ($($name:ident: $args:expr;)*) => {$(
        #[test]
        fn $name() {
            let name = stringify!($name);
            let f = Folder::with_scene(&format!("fault_{name}"), BALL);
            said(&f, name, &[&["render", "scene.toml"], $args as &[&str]].concat());
            assert_eq!(f.names(), ["scene.toml"]);
        }
    )*};
}

faulty_renders! {
    override_of_nothing: &["-D", "integrator.max_depth"];
    override_of_unknown: &["-D", "lights.lmap.intensity=2", "-D", "background.colr=2"];
    override_too_short: &["-D", "lights.lamp=2"];
    override_too_deep: &["-D", "lights.lamp.position.7=2"];
    override_syntax: &["-D", "lights.lamp.position=[1, 2"];
    override_wrong_type: &["-D", "lights.lamp.position=here"];
    option_out_of_range: &["--spp", "-3"];
    option_unknown_names: &["--integrator", "whited", "--accel", "bvh3", "--camera", "man", "--tone", "flmic"];
    option_bad_size: &["--size", "640"];
    option_zero_size: &["--size", "0x480"];
    option_bad_samples: &["--samples", "5..5"];
    option_bad_crop: &["--crop", "0,0,99,9"];
    option_empty_crop: &["--crop", "5,5,5,9"];
    option_bad_aov: &["--aov", "normals,dept"];
    option_bad_aov_range: &["--aov", "depth:3"];
    option_bad_threads: &["--threads", "0"];
    option_resume_alone: &["--resume"];
    output_unknown_format: &["-o", "a.jpg"];
    output_twice: &["-o", "a.png", "-o", "a.png"];
    output_no_folder: &["-o", "nowhere/a.png"];
    stats_no_folder: &["--stats", "nowhere/s.json"];
}

#[test]
fn a_scene_that_is_not_there() {
    let f = Folder::with_scene("fault_missing", BALL);
    said(&f, "missing_scene", &["render", "scene.tom"]);
    said(&f, "folder_as_scene", &["check", "."]);
}

#[test]
fn checkpoints_of_other_pictures_are_refused() {
    let f = Folder::with_scene("fault_checkpoint", BALL);
    let with = |more: &[&'static str]| -> Vec<&'static str> {
        [&["render", "scene.toml", "-o", "a.exr", "--checkpoint", "c.exr"], more].concat()
    };
    f.ok(&with(&[]));
    let before = std::fs::read(f.path("c.exr")).unwrap();
    said(&f, "checkpoint_exists", &with(&[]));
    said(&f, "checkpoint_of_fewer_samples", &with(&["--resume", "--spp", "2"]));
    said(
        &f,
        "checkpoint_of_other_options",
        &with(&["--resume", "--seed", "3", "--size", "8x8", "-D", "integrator.max_depth=1"]),
    );
    std::fs::write(f.path("scene.toml"), BALL.replace("20", "21")).unwrap();
    said(&f, "checkpoint_of_changed_scene", &with(&["--resume"]));
    assert_eq!(std::fs::read(f.path("c.exr")).unwrap(), before);
    std::fs::write(f.path("c.exr"), &before[..before.len() / 2]).unwrap();
    said(&f, "checkpoint_cut_off", &with(&["--resume"]));
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let f = Folder::with_scene("fault_merge", BALL);
    f.ok(&["render", "scene.toml", "--samples", "0..2", "-o", "a.exr"]);
    f.ok(&["render", "scene.toml", "--samples", "1..3", "-o", "overlap.exr"]);
    f.ok(&["render", "scene.toml", "--samples", "2..4", "--seed", "1", "-o", "seed.exr"]);
    f.ok(&["render", "scene.toml", "--samples", "2..4", "--crop", "0,0,9,9", "-o", "crop.exr"]);
    f.ok(&["render", "scene.toml", "-o", "whole.exr", "-o", "whole.png"]);
    said(&f, "merge_overlap", &["merge", "a.exr", "overlap.exr", "-o", "m.exr"]);
    said(&f, "merge_other_seed", &["merge", "a.exr", "seed.exr", "-o", "m.exr"]);
    said(&f, "merge_other_crop", &["merge", "a.exr", "crop.exr", "-o", "m.exr"]);
    said(&f, "merge_without_integers", &["merge", "a.exr", "whole.exr", "-o", "m.exr"]);
    said(&f, "merge_png", &["merge", "whole.png", "-o", "m.exr"]);
    said(&f, "merge_missing", &["merge", "b.exr", "-o", "m.exr"]);
    assert!(!f.path("m.exr").exists());
}

#[test]
fn pictures_that_cannot_be_compared() {
    let f = Folder::with_scene("fault_diff", BALL);
    f.ok(&["render", "scene.toml", "-o", "a.png"]);
    f.ok(&["render", "scene.toml", "-o", "b.png", "--size", "8x8"]);
    said(&f, "diff_sizes", &["diff", "a.png", "b.png"]);
    said(&f, "diff_missing", &["diff", "a.png", "c.png"]);
    said(&f, "diff_no_picture", &["diff", "a.png", "scene.toml"]);
    said(&f, "diff_metric", &["diff", "a.png", "b.png", "--metric", "psnr"]);
}

#[test]
fn what_cannot_be_converted() {
    let scene = BALL.replace("type = \"sphere\"", "type = \"mesh\"\nfile = \"t.obj\"");
    let f =
        Folder::new("fault_convert").file("in/scene.toml", scene).file("out/.keep", "").file("in/t.obj", "v 0 0 0\n");
    // Its cure names a folder of this machine, so it is no snapshot.
    let run = f.run(&["convert", "in/scene.toml", "out/scene.toml"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("`t.obj` would lie outside the folder of the new scene"), "{}", run.stderr);
    said(&f, "convert_to_unknown_format", &["convert", "in/scene.toml", "out/scene.xml"]);
    said(&f, "convert_bad_scene", &["convert", "in/scene.toml", "in/b.toml", "-D", "objects.ball.material=rad"]);
}
