//! Each model's formula at one or two pairs of directions, against numbers computed apart from this code (double precision,
//! from the equations in each manual head).

use crate::models::{build, parse};
use crate::near;
use kirkas_geometry::Vec3;
use kirkas_optics::{Lobe, LobeSet, Mode};
use kirkas_scene::Value;

const WO: Vec3 = Vec3::new(0.6, 0.0, 0.8);
const WI: Vec3 = Vec3::new(0.0, 0.8, 0.6);

/// Value and density in lane 0, from above and (turned over) from below.
#[track_caller]
fn check(name: &str, pairs: &[(&str, Value)], lobes: LobeSet, expected: (f64, f64, f64)) {
    let (radiance, importance, pdf) = expected;
    let case = build(name, &parse(pairs), 1.0);
    let turn = |v: Vec3| Vec3::new(v.x, v.y, -v.z);
    for (wo, wi) in [(WO, WI), (turn(WO), turn(WI))] {
        near(case.bsdf.eval(wo, wi, lobes, Mode::Radiance)[0], radiance, 1e-6);
        near(case.bsdf.eval(wo, wi, lobes, Mode::Importance)[0], importance, 1e-6);
        near(case.bsdf.pdf(wo, wi, lobes, Mode::Radiance), pdf, 1e-6);
    }
    if case.model.medium().is_none() {
        assert!(case.bsdf.eval(WO, turn(WI), lobes, Mode::Radiance).is_black());
        assert_eq!(case.bsdf.pdf(WO, turn(WI), lobes, Mode::Radiance), 0.0);
    }
}

#[test]
fn lambert_is_its_reflectance_over_pi() {
    // 0.3 / pi; 0.6 / pi
    let f = 0.09549296585513721;
    check("lambert", &[("reflectance", Value::Float(0.3))], LobeSet::ALL, (f, f, 0.19098593171027442));
}

