//! Mirrors and panes: directions, weights, probabilities, and what a Whitted tree is told.

use crate::models::{build, cases, outgoing, parse};
use crate::near;
use kirkas_geometry::Vec3;
use kirkas_optics::{BsdfSample, Light, Lobe, LobeSet, Mode};
use kirkas_scene::{Map, Value};

const DOWN_40: Vec3 = Vec3::new(0.642_787_6, 0.0, -0.766_044_4);
const UP: Vec3 = Vec3::new(0.6, 0.0, 0.8);

fn branches(name: &str, pairs: &[(&str, Value)], outside: f32, wo: Vec3, mode: Mode) -> Vec<BsdfSample> {
    build(name, &parse(pairs), outside).bsdf.delta_branches(wo, mode).into_iter().collect()
}

/// Where neither tint is below 1, what is reflected and what passes is all.
#[test]
fn reflected_and_refracted_power_add_up_to_one() {
    for fresnel in ["exact", "schlick"] {
        for (ior, outside) in [(1.5, 1.0), (1.1, 1.33), (1.0, 1.0)] {
            let pairs = [("ior", Value::Float(ior)), ("fresnel", Value::from(fresnel))];
            for wo in outgoing() {
                let all = branches("dielectric", &pairs, outside, wo, Mode::Importance);
                let total: Light = all.iter().map(|s| s.f).sum();
                for lane in 0..3 {
                    near(total[lane], 1.0, 1e-6);
                }
                assert_eq!(total[3], 0.0);
                assert!(all.iter().all(|s| s.pdf == 1.0));
            }
        }
    }
}

#[test]
fn glass_bends_and_weighs_as_fresnel_and_snell_say() {
    // cos 0.8 onto n = 1.5: sin 0.6 -> 0.4; R from sin^2(t-u)/sin^2(t+u) and tan^2 likewise.
    for (mode, scale) in [(Mode::Radiance, 1.0 / 2.25), (Mode::Importance, 1.0)] {
        let all = branches("dielectric", &[], 1.0, UP, mode);
        assert_eq!(all.iter().map(|s| s.lobe).collect::<Vec<_>>(), [Lobe::DeltaReflection, Lobe::DeltaTransmission]);
        let (r, t) = (all[0], all[1]);
        assert!((r.wi - Vec3::new(-0.6, 0.0, 0.8)).length() < 1e-6 && r.eta == 1.0);
        assert!((t.wi - Vec3::new(-0.4, 0.0, -0.84_f32.sqrt())).length() < 1e-6 && t.eta == 1.5);
        near(r.f[1], 0.043894736, 1e-7);
        near(t.f[1], (1.0 - 0.043894736) * scale, 1e-6);
    }
    // Leaving at 40 degrees, just before the critical 41.8.
    for (mode, scale) in [(Mode::Radiance, 2.25), (Mode::Importance, 1.0)] {
        let all = branches("dielectric", &[], 1.0, DOWN_40, mode);
        near(all[0].f[2], 0.2452912, 1e-5);
        near(all[1].f[2], (1.0 - 0.2452912) * scale, 2e-5);
        near(all[1].wi.x, -0.642_787_6 * 1.5, 1e-6);
        assert!(all[1].wi.z > 0.0);
        near(all[1].eta, 1.0 / 1.5, 1e-7);
    }
}

#[test]
fn beyond_the_critical_angle_one_branch_remains() {
    let steep = Vec3::new(0.67, 0.0, -(1.0_f32 - 0.67 * 0.67).sqrt());
    let shallow = Vec3::new(0.66, 0.0, -(1.0_f32 - 0.66 * 0.66).sqrt());
    for fresnel in ["exact", "schlick", "constant"] {
        let pairs = [
            ("fresnel", Value::from(fresnel)),
            ("reflectance", Value::Float(0.25)),
            ("transmittance", Value::Float(0.5)),
        ];
        let total = branches("dielectric", &pairs, 1.0, steep, Mode::Radiance);
        assert_eq!(total.len(), 1, "{fresnel}");
        assert_eq!((total[0].lobe, total[0].f), (Lobe::DeltaReflection, Light([0.25, 0.25, 0.25, 0.0])));
        assert_eq!(branches("dielectric", &pairs, 1.0, shallow, Mode::Radiance).len(), 2, "{fresnel}");
    }
}

/// The constant hack scales no radiance, so its adjoint does.
#[test]
fn constants_hold_at_every_angle() {
    let pairs = [
        ("fresnel", Value::from("constant")),
        ("reflectance", Value::Float(0.25)),
        ("transmittance", Value::Float(0.5)),
    ];
    for wo in [UP, Vec3::Z, Vec3::new(0.995, 0.0, 0.1).normalize(), -Vec3::Z, DOWN_40] {
        let radiance = branches("dielectric", &pairs, 1.0, wo, Mode::Radiance);
        assert_eq!((radiance[0].f[0], radiance[1].f[0]), (0.25, 0.5));
        let importance = branches("dielectric", &pairs, 1.0, wo, Mode::Importance);
        near(importance[0].f[0], 0.25, 0.0);
        near(importance[1].f[0], if wo.z > 0.0 { 0.5 / 2.25 } else { 0.5 * 2.25 }, 1e-6);
    }
}

