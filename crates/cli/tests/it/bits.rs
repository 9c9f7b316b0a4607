//! The same bits, however the work is cut.

use crate::common::{BALL, EVERYTHING, Folder, bits, header};

const AOVS: &str = "depth,normals,object_id,variance,sample_count";

#[test]
fn threads_and_flocks_do_not_change_a_bit() {
    let f = Folder::with_scene("threads", EVERYTHING);
    let picture = |args: &[&str]| {
        f.ok(&[&["render", "scene.toml", "-o", "out.exr", "-o", "out.png", "--aov", AOVS], args].concat());
        let image = f.exr("out.exr");
        (bits(&image), header(&image))
    };
    let one = picture(&["--threads", "1"]);
    assert!(one.0["R"].iter().any(|&v| v != one.0["R"][0]), "the picture is of one colour");
    for args in [["--threads", "2"], ["--threads", "7"], ["--flock", "1"], ["--flock", "7"]] {
        let other = picture(&args);
        assert_eq!(one.0, other.0, "{args:?}");
        assert_eq!(one.1, other.1, "{args:?}");
    }
    for accelerator in kirkas_render::catalog().types.iter().filter(|t| t.kind == kirkas_scene::Kind::Accelerator) {
        assert_eq!(one.0, picture(&["--accel", accelerator.name]).0, "{}", accelerator.name);
    }
}

#[test]
fn parts_merge_to_what_is_rendered_at_once() {
    let f = Folder::with_scene("merge", EVERYTHING);
    let render = |args: &[&str]| f.ok(&[&["render", "scene.toml", "--aov", AOVS], args].concat());
    render(&["--samples", "0..3", "-o", "a.exr"]);
    render(&["--samples", "3..5", "-o", "b.exr"]);
    render(&["--samples", "5..8", "-o", "c.exr"]);
    render(&["--samples", "0..8", "-o", "all.exr"]);
    render(&["--spp", "8", "-o", "plain.exr", "-o", "plain.png"]);

    // Any order, in one step or in two, over a gap that is filled later.
    f.ok(&["merge", "c.exr", "a.exr", "-o", "gap.exr"]);
    assert_eq!(f.exr("gap.exr").text("kirkas.samples"), Some("0..3,5..8"));
    f.ok(&["merge", "gap.exr", "b.exr", "-o", "merged.exr"]);
    f.ok(&["merge", "b.exr", "c.exr", "a.exr", "-o", "flat.exr", "-o", "flat.png", "--flat"]);
    for (merged, whole) in [("merged.exr", "all.exr"), ("flat.exr", "plain.exr")] {
        let (m, w) = (f.exr(merged), f.exr(whole));
        assert_eq!(bits(&m), bits(&w), "{merged}");
        assert_eq!(header(&m), header(&w), "{merged}");
        assert_eq!((m.data, m.display), (w.data, w.display));
    }
    assert_eq!(f.ok(&["diff", "flat.png", "plain.png"]).stdout, "rmse 0\n");
    assert!(f.path("flat.depth.png").exists());
}

#[test]
fn a_crop_is_a_piece_of_the_whole() {
    let f = Folder::with_scene("crop", EVERYTHING);
    f.ok(&["render", "scene.toml", "-o", "whole.exr"]);
    f.ok(&["render", "scene.toml", "-o", "crop.exr", "-o", "crop.png", "--crop", "5,7,29,30"]);
    let crop = f.exr("crop.exr");
    assert_eq!((crop.data.x, crop.data.y, crop.data.width, crop.data.height), (5, 7, 24, 23));
    assert_eq!(f.ok(&["diff", "crop.exr", "whole.exr"]).stdout, "rmse 0\n");
}

#[test]
fn the_header_tells_all_that_made_the_picture() {
    let f = Folder::with_scene("header", BALL);
    f.ok(&["render", "scene.toml", "-o", "a.exr", "-o", "a.png", "-D", "integrator.max_depth = 3", "--seed", "7"]);
    let image = f.exr("a.exr");
    let png = kirkas_images::read_png(&std::fs::read(f.path("a.png")).unwrap()).unwrap();
    let check = |name: &str, expected: &str| {
        assert_eq!(image.text(name), Some(expected));
        assert_eq!(png.texts.get(name).map(String::as_str), Some(expected));
    };
    check("kirkas.version", env!("CARGO_PKG_VERSION"));
    check("kirkas.scene", "scene.toml");
    check("kirkas.seed", "7");
    check("kirkas.samples", "0..4");
    check("kirkas.overrides", "integrator.max_depth=3");
    check("kirkas.tone", "linear");
    assert!(image.text("kirkas.argv").unwrap().ends_with("-D 'integrator.max_depth = 3' --seed 7"));
    let files = image.text("kirkas.files").unwrap();
    assert!(files.len() == 64 + 2 + "scene.toml".len() && files.ends_with("  scene.toml"), "{files}");
    assert_eq!(image.text("kirkas.scene_hash").unwrap().len(), 64);
}

#[test]
fn the_scene_hash_changes_with_any_file_read() {
    let f = Folder::with_scene("scene_hash", "include = [\"ball.toml\"]").file("ball.toml", BALL);
    let hash = || {
        f.ok(&["render", "scene.toml", "-o", "a.exr"]);
        f.exr("a.exr").text("kirkas.scene_hash").unwrap().to_string()
    };
    let first = hash();
    assert_eq!(first, hash());
    std::fs::write(f.path("ball.toml"), format!("{BALL}\n# more\n")).unwrap();
    assert_ne!(first, hash());
}