fn highlight(form: &str) -> [(&'static str, Value); 4] {
    [
        ("diffuse", Value::Float(0.3)),
        ("specular", Value::Float(0.4)),
        ("exponent", Value::Float(3.0)),
        ("form", Value::from(form)),
    ]
}

#[test]
fn phong_meets_its_equations() {
    // Mixed density: (0.3 * 0.6 / pi + 0.4 * 4 / (2 pi) * 0.48^3) / 0.7
    let glossy = 0.07040505386567555;
    let pdf = (0.3 * 0.19098593171027442 + 0.4 * glossy) / 0.7;
    check("phong", &highlight("normalized"), LobeSet::ALL, (0.130695492787975, 0.130695492787975, pdf));
    check("phong", &highlight("classic"), LobeSet::ALL, (0.1189613171436957, 0.11309422932155608, pdf));
    let only = 0.130695492787975 - 0.3 / std::f64::consts::PI;
    check("phong", &highlight("normalized"), Lobe::GlossyReflection.into(), (only, only, glossy));
    let base = 0.3 / std::f64::consts::PI;
    check("phong", &highlight("classic"), Lobe::DiffuseReflection.into(), (base, base, 0.19098593171027442));
}

#[test]
fn blinn_phong_meets_its_equations() {
    let glossy = 0.09968982008860501;
    let pdf = (0.3 * 0.19098593171027442 + 0.4 * glossy) / 0.7;
    check("blinn_phong", &highlight("normalized"), LobeSet::ALL, (0.18499429635943562, 0.18499429635943562, pdf));
    let swapped = 0.3 / std::f64::consts::PI + (0.20983486695048925 - 0.3 / std::f64::consts::PI) * 0.6 / 0.8;
    check("blinn_phong", &highlight("classic"), LobeSet::ALL, (0.20983486695048925, swapped, pdf));
}

/// Delta lobes that were asked for take their share of the density.
#[test]
fn a_mirror_on_top_takes_its_share() {
    let mut pairs = highlight("normalized").to_vec();
    pairs.push(("reflect", Value::Float(0.7)));
    let scattered = 0.3 * 0.19098593171027442 + 0.4 * 0.07040505386567555;
    let f = 0.130695492787975;
    check("phong", &pairs, LobeSet::ALL, (f, f, scattered / 1.4));
    check("phong", &pairs, LobeSet::NON_DELTA, (f, f, scattered / 0.7));
}

#[test]
fn rough_mirror_meets_its_equations() {
    let rough = ("roughness", Value::Float(0.4));
    let (f, pdf) = (0.12371574778265387, 0.07907147969212017);
    check("rough_mirror", std::slice::from_ref(&rough), LobeSet::ALL, (f, f, pdf));
    let metal = [rough, ("reflectance", Value::Float(0.25)), ("fresnel", Value::from("schlick"))];
    check("rough_mirror", &metal, LobeSet::ALL, (0.03093388593842272, 0.03093388593842272, pdf));
}

#[test]
fn rough_dielectric_meets_walter() {
    let rough = ("roughness", Value::Float(0.4));
    let glass = build("rough_dielectric", &parse(std::slice::from_ref(&rough)), 1.0);
    let all = LobeSet::ALL;
    let one = |lobe| LobeSet::of(lobe);
    // Reflection: F = 0.0416769 times the rough mirror.
    let f = 0.04167694023084846;
    near(glass.bsdf.eval(WO, WI, all, Mode::Radiance)[0], 0.0051560938259523886, 1e-7);
    near(glass.bsdf.pdf(WO, WI, all, Mode::Radiance), f * 0.07907147969212017, 1e-7);
    near(glass.bsdf.pdf(WO, WI, one(Lobe::GlossyReflection), Mode::Radiance), 0.07907147969212017, 1e-7);
    assert!(glass.bsdf.eval(WO, WI, one(Lobe::GlossyTransmission), Mode::Radiance).is_black());
    // Transmission into the glass, then out of it (equation 21 and its Jacobian, equation 17).
    let down = Vec3::new(-0.3, 0.2, -(0.87_f32.sqrt()));
    near(glass.bsdf.eval(WO, down, all, Mode::Radiance)[0], 0.47701893796006223, 2e-6);
    near(glass.bsdf.eval(WO, down, all, Mode::Importance)[0], 1.07329261041014, 5e-6);
    near(glass.bsdf.pdf(WO, down, one(Lobe::GlossyTransmission), Mode::Radiance), 1.0841968142694078, 5e-6);
    near(glass.bsdf.pdf(WO, down, all, Mode::Radiance), (1.0 - 0.07115669810758016) * 1.0841968142694078, 5e-6);
    let (from, to) = (Vec3::new(0.1, 0.2, -(0.95_f32.sqrt())), Vec3::new(0.05, -0.4, 0.8375_f32.sqrt()));
    near(glass.bsdf.eval(from, to, all, Mode::Radiance)[0], 3.0437197333840795, 2e-5);
    near(glass.bsdf.eval(from, to, all, Mode::Importance)[0], 1.3527643259484798, 1e-5);
    near(glass.bsdf.pdf(from, to, one(Lobe::GlossyTransmission), Mode::Radiance), 1.3076124308265564, 1e-5);
    // No facet turns light back on the side it came from: straight on through a wide angle.
    assert!(glass.bsdf.eval(Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.8, 0.0, -0.6), all, Mode::Radiance).is_black());
    assert_eq!(glass.bsdf.pdf(Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.8, 0.0, -0.6), all, Mode::Radiance), 0.0);
    // Schlick and constant weights at the same facets.
    let with = |pairs: &[(&str, Value)]| build("rough_dielectric", &parse(pairs), 1.0).bsdf;
    let schlick = with(&[rough.clone(), ("fresnel", Value::from("schlick"))]);
    near(schlick.eval(WO, WI, all, Mode::Radiance)[0], 0.12371574778265387 * 0.04005120375413302, 1e-7);
    let constant = with(&[
        rough,
        ("fresnel", Value::from("constant")),
        ("reflectance", Value::Float(0.25)),
        ("transmittance", Value::Float(0.5)),
    ]);
    near(constant.eval(WO, WI, all, Mode::Radiance)[0], 0.25 * 0.12371574778265387, 1e-6);
    let whole = 0.5 * 1.07329261041014 / (1.0 - 0.07115669810758016);
    near(constant.eval(WO, down, all, Mode::Radiance)[0], whole, 5e-6);
    near(constant.eval(WO, down, all, Mode::Importance)[0], whole / 2.25, 1e-5);
    near(constant.pdf(WO, down, all, Mode::Radiance), 1.0841968142694078 * 0.5 / 0.75, 5e-6);
}

/// Equal indices are moved a little apart: light goes nearly straight through, and nothing is NaN.
#[test]
fn matched_rough_glass_is_a_window() {
    for ior in [1.0, 1.0005, 0.9995] {
        let glass = build("rough_dielectric", &parse(&[("ior", Value::Float(ior))]), 1.0);
        for wo in [WO, -WO] {
            let s = glass.bsdf.sample(wo, 0.5, (0.3, 0.8), LobeSet::ALL, Mode::Importance).unwrap();
            assert_eq!(s.lobe, Lobe::GlossyTransmission);
            assert!((s.wi + wo).length() < 2e-3 && s.weight().is_finite());
            near(s.weight()[0], 1.0, 0.05);
        }
        let eta = glass.bsdf.sample(WO, 0.5, (0.3, 0.8), LobeSet::ALL, Mode::Radiance).unwrap().eta;
        near(eta, if ior < 1.0 { 0.999 } else { 1.001 }, 1e-6);
    }
    // Just outside the band, indices stay as they are.
    let glass = build("rough_dielectric", &parse(&[("ior", Value::Float(1.002))]), 1.0);
    near(glass.bsdf.sample(WO, 0.5, (0.3, 0.8), LobeSet::ALL, Mode::Radiance).unwrap().eta, 1.002, 1e-6);
}