/// `sample` picks a branch with the probability it states, and divides nothing out of `f`.
#[test]
fn branches_are_picked_with_their_stated_probability() {
    // Composed models have several branches of one kind; the furnace weighs them.
    for case in cases().into_iter().filter(|c| !c.is_composed) {
        for (wo, mode) in outgoing().into_iter().flat_map(|w| [(w, Mode::Radiance), (w, Mode::Importance)]) {
            let all: Vec<BsdfSample> = case.bsdf.delta_branches(wo, mode).into_iter().collect();
            assert_eq!(all.iter().map(|s| s.lobe).collect::<Vec<_>>(), {
                let mut sorted: Vec<_> = all.iter().map(|s| s.lobe).collect();
                sorted.sort_by_key(|l| l.is_transmission());
                sorted
            });
            for lobes in [LobeSet::ALL, LobeSet::DELTA] {
                const N: u32 = 4000;
                let drawn: Vec<BsdfSample> = (0..N)
                    .filter_map(|i| case.bsdf.sample(wo, (i as f32 + 0.5) / N as f32, (0.3, 0.6), lobes, mode))
                    .filter(|s| s.lobe.is_delta())
                    .collect();
                let mut stated = 0.0;
                for branch in &all {
                    let like: Vec<&BsdfSample> = drawn.iter().filter(|s| s.lobe == branch.lobe).collect();
                    let first = like.first().unwrap_or_else(|| panic!("{} never picks {branch:?}", case.label));
                    assert_eq!((first.f, first.wi, first.eta), (branch.f, branch.wi, branch.eta), "{}", case.label);
                    near(like.len() as f64 / f64::from(N), first.pdf, 1.5 / f64::from(N));
                    stated += f64::from(first.pdf);
                }
                assert!(!drawn.iter().any(|d| all.iter().all(|b| b.lobe != d.lobe)), "{}", case.label);
                if lobes == LobeSet::DELTA && !all.is_empty() {
                    near(stated, 1.0, 1e-6);
                }
            }
            // Alone, a branch is certain.
            for branch in &all {
                let alone = case.bsdf.sample(wo, 0.99, (0.3, 0.6), LobeSet::of(branch.lobe), mode).unwrap();
                assert_eq!(alone, *branch, "{}", case.label);
            }
        }
    }
}

/// Probabilities follow the greatest lane of the power each way carries, not of the radiance.
#[test]
fn probabilities_are_power() {
    let case = build(
        "dielectric",
        &parse(&[("reflectance", Value::from([0.1, 0.9, 0.2])), ("transmittance", Value::Float(0.3))]),
        1.0,
    );
    let p = case.bsdf.sample(DOWN_40, 0.0, (0.0, 0.0), LobeSet::ALL, Mode::Radiance).unwrap();
    assert_eq!(p.lobe, Lobe::DeltaReflection);
    let (r, t) = (0.9 * 0.2452912, 0.3 * (1.0 - 0.2452912));
    near(p.pdf, r / (r + t), 1e-5);
    let phong = build(
        "phong",
        &parse(&[
            ("diffuse", Value::from([0.1, 0.4, 0.2])),
            ("specular", Value::Float(0.2)),
            ("reflect", Value::Float(0.3)),
            ("transmit", Value::Float(0.1)),
        ]),
        1.0,
    );
    for (u, lobe, p) in [
        (0.39, Lobe::DiffuseReflection, None),
        (0.41, Lobe::GlossyReflection, None),
        (0.59, Lobe::GlossyReflection, None),
        (0.61, Lobe::DeltaReflection, Some(0.3)),
        (0.89, Lobe::DeltaReflection, Some(0.3)),
        (0.91, Lobe::DeltaTransmission, Some(0.1)),
    ] {
        let s = phong.bsdf.sample(Vec3::Z, u, (0.1, 0.2), LobeSet::ALL, Mode::Radiance).unwrap();
        assert_eq!(s.lobe, lobe);
        if let Some(p) = p {
            near(s.pdf, p, 1e-6);
        }
    }
}

#[test]
fn mirrors_follow_schlick_or_do_not() {
    let colour = ("reflectance", Value::from([0.9, 0.2, 0.0]));
    let plain = branches("mirror", std::slice::from_ref(&colour), 1.0, UP, Mode::Radiance);
    assert_eq!((plain.len(), plain[0].f, plain[0].wi), (1, Light([0.9, 0.2, 0.0, 0.0]), Vec3::new(-0.6, 0.0, 0.8)));
    let below = branches("mirror", std::slice::from_ref(&colour), 1.0, Vec3::new(0.6, 0.0, -0.8), Mode::Radiance);
    assert_eq!(below[0].wi, Vec3::new(-0.6, 0.0, -0.8));
    let metal = branches("mirror", &[colour, ("fresnel", Value::from("schlick"))], 1.0, UP, Mode::Radiance);
    near(metal[0].f[0], 0.9 + 0.1 * 0.00032, 1e-6);
    near(metal[0].f[1], 0.2 + 0.8 * 0.00032, 1e-6);
    assert_eq!((metal[0].f[2], metal[0].f[3]), (0.0, 0.0));
    assert!(branches("mirror", &[("reflectance", Value::Float(0.0))], 1.0, UP, Mode::Radiance).is_empty());
}

