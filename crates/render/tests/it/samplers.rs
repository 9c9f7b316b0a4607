//! Samplers: how fast their means converge, and that what should be independent is.

use kirkas_geometry::hash::of_name;
use kirkas_render::sampler::{SAMPLERS, Sampler, SamplerKind};

fn kind(name: &str, samples: u32) -> SamplerKind {
    SamplerKind::from_name(name, samples).unwrap()
}

fn pairs(name: &str, samples: u32, x: u32, purpose: u64) -> Vec<(f64, f64)> {
    let pair = |i| Sampler::new(kind(name, samples), 11, x, 5, i).pair(purpose);
    (0..samples).map(pair).map(|(u, v)| (f64::from(u), f64::from(v))).collect()
}

/// The root mean square, over pixels, of the error of the mean of `f`, whose integral is `truth`.
fn rms_error(name: &str, samples: u32, f: impl Fn(f64, f64) -> f64, truth: f64) -> f64 {
    const PIXELS: u32 = 64;
    let error = |x| {
        let sum: f64 = pairs(name, samples, x, of_name("light")).into_iter().map(|(u, v)| f(u, v)).sum();
        (sum / f64::from(samples) - truth).powi(2)
    };
    ((0..PIXELS).map(error).sum::<f64>() / f64::from(PIXELS)).sqrt()
}

#[test]
fn errors_fall_with_the_slopes_of_theory() {
    let smooth = |u: f64, v: f64| (u * v + u).exp();
    // The integral over v is e^u (e^u - 1) / u; over u by Simpson's rule on 10,000 pieces.
    let inner = |u: f64| if u == 0.0 { 1.0 } else { u.exp() * u.exp_m1() / u };
    let n = 10_000;
    let truth = (0..=n)
        .map(|i| inner(f64::from(i) / f64::from(n)) * if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) })
        .sum::<f64>()
        / (3.0 * f64::from(n));
    for (name, few, many, slowest, fastest) in [
        ("sobol", 16, 4096, -1.25, -1.75),
        ("halton", 36, 7776, -1.1, -1.75),
        ("stratified", 16, 4096, -0.85, -1.75),
        ("independent", 16, 4096, -0.4, -0.6),
    ] {
        let (a, b) = (rms_error(name, few, smooth, truth), rms_error(name, many, smooth, truth));
        let slope = (b / a).ln() / (f64::from(many) / f64::from(few)).ln();
        println!("{name}: error {a:.2e} at {few}, {b:.2e} at {many}, slope {slope:.2}");
        assert!(slope < slowest && slope > fastest, "{name}: {slope}");
    }
}

#[test]
fn an_edge_is_found_sooner_than_by_chance() {
    let edge = |u: f64, v: f64| f64::from(u8::from(v < 0.3 + 0.5 * u));
    let error = |name, n| rms_error(name, n, edge, 0.55);
    for (name, n) in [("sobol", 1024), ("halton", 1296), ("stratified", 1024)] {
        let share = error(name, n) / error("independent", n);
        assert!(share < 0.5, "{name}: {share}");
    }
}

#[test]
fn purposes_and_pixels_are_independent_of_each_other() {
    // The mean of a product of two centred numbers is 0 on the average; by chance its variance would be 1 / (144 n). Where
    // each pair of neighbours in a sequence is antithetic for both purposes, half as many products are independent.
    const SAMPLES: u32 = 64;
    const TRIALS: u32 = 2000;
    for spec in SAMPLERS {
        let name = spec.name;
        let product = |a: &[(f64, f64)], b: &[(f64, f64)]| {
            a.iter().zip(b).map(|(a, b)| (a.0 - 0.5) * (b.0 - 0.5)).sum::<f64>() / f64::from(SAMPLES)
        };
        let purposes =
            |x| product(&pairs(name, SAMPLES, x, of_name("lens")), &pairs(name, SAMPLES, x, of_name("light")));
        let neighbours =
            |x: u32| product(&pairs(name, SAMPLES, x, of_name("lens")), &pairs(name, SAMPLES, x + 1, of_name("lens")));
        for (what, of) in [("purposes", &purposes as &dyn Fn(u32) -> f64), ("neighbours", &neighbours)] {
            let values: Vec<f64> = (0..TRIALS).map(|x| of(2 * x)).collect();
            let mean = values.iter().sum::<f64>() / f64::from(TRIALS);
            let variance = values.iter().map(|v| v * v).sum::<f64>() / f64::from(TRIALS);
            let by_chance = 1.0 / (144.0 * f64::from(SAMPLES));
            assert!(mean.abs() < 4.0 * (by_chance / f64::from(TRIALS)).sqrt(), "{name}, {what}: mean {mean:e}");
            assert!((0.8..2.2).contains(&(variance / by_chance)), "{name}, {what}: {}", variance / by_chance);
        }
    }
}

#[test]
fn first_numbers_of_all_pixels_fill_the_square_evenly() {
    for spec in SAMPLERS {
        let mut counts = [0_u32; 64];
        for y in 0..80 {
            for x in 0..80 {
                let (u, v) = Sampler::new(kind(spec.name, 16), 3, x, y, 0).pair(of_name("filter"));
                counts[(u * 8.0) as usize + 8 * (v * 8.0) as usize] += 1;
            }
        }
        let chi_square: f64 = counts.iter().map(|&c| (f64::from(c) - 100.0).powi(2) / 100.0).sum();
        // 63 degrees of freedom: above 103.4 with probability 0.001.
        assert!(chi_square < 103.4, "{}: {chi_square}", spec.name);
    }
}

#[test]
fn a_sample_is_the_same_whatever_the_final_count() {
    for spec in SAMPLERS {
        let of = |samples| Sampler::new(kind(spec.name, samples), 1, 2, 3, 4).pair_of(of_name("lamp"), 1, 2);
        match kind(spec.name, 5).limit() {
            None => assert_eq!(of(5), of(5000), "{}", spec.name),
            Some(limit) => assert_eq!((limit, of(5) == of(5000)), (5, false), "{}", spec.name),
        }
    }
}
