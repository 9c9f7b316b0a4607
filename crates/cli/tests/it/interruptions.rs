//! Nothing is lost: kill -9, Ctrl-C, time limits, more samples later.

use crate::common::{BALL, EVERYTHING, Folder, bits, header};
use std::io::Read;
use std::process::Child;
use std::time::{Duration, Instant};

const ENDLESS: &str = "1000000";

fn wait_for(f: &Folder, name: &str, child: &mut Child) {
    let begun = Instant::now();
    while !f.path(name).exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended without a checkpoint");
        assert!(begun.elapsed() < Duration::from_secs(60), "no checkpoint came");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn after_kill_9_a_resumed_render_gives_the_same_bits() {
    let f = Folder::with_scene("kill", EVERYTHING);
    let endless = [
        "render",
        "scene.toml",
        "-o",
        "x.exr",
        "--spp",
        ENDLESS,
        "--checkpoint",
        "c.exr",
        "--checkpoint-seconds",
        "0",
        "--resume",
    ];
    for pause in [50, 300] {
        let mut child = f.start(&endless);
        wait_for(&f, "c.exr", &mut child);
        std::thread::sleep(Duration::from_millis(pause));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(!f.path("x.exr").exists());

    // It may have been killed within a pass: go on to more than any pixel has.
    let killed = f.exr("c.exr");
    let most = killed.channel("kirkas.count.taken").and_then(|c| c.integers()).unwrap().iter().max().unwrap() + 5;
    let spp = most.to_string();
    f.ok(&["render", "scene.toml", "--spp", &spp, "-o", "resumed.exr", "--checkpoint", "c.exr", "--resume"]);
    f.ok(&["render", "scene.toml", "--spp", &spp, "-o", "at_once.exr"]);
    let (resumed, at_once) = (f.exr("resumed.exr"), f.exr("at_once.exr"));
    assert_eq!(bits(&resumed), bits(&at_once));
    assert_eq!(header(&resumed), header(&at_once));
}

#[test]
fn more_samples_can_be_added_to_a_finished_checkpoint() {
    let f = Folder::with_scene("more", EVERYTHING);
    let render = |spp: &str, out: &str| {
        let done = f.ok(&["render", "scene.toml", "--spp", spp, "-o", out, "--checkpoint", "c.exr", "--resume"]);
        (f.exr(out), done.stderr)
    };
    assert!(render("4", "four.exr").1.contains("no checkpoint"));
    let (eight, note) = render("8", "eight.exr");
    assert_eq!(note, "");
    f.ok(&["render", "scene.toml", "-o", "at_once.exr"]);
    assert_eq!(bits(&eight), bits(&f.exr("at_once.exr")));
    assert_eq!(header(&eight), header(&f.exr("at_once.exr")));

    // A checkpoint is a part, too.
    f.ok(&["render", "scene.toml", "--samples", "8..9", "-o", "ninth.exr"]);
    f.ok(&["merge", "c.exr", "ninth.exr", "-o", "nine.exr"]);
    assert_eq!(f.exr("nine.exr").text("kirkas.samples"), Some("0..9"));
}

#[test]
fn the_time_limit_ends_after_a_pass_with_a_valid_picture() {
    let f = Folder::with_scene("time_limit", BALL);
    let begun = Instant::now();
    let done = f.ok(&["render", "scene.toml", "--spp", ENDLESS, "--time-limit", "0.5", "-o", "a.exr", "--quiet"]);
    assert!(begun.elapsed() < Duration::from_secs(30));
    assert!(done.stderr.contains("the time limit was reached"), "{}", done.stderr);
    check_stopped_picture(&f);
}

#[test]
fn no_time_at_all_still_gives_one_pass() {
    let f = Folder::with_scene("no_time", BALL);
    f.ok(&["render", "scene.toml", "--time-limit", "0", "-o", "a.exr"]);
    assert_eq!(f.exr("a.exr").text("kirkas.samples"), Some("0..1"));
}

/// The picture is the one that its number of samples gives at once.
fn check_stopped_picture(f: &Folder) {
    let stopped = f.exr("a.exr");
    let samples = stopped.text("kirkas.samples").unwrap().to_string();
    assert_eq!(stopped.text("kirkas.unfinished"), None);
    let spp = samples.strip_prefix("0..").unwrap();
    assert_ne!(spp, "0");
    f.ok(&["render", "scene.toml", "--spp", spp, "-o", "at_once.exr"]);
    assert_eq!(bits(&stopped), bits(&f.exr("at_once.exr")));
}

#[cfg(unix)]
#[test]
fn ctrl_c_finishes_the_pass_and_writes() {
    let f = Folder::with_scene("ctrl_c", BALL);
    let args =
        ["render", "scene.toml", "--spp", ENDLESS, "-o", "a.exr", "--checkpoint", "c.exr", "--checkpoint-seconds", "0"];
    let mut child = f.start(&args);
    wait_for(&f, "c.exr", &mut child);
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let mut stderr = String::new();
    child.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0), "{stderr}");
    assert!(stderr.contains("finishing the running pass"), "{stderr}");
    assert!(stderr.contains("stopped after"), "{stderr}");
    check_stopped_picture(&f);
}

#[test]
fn a_run_leaves_nothing_but_what_was_asked_for() {
    let f = Folder::with_scene("clean", BALL);
    f.ok(&["render", "scene.toml", "-o", "a.png", "--stats", "s.json", "--checkpoint", "c.exr"]);
    assert_eq!(f.names(), ["a.png", "c.exr", "s.json", "scene.toml"]);
    f.ok(&["render", "scene.toml"]);
    assert!(f.path("scene.png").exists());
}
