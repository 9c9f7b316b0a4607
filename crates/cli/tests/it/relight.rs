//! `kirkas relight`: other lamps without a ray.

use crate::common::{EVERYTHING, Folder, bits};
use kirkas_images::Image;

fn rgb(image: &Image) -> Vec<[f32; 3]> {
    image.rgb().unwrap().pixels
}

#[test]
fn a_relit_picture_is_one_rendered_with_other_lamps() {
    let f = Folder::with_scene("relight", EVERYTHING);
    let render = |args: &[&str]| f.ok(&[&["render", "scene.toml", "--integrator", "whitted"], args].concat());
    render(&["--samples", "0..8", "-o", "integers.exr", "--aov", "depth,variance"]);
    render(&["-o", "floats.exr", "--aov", "depth,variance"]);
    // The point and the panel are both named `lamp`, and so one group.
    render(&["-D", "lights.lamp.intensity=20", "-D", "materials.shine.intensity=10", "-o", "anew.exr"]);
    let anew = f.exr("anew.exr");
    for (input, tolerance) in [("integers.exr", 0.0), ("floats.exr", 1.2e-7)] {
        f.ok(&["relight", input, "lamp=2", "-o", "relit.exr"]);
        let relit = f.exr("relit.exr");
        for (a, b) in rgb(&relit).iter().flatten().zip(rgb(&anew).iter().flatten()) {
            assert!((a - b).abs() <= tolerance * b.abs(), "{input}: {a} {b}");
        }
        assert_eq!(bits(&relit)["group.lamp.R"], bits(&anew)["group.lamp.R"], "{input}");
        assert_eq!(relit.text("kirkas.relight"), Some("lamp=2"));
        assert!(relit.channel("depth.Z").is_some() && relit.channel("variance.R").is_none());
        assert!(relit.channel("kirkas.count.taken").is_none());
    }
}

#[test]
fn factors_of_one_change_nothing_and_colours_multiply() {
    let f = Folder::with_scene("relight_colours", EVERYTHING);
    f.ok(&["render", "scene.toml", "--samples", "0..8", "-o", "in.exr"]);
    let original = f.exr("in.exr");
    f.ok(&["relight", "in.exr", "background=1", "-o", "same.exr", "-o", "same.png"]);
    let same = f.exr("same.exr");
    let kept = bits(&original).into_iter().filter(|(name, _)| !name.starts_with("kirkas."));
    assert_eq!(bits(&same), kept.collect());
    f.ok(&["render", "scene.toml", "-o", "rendered.png"]);
    assert_eq!(f.ok(&["diff", "same.png", "rendered.png"]).stdout, "rmse 0\n");

    f.ok(&["relight", "in.exr", "background=0.5,#ff0000", "lamp=0", "-o", "red.exr", "-o", "red.hdr"]);
    let red = f.exr("red.exr");
    let sky = |image: &Image| image.channel("group.background.R").and_then(|c| c.floats()).unwrap().to_vec();
    for (i, pixel) in rgb(&red).iter().enumerate() {
        assert_eq!((pixel[1], pixel[2]), (0.0, 0.0));
        assert!((pixel[0] - 0.5 * sky(&original)[i]).abs() <= 1e-6 * pixel[0]);
    }
    // What was relit can be relit.
    f.ok(&["relight", "red.exr", "background=2", "-o", "again.exr"]);
    assert_eq!(sky(&f.exr("again.exr")), sky(&red).iter().map(|v| 2.0 * v).collect::<Vec<_>>());
    assert_eq!(f.exr("again.exr").text("kirkas.relight"), Some("background=0.5,#ff0000 lamp=0\nbackground=2"));
}

#[test]
fn what_cannot_be_relit_is_said() {
    let f = Folder::with_scene("relight_errors", EVERYTHING).file("note.exr", "no picture");
    f.ok(&["render", "scene.toml", "-o", "in.exr", "-o", "in.png"]);
    f.ok(&["render", "scene.toml", "-o", "plain.exr", "-D", "film.light_groups=false"]);
    for (args, why) in [
        (&["in.exr", "lmap=2"][..], "did you mean `lamp`?"),
        (&["in.exr", "lamp"], "does not say what the light is multiplied by"),
        (&["in.exr", "lamp=-1"], "does not say what"),
        (&["in.exr", "lamp=1", "lamp=2"], "given twice"),
        (&["plain.exr", "lamp=2"], "--light-groups"),
        (&["in.png", "lamp=2"], "no other keeps light groups"),
        (&["note.exr", "lamp=2"], "no other keeps light groups"),
        (&["none.exr", "lamp=2"], "there is no file"),
    ] {
        let done = f.run(&[&["relight"], args, &["-o", "out.exr"]].concat());
        assert_eq!(done.code, Some(2), "{args:?}");
        assert!(done.stderr.contains(why), "{args:?}\n{}", done.stderr);
        assert!(!f.path("out.exr").exists());
    }
    let done = f.run(&["relight", "in.exr", "lamp=2", "-o", "in.exr"]);
    assert!(done.code == Some(2) && done.stderr.contains("would lose"), "{}", done.stderr);
}
