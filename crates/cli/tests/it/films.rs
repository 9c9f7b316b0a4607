//! `render --frames`: numbered files, the same bits alone and in a film, resumed, stopped.

use crate::common::{BALL, EVERYTHING, Folder, bits, header};
use crate::errors::said;
use kirkas_images::Attribute;
use serde_json::Value;
use std::collections::BTreeMap;

type Frame = (BTreeMap<String, Vec<u32>>, BTreeMap<String, Attribute>);

/// A frame, but for the command that was typed.
fn frame(f: &Folder, name: &str) -> Frame {
    let image = f.exr(name);
    (bits(&image), header(&image))
}

/// Make a file look as if it had been written long ago.
fn make_old(f: &Folder, name: &str) {
    std::fs::File::options().write(true).open(f.path(name)).unwrap().set_modified(std::time::UNIX_EPOCH).unwrap();
}

fn is_old(f: &Folder, name: &str) -> bool {
    std::fs::metadata(f.path(name)).unwrap().modified().unwrap() == std::time::UNIX_EPOCH
}

#[test]
fn a_frame_alone_is_the_frame_in_a_film() {
    let f = Folder::with_scene("film", EVERYTHING);
    let film = |args: &[&str]| f.ok(&[&["render", "scene.toml", "--spp", "2", "--size", "20x18"], args].concat());
    film(&["--frames", "0..4", "-o", "film.exr"]);
    film(&["--frames", "2..4", "-o", "some.##.exr", "--threads", "1"]);
    assert_eq!(
        f.names(),
        [
            "film.0000.exr",
            "film.0001.exr",
            "film.0002.exr",
            "film.0003.exr",
            "scene.toml",
            "some.02.exr",
            "some.03.exr"
        ]
    );
    assert_eq!(frame(&f, "film.0002.exr"), frame(&f, "some.02.exr"));
    assert_eq!(frame(&f, "film.0003.exr"), frame(&f, "some.03.exr"));
    assert_ne!(bits(&f.exr("film.0002.exr")), bits(&f.exr("film.0003.exr")));
    assert_eq!(f.exr("film.0003.exr").text("kirkas.frame"), Some("3"));
}

#[test]
fn the_lectures_windmill_turns_before_both_cameras() {
    let f = Folder::new("film_windmill");
    let scene = format!("{}/../../scenes/lecture/motion_blur.toml", env!("CARGO_MANIFEST_DIR"));
    for camera in ["main", "panning"] {
        let film = |more: &[&str]| {
            f.ok(&[&["render", &scene, "--camera", camera, "--size", "32x24", "--spp", "2"], more].concat());
        };
        film(&["--frames", "5..7", "-o", "film.exr"]);
        film(&["--frames", "6..7", "-o", "alone.exr"]);
        assert_eq!(frame(&f, "film.0006.exr"), frame(&f, "alone.0006.exr"));
        assert_ne!(bits(&f.exr("film.0005.exr")), bits(&f.exr("film.0006.exr")));
    }
}

#[test]
fn parts_of_one_frame_merge_and_of_two_frames_do_not() {
    let f = Folder::with_scene("film_parts", EVERYTHING);
    let film = |args: &[&str]| f.ok(&[&["render", "scene.toml", "--size", "20x18"], args].concat());
    film(&["--frames", "3..4", "-o", "whole.exr", "--spp", "2"]);
    film(&["--frames", "3..4", "--samples", "0..1", "-o", "a.exr"]);
    film(&["--frames", "3..5", "--samples", "1..2", "-o", "b.exr"]);
    f.ok(&["merge", "a.0003.exr", "b.0003.exr", "--flat", "-o", "merged.exr"]);
    assert_eq!(bits(&f.exr("merged.exr")), bits(&f.exr("whole.0003.exr")));
    said(&f, "merge_other_frame", &["merge", "a.0003.exr", "b.0004.exr", "-o", "wrong.exr"]);
}

