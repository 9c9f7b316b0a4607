//! Scenes as inline TOML, pictures as numbers.

use kirkas_formats::{FormatAssets, load};
use kirkas_render::film::fixed;
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, Prepared, Statistics, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_scene::{Kind, Name};
use kirkas_testkit::{Measured, z_test};
use std::ops::Range;

/// A colour, or any three numbers, in double precision.
pub type Rgb = [f64; 3];

/// A closed box of 4 x 3 x 4 with a lamp in it.
pub const ROOM: &str = "
[materials.wall]
type = \"lambert\"
reflectance = [0.7, 0.5, 0.3]
[objects.room]
type = \"box\"
min = [-2, 0, -2]
max = [2, 3, 2]
material = \"wall\"
[materials.lamp]
type = \"emitter\"
radiance = 6
[objects.lamp]
type = \"rectangle\"
center = [0, 2.9, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = \"lamp\"
";

/// Compile a scene that stands in `toml`, with other files beside it.
pub fn prepared_with(toml: &str, files: &[(&str, &[u8])], options: &Options) -> Prepared {
    let mut all = MemoryFiles::default();
    all.0.insert("scene.toml".into(), toml.as_bytes().to_vec());
    for (name, bytes) in files {
        all.0.insert((*name).into(), bytes.to_vec());
    }
    let access = FileAccess::new(Box::new(all), Limits::default());
    let mut description = load(&access, "scene.toml").unwrap_or_else(|e| panic!("{e:?}\n{toml}"));
    // Most tests are about single rays: they speak of `whitted` unless they name another integrator.
    let integrator = description.single_mut(Kind::Integrator);
    if !integrator.type_name.span.is_some() {
        integrator.type_name = Name::new("whitted");
    }
    let assets = FormatAssets::new(&access, &description.sources);
    prepare(&description, &assets, options).unwrap_or_else(|e| panic!("{e:#?}\n{toml}"))
}

/// Compile a scene that needs no other file.
pub fn prepared(toml: &str) -> Prepared {
    prepared_with(toml, &[], &Options::default())
}

/// Take `samples` of every pixel.
pub fn expose(p: &Prepared, samples: Range<u32>) -> (Film, Statistics) {
    let mut film = Film::new(p.film.clone());
    let statistics = p.renderer(64).render(&mut film, samples, &Undisturbed);
    assert_eq!(film.invalid_samples(), 0, "samples that are no numbers");
    (film, statistics)
}

/// The whole picture.
pub fn render(toml: &str) -> Film {
    let p = prepared(toml);
    expose(&p, 0..p.samples).0
}

/// The mean of a pixel, in double precision.
pub fn pixel(film: &Film, x: u32, y: u32) -> Rgb {
    let (_, _, tile, i) = film.pixels().find(|p| (p.0, p.1) == (x, y)).expect("a pixel of the film");
    let planes = film.layout.planes();
    let n = f64::from(tile.counts[i].taken - tile.counts[i].invalid);
    std::array::from_fn(|c| fixed::to_f64((0..planes).map(|p| tile.sums[i * planes + p][c]).sum()) / n)
}

/// All pixels, row by row.
pub fn pixels(film: &Film) -> Vec<Rgb> {
    let c = film.layout.crop;
    (c.y0..c.y1).flat_map(|y| (c.x0..c.x1).map(move |x| (x, y))).map(|(x, y)| pixel(film, x, y)).collect()
}

/// `body` with a camera of one pixel at `from`, whose every ray runs exactly towards `to`.
pub fn one_pixel(body: &str, from: Rgb, to: Rgb, samples: u32) -> String {
    format!(
        "{body}\n[film]\nwidth = 1\nheight = 1\nfilter = \"point\"\ntexture_footprint = 0\n[sampler]\nsamples = {samples}\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = {from:?}\nlook_at = {to:?}\nfov = 10\n"
    )
}

/// The radiance that arrives at `from` out of the direction of `to`.
pub fn seen(body: &str, from: Rgb, to: Rgb, samples: u32) -> Rgb {
    pixel(&render(&one_pixel(body, from, to, samples)), 0, 0)
}

/// The same for grey scenes: red, which must be the others too.
pub fn grey(body: &str, from: Rgb, to: Rgb, samples: u32) -> f64 {
    let [r, g, b] = seen(body, from, to, samples);
    assert!(r == g && g == b, "not grey: {r} {g} {b}");
    r
}

/// `value` is `truth` but for a share of `tolerance`.
#[track_caller]
pub fn assert_near(value: f64, truth: f64, tolerance: f64) {
    assert!((value - truth).abs() <= tolerance * truth.abs().max(1e-12), "{value} is not {truth}");
}

/// Means and variances of the means of all pixels' channels, for a Z-test.
pub fn noisy(film: &Film) -> (Vec<f64>, Vec<f64>) {
    let variances = film.pixels().flat_map(|(_, _, tile, i)| tile.variance_of_mean(i)).map(f64::from).collect();
    (film.pixels().flat_map(|(x, y, _, _)| pixel(film, x, y)).collect(), variances)
}

/// The expectations of two films are the same, as far as their noise lets one see: pixel by pixel, and all together.
#[track_caller]
pub fn assert_agree(what: &str, a: &Film, b: &Film) {
    let ((mean_a, variance_a), (mean_b, variance_b)) = (noisy(a), noisy(b));
    let found = z_test(
        Measured { mean: &mean_a, variance: &variance_a },
        Measured { mean: &mean_b, variance: &variance_b },
        1e-3,
        1e-4,
    );
    // The channels of a pixel share their noise: green stands for all.
    let green = |v: &[f64]| v.iter().skip(1).step_by(3).sum::<f64>();
    let (sum_a, sum_b) = (green(&mean_a), green(&mean_b));
    let z = (sum_a - sum_b) / ((green(&variance_a) + green(&variance_b)).sqrt() + 1e-4 * sum_a);
    println!("{what}: sums {sum_a:.5} and {sum_b:.5}, z {z:.2}, least p {:.1e}", found.p_value);
    assert!(found.passed, "{what}: {found:?}, {} and {}", mean_a[found.worst], mean_b[found.worst]);
    assert!(z.abs() < 4.0, "{what}: all together {sum_a} and {sum_b}, z {z}");
}

/// The one pixel of a picture is `truth` but for its noise, which is at most a share of `precision`.
#[track_caller]
pub fn assert_shows(film: &Film, truth: f64, precision: f64) {
    let (mean, variance) = noisy(film);
    let error = variance[1].sqrt();
    println!("{} +- {error:.1e} for {truth}", mean[1]);
    assert!(error <= precision * truth, "too noisy: {} +- {error} for {truth}", mean[1]);
    assert!((mean[1] - truth).abs() <= 4.0 * error + 1e-5 * truth, "{} +- {error} is not {truth}", mean[1]);
}
