//! Adaptive sampling: it reaches its target, its decisions are the image's alone, and its bias is known.

use crate::support::{pixels, prepared, prepared_with, render};
use kirkas_render::film::adaptive::{BLOCK, ErrorTarget};
use kirkas_render::film::part::{read_part, write_part};
use kirkas_render::film::{Film, FilmLayout, Rect, fixed, image::Depth};
use kirkas_render::render::{Control, Undisturbed};
use kirkas_render::{Options, Prepared};
use std::sync::atomic::{AtomicU32, Ordering};

/// A floor under a lamp, half in the shadow of a screen, and empty sky above.
const SHADOWS: &str = r#"
[film]
width = 72
height = 56

[sampler]
error = 0.04
min_samples = 16
max_samples = 2048

[background]
type = "constant"
color = 0.2

[cameras.main]
type = "perspective"
position = [0, 1.5, 5]
look_at = [0, 1.1, 0]
fov = 50

[materials.shine]
type = "emitter"
intensity = 8

[objects.floor]
type = "rectangle"
center = [0, 0, 0]
edge_u = [8, 0, 0]
edge_v = [0, 0, -4]

[objects.lamp]
type = "rectangle"
center = [0, 4, 0]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "shine"
visible = false

[objects.screen]
type = "disk"
center = [0.4, 1, 0]
normal = [0, 1, 0]
radius = 0.8
"#;

fn adaptive(p: &Prepared, flock: usize) -> Film {
    let mut film = Film::new(p.film.clone());
    p.renderer(flock).render(&mut film, 0..p.samples, &Undisturbed);
    film
}

/// Root mean square of the difference of two films in a block, over the block's mean or a sixteenth of the image's.
fn error_of_block(film: &Film, truth: &Film, block: (u32, u32)) -> f64 {
    let grey = |c: [f64; 3]| (c[0] + c[1] + c[2]) / 3.0;
    let (w, h) = film.layout.size;
    let image = truth.pixels().map(|(_, _, t, i)| grey(t.moments(i).0)).sum::<f64>() / f64::from(w * h);
    let (mut square, mut mean, mut n) = (0.0, 0.0, 0.0);
    for (a, b) in film.pixels().zip(truth.pixels()) {
        if (a.0 / BLOCK, a.1 / BLOCK) == block {
            let (x, y) = (a.2.moments(a.3).0, b.2.moments(b.3).0);
            square += (0..3).map(|c| (x[c] - y[c]).powi(2) / 3.0).sum::<f64>();
            mean += grey(y);
            n += 1.0;
        }
    }
    (square / n).sqrt() / (mean / n).max(image / 16.0)
}

#[test]
fn every_block_reaches_the_target_and_no_more_samples_are_spent_than_it_needs() {
    let p = prepared(&SHADOWS.replace("[sampler]", "[sampler]\ntype = \"independent\""));
    let film = adaptive(&p, 64);
    let c = film.convergence();
    assert_eq!((c.open, c.blocks), (0, 63));

    let truth = render(&SHADOWS.replace("error = 0.04", "samples = 4096").replace("[sampler]", "[sampler]\nseed = 9"));
    let errors: Vec<f64> =
        (0..7).flat_map(|y| (0..9).map(move |x| (x, y))).map(|b| error_of_block(&film, &truth, b)).collect();
    // Each is estimated from 64 pixels, so a few are a little greater.
    let above = errors.iter().filter(|&&e| e > 0.04).count();
    assert!(above <= 3 && errors.iter().all(|&e| e < 0.04 * 1.5), "{errors:.3?}");
    let counts: Vec<u32> = film.pixels().map(|(_, _, t, i)| t.counts[i].taken).collect();
    let (least, most) = (*counts.iter().min().unwrap(), *counts.iter().max().unwrap());
    println!("{least} to {most} samples, {:.1} on the average", c.mean_samples);
    assert_eq!(least, 16, "the sky is known at once");
    assert!(most >= 256 && c.mean_samples < 0.6 * f64::from(most), "{most} {}", c.mean_samples);
}

