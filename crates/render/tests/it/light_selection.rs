//! However lights are chosen, the picture is the same but for noise.

use crate::support::{expose, pixels, prepared};
use kirkas_geometry::DVec3;
use kirkas_testkit::{Measured, Random, z_test};
use std::fmt::Write;

/// A floor and a block under lamps of every kind, near and far, some with their backs turned.
fn scene(selection: &str, seed: u64) -> String {
    let mut s = format!(
        "[film]\nwidth = 16\nheight = 12\nfilter = \"box\"\n[sampler]\nsamples = 64\nseed = {seed}\n\
         [integrator]\ntype = \"path\"\nmax_depth = 2\nlight_selection = \"{selection}\"\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0, 5, 9]\nlook_at = [0, 0.5, 0]\nfov = 50\n\
         [background]\ntype = \"gradient\"\nstops = [[0, 0.02], [1, [0.02, 0.05, 0.2]]]\n\
         [lights.moon]\ntype = \"directional\"\ndirection = [-1, -2, 0.5]\nintensity = 0.1\n\
         [materials.white]\ntype = \"lambert\"\nreflectance = 0.7\n\
         [materials.lamp]\ntype = \"emitter\"\nradiance = [3, 2, 1]\nunit = \"W\"\n\
         [materials.pane]\ntype = \"emitter\"\nradiance = [1, 2, 3]\ntwo_sided = true\n\
         [objects.floor]\ntype = \"plane\"\nmaterial = \"white\"\n\
         [objects.block]\ntype = \"box\"\nmin = [-1, 0, -1]\nmax = [0.5, 1.2, 0.4]\nmaterial = \"white\"\n\
         [objects.moving]\ntype = \"sphere\"\nradius = 0.1\nmaterial = \"lamp\"\n\
         motion = [{{ time = 0, transform = [{{ translate = [2, 1, 1] }}] }}, {{ time = 1, transform = [{{ translate = [2, 3, 1] }}] }}]\n\
         [objects.stretched]\ntype = \"disk\"\nradius = 0.2\nmaterial = \"pane\"\n\
         transform = [{{ scale = [1, 1, 3] }}, {{ rotate = [1, 0, 0, 40] }}, {{ translate = [-2, 2, 0] }}]\n"
    );
    let mut random = Random::new(3);
    for i in 0..40 {
        let mut within = |low: f64, high: f64| low + (high - low) * f64::from(random.number());
        let p = [within(-4.0, 4.0), within(0.3, 3.0), within(-4.0, 3.0)];
        let d = [within(-1.0, 1.0), within(-1.0, 1.0), within(-1.0, 1.0)];
        match i % 5 {
            0 => writeln!(s, "[lights.l{i}]\ntype = \"point\"\nposition = {p:?}\nintensity = 0.05"),
            1 => writeln!(
                s,
                "[lights.l{i}]\ntype = \"spot\"\nposition = {p:?}\ndirection = {d:?}\nintensity = 0.4\nhotspot = 10\nfalloff_angle = 110"
            ),
            2 => writeln!(
                s,
                "[objects.l{i}]\ntype = \"sphere\"\ncenter = {p:?}\nradius = 0.05\nmaterial = \"lamp\""
            ),
            3 => writeln!(
                s,
                "[objects.l{i}]\ntype = \"disk\"\ncenter = {p:?}\nnormal = {d:?}\nradius = 0.1\nmaterial = \"lamp\""
            ),
            _ => writeln!(
                s,
                "[objects.l{i}]\ntype = \"mesh\"\nvertices = [[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]\n\
                 faces = [0, 1, 2, 0, 2, 3]\nmaterial = \"pane\"\ntransform = [{{ translate = {p:?} }}]"
            ),
        }
        .unwrap();
    }
    s
}

/// Mean and variance of the mean over some seeds.
fn measured(selection: &str, seeds: std::ops::Range<u64>) -> (Vec<f64>, Vec<f64>) {
    let n = (seeds.end - seeds.start) as f64;
    let runs: Vec<Vec<f64>> = seeds
        .map(|seed| {
            let p = prepared(&scene(selection, seed));
            pixels(&expose(&p, 0..p.samples).0).into_iter().flatten().collect()
        })
        .collect();
    let mean: Vec<f64> = (0..runs[0].len()).map(|i| runs.iter().map(|r| r[i]).sum::<f64>() / n).collect();
    let variance = (0..mean.len())
        .map(|i| runs.iter().map(|r| (r[i] - mean[i]) * (r[i] - mean[i])).sum::<f64>() / (n * (n - 1.0)))
        .collect();
    (mean, variance)
}

#[test]
fn the_tree_gives_the_picture_that_even_choice_gives() {
    let (tree, tree_variance) = measured("tree", 0..24);
    let noise = |v: &[f64]| v.iter().sum::<f64>();
    for selection in ["uniform", "power"] {
        let (plain, plain_variance) = measured(selection, 100..124);
        // With variances of 24 seeds each the normal law is a little narrow: hence the level.
        let found = z_test(
            Measured { mean: &tree, variance: &tree_variance },
            Measured { mean: &plain, variance: &plain_variance },
            1e-4,
            0.0,
        );
        assert!(found.passed, "{selection}: {found:?}");
        assert!(noise(&tree_variance) < noise(&plain_variance), "{selection} is no noisier than the tree");
        let whole = |m: &[f64]| m.iter().sum::<f64>();
        let spread = (noise(&tree_variance) + noise(&plain_variance)).sqrt();
        assert!((whole(&tree) - whole(&plain)).abs() < 4.0 * spread, "{} {}", whole(&tree), whole(&plain));
    }
}

#[test]
fn every_light_that_reaches_a_point_can_be_picked_there() {
    let p = prepared(&scene("tree", 0));
    let scene = &p.scene;
    let mut random = Random::new(8);
    let mut found = 0;
    for _ in 0..300 {
        let mut within = |low: f64, high: f64| low + (high - low) * f64::from(random.number());
        let at = DVec3::new(within(-4.0, 4.0), within(0.0, 3.0), within(-4.0, 4.0));
        let normal = DVec3::new(within(-1.0, 1.0), within(-1.0, 1.0), within(-1.0, 1.0)).normalize();
        let u = (random.number(), random.number());
        let mut sum = 0.0;
        for (number, light) in scene.lights.iter().enumerate() {
            let probability = scene.picker.probability(at, normal, number as u32);
            sum += f64::from(probability);
            let sample = scene.sample_light(&kirkas_optics::Lanes::RGB, light, at, 0.5, u);
            if sample.is_some_and(|s| !s.light.is_black() && s.direction.dot(normal) > 0.0) {
                assert!(probability > 0.0, "{} from {at} {normal}", light.name);
                found += 1;
            }
        }
        assert!((sum - 1.0).abs() < 1e-4, "{sum}");
    }
    assert!(found > 2000, "{found}");
}

#[test]
fn the_same_seed_gives_the_same_bits_with_any_flock() {
    let p = prepared(&scene("tree", 5));
    let take = |flock| {
        let mut film = kirkas_render::Film::new(p.film.clone());
        p.renderer(flock).render(&mut film, 0..4, &kirkas_render::render::Undisturbed);
        pixels(&film)
    };
    assert_eq!(take(1), take(64));
}
