//! `--error`, and what it cannot be joined with.

use crate::common::{BALL, Done, EVERYTHING, Folder, bits, header};

const ERROR: [&str; 4] = ["--error", "0.15", "-D", "sampler.min_samples=4"];

fn render_up_to(spp: &str, f: &Folder, args: &[&str]) -> Done {
    f.run(&[&["render", "scene.toml", "--aov", "sample_count", "--spp", spp], &ERROR[..], args].concat())
}

fn render(f: &Folder, args: &[&str]) -> Done {
    render_up_to("128", f, args)
}

#[test]
fn an_adaptive_picture_is_the_same_after_any_stop_and_can_be_given_more() {
    let f = Folder::with_scene("adaptive", EVERYTHING);
    assert_eq!(render(&f, &["-o", "whole.exr", "--stats", "s.json"]).code, Some(0));
    let whole = f.exr("whole.exr");
    let counts = whole.channel("sample_count.N").and_then(|c| c.integers()).unwrap();
    let (least, most) = (*counts.iter().min().unwrap(), *counts.iter().max().unwrap());
    assert!(least < most && most <= 128, "{least} to {most}");
    assert_eq!((whole.text("kirkas.samples"), whole.text("kirkas.error")), (Some("0..128"), Some("0.15")));
    let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(f.path("s.json")).unwrap()).unwrap();
    assert_eq!(stats["adaptive"]["error"], 0.15);
    assert!(stats["adaptive"]["mean_samples"].as_f64().unwrap() < 128.0);

    // Threads and flocks; then pass after pass, each a process of its own.
    assert_eq!(render(&f, &["-o", "other.exr", "--threads", "1", "--flock", "3"]).code, Some(0));
    assert_eq!(bits(&f.exr("other.exr")), bits(&whole));
    let step = |spp: &str, name: &str, args: &[&str]| {
        let done = render_up_to(spp, &f, &[&["-o", name, "--checkpoint", "c.exr", "--resume"], args].concat());
        assert_eq!(done.code, Some(0), "{}", done.stderr);
    };
    for _ in 0..6 {
        step("128", "part.exr", &["--time-limit", "0"]);
    }
    step("100", "less.exr", &[]);
    step("128", "resumed.exr", &[]);
    assert_eq!(bits(&f.exr("resumed.exr")), bits(&whole));
    assert_eq!(header(&f.exr("resumed.exr")), header(&whole));
}

#[test]
fn adaptive_pictures_are_not_cut_nor_added_up() {
    let f = Folder::with_scene("adaptive_parts", EVERYTHING);
    for (args, why) in [
        (&["--crop", "0,0,8,8"][..], "it cannot render a crop"),
        (&["-D", "sampler.type=stratified"], "more can be added"),
    ] {
        let done = render(&f, &[args, &["-o", "x.exr"]].concat());
        assert_eq!(done.code, Some(2), "{}", done.stderr);
        assert!(done.stderr.contains(why), "{}", done.stderr);
    }
    let done = f.run(&["render", "scene.toml", "--error", "0.1", "--samples", "0..8", "-o", "x.exr"]);
    assert!(done.code == Some(2) && done.stderr.contains("all samples so far"), "{}", done.stderr);
    render(&f, &["-o", "a.exr", "--checkpoint", "c.exr"]);
    f.ok(&["render", "scene.toml", "--samples", "128..129", "-o", "b.exr", "--aov", "sample_count"]);
    for parts in [["c.exr", "b.exr"], ["b.exr", "c.exr"]] {
        let done = f.run(&["merge", parts[0], parts[1], "-o", "x.exr"]);
        assert_eq!(done.code, Some(2));
    }
    let done = f.run(&["merge", "c.exr", "c.exr", "-o", "x.exr"]);
    assert!(done.stderr.contains("was sampled adaptively"), "{}", done.stderr);
    f.ok(&["merge", "c.exr", "-o", "developed.png"]);
}

#[test]
fn what_is_not_reached_and_what_is_clamped_is_said_aloud() {
    let f = Folder::with_scene("aloud", EVERYTHING);
    let said = |args: &[&str]| {
        let done = f.ok(&[&["render", "scene.toml", "-o", "a.exr", "--stats", "s.json"], args].concat());
        (done.stderr, std::fs::read_to_string(f.path("s.json")).unwrap(), f.exr("a.exr"))
    };
    let (stderr, stats, _) = said(&["--error", "0.001", "--spp", "8"]);
    assert!(stderr.contains("did not reach the error 0.001 in 8 samples"), "{stderr}");
    assert!(stats.contains("error-not-reached"));
    let (stderr, stats, image) = said(&["-D", "film.clamp=2.5"]);
    assert!(stderr.contains("clamped at 2.5") && stderr.contains("darker than the truth"), "{stderr}");
    assert!(stats.contains("firefly-clamp"));
    assert_eq!(image.text("kirkas.clamp"), Some("2.5"));
    let (stderr, stats, image) = said(&[]);
    assert!(!stderr.contains("clamp") && !stats.contains("firefly-clamp"));
    assert!(image.text("kirkas.clamp").is_none() && image.text("kirkas.error").is_none());
}

#[test]
fn a_quiet_scene_is_done_soon() {
    let f = Folder::with_scene("quiet", &BALL.replace("samples = 4", "error = 5"));
    f.ok(&["render", "scene.toml", "-o", "a.exr", "--aov", "sample_count"]);
    let image = f.exr("a.exr");
    let counts = image.channel("sample_count.N").and_then(|c| c.integers()).unwrap();
    assert!(counts.iter().all(|&n| n == 64), "{counts:?}");
    assert_eq!(image.text("kirkas.samples"), Some("0..65536"));
}