#[test]
fn decisions_fall_at_powers_of_two_on_blocks_of_the_whole_image() {
    let film = adaptive(&prepared(SHADOWS), 64);
    let at =
        |x: u32, y: u32| film.pixels().find(|p| (p.0, p.1) == (x, y)).map(|(_, _, t, i)| t.counts[i].taken).unwrap();
    for (x, y, t, i) in film.pixels() {
        let taken = t.counts[i].taken;
        assert!(taken.is_power_of_two() && taken >= 16);
        assert_eq!(taken, at(x - x % BLOCK, y - y % BLOCK));
    }
}

/// Ends the render at the so-manieth chance.
struct Impatient(AtomicU32);

impl Control for Impatient {
    fn between(&self, _: &Film) -> bool {
        self.0.fetch_sub(1, Ordering::Relaxed) > 1
    }
}

#[test]
fn threads_flocks_and_interruptions_change_no_bit() {
    let p = prepared(SHADOWS);
    let whole = adaptive(&p, 64);
    for (threads, flock) in [(1, 7), (3, 1)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert!(pool.install(|| adaptive(&p, flock)) == whole, "{threads} threads, flocks of {flock}");
    }
    // Stopped after every pass, kept in a file, read again.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut film = Film::new(p.film.clone());
    let mut sessions = 0;
    while film.going_on().is_some_and(|(least, _)| least < p.samples) && sessions < 1000 {
        let control = Impatient(AtomicU32::new(1));
        pool.install(|| p.renderer(64).render(&mut film, 0..p.samples, &control));
        let mut image = film.to_image(Depth::Float);
        write_part(&film, &mut image);
        film = read_part(&image).unwrap();
        sessions += 1;
    }
    assert!(sessions > 10, "{sessions}");
    assert!(film == whole);
    // Fewer samples first, then more.
    let mut film = Film::new(p.film.clone());
    for end in [10, 100, p.samples] {
        p.renderer(64).render(&mut film, 0..end, &Undisturbed);
    }
    assert!(film == whole);
}

#[test]
fn a_crop_is_refused() {
    let crop = Some(Rect { x0: 8, y0: 8, x1: 32, y1: 32 });
    let refused = std::panic::catch_unwind(|| prepared_with(SHADOWS, &[], &Options { crop, ..Options::default() }));
    let why = refused.err().and_then(|e| e.downcast::<String>().ok()).expect("a message");
    assert!(why.contains("adaptive-crop"), "{why}");
}

/// A film of 3x3 blocks of grey 1, the one in the middle with the given variance per sample.
fn film_with_noise_in_the_middle(samples: u32, variance: f64, mean: f64) -> Film {
    let (size, crop) = ((24, 24), Rect { x0: 0, y0: 0, x1: 24, y1: 24 });
    let mut film = Film::new(FilmLayout { size, crop, groups: Vec::new(), aovs: Default::default(), bins: None });
    for tile in &mut film.tiles {
        for i in 0..tile.counts.len() {
            let (x, y) = tile.place(i);
            let v = if (x / 8, y / 8) == (1, 1) { variance } else { 0.0 };
            let n = f64::from(samples);
            tile.counts[i].taken = samples;
            tile.sums[i] = [fixed::from_f64(n * mean).unwrap(); 3];
            tile.squares[i] = [fixed::from_f64(n * mean * mean + (n - 1.0) * v).unwrap(); 3];
        }
    }
    film
}

#[test]
fn the_error_is_the_standard_error_over_the_mean_and_keeps_neighbours_going() {
    for mean in [1.0, 1e-3, 1e4] {
        // A standard deviation of 0.8 of the mean over 64 samples: an error of 0.1.
        let film = || film_with_noise_in_the_middle(64, (0.8 * mean) * (0.8 * mean), mean);
        for (target, stopped) in [(0.101, 576), (0.099, 0)] {
            let mut film = film();
            film.judge(&ErrorTarget { error: target, min_samples: 16 });
            let count = film.pixels().filter(|(_, _, t, i)| t.counts[*i].is_stopped).count();
            assert_eq!(count, stopped, "mean {mean}, target {target}");
        }
    }
    let target = ErrorTarget { error: 0.1, min_samples: 48 };
    assert_eq!([1, 48, 63, 64, 65, 128].map(|n| target.next_round(n)), [64, 64, 64, 128, 128, 256]);
    assert_eq!([32, 48, 64, 96].map(|n| target.is_round(n)), [false, false, true, false]);
}

