//! Distributed effects by number: motion blur, depth of field, antialiasing.

use crate::support::{assert_near, expose, pixels, prepared, render};
use std::f64::consts::PI;

/// A row of pixels from x = -2 to x = 2 in the plane z = 0, looked at along -z, each pixel through its middle.
fn row(camera: &str, things: &str) -> Vec<f64> {
    let toml = format!(
        "{things}\n[film]\nwidth = 40\nheight = 1\nfilter = \"point\"\n[sampler]\nsamples = 1024\n
         [cameras.c]\ntype = \"orthographic\"\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nheight = 0.1\n{camera}\n
         [materials.lamp]\ntype = \"emitter\"\n"
    );
    pixels(&render(&toml)).iter().map(|p| p[1]).collect()
}

/// The middle of pixel `i`.
fn x_of(i: usize) -> f64 {
    (i as f64 + 0.5) * 0.1 - 2.0
}

#[track_caller]
fn assert_row(values: &[f64], truth: impl Fn(f64) -> f64) {
    for (i, &v) in values.iter().enumerate() {
        let t = truth(x_of(i));
        assert!((v - t).abs() < 0.004, "at {}: {v} is not {t}", x_of(i));
    }
}

const SQUARE: &str = "[objects.o]\ntype = \"rectangle\"\nmaterial = \"lamp\"\n";

/// The share of times 0..1 at which a unit square, moving from `a` to `b`, is at `x`.
fn covered(x: f64, a: f64, b: f64) -> f64 {
    let (t0, t1) = ((x - 0.5 - a) / (b - a), (x + 0.5 - a) / (b - a));
    (t0.max(t1).clamp(0.0, 1.0) - t0.min(t1).clamp(0.0, 1.0)).max(0.0)
}

#[test]
fn a_moving_square_covers_each_pixel_for_its_share_of_the_time() {
    let motion = "motion = [{ time = 0, transform = [{ translate = [-1, 0, 0] }] }, { time = 1, transform = [{ translate = [1, 0, 0] }] }]\n";
    let moving = format!("{SQUARE}{motion}");
    assert_row(&row("shutter = [0, 1]", &moving), |x| covered(x, -1.0, 1.0));
    // A shorter shutter sees a part of the way; none, a moment.
    assert_row(&row("shutter = [0.5, 0.75]", &moving), |x| covered(x, 0.0, 0.5));
    assert_row(&row("shutter = [0.25, 0.25]", &moving), |x| f64::from((x + 0.5).abs() < 0.5));
    assert_row(&row("", &moving), |x| f64::from((x + 1.0).abs() < 0.5));
    // The same within a moving group, through an instance, and by a camera that moves the other way.
    let group = format!("[objects.g]\ntype = \"group\"\n{motion}{SQUARE}parent = \"g\"\n");
    assert_row(&row("shutter = [0, 1]", &group), |x| covered(x, -1.0, 1.0));
    let instance = format!(
        "[objects.g]\ntype = \"group\"\ntemplate = true\n{SQUARE}parent = \"g\"\n[objects.i]\ntype = \"instance\"\nof = \"g\"\n{motion}"
    );
    assert_row(&row("shutter = [0, 1]", &instance), |x| covered(x, -1.0, 1.0));
    let camera = "shutter = [0, 1]\nmotion = [{ time = 0, transform = [{ translate = [1, 0, 0] }] }, { time = 1, transform = [{ translate = [-1, 0, 0] }] }]";
    assert_row(&row(camera, SQUARE), |x| covered(x, -1.0, 1.0));
    // Motion within motion adds.
    let half = motion.replace("[-1, 0, 0]", "[-0.5, 0, 0]").replace("[1, 0, 0]", "[0.5, 0, 0]");
    let nested = format!("[objects.g]\ntype = \"group\"\n{half}{SQUARE}parent = \"g\"\n{half}");
    assert_row(&row("shutter = [0, 1]", &nested), |x| covered(x, -1.0, 1.0));
}

