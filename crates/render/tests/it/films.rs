//! Films: each frame a picture of its own, whichever came before.

use crate::support::{expose, prepared_with};
use kirkas_accel::AccelKind;
use kirkas_render::{Film, Options, Prepared};

/// A camera that flies through a moving ball of glass, past a mirror that turns in a moving group, above a lamp that moves.
const MOVING: &str = r#"
[film]
width = 12
height = 9
frames_per_second = 10
light_groups = true

[cameras.main]
type = "thin_lens"
position = [0, 0.5, 4]
aperture_radius = 0.1
focus_distance = 4
shutter = [0.25, 0.3]
motion = [{ time = 0, transform = [] }, { time = 1, transform = [{ translate = [0, 0, -4] }] }]

[materials.glass]
type = "dielectric"

[materials.mirror]
type = "mirror"

[materials.shine]
type = "emitter"
intensity = 4

[objects.floor]
type = "plane"
point = [0, -1, 0]

[objects.ball]
type = "sphere"
center = [0, 0.5, 2.6]
radius = 0.8
material = "glass"
motion = [{ time = 0, transform = [] }, { time = 1, transform = [{ translate = [0.3, 0, 0] }] }]

[objects.turning]
type = "group"
motion = [{ time = 0, transform = [] }, { time = 1, transform = [{ rotate = [0, 1, 0, 90] }] }]

[objects.mirror]
type = "box"
parent = "turning"
material = "mirror"
min = [-1, -0.9, -1]
max = [-0.2, 0.4, -0.5]
motion = [{ time = 0, transform = [] }, { time = 1, transform = [{ translate = [0, 0.4, 0] }] }]

[objects.lamp]
type = "rectangle"
material = "shine"
center = [0, 3, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
motion = [{ time = 0, transform = [] }, { time = 1, transform = [{ translate = [0, -1, 0] }] }]
"#;

fn at_frame(toml: &str, frame: Option<u32>) -> Prepared {
    prepared_with(toml, &[], &Options { frame, ..Options::default() })
}

fn picture(p: &Prepared) -> Film {
    expose(p, 0..3).0
}

#[test]
fn a_frame_is_the_same_alone_and_after_others() {
    let mut film = at_frame(MOVING, Some(9));
    let mut before: Option<Film> = None;
    for frame in [0, 4, 5, 2] {
        film = film.at_frame(frame).expect("it can be built");
        assert_eq!(film.frame, Some(frame));
        let (shown, alone) = (picture(&film), picture(&at_frame(MOVING, Some(frame))));
        assert_eq!(shown, alone, "frame {frame}");
        assert!(before.is_none_or(|b| b != shown), "frame {frame} is no other picture");
        before = Some(shown);
    }
}

#[test]
fn the_camera_is_within_the_bodies_around_it_at_each_frame() {
    let bodies = |frame| at_frame(MOVING, Some(0)).at_frame(frame).expect("it can be built").scene.camera_media;
    assert!(bodies(0).materials().is_empty());
    assert_eq!(bodies(4).materials().len(), 1);
    assert!(bodies(9).materials().is_empty());
}

/// Without lens, lamps of any size or an open shutter nothing is left to chance.
const SHARP: &str = r#"
[film]
width = 12
height = 9
filter = "point"

[cameras.main]
type = "perspective"
shutter = [SHUTTER]

[lights.lamp]
type = "point"
position = [2, 3, 4]

[objects.ball]
type = "sphere"
motion = [{ time = 0, transform = [{ translate = [-2, 0, 0] }] }, { time = 1, transform = [{ translate = [2, 0, 0] }] }]
"#;

#[test]
fn frame_n_shows_the_moment_n_over_the_frames_per_second() {
    let scene = |open: &str| SHARP.replace("SHUTTER", &format!("{open}, {open}"));
    let moment = |open: &str| picture(&at_frame(&scene(open), None));
    // Whenever the camera itself would open it.
    assert_eq!(picture(&at_frame(&scene("7"), Some(6))), moment("0.25"));
    assert_eq!(picture(&at_frame(&scene("7"), Some(18))), moment("0.75"));
    let slow = scene("7").replace("[film]", "[film]\nframes_per_second = 2.5");
    assert_eq!(picture(&at_frame(&slow, Some(1))), moment("0.4"));
    assert_ne!(moment("0.4"), moment("0.25"));
}

#[test]
fn the_shutter_stays_open_as_long_in_every_frame() {
    let shutter = |frame| at_frame(MOVING, Some(3)).at_frame(frame).expect("it can be built").scene.camera.shutter();
    let long = 0.3 - 0.25;
    for frame in [0, 3, 700] {
        let open = f64::from(frame) / 10.0;
        assert_eq!(shutter(frame), (open, open + long));
    }
}

/// Where nothing moves: a lamp with soft shadows.
fn still() -> String {
    MOVING.lines().filter(|l| !l.starts_with("motion")).map(|l| format!("{l}\n")).collect()
}

#[test]
fn where_nothing_moves_nothing_is_built_anew() {
    let place = |p: &Prepared| p.scene.accel.scene_geometry().world.as_ptr();
    for (scene, is_still) in [(still(), true), (MOVING.to_string(), false)] {
        let first = at_frame(&scene, Some(0));
        let before = place(&first);
        assert_eq!(place(&first.at_frame(1).expect("it can be built")) == before, is_still);
    }
}

#[test]
fn frames_of_what_moves_are_built_quickly_unless_the_scene_names_a_structure() {
    let kind = |toml: &str, frame| at_frame(toml, frame).scene.accel.kind();
    assert_eq!(kind(MOVING, Some(0)), AccelKind::Bvh8Fast);
    assert_eq!(kind(MOVING, None), AccelKind::Bvh8);
    assert_eq!(kind(&still(), Some(0)), AccelKind::Bvh8);
    for name in ["bvh8", "kd_tree"] {
        let named = format!("{MOVING}\n[accelerator]\ntype = \"{name}\"\n");
        assert_eq!(kind(&named, Some(0)).name(), name);
    }
}

#[test]
fn frames_of_a_still_scene_differ_in_their_noise_alone() {
    let scene = still();
    let (a, b) = (at_frame(&scene, Some(0)), at_frame(&scene, Some(1)));
    assert_ne!(picture(&a), picture(&b));
    assert_ne!(picture(&a), picture(&at_frame(&scene, None)));
    let sharp = SHARP.replace("SHUTTER", "0, 0").replace("motion", "# motion");
    assert_eq!(picture(&at_frame(&sharp, Some(0))), picture(&at_frame(&sharp, Some(1))));
}

#[test]
fn a_film_of_moments_warns_of_no_closed_shutter() {
    let scene = SHARP.replace("SHUTTER", "0, 0");
    assert_eq!(at_frame(&scene, None).warnings.len(), 1);
    assert!(at_frame(&scene, Some(0)).warnings.is_empty());
}
