//! Textures are filtered over what a sample stands for: no aliasing far away, in mirrors and through glass, and nothing lost nearby.

use crate::support::{expose, pixels, prepared_with};
use kirkas_images::{Texts, write_png8};
use kirkas_render::{Film, Options};

const WIDTH: u32 = 128;
const HEIGHT: u32 = 64;

/// A floor to the horizon, seen at one sample per pixel through the pixel's centre unless told otherwise; evenly lit.
fn floor(texture: &str, more: &str, film: &str, samples: u32) -> Film {
    exposed(&scene(texture, more, film, samples), samples)
}

fn scene(texture: &str, more: &str, film: &str, samples: u32) -> String {
    format!(
        "[film]\nwidth = {WIDTH}\nheight = {HEIGHT}\n{film}\n[sampler]\nsamples = {samples}\n\
         [integrator]\ntype = \"path\"\nmax_depth = 4\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0.3, 1, 0]\nlook_at = [0.9, 0.55, -2]\nfov = 40\n\
         {texture}\n[materials.tiles]\ntype = \"emitter\"\nradiance = \"tiles\"\ntwo_sided = true\n\
         [objects.floor]\ntype = \"plane\"\nmaterial = \"tiles\"\n{more}\n"
    )
}

fn exposed(toml: &str, samples: u32) -> Film {
    // Two by two texels, so that only smaller copies can show their mean.
    let picture = write_png8(2, 2, &[255, 0, 0, 255], &Texts::new()).expect("a sound picture");
    let p = prepared_with(toml, &[("tiles.png", &picture)], &Options::default());
    expose(&p, 0..samples).0
}

const CHECKER: &str = "[textures.tiles]\ntype = \"checker\"\nscale = 2";
const PICTURE: &str = "[textures.tiles]\ntype = \"image\"\nfile = \"tiles.png\"\nencoding = \"linear\"";
const POINTS: &str = "filter = \"point\"";

fn grey(film: &Film) -> Vec<f64> {
    pixels(film).iter().map(|p| p[1]).collect()
}

/// The part of the rows' spectral power that lies in the upper half of the frequencies that pixels can show, for the rows of the far
/// field, where the true picture has next to none. Also their error: the mean square of what differs from `truth`.
fn far_field(picture: &[f64], truth: &[f64], rows: std::ops::Range<u32>) -> (f64, f64) {
    let n = WIDTH as usize;
    let (mut high, mut error, mut count) = (0.0, 0.0, 0.0);
    for y in rows {
        let row = &picture[y as usize * n..][..n];
        let mean = row.iter().sum::<f64>() / n as f64;
        for k in n / 4..=n / 2 {
            let (mut re, mut im) = (0.0, 0.0);
            for (x, value) in row.iter().enumerate() {
                let angle = std::f64::consts::TAU * (k * x) as f64 / n as f64;
                // A window, so that the ends of the row do not show.
                let window = 0.5 - 0.5 * (std::f64::consts::TAU * (x as f64 + 0.5) / n as f64).cos();
                re += (value - mean) * window * angle.cos();
                im += (value - mean) * window * angle.sin();
            }
            high += (re * re + im * im) / (n * n) as f64;
        }
        let truth = &truth[y as usize * n..][..n];
        error += row.iter().zip(truth).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        count += n as f64;
    }
    (high / count * n as f64, error / count)
}

/// Rows between the horizon and where squares are about two pixels wide.
fn far_rows(truth: &[f64]) -> std::ops::Range<u32> {
    let n = WIDTH as usize;
    let first = (0..HEIGHT).find(|&y| truth[y as usize * n..][..n].iter().all(|&v| v > 0.2)).expect("a floor") + 1;
    first..first + 8
}

#[test]
fn a_checker_floor_to_the_horizon_shows_no_aliasing_at_one_sample() {
    // Power above half the pixels' frequency, and error: at most with filter, at least without.
    let cases = [("checker", CHECKER, (1e-4, 0.01), (5e-3, 0.1)), ("picture", PICTURE, (5e-5, 2e-3), (5e-4, 0.01))];
    for (name, texture, most, least) in cases {
        let truth = grey(&floor(texture, "", "filter = \"box\"\ntexture_footprint = 0", 1024));
        let rows = far_rows(&truth);
        let filtered = far_field(&grey(&floor(texture, "", POINTS, 1)), &truth, rows.clone());
        let bare = format!("{POINTS}\ntexture_footprint = 0");
        let aliased = far_field(&grey(&floor(texture, "", &bare, 1)), &truth, rows.clone());
        println!("{name}: rows {rows:?}, filtered {filtered:?}, unfiltered {aliased:?}");
        assert!(filtered.0 < most.0 && filtered.1 < most.1, "{name} aliases: {filtered:?}");
        assert!(aliased.0 > least.0 && aliased.1 > least.1, "{name}: the measure sees no aliasing: {aliased:?}");
    }
}

