//! No light from nowhere, and the same both ways, for every listed model.

use crate::models::{Case, build, cases, outgoing, parse, set};
use crate::near;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_optics::{LobeSet, Mode};
use kirkas_scene::Value;
use kirkas_testkit::statistics::normal_two_sided_tail;
use kirkas_testkit::{Random, albedo_by_quadrature, albedo_by_sampling, reciprocity_error, sidak};

/// The mode in which a bounded model sends out no more than it gets. Importance is power; the constant hack counts radiance.
fn power_mode(case: &Case) -> Mode {
    if case.scales_radiance { Mode::Importance } else { Mode::Radiance }
}

fn scattered(case: &Case, wo: Vec3, lane: usize, mode: Mode) -> f64 {
    albedo_by_quadrature(|wi| f64::from(case.bsdf.eval(wo, wi, LobeSet::ALL, mode)[lane]))
}

fn deltas(case: &Case, wo: Vec3, lane: usize, mode: Mode) -> f64 {
    case.bsdf.delta_branches(wo, mode).iter().map(|s| f64::from(s.f[lane])).sum()
}

/// White furnace: by quadrature no more than 1 leaves, and sampling gives the same in all lobes together.
#[test]
fn a_furnace_is_never_outshone_and_sampling_agrees() {
    let all = cases();
    let threshold = sidak(0.01, all.len() * outgoing().len());
    for case in &all {
        for (i, wo) in outgoing().into_iter().enumerate() {
            let mode = power_mode(case);
            let lane = i % 3;
            let total = scattered(case, wo, lane, mode) + deltas(case, wo, lane, mode);
            if case.is_bounded {
                // What compensation gives back is from a table of round facets.
                let slack = match (case.label.contains("compensation"), case.label.contains("anisotropy")) {
                    (true, true) => 0.1,
                    (true, false) => 5e-3,
                    // What a rough coat reflects is from one as well.
                    (_, true) if case.label.starts_with("rough_plastic") => 3e-2,
                    _ if case.label.starts_with("principled") => 2e-2,
                    _ if case.label.starts_with("rough_plastic") => 1e-2,
                    _ => 1e-4,
                };
                assert!(total <= 1.0 + slack, "{} from {wo}: {total}", case.label);
            }
            let estimate = albedo_by_sampling(40_000, i as u64, |u, v| {
                case.bsdf.sample(wo, u, v, LobeSet::ALL, mode).map_or(0.0, |s| f64::from(s.weight()[lane]))
            });
            let p = normal_two_sided_tail(estimate.z(total));
            assert!(p >= threshold, "{} from {wo}: {total} but sampled {estimate:?}", case.label);
        }
    }
}

/// `f(a, b) / eta_a^2 = f(b, a) / eta_b^2`; and the adjoint is the function with its arguments swapped, for all.
#[test]
fn scattering_is_reciprocal_and_importance_is_the_adjoint() {
    for case in cases() {
        let f = |a, b, mode| f64::from(case.bsdf.eval(a, b, LobeSet::ALL, mode)[0]);
        if case.is_reciprocal && case.scales_radiance {
            let error = reciprocity_error(3000, 7, 1e-3, |a, b| f(a, b, Mode::Radiance) / (case.eta(a) * case.eta(a)));
            // Near total reflection 1 - F loses digits.
            assert!(error < 1e-2, "{}: {error}", case.label);
        }
        let mut random = Random::new(9);
        for _ in 0..3000 {
            let (u, v) = (random.pair(), random.pair());
            let (a, b) = (square_to_uniform_sphere(u), square_to_uniform_sphere(v));
            let (r, i) = (f(a, b, Mode::Radiance), f(b, a, Mode::Importance));
            assert!((r - i).abs() <= 1e-2 * r.max(i).max(1e-3), "{} {a} {b}: {r} {i}", case.label);
        }
    }
}

