//! Fresnel and Snell against `references/analytic.json` ("truths") and hand calculation.

use crate::near;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{atan, cos, sin};
use kirkas_optics::fresnel::*;
use kirkas_optics::medium::transmittance;
use kirkas_optics::{Light, Medium};

/// `2 int F(mu) mu dmu` by Simpson's rule; `F` bends sharply at grazing, hence `mu = s^2`.
fn diffuse(f: impl Fn(f32) -> f32) -> f64 {
    const N: u32 = 20_000;
    let value = |i: u32| {
        let s = f64::from(i) / f64::from(N);
        f64::from(f((s * s) as f32)) * 4.0 * s * s * s
    };
    let sum: f64 = (0..=N).map(|i| value(i) * if i == 0 || i == N { 1.0 } else { f64::from(2 + 2 * (i % 2)) }).sum();
    sum / (3.0 * f64::from(N))
}

#[test]
fn fresnel_meets_the_reference_values() {
    // "Fresnel n=1.5 normal R", "Fresnel n=1.5 60deg (Rs,Rp,mean)"
    near(dielectric(1.0, 1.0, 1.5), 0.04, 1e-7);
    near(dielectric(1.0, 1.5, 1.0), 0.04, 1e-7);
    let (s, p) = dielectric_polarised(0.5, 1.0, 1.5);
    near(s, 0.176571488083, 1e-7);
    near(p, 0.00180193752159, 1e-7);
    near(dielectric(0.5, 1.0, 1.5), 0.0891867128022, 1e-7);
    // "Brewster n=1.5"
    let brewster = cos(atan(1.5)) as f32;
    near(atan(1.5).to_degrees(), 56.3099324740202, 1e-10);
    near(dielectric_polarised(brewster, 1.0, 1.5).1, 0.0, 1e-12);
    assert!(dielectric_polarised(brewster, 1.0, 1.5).0 > 0.14);
    // From inside, at cosine 0.8 (by sin^2(t-u)/sin^2(t+u) and tan^2 likewise).
    let (s, p) = dielectric_polarised(0.8, 1.5, 1.0);
    near(s, 0.21817437860721697, 1e-6);
    near(p, 0.010107821835490511, 1e-6);
    // Grazing: all; matched: nothing.
    near(dielectric(0.0, 1.0, 1.5), 1.0, 1e-6);
    near(dielectric(0.3, 1.3, 1.3), 0.0, 1e-12);
}

#[test]
fn total_reflection_begins_at_the_critical_angle() {
    // "Critical n=1.5", "Snell window n=1.333 full angle"
    let at = |degrees: f64| cos(degrees.to_radians()) as f32;
    assert!(refracted_cosine(at(41.8103 - 0.01), 1.5, 1.0).is_some());
    assert!(refracted_cosine(at(41.8103 + 0.01), 1.5, 1.0).is_none());
    assert_eq!(dielectric(at(41.82), 1.5, 1.0), 1.0);
    assert_eq!(dielectric_schlick(at(41.82), 1.5, 1.0), 1.0);
    assert!(dielectric(at(41.5), 1.5, 1.0) < 0.7);
    let half = 97.2132527833805 / 2.0;
    assert!(refracted_cosine(at(half - 0.01), 1.333, 1.0).is_some());
    assert!(refracted_cosine(at(half + 0.01), 1.333, 1.0).is_none());
    assert!(refracted_cosine(0.001, 1.0, 1.5).is_some());
}

#[test]
fn diffuse_reflectances_meet_their_integrals() {
    // "diffuse Fresnel reflectance external n=1.5", "... internal ...", "diffuse Fresnel ext n=1.333"
    near(diffuse(|mu| dielectric(mu, 1.0, 1.5)), 0.0917779593423512, 1e-6);
    near(diffuse(|mu| dielectric(mu, 1.5, 1.0)), 0.596345759707712, 1e-5);
    near(diffuse(|mu| dielectric(mu, 1.0, 1.333)), 0.0664057647830795, 1e-6);
}