#[test]
fn every_file_of_a_frame_is_numbered() {
    let f = Folder::with_scene("film_names", BALL);
    f.ok(&[
        "render",
        "scene.toml",
        "--frames",
        "9..11",
        "-o",
        "a.#.png",
        "-o",
        "b.hdr",
        "--aov",
        "depth",
        "--stats",
        "s.json",
        "--checkpoint",
        "c#.exr",
    ]);
    let names = f.names();
    for n in ["09", "10"] {
        let all = [format!("a.{n}.png"), format!("a.{n}.depth.png"), format!("b.00{n}.hdr")];
        for name in all.into_iter().chain([format!("b.00{n}.depth.png"), format!("s.00{n}.json"), format!("c{n}.exr")])
        {
            assert!(names.contains(&name), "{name} of {names:?}");
        }
    }
    assert_eq!(names.len(), 2 * 6 + 1);
    let stats = |name: &str| -> Value { serde_json::from_slice(&std::fs::read(f.path(name)).unwrap()).unwrap() };
    assert_eq!((&stats("s.0009.json")["frame"], &stats("s.0010.json")["frame"]), (&Value::from(9), &Value::from(10)));
    assert!(stats("s.0009.json")["seconds"]["load"].as_f64().unwrap() > 0.0);
    assert_eq!(stats("s.0010.json")["seconds"]["load"], 0.0);
    f.ok(&["render", "scene.toml", "--stats", "still.json"]);
    assert_eq!(stats("still.json")["frame"], Value::Null);
    f.ok(&["render", "scene.toml", "--frames", "0..1"]);
    assert!(f.path("scene.0000.png").exists());
}

#[test]
fn a_resumed_film_renders_what_is_not_there_or_not_the_same() {
    let f = Folder::with_scene("film_resumed", BALL);
    let args =
        ["render", "scene.toml", "--frames", "0..4", "-o", "a.exr", "-o", "a.png", "-o", "a.hdr", "--aov", "depth"];
    let film = |more: &[&str]| f.ok(&[&args, more].concat()).stderr;
    assert_eq!(film(&["--resume"]), "");
    let all: Vec<String> = f.names().into_iter().filter(|n| n.starts_with('a')).collect();
    let changed = |more: &[&str]| {
        all.iter().for_each(|n| make_old(&f, n));
        let said = film(&[&["--resume"], more].concat());
        (all.iter().filter(|n| !is_old(&f, n)).map(|n| n[2..6].to_string()).collect::<Vec<_>>(), said)
    };
    let none = |n: usize| format!("kirkas: {n} of 4 frames were finished already\n");
    assert_eq!(changed(&[]), (vec![], none(4)));

    // Missing, cut off, of another scene: each is made anew, with all its files.
    let frame_2 = bits(&f.exr("a.0002.exr"));
    for spoil in ["a.0002.exr", "a.0002.hdr", "a.0002.png", "a.0002.depth.png"] {
        let bytes = std::fs::read(f.path(spoil)).unwrap();
        std::fs::write(f.path(spoil), &bytes[..bytes.len() - 9]).unwrap();
        let (new, said) = changed(&[]);
        assert_eq!((new, said), (vec!["0002".to_string(); 4], none(3)), "{spoil}");
    }
    assert_eq!(bits(&f.exr("a.0002.exr")), frame_2);
    std::fs::remove_file(f.path("a.0000.png")).unwrap();
    make_old(&f, "a.0000.exr");
    film(&["--resume"]);
    assert!(f.path("a.0000.png").exists() && !is_old(&f, "a.0000.exr"));
    f.ok(&["render", "scene.toml", "--time", "0.1", "-o", "a.0001.exr"]);
    assert_eq!(changed(&[]).0, vec!["0001"; 4]);
    for more in [
        ["--spp", "5"],
        ["--seed", "3"],
        ["--crop", "0,0,5,5"],
        ["--exposure", "1"],
        ["-D", "film.frames_per_second=25"],
    ] {
        assert_eq!(changed(&more), (all.iter().map(|n| n[2..6].into()).collect(), String::new()), "{more:?}");
        assert_eq!(changed(&more).1, none(4), "{more:?}");
    }
}

#[test]
fn a_frame_goes_on_from_its_own_checkpoint() {
    let f = Folder::with_scene("film_checkpoints", EVERYTHING);
    let film = |frames: &str, spp: &str, out: &str, more: &[&str]| {
        let args = ["render", "scene.toml", "--size", "20x18", "--frames", frames, "--spp", spp, "-o", out];
        f.ok(&[&args, more].concat())
    };
    film("1..3", "2", "two.exr", &["--checkpoint", "c.exr"]);
    film("1..4", "5", "five.exr", &["--checkpoint", "c.exr", "--resume"]);
    film("1..4", "5", "at_once.exr", &[]);
    for n in 1..4 {
        assert_eq!(frame(&f, &format!("five.000{n}.exr")), frame(&f, &format!("at_once.000{n}.exr")), "frame {n}");
    }
    // The checkpoint of another frame is refused.
    std::fs::copy(f.path("c.0002.exr"), f.path("c.0007.exr")).unwrap();
    said(
        &f,
        "checkpoint_of_other_frame",
        &[
            "render",
            "scene.toml",
            "--size",
            "20x18",
            "--frames",
            "7..8",
            "--checkpoint",
            "c.exr",
            "--resume",
            "-o",
            "x.exr",
        ],
    );
}