/// The classic forms and constants are unbounded by design; this is how much.
#[test]
fn the_classics_break_what_their_manuals_say() {
    let classic = parse(&[
        ("diffuse", Value::Float(0.0)),
        ("specular", Value::Float(1.0)),
        ("exponent", Value::Float(1.0)),
        ("form", Value::from("classic")),
    ]);
    // At normal incidence f cos = cos / pi: an albedo of exactly 1; the light's cosine is missing, so grazing light
    // counts as much as steep light.
    near(scattered(&build("phong", &classic, 1.0), Vec3::Z, 0, Mode::Radiance), 1.0, 1e-4);
    let c = build("phong", &classic, 1.0);
    let f = |a, b| f64::from(c.bsdf.eval(a, b, LobeSet::ALL, Mode::Radiance)[0]);
    assert!(reciprocity_error(100, 1, 1e-3, f) > 0.1);
    // q = 0: f cos = 1 / pi over a hemisphere of 2 pi: twice what came.
    let flat = parse(&[
        ("diffuse", Value::Float(0.0)),
        ("specular", Value::Float(1.0)),
        ("exponent", Value::Float(0.0)),
        ("form", Value::from("classic")),
    ]);
    near(scattered(&build("blinn_phong", &flat, 1.0), Vec3::Z, 0, Mode::Radiance), 2.0, 1e-4);
}

/// Closed forms of directional albedo.
#[test]
fn albedos_meet_their_closed_forms() {
    let with = |name: &str, pairs: &[(&str, Value)]| build(name, &parse(pairs), 1.0);
    let wall = with("lambert", &[("reflectance", Value::from([0.7, 0.2, 0.1]))]);
    for (lane, expected) in [0.7, 0.2, 0.1, 0.0].into_iter().enumerate() {
        near(scattered(&wall, Vec3::new(0.6, 0.0, 0.8), lane, Mode::Radiance), expected, 1e-5);
    }
    // Both normalised highlights give back k_s at normal incidence, for any exponent.
    for name in ["phong", "blinn_phong"] {
        for q in [0.0, 1.0, 7.0, 60.0, 800.0] {
            let pairs =
                [("diffuse", Value::Float(0.0)), ("specular", Value::Float(0.9)), ("exponent", Value::Float(q))];
            near(scattered(&with(name, &pairs), Vec3::Z, 0, Mode::Radiance), 0.9, 3e-4);
        }
    }
    // GGX seen straight on: analytic.json, "GGX_E_normal_incidence_exact".
    for (alpha, expected) in [
        (0.05, 0.997295868488647),
        (0.1, 0.988304056520612),
        (0.25, 0.91581243024975),
        (0.5, 0.687848515110236),
        (0.75, 0.463916510940695),
        (1.0, 0.306852819440055),
    ] {
        let rough = with("rough_mirror", &[("roughness", Value::Float(alpha))]);
        near(scattered(&rough, Vec3::Z, 0, Mode::Radiance), expected, 1e-4);
    }
}

/// White stays white where what bounces among the facets is given back.
#[test]
fn compensated_facets_stand_a_white_furnace() {
    let with = |words: &str| {
        let (params, _) = set(words);
        build("rough_mirror", &params, 1.0)
    };
    for wo in kirkas_testkit::furnace::directions_above(5, 0.05) {
        for distribution in ["ggx", "beckmann"] {
            for roughness in [0.1, 0.3, 0.5, 0.8, 1.0] {
                let white = with(&format!("roughness={roughness} distribution={distribution} compensation=true"));
                near(scattered(&white, wo, 0, Mode::Radiance), 1.0, 5e-3);
            }
        }
        // Stretched ones are taken for round ones of the same mean.
        for (anisotropy, off) in [(0.3, 0.051), (0.7, 0.09)] {
            let white = with(&format!("roughness=0.5 anisotropy={anisotropy} compensation=true"));
            for wo in [wo, Vec3::new(wo.y, wo.x, wo.z), Vec3::new((1.0 - wo.z * wo.z).sqrt(), 0.0, wo.z)] {
                near(scattered(&white, wo, 0, Mode::Radiance), 1.0, off);
            }
        }
        // Coloured facets give back less than white ones, and more than without.
        let dull = with("roughness=0.5 reflectance=0.6");
        let given = with("roughness=0.5 reflectance=0.6 compensation=true");
        let (less, more) = (scattered(&dull, wo, 0, Mode::Radiance), scattered(&given, wo, 0, Mode::Radiance));
        assert!(more > less && more < 0.6, "{less} {more}");
    }
    // analytic.json: "GGX_E_normal_incidence_exact" without, 1 with.
    near(scattered(&with("roughness=0.5"), Vec3::Z, 0, Mode::Radiance), 0.687848515, 1e-4);
    near(scattered(&with("roughness=0.5 compensation=true"), Vec3::Z, 0, Mode::Radiance), 1.0, 5e-3);
}

