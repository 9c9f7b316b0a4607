//! Films against `references/analytic.json` and numbers computed apart from this code, and RGB against the spectrum.

use crate::models::{Colors, build_in, set};
use crate::near;
use kirkas_geometry::Vec3;
use kirkas_optics::fresnel::{conductor, dielectric};
use kirkas_optics::thin_film::{Beneath, Film, airy};
use kirkas_optics::{Lanes, Light, Lobe, Mode};

#[test]
fn films_reflect_as_airy_says() {
    // "soap film n=1.33 d=500nm normal R(450,550,650)"
    near(airy(1.0, 1.0, 1.33, (1.0, 0.0), 500.0 / 450.0), 0.00161578942180727, 1e-10);
    near(airy(1.0, 1.0, 1.33, (1.0, 0.0), 500.0 / 550.0), 0.0724902782040783, 1e-10);
    near(airy(1.0, 1.0, 1.33, (1.0, 0.0), 500.0 / 650.0), 0.00174136332506681, 1e-10);
    // NumPy, by angles in place of normal parts.
    for (cos, eta_o, eta_f, body, thickness, expected) in [
        (0.5, 1.0, 1.5, (0.2, 3.4), 0.37, 0.9321250311142287),
        (0.2, 1.33, 2.1, (1.5, 4.0), 1.3, 0.6827603364877678),
        (0.7, 1.0, 1.4, (1.8, 0.0), 0.25, 0.016652240072360987),
        // Light that tunnels through a gap of air.
        (0.3, 1.5, 1.0, (1.5, 0.0), 0.1, 0.6178515694223004),
        (0.3, 1.5, 1.0, (1.5, 0.0), 0.9, 0.9999871323302887),
    ] {
        near(airy(cos, eta_o, eta_f, body, thickness), expected, 1e-10);
    }
    // Nothing between, or more of either side: as if it were not there.
    for cos in [1.0_f32, 0.6, 0.1] {
        let c = f64::from(cos);
        near(airy(c, 1.0, 1.7, (0.2, 3.4), 0.0), conductor(cos, 0.2, 3.4), 1e-6);
        near(airy(c, 1.0, 1.0, (1.5, 0.0), 0.7), dielectric(cos, 1.0, 1.5), 1e-6);
        near(airy(c, 1.0, 1.5, (1.5, 0.0), 0.7), dielectric(cos, 1.0, 1.5), 1e-6);
        // As much from inside as from outside, at the angles that belong together.
        let inside = (1.0 - (1.0 - c * c) / 2.25).sqrt();
        near(airy(c, 1.0, 1.33, (1.5, 0.0), 0.4), airy(inside, 1.5, 1.33, (1.0, 0.0), 0.4), 1e-9);
    }
}

/// The bands of an RGB render add up to what all wavelengths together show.
#[test]
fn a_film_has_the_same_colour_in_rgb_and_by_wavelength() {
    for (n, k, most) in [(1.0, 0.0, 0.004), (0.2, 3.4, 0.01)] {
        for thickness in [120.0, 400.0, 900.0] {
            let beneath = Beneath { n: Light::splat(n), k: Light::splat(k) };
            let of = |lanes: &Lanes| Film::new(lanes, thickness, 1.33).unwrap().reflectance(0.9, 1.0, &beneath);
            let rgb = of(&Lanes::RGB);
            const PATHS: usize = 4096;
            let mut sum = [0.0; 3];
            for i in 0..PATHS {
                let lanes = Lanes::spectral((i as f32 + 0.5) / PATHS as f32);
                let seen = lanes.to_film(of(&lanes) * lanes.illuminant([1.0; 3]));
                (0..3).for_each(|c| sum[c] += f64::from(seen[c]) / PATHS as f64);
            }
            for c in 0..3 {
                // A colour may be purer than the screen's.
                near(rgb[c], sum[c].max(0.0), most);
            }
        }
    }
    assert!(Film::new(&Lanes::RGB, 0.0, 1.33).is_none());
}

/// Soap's skin on a body of air's index, and a lens's coat: what is not reflected passes.
#[test]
fn films_on_clear_bodies_share_the_light() {
    for words in ["ior=1.5 film_thickness=300 film_ior=1.38", "ior=1.2 film_thickness=500 film_ior=1.33"] {
        let (params, outside) = set(words);
        for colors in [Colors::Rgb, Colors::Spectral(0.3)] {
            let glass = build_in(colors, "dielectric", &params, outside);
            for wo in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.96, 0.0, -0.28)] {
                let mut total = Light::BLACK;
                for s in glass.bsdf.delta_branches(wo, Mode::Importance).iter() {
                    total += s.f;
                }
                near(total[0], 1.0, 1e-6);
                near(total[1], 1.0, 1e-6);
            }
            let mirror = glass.bsdf.delta_branches(Vec3::Z, Mode::Radiance).iter().next().copied().unwrap();
            assert_eq!(mirror.lobe, Lobe::DeltaReflection);
            assert!(mirror.f[0] != mirror.f[1], "a film is coloured");
        }
    }
}
