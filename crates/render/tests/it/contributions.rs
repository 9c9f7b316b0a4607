//! Contributions on their way to the film: light groups that add up, the clamp, what is no number.

use crate::support::{prepared, render};
use kirkas_optics::Light;
use kirkas_render::film::image::Depth;
use kirkas_render::integrators::{Integrator, PathState, StepOutput};
use kirkas_render::observe::SampleId;
use kirkas_render::render::Undisturbed;
use kirkas_render::sampler::Sampler;
use kirkas_render::scene::{Scene, SurfaceHit};
use kirkas_render::{Film, Prepared, Renderer};

const LAMPS: &str = r#"
[film]
width = 24
height = 20
light_groups = true

[sampler]
samples = 16

[background]
type = "constant"
color = [0.02, 0.05, 0.1]

[cameras.main]
type = "perspective"
position = [0, 1.5, 5]
look_at = [0, 0.6, 0]

[lights.key]
type = "point"
position = [2, 3, 4]
intensity = 20

[lights.rim]
type = "point"
position = [-3, 3, -1]
color = [1, 2, 3]
intensity = 10

[materials.shine]
type = "emitter"
intensity = 3

[objects.floor]
type = "plane"

[objects.ball]
type = "sphere"
center = [0, 0.7, 0]
radius = 0.7