#[test]
fn a_floor_in_a_flat_mirror_is_as_sharp_as_the_mirrored_camera_sees_it() {
    let ceiling = "[materials.mirror]\ntype = \"mirror\"\n[objects.ceiling]\ntype = \"plane\"\npoint = [0, 2, 0]\nnormal = [0, -1, 0]\nmaterial = \"mirror\"";
    let up = |t: &str| t.replace("look_at = [0.9, 0.55, -2]", "look_at = [0.9, 1.6, -2]");
    let straight = |t: &str| {
        t.replace(
            "position = [0.3, 1, 0]\nlook_at = [0.9, 0.55, -2]",
            "position = [0.3, 3, 0]\nlook_at = [0.9, 2.4, -2]",
        )
    };
    let (mirrored, direct) = (floor_with(up, ceiling), floor_with(straight, ""));
    let (n, mut compared) = (WIDTH as usize, 0);
    // Below, the camera sees past the horizon.
    for y in 0..HEIGHT as usize / 2 {
        // The mirror turns the picture upside down.
        let (a, b) = (&mirrored[y * n..][..n], &direct[(HEIGHT as usize - 1 - y) * n..][..n]);
        for (a, b) in a.iter().zip(b) {
            if *a > 0.0 {
                assert!((a - b).abs() < 0.01, "row {y}: {a} {b}");
                compared += usize::from(*a > 0.01 && *a < 0.99);
            }
        }
    }
    assert!(compared > 1000, "only {compared} pixels show an edge");
}

/// One sample per pixel of a checker floor, the scene's text being changed by `change`.
fn floor_with(change: impl Fn(&str) -> String, more: &str) -> Vec<f64> {
    grey(&exposed(&change(&scene(CHECKER, more, POINTS, 1)), 1))
}

#[test]
fn a_floor_through_glass_and_in_a_ball_shows_no_aliasing() {
    let pane = "[materials.glass]\ntype = \"dielectric\"\nreflectance = 0\n[objects.pane]\ntype = \"box\"\nmin = [-9, -9, -0.6]\nmax = [9, 9, -0.5]\nmaterial = \"glass\"";
    let ball = "[materials.mirror]\ntype = \"mirror\"\n[objects.ball]\ntype = \"sphere\"\ncenter = [1.2, 1, -4]\nradius = 1\nmaterial = \"mirror\"";
    for (name, more) in [("glass", pane), ("ball", ball)] {
        let far = |film: &str, samples| grey(&floor(CHECKER, more, film, samples));
        let truth = far("filter = \"box\"\ntexture_footprint = 0", 1024);
        let error = |picture: &[f64]| {
            picture.iter().zip(&truth).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / truth.len() as f64
        };
        let (filtered, bare) = (error(&far(POINTS, 1)), error(&far(&format!("{POINTS}\ntexture_footprint = 0"), 1)));
        println!("{name}: error {filtered} filtered, {bare} not");
        assert!(filtered < 0.3 * bare, "{name}: {filtered} {bare}");
    }
}

#[test]
fn nearby_a_filtered_texture_is_what_it_is_without_filter() {
    // Texels and squares many pixels wide: away from edges nothing changes.
    let near = |t: &str| {
        t.replace(
            "position = [0.3, 1, 0]\nlook_at = [0.9, 0.55, -2]",
            "position = [0.3, 0.4, 0]\nlook_at = [0.4, 0, -0.1]",
        )
    };
    let sharp = |t: &str| near(t).replace(POINTS, "filter = \"point\"\ntexture_footprint = 0");
    let (filtered, bare) = (floor_with(near, ""), floor_with(sharp, ""));
    let same = filtered.iter().zip(&bare).filter(|(a, b)| a == b).count();
    assert!(same * 10 > filtered.len() * 8, "{same} of {}", filtered.len());
}