/// Phong's mirror and pane; without a pane, an opaque coat reflects by the body's own index, from either side.
#[test]
fn phong_carries_the_classic_mirror_and_pane() {
    for name in ["phong", "blinn_phong"] {
        let both = [("reflect", Value::Float(0.3)), ("transmit", Value::Float(0.4))];
        let all = branches(name, &both, 1.0, UP, Mode::Radiance);
        assert_eq!((all[0].f[0], all[1].f[0], all[1].eta), (0.3, 0.4, 1.5));
        let total = branches(name, &both, 1.0, Vec3::new(0.8, 0.0, -0.6), Mode::Radiance);
        assert_eq!((total.len(), total[0].f[0]), (1, 0.3));
        let exact = [both[0].clone(), both[1].clone(), ("fresnel", Value::from("exact"))];
        let all = branches(name, &exact, 1.0, UP, Mode::Radiance);
        near(all[0].f[0], 0.3 * 0.043894736, 1e-7);
        near(all[1].f[0], 0.4 * (1.0 - 0.043894736) / 2.25, 1e-6);
        let coat = [("reflect", Value::Float(1.0)), ("fresnel", Value::from("exact"))];
        for wo in [UP, Vec3::new(0.6, 0.0, -0.8)] {
            let all = branches(name, &coat, 1.0, wo, Mode::Radiance);
            assert_eq!((all.len(), all[0].wi), (1, Vec3::new(-0.6, 0.0, wo.z)));
            near(all[0].f[0], 0.043894736, 1e-7);
        }
    }
}

#[test]
fn each_model_tells_its_lobes() {
    let of = |name: &str, pairs: &[(&str, Value)]| build(name, &parse(pairs), 1.0).bsdf;
    let set = |l: &[Lobe]| l.iter().fold(LobeSet::NONE, |s, &x| s | LobeSet::of(x));
    use Lobe::*;
    assert_eq!(of("lambert", &[]).lobes(), set(&[DiffuseReflection]));
    assert_eq!(of("lambert", &[("reflectance", Value::Float(0.0))]).lobes(), LobeSet::NONE);
    assert_eq!(of("phong", &[]).lobes(), set(&[DiffuseReflection]));
    let full = [("specular", Value::Float(0.1)), ("reflect", Value::Float(0.1)), ("transmit", Value::Float(0.1))];
    let four = set(&[DiffuseReflection, GlossyReflection, DeltaReflection, DeltaTransmission]);
    assert_eq!(of("phong", &full).lobes(), four);
    assert_eq!(of("phong", &full).traced_lobes(), LobeSet::NONE);
    assert_eq!(of("mirror", &[]).lobes(), set(&[DeltaReflection]));
    assert_eq!(of("mirror", &[("reflectance", Value::Float(0.0))]).lobes(), LobeSet::NONE);
    assert_eq!(of("dielectric", &[]).lobes(), set(&[DeltaReflection, DeltaTransmission]));
    assert_eq!(of("dielectric", &[("transmittance", Value::Float(0.0))]).lobes(), set(&[DeltaReflection]));
    assert_eq!(of("dielectric", &[("reflectance", Value::Float(0.0))]).lobes(), set(&[DeltaTransmission]));
    assert_eq!(of("rough_mirror", &[]).traced_lobes(), set(&[GlossyReflection]));
    assert_eq!(of("rough_dielectric", &[]).traced_lobes(), set(&[GlossyReflection, GlossyTransmission]));
    assert_eq!(of("rough_dielectric", &[("reflectance", Value::Float(0.0))]).lobes(), set(&[GlossyTransmission]));
    assert_eq!(of("rough_dielectric", &[("transmittance", Value::Float(0.0))]).lobes(), set(&[GlossyReflection]));
    assert_eq!(of("emitter", &[]).lobes(), LobeSet::NONE);
}

#[test]
fn ambient_light_meets_the_diffuse_colour_or_its_own() {
    let of = |name: &str, params: &Map| build(name, params, 1.0).bsdf.ambient();
    assert_eq!(of("lambert", &parse(&[("reflectance", Value::Float(0.25))])), Light([0.25, 0.25, 0.25, 0.0]));
    let own = parse(&[("diffuse", Value::Float(0.25)), ("ambient", Value::from([0.5, 0.0, 0.125]))]);
    assert_eq!(of("phong", &own), Light([0.5, 0.0, 0.125, 0.0]));
    assert_eq!(of("blinn_phong", &parse(&[("diffuse", Value::Float(0.25))])), Light([0.25, 0.25, 0.25, 0.0]));
    for name in ["mirror", "dielectric", "rough_mirror", "rough_dielectric", "emitter"] {
        assert!(of(name, &Map::default()).is_black());
    }
}