#[test]
fn a_growing_disk_covers_each_pixel_from_when_it_reaches_it() {
    let disk = "[objects.o]\ntype = \"disk\"\nnormal = [0, 0, 1]\nmaterial = \"lamp\"\n
                motion = [{ time = 0, transform = [{ scale = 0.5 }] }, { time = 1, transform = [{ scale = 1.5 }] }]\n";
    assert_row(&row("shutter = [0, 1]", disk), |x| (1.5 - x.abs()).clamp(0.0, 1.0));
}

/// A thin bar turns by 90 degrees about its end: it passes each pixel of the row once, the nearer ones for longer.
#[test]
fn a_turning_bar_covers_each_pixel_for_its_share_of_the_turn() {
    let bar = "[objects.o]\ntype = \"rectangle\"\ncenter = [1.5, 0, 0]\nedge_u = [3, 0, 0]\nedge_v = [0, 0.2, 0]\nmaterial = \"lamp\"\n
               motion = [{ time = 0, transform = [{ rotate = [0, 0, 1, -45] }] }, { time = 1, transform = [{ rotate = [0, 0, 1, 45] }] }]\n";
    let truth = |x: f64| {
        // Seen at distance x while the angle is below asin(0.1 / x).
        if x < 0.0 { 0.0 } else { (0.1 / x).min(1.0).asin().min(PI / 4.0) / (PI / 4.0) }
    };
    let values = row("shutter = [0, 1]", bar);
    for (i, v) in values.iter().enumerate().filter(|(i, _)| x_of(*i) > 0.15 || x_of(*i) < -0.11) {
        let t = truth(x_of(i));
        assert!((v - t).abs() < 0.01, "at {}: {v} is not {t}", x_of(i));
    }
}

/// What moves casts a moving shadow: the time of the camera ray is the time of its shadow rays.
#[test]
fn the_shadow_of_a_moving_square_is_as_soft_as_its_motion() {
    let scene = "[lights.l]\ntype = \"directional\"\ndirection = [0, 0, -1]\n[materials.white]\ntype = \"lambert\"\nreflectance = 1
        [objects.floor]\ntype = \"rectangle\"\ncenter = [0, 0, -1]\nedge_u = [9, 0, 0]\nedge_v = [0, 9, 0]\nmaterial = \"white\"
        [objects.o]\ntype = \"rectangle\"\nvisible = false\ncenter = [0, 0, 1]
        motion = [{ time = 0, transform = [{ translate = [-1, 0, 0] }] }, { time = 1, transform = [{ translate = [1, 0, 0] }] }]\n";
    assert_row(&row("shutter = [0, 1]", scene), |x| 1.0 - covered(x, -1.0, 1.0));
}

/// The area, in the plane of focus at distance 2, of the image of a small lamp at `distance`: where it is at least half as
/// bright as in its middle.
fn blurred(lens: &str, distance: f64) -> f64 {
    let lens = if lens.contains("aperture") { lens.to_string() } else { format!("aperture_radius = 0.05\n{lens}") };
    const SIDE: u32 = 60;
    let toml = format!(
        "[film]\nwidth = {SIDE}\nheight = {SIDE}\nfilter = \"box\"\n[sampler]\nsamples = 512\n
         [cameras.c]\ntype = \"thin_lens\"\nposition = [0, 0, 0]\nlook_at = [0, 0, -2]\nfov = 5\n{lens}\n
         [materials.lamp]\ntype = \"emitter\"\n[objects.o]\ntype = \"sphere\"\ncenter = [0, 0, {:?}]\nradius = {:?}\nmaterial = \"lamp\"\n",
        -distance,
        LAMP * distance / 2.0
    );
    let values: Vec<f64> = pixels(&render(&toml)).iter().map(|p| p[1]).collect();
    let middle = |k: usize| -> f64 { values[k * 60 + 28..k * 60 + 32].iter().sum() };
    let half = 0.5 * (28..32).map(middle).sum::<f64>() / 16.0;
    let unit = 2.0 * 2.0 * 2.5_f64.to_radians().tan() / f64::from(SIDE);
    values.iter().filter(|v| **v > half).count() as f64 * unit * unit
}