#[test]
fn the_time_limit_ends_a_film_and_resuming_finishes_it() {
    let f = Folder::with_scene("film_time_limit", BALL);
    let film =
        |more: &[&str]| f.ok(&[&["render", "scene.toml", "--frames", "0..3", "-o", "a.exr"], more].concat()).stderr;
    let said = film(&["--time-limit", "0"]);
    assert_eq!(said, "kirkas: the time limit was reached after 1 of 4 samples per pixel of frame 0\n");
    assert_eq!(f.names(), ["a.0000.exr", "scene.toml"]);
    assert_eq!(f.exr("a.0000.exr").text("kirkas.samples"), Some("0..1"));
    let said = film(&["--time-limit", "0", "--spp", "1", "--resume"]);
    assert!(said.contains("the time limit was reached before frame 2"), "{said}");
    assert!(said.contains("1 of 3 frames were finished already"), "{said}");
    film(&["--resume"]);
    f.ok(&["render", "scene.toml", "--frames", "0..3", "-o", "b.exr"]);
    for n in 0..3 {
        assert_eq!(frame(&f, &format!("a.000{n}.exr")), frame(&f, &format!("b.000{n}.exr")));
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_film_and_keeps_its_frames() {
    let f = Folder::with_scene("film_ctrl_c", BALL);
    let child = f.start(&["render", "scene.toml", "--frames", "0..9000", "-o", "a.exr"]);
    let begun = std::time::Instant::now();
    while !f.path("a.0001.exr").exists() && begun.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let out = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(out.stderr).unwrap();
    assert_eq!(out.status.code(), Some(0), "{stderr}");
    assert!(stderr.contains("kirkas: stopped"), "{stderr}");
    let names = f.names();
    assert!(names.iter().all(|n| n.ends_with(".exr") || n == "scene.toml"), "{names:?}");
    // All but the last are whole.
    let frames = names.len() - 1;
    for n in 0..frames - 1 {
        assert_eq!(f.exr(&format!("a.{n:04}.exr")).text("kirkas.samples"), Some("0..4"));
    }
}

#[test]
fn the_frame_rate_is_told_and_time_is_another_thing() {
    let f = Folder::with_scene("film_rate", EVERYTHING);
    f.ok(&["render", "scene.toml", "--spp", "1", "--frames", "5..6", "-o", "a.exr", "-D", "film.frames_per_second=10"]);
    let header = f.exr("a.0005.exr").attributes;
    assert_eq!(header["kirkas.overrides"], Attribute::Text("film.frames_per_second=10".into()));
    f.ok(&["render", "scene.toml", "--spp", "1", "--time", "0.5", "-o", "b.exr"]);
    assert!(f.exr("b.exr").text("kirkas.frame").is_none());
}

#[test]
fn a_closed_shutter_is_suspicious_only_where_no_moment_is_asked_for() {
    let f = Folder::with_scene("film_shutter", EVERYTHING);
    let said = |args: &[&str]| {
        let closed = ["render", "scene.toml", "--spp", "1", "-o", "a.png", "-D", "cameras.main.shutter=[0, 0]"];
        f.ok(&[&closed, args].concat()).stderr
    };
    assert!(said(&[]).contains("no-shutter"));
    assert_eq!(said(&["--time", "0.5"]), "");
    assert_eq!(said(&["--frames", "2..3"]), "");
}

#[test]
fn bad_frames_are_told_of() {
    let f = Folder::with_scene("film_errors", BALL);
    let textured = BALL.replace("reflectance = [0.8, 0.2, 0.1]", "reflectance = \"t\"")
        + "[textures.t]\ntype = \"image\"\nfile = \"wood.0003.png\"\n";
    let f = f.file("textured.toml", textured);
    f.ok(&["render", "scene.toml", "-o", "wood.0003.png"]);
    let check = |name: &str, args: &[&str]| said(&f, name, &[&["render"], args].concat());
    check("frames_and_time", &["scene.toml", "--frames", "0..3", "--time", "1"]);
    check("frames_empty", &["scene.toml", "--frames", "3..3"]);
    check("frames_word", &["scene.toml", "--frames", "all"]);
    check("frames_endless", &["scene.toml", "--frames", "0..2000000"]);
    check("frames_rate", &["scene.toml", "--frames", "0..2", "-D", "film.frames_per_second=0"]);
    check("frames_same_file", &["scene.toml", "--frames", "0..2", "-o", "a.png", "-o", "a.####.png"]);
    check("frames_over_texture", &["textured.toml", "--frames", "0..9", "-o", "wood.png"]);
    f.ok(&["render", "scene.toml", "--frames", "5..6", "--checkpoint", "c.exr"]);
    check("frames_checkpoint_exists", &["scene.toml", "--frames", "3..9", "--checkpoint", "c.exr"]);
}