#[test]
fn slabs_add_up_their_echoes() {
    // Both faces, all orders, without interference: "Incoherent slab n=1.5 normal: T,R" and "... 60deg T".
    let slab = |r: f64, tau: f64| {
        let (mut t, mut back, mut inside) = (0.0, r, (1.0 - r) * tau);
        for _ in 0..200 {
            t += inside * (1.0 - r);
            inside *= r * tau;
            back += inside * (1.0 - r);
            inside *= r * tau;
        }
        (t, back)
    };
    let (t, r) = slab(f64::from(dielectric(1.0, 1.0, 1.5)), 1.0);
    near(t, 0.923076923077, 1e-6);
    near(r, 0.0769230769231, 1e-6);
    let (s, p) = dielectric_polarised(0.5, 1.0, 1.5);
    near(0.5 * (slab(f64::from(s), 1.0).0 + slab(f64::from(p), 1.0).0), 0.8481284097288, 1e-6);
    // "absorbing slab n=1.5 normal, tau=e^-1"; "Beer-Lambert sigma=0.5,d=2"
    let tau = transmittance(Light([0.5, 0.0, 1.0, 0.0]), 2.0);
    near(tau[0], 0.367879441171442, 1e-7);
    near(tau[2], 0.1353352832366127, 1e-7);
    assert_eq!((tau[1], tau[3]), (1.0, 1.0));
    let (t, r) = slab(0.04, f64::from(tau[0]));
    near(t, 0.339111122903, 1e-7);
    near(r, 0.0449900804155, 1e-7);
    // Clear stays clear at any distance, and what absorbs is black at the end of the world.
    assert_eq!(transmittance(Light([0.0, 1.0, 0.0, 0.0]), f32::INFINITY), Light([1.0, 0.0, 1.0, 1.0]));
    assert_eq!(Medium::VACUUM.ior.at_d_line(), 1.0);
}

#[test]
fn schlick_takes_the_cosine_on_the_thin_side() {
    near(dielectric_schlick(1.0, 1.0, 1.5), 0.04, 1e-7);
    near(dielectric_schlick(0.5, 1.0, 1.5), 0.07, 1e-7);
    // From inside at 30 degrees: outside the sine is 0.75.
    near(dielectric_schlick(0.75_f32.sqrt(), 1.5, 1.0), 0.04427034925264154, 1e-6);
    near(dielectric_schlick(0.0, 1.0, 1.5), 1.0, 1e-6);
    assert_eq!(dielectric_schlick(0.1, 1.3, 1.3), 0.0);
    near(schlick(0.2, 0.5), 0.2 + 0.8 / 32.0, 1e-7);
    assert_eq!(schlick(0.2, 1.0), 0.2);
    near(schlick(0.2, 0.0), 1.0, 1e-7);
    assert_eq!(schlick(0.2, 1.000_001), 0.2);
}

#[test]
fn refraction_keeps_the_tangential_part_in_proportion() {
    let n = Vec3::new(0.36, 0.48, 0.8);
    for (wo, eta_o, eta_i) in [
        (Vec3::new(0.1, 0.9, 0.3).normalize(), 1.0_f32, 1.5_f32),
        (Vec3::new(0.4, 0.3, 0.9).normalize(), 1.5, 1.0),
        (Vec3::new(-0.3, 0.5, 0.5).normalize(), 1.33, 1.1),
    ] {
        let wi = refract(wo, n, eta_o, eta_i).unwrap();
        near(wi.length(), 1.0, 1e-6);
        assert!(wo.dot(n) > 0.0 && wi.dot(n) < 0.0);
        let tangential = |w: Vec3| w - n * w.dot(n);
        assert!((tangential(wo) * eta_o + tangential(wi) * eta_i).length() < 1e-6);
        let mirrored = reflect(wo, n);
        assert!((mirrored - n * mirrored.dot(n) + tangential(wo)).length() < 1e-6);
        near(mirrored.dot(n), wo.dot(n), 1e-6);
    }
    // 30 degrees onto n = 1.5: the sine goes from 0.5 to a third.
    let wo = Vec3::new(sin(0.5235987755982988) as f32, 0.0, cos(0.5235987755982988) as f32);
    near(refract(wo, Vec3::Z, 1.0, 1.5).unwrap().x, -1.0 / 3.0, 1e-6);
    near(refract(wo, Vec3::Z, 1.5, 1.0).unwrap().x, -0.75, 1e-6);
    assert!(refract(Vec3::new(0.8, 0.0, 0.6), Vec3::Z, 1.5, 1.0).is_none());
    assert_eq!(refract(wo, Vec3::Z, 1.4, 1.4).unwrap(), -wo);
    near(refracted_cosine(0.8, 1.0, 1.5).unwrap(), 0.84_f64.sqrt(), 1e-6);
}