/// Radius of the lamp as it would be seen sharp in the plane of focus.
const LAMP: f64 = 0.005;

fn diameter(area: f64) -> f64 {
    2.0 * (area / PI).sqrt()
}

/// c = A |s - f| / s in the plane of focus.
#[test]
fn the_circle_of_confusion_is_the_thin_lenss() {
    for distance in [4.0, 8.0, 1.2] {
        let truth = 0.1 * (distance - 2.0_f64).abs() / distance;
        assert_near(diameter(blurred("", distance)), truth, 0.06);
    }
    // Twice the lens, twice the circle.
    assert_near(diameter(blurred("aperture_radius = 0.1", 4.0)) / 2.0, diameter(blurred("", 4.0)), 0.06);
    // Sharp in the plane of focus.
    assert_near(diameter(blurred("", 2.0)), 2.0 * LAMP, 0.2);
    assert_near(diameter(blurred("focus_distance = 4", 4.0)), 2.0 * LAMP, 0.2);
    assert_near(diameter(blurred("focus_distance = 4", 2.0)), 0.1 * 2.0 / 4.0, 0.06);
}

/// An aperture's corners lie on the circle of the lens: a square has 2 / pi of its area.
#[test]
fn an_aperture_of_blades_draws_its_shape() {
    assert_near(blurred("blades = 4", 4.0), 0.5 * 0.05 * 0.05, 0.08);
    assert_near(blurred("blades = 6\nblade_rotation = 20", 4.0), 1.5 * 3.0_f64.sqrt() * 0.025 * 0.025, 0.08);
}

/// An edge through the middle of a pixel row: each filter gives the share of its weight on the bright side.
#[test]
fn filters_share_an_edge_between_pixels() {
    let scene = |filter: &str| {
        let toml = format!(
            "[film]\nwidth = 9\nheight = 1\nfilter = \"{filter}\"\n[sampler]\nsamples = 4096\n[cameras.c]\ntype = \"orthographic\"\nposition = [0, 0, 5]\nheight = 1\n
             [materials.lamp]\ntype = \"emitter\"\n[objects.o]\ntype = \"rectangle\"\ncenter = [50, 0, 0]\nedge_u = [100, 0, 0]\nedge_v = [0, 100, 0]\nmaterial = \"lamp\"\n"
        );
        let p = prepared(&toml);
        let (film, s) = expose(&p, 0..p.samples);
        assert_eq!(s.samples, 9 * 4096);
        pixels(&film).iter().map(|p| p[1]).collect::<Vec<_>>()
    };
    for filter in ["point", "box", "tent", "gaussian", "mitchell", "blackman_harris"] {
        let v = scene(filter);
        assert!((v[4] - 0.5).abs() < 0.01 || filter == "point", "{filter}: {}", v[4]);
        // The sign of a negative rim is drawn, too, so there white is white on average only.
        assert!(
            v[0].abs() < 1e-9 && (v[8] - 1.0).abs() < if filter == "mitchell" { 0.01 } else { 1e-9 },
            "{filter}: {}",
            v[8]
        );
        for k in 0..9 {
            assert!((v[k] + v[8 - k] - 1.0).abs() < 0.01 || filter == "point", "{filter}");
        }
    }
    let tent = scene("tent");
    // The integral of 1 - |x| from 1 to infinity is 0: a tent's pixel beside the edge is whole.
    assert_eq!((tent[3], tent[5]), (0.0, 1.0));
    assert!(scene("mitchell")[5] > 1.01, "its negative rim overshoots");
}