[objects.panel]
type = "rectangle"
center = [0, 3, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = "shine"
"#;

#[test]
fn layers_add_up_to_the_picture() {
    let (apart, together) = (render(LAMPS), render(&LAMPS.replace("light_groups = true", "light_groups = false")));
    assert_eq!(apart.layout.groups, ["background", "panel", "key", "rim"]);
    for (a, b) in apart.tiles.iter().zip(&together.tiles) {
        for (pixel, whole) in b.sums.iter().enumerate() {
            // In the integers, exactly.
            let planes = &a.sums[4 * pixel..4 * pixel + 4];
            let sum: [i128; 3] = std::array::from_fn(|c| planes.iter().map(|p| p[c]).sum());
            assert_eq!(sum, *whole);
            // In floats, to the rounding of each layer.
            let mean = a.mean(pixel);
            for c in 0..3 {
                let layers: Vec<f64> = (0..4).map(|g| f64::from(a.plane_mean(pixel, g)[c])).collect();
                let unit = f64::from(f32::EPSILON) / 2.0;
                let bound: f64 = layers.iter().map(|l| l.abs() * unit).sum::<f64>() + f64::from(mean[c].abs()) * unit;
                assert!((layers.iter().sum::<f64>() - f64::from(mean[c])).abs() <= bound);
            }
        }
    }
    assert_eq!(apart.to_image(Depth::Float).channel("R"), together.to_image(Depth::Float).channel("R"));
}

#[test]
fn relighting_is_rendering_with_other_lamps() {
    let film = render(LAMPS);
    let same = film.clone().relit(&[[1.0; 3]; 4]);
    assert!(film.tiles.iter().zip(&same.tiles).all(|(a, b)| a.sums == b.sums));

    let pictures = |film: &Film| film.to_rgb().pixels;
    let (key, rim) = ("intensity = 20", "color = [1, 2, 3]\nintensity = 10");
    // Powers of two: to the bit.
    let anew = LAMPS.replace(key, "intensity = 40").replace(rim, "color = [0.25, 0.5, 0.75]\nintensity = 10");
    let relit = film.clone().relit(&[[1.0; 3], [1.0; 3], [2.0; 3], [0.25; 3]]);
    assert_eq!(pictures(&relit), pictures(&render(&anew)));
    // Lamps switched off: to the bit.
    let anew = LAMPS.replace(key, "intensity = 0").replace(rim, "color = [1, 0, 0]\nintensity = 10");
    let relit = film.clone().relit(&[[1.0; 3], [1.0; 3], [0.0; 3], [1.0, 0.0, 0.0]]);
    assert_eq!(pictures(&relit), pictures(&render(&anew)));
    // Any colour: to the roundings of the light's own numbers.
    let anew = LAMPS.replace(key, "color = [0.7, 0.11, 3]\nintensity = 20");
    let relit = film.relit(&[[1.0; 3], [1.0; 3], [0.7, 0.11, 3.0], [1.0; 3]]);
    for (a, b) in pictures(&relit).iter().flatten().zip(pictures(&render(&anew)).iter().flatten()) {
        assert!((a - b).abs() <= 1e-6 * b.abs(), "{a} {b}");
    }
}

#[test]
fn the_clamp_holds_every_contribution_keeps_its_colour_and_is_said_aloud() {
    let p = prepared(LAMPS);
    assert!(p.clamp == 0.0 && p.warnings.is_empty());
    let clamped = prepared(&LAMPS.replace("light_groups = true", "filter = \"box\"\nclamp = 0.25"));
    assert!(clamped.warnings.iter().any(|w| w.code == "firefly-clamp"));

    let source = Source(|_| Light([0.5, 0.25, 0.0, 0.0]));
    let film = with_integrator(&clamped, &source, 4);
    assert_eq!(film.tiles[0].mean(0), [0.25, 0.125, 0.0]);
    let source = Source(|_| Light([0.2, 0.1, 0.25, 0.0]));
    assert_eq!(with_integrator(&clamped, &source, 4).tiles[0].mean(0), [0.2, 0.1, 0.25]);
}

/// Every camera ray brings what the function says of its sample.
struct Source<F>(F);

impl<F: Fn(u64) -> Light + Sync> Integrator for Source<F> {
    fn step(&self, _: &Scene, _: &PathState, sampler: &Sampler, _: Option<&SurfaceHit>, out: &mut StepOutput) {
        out.contributions.push(((self.0)(sampler.key()), 0));
    }
}

fn with_integrator(p: &Prepared, integrator: &dyn Integrator, samples: u32) -> Film {
    let mut film = Film::new(p.film.clone());
    Renderer { integrator, ..p.renderer(16) }.render(&mut film, 0..samples, &Undisturbed);
    film
}

#[test]
fn what_is_no_number_is_counted_located_and_left_out() {
    let p = prepared(&LAMPS.replace("light_groups = true", "filter = \"box\""));
    let kind = |key: u64| key % 97;
    let source = Source(|key| match kind(key) {
        0 => Light([f32::NAN, 1.0, 1.0, 0.0]),
        1 => Light([1.0, f32::INFINITY, 1.0, 0.0]),
        2 => Light([1.0, 1.0, f32::NEG_INFINITY, 0.0]),
        3 => Light([1e30, 1.0, 1.0, 0.0]),
        _ => Light([0.5, 0.25, 2.0, 0.0]),
    });
    const SAMPLES: u32 = 8;
    let film = with_integrator(&p, &source, SAMPLES);
    let r = p.renderer(16);
    let is_bad = |x, y, sample| kind(Sampler::new(r.sampler, r.seed, x, y, sample).key()) < 4;
    let mut all = 0;
    for tile in &film.tiles {
        let mut expected = Vec::new();
        for i in 0..tile.counts.len() {
            let (x, y) = tile.place(i);
            let bad: Vec<SampleId> =
                (0..SAMPLES).filter(|&s| is_bad(x, y, s)).map(|sample| SampleId { x, y, sample }).collect();
            assert_eq!((tile.counts[i].taken, tile.counts[i].invalid), (SAMPLES, bad.len() as u32));
            let valid = SAMPLES as usize > bad.len();
            assert_eq!(tile.mean(i), if valid { [0.5, 0.25, 2.0] } else { [0.0; 3] });
            expected.extend(bad);
        }
        all += expected.len();
        assert!(tile.invalid.len() == expected.len().min(16));
        assert!(tile.invalid.iter().all(|id| expected.contains(id)));
    }
    assert_eq!(film.invalid_samples(), all as u64);
    assert!(all > 50, "{all}");
}