/// Clear rough glass that gives back what bounces among its facets stands a furnace from both sides.
#[test]
fn compensated_glass_stands_a_white_furnace() {
    for words in ["", "ior=1.2", "ior=2.2", "ior=0.7", "distribution=beckmann"] {
        for roughness in [0.1, 0.35, 0.6, 1.0] {
            let (params, _) = set(&format!("roughness={roughness} compensation=true {words}"));
            let glass = build("rough_dielectric", &params, 1.0);
            for wo in kirkas_testkit::furnace::directions_above(5, 0.05) {
                for wo in [wo, -wo] {
                    let total = scattered(&glass, wo, 0, Mode::Importance);
                    assert!((total - 1.0).abs() <= 5e-3, "roughness={roughness} {words} from {wo}: {total}");
                }
            }
        }
    }
    // Without it a fifth is lost.
    let dull = build("rough_dielectric", &set("roughness=1").0, 1.0);
    assert!(scattered(&dull, Vec3::Z, 0, Mode::Importance) < 0.9);
}

/// Nothing is lost between the coat of white plastic and its base, and panes pass what the echoes of both polarisations leave.
#[test]
fn coats_and_panes_keep_their_light() {
    let with = |name: &str, words: &str| {
        let (params, outside) = set(words);
        build(name, &params, outside)
    };
    for wo in kirkas_testkit::furnace::directions_above(5, 0.05) {
        for words in ["reflectance=1", "reflectance=1 ior=2.2", "reflectance=1 ior=1.3 outside=1.5"] {
            let white = with("plastic", words);
            near(scattered(&white, wo, 0, Mode::Radiance) + deltas(&white, wo, 0, Mode::Radiance), 1.0, 2e-4);
        }
        for words in ["roughness=0.05", "roughness=0.3", "roughness=0.3 distribution=beckmann", "roughness=1 ior=1.8"] {
            let white = with("rough_plastic", &format!("reflectance=1 {words}"));
            near(scattered(&white, wo, 0, Mode::Radiance), 1.0, 1e-2);
        }
        for (words, most) in [
            ("", 0.01),
            ("metalness=1", 0.01),
            ("metalness=0.5", 0.01),
            ("diffuse_roughness=1", 0.02),
            ("coat=1 coat_roughness=0.2", 0.15),
            ("fuzz=1", 0.15),
        ] {
            let white = with("principled", &format!("base_color=1 roughness=0.3 {words}"));
            let total = scattered(&white, wo, 0, Mode::Radiance);
            assert!(total <= 1.01 && total >= 1.0 - most, "{words} from {wo}: {total}");
        }
        near(deltas(&with("thin_dielectric", ""), wo, 0, Mode::Radiance), 1.0, 1e-6);
    }
    // analytic.json: "Incoherent slab n=1.5" straight on and at 60 degrees.
    let pane = with("thin_dielectric", "");
    let passed = |wo: Vec3| {
        pane.bsdf
            .delta_branches(wo, Mode::Radiance)
            .iter()
            .filter(|s| s.lobe.is_transmission())
            .map(|s| s.f[0])
            .sum::<f32>()
    };
    near(passed(Vec3::Z), 0.923076923077, 1e-6);
    near(passed(Vec3::new(0.75_f32.sqrt(), 0.0, 0.5)), 0.8481284097288, 1e-6);
}

/// Nearly smooth rough glass loses nearly nothing, from both sides, even where it reflects totally.
#[test]
fn rough_glass_tends_to_smooth_glass() {
    let rough = build("rough_dielectric", &parse(&[("roughness", Value::Float(0.03))]), 1.0);
    let smooth = build("dielectric", &parse(&[]), 1.0);
    for wo in
        [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), -Vec3::Z, Vec3::new(0.3, 0.0, -0.91).normalize(), Vec3::new(0.8, 0.0, -0.6)]
    {
        for (lobes, branch) in [(LobeSet::REFLECTION, false), (LobeSet::TRANSMISSION, true)] {
            for mode in [Mode::Radiance, Mode::Importance] {
                let a = albedo_by_quadrature(|wi| f64::from(rough.bsdf.eval(wo, wi, lobes, mode)[1]));
                let b: f64 = smooth
                    .bsdf
                    .delta_branches(wo, mode)
                    .iter()
                    .filter(|s| s.lobe.is_transmission() == branch)
                    .map(|s| f64::from(s.f[1]))
                    .sum();
                near(a, b, 0.015 * b.max(1.0));
            }
        }
    }
}