/// Grey 0.2; `share` of the samples of some pixels find a light that doubles their mean.
fn rare(places: &str, share: f64, sampler: &str) -> String {
    format!(
        "[film]\nwidth = 24\nheight = 24\nfilter = \"box\"\n[background]\ntype = \"constant\"\ncolor = 0.2\n\
         [cameras.plan]\ntype = \"orthographic\"\nposition = [12, 12, 5]\nlook_at = [12, 12, 0]\nheight = 24\n\
         [sampler]\n{sampler}\n[materials.shine]\ntype = \"emitter\"\nintensity = {}\n{places}",
        0.2 + 0.2 / share
    )
}

fn lamp(x: f64, y: f64, side: f64) -> String {
    format!(
        "[objects.\"l{x} {y}\"]\ntype = \"rectangle\"\ncenter = [{x}, {y}, 0]\nedge_u = [{side}, 0, 0]\nedge_v = [0, {side}, 0]\nmaterial = \"shine\"\n"
    )
}

/// The mean over seeds of a pixel, or of all, over its truth, less 1, with its standard error; and samples per pixel.
fn bias(toml: &str, is_everywhere: bool, seeds: u64) -> (f64, f64, f64) {
    let mut p = prepared(toml);
    let (mut sum, mut squares, mut samples) = (0.0, 0.0, 0.0);
    for seed in 0..seeds {
        p.seed = seed;
        let film = adaptive(&p, 256);
        let all = pixels(&film);
        let shown = if is_everywhere { &all[..] } else { &all[11 * 24 + 12..][..1] };
        let v = shown.iter().map(|p| p[0]).sum::<f64>() / shown.len() as f64 / 0.4 - 1.0;
        sum += v;
        squares += v * v;
        samples += film.convergence().mean_samples;
    }
    let n = seeds as f64;
    let mean = sum / n;
    (mean, ((squares / n - mean * mean) / (n - 1.0)).sqrt(), samples / n)
}

/// `KIRKAS_BIAS_SEEDS=1000` (`cargo xtask bias`) gives the figures of the manual.
#[test]
fn the_bias_of_rare_light_is_what_the_manual_says() {
    let seeds = std::env::var("KIRKAS_BIAS_SEEDS").ok().and_then(|s| s.parse().ok()).unwrap_or(30);
    let everywhere = |share: f64| -> String {
        (0..24)
            .flat_map(|y| (0..24).map(move |x| (x, y)))
            .map(|(x, y)| lamp(f64::from(x) + 0.5, f64::from(y) + 0.5, share.sqrt()))
            .collect()
    };
    // The share of samples that find the light, where it is, the target, the least samples, how many of the seeds, and the range
    // that the bias lies in.
    for (share, place, target, min_samples, seeds, low, high) in [
        (0.002_f64, "all pixels", 0.3, 64, seeds / 5, -0.02, 0.02),
        (0.002, "one pixel", 0.05, 1024, seeds / 5, -0.4, 0.05),
        (0.002, "one pixel", 0.05, 64, seeds, -0.6, -0.2),
        (0.01, "one pixel", 0.05, 64, seeds, -0.45, 0.0),
    ] {
        let sampler = format!("type = \"independent\"\nerror = {target}\nmin_samples = {min_samples}");
        let places = if place == "one pixel" { lamp(12.5, 12.5, share.sqrt()) } else { everywhere(share) };
        let (mean, error, samples) = bias(&rare(&places, share, &sampler), place == "all pixels", seeds.max(2));
        println!(
            "{share} of the samples of {place}, error {target}, at least {min_samples}: bias {:.1} % +- {:.1} %, {samples:.0} samples \
             per pixel, {seeds} seeds",
            100.0 * mean,
            100.0 * error
        );
        let (low, high) = (low - 4.0 * error, high + 4.0 * error);
        assert!((low..high).contains(&mean), "{share} {place} {min_samples}: {mean} +- {error}");
    }
}
