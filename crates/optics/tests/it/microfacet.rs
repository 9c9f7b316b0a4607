//! Facets: closed forms, normalisations, sampling, losses.

use crate::near;
use kirkas_geometry::Vec3;
use kirkas_optics::microfacet::albedo::Losses;
use kirkas_optics::microfacet::{Distribution, Facets, LEAST_ALPHA};
use kirkas_testkit::furnace::directions_above;
use kirkas_testkit::{ChiSquare, integrate_sphere, sidak};
use std::f64::consts::PI;

fn above(f: impl Fn(Vec3) -> f64) -> f64 {
    integrate_sphere(|h| if h.z > 0.0 { f(h) } else { 0.0 })
}

#[test]
fn d_and_g_meet_hand_calculation() {
    let g = Facets::ggx(0.5);
    near(g.d(Vec3::Z), 4.0 / PI, 1e-6);
    // 45 degrees: 0.25 / (pi (0.5 (0.25 - 1) + 1)^2)
    let s = 0.5_f32.sqrt();
    near(g.d(Vec3::new(s, 0.0, s)), 0.25 / (PI * 0.390625), 1e-6);
    near(g.d(Vec3::new(0.0, s, s)), 0.25 / (PI * 0.390625), 1e-6);
    // 60 degrees: tan^2 = 3, Lambda = (sqrt(1.75) - 1) / 2
    let w = Vec3::new(0.75_f32.sqrt(), 0.0, 0.5);
    near(g.lambda(w), 0.16143782776614762, 1e-6);
    near(g.lambda(Vec3::new(0.0, w.x, -w.z)), 0.16143782776614762, 1e-6);
    near(g.g1(w), 0.8610017480861209, 1e-6);
    let v = Vec3::new(0.0, -0.6, 0.8);
    let lambda_v = 0.5 * ((1.0 + 0.25 * 0.5625_f64).sqrt() - 1.0);
    near(g.g2_reflection(w, v), 1.0 / (1.0 + 0.16143782776614762 + lambda_v), 1e-6);
    near(g.g2_transmission(w, v), 0.8610017480861209 / (1.0 + lambda_v), 1e-6);
    assert_eq!((g.lambda(Vec3::Z), g.g1(Vec3::Z)), (0.0, 1.0));
    assert_eq!(g.g1(Vec3::X), 0.0);
    // Density of visible normals: G1 D (wo.h) / wo.z
    let h = Vec3::new(0.0, s, s);
    near(g.visible_normal_pdf(v, h), f64::from(g.g1(v) * g.d(h)) * 0.1414213562373095 / 0.8, 1e-6);
    near(g.visible_normal_pdf(w, Vec3::Z), 0.8610017480861209 * 4.0 / PI, 1e-5);
    assert_eq!(g.visible_normal_pdf(Vec3::new(0.0, -0.96, 0.28), h), 0.0);
}

#[test]
fn tiny_roughness_is_raised() {
    assert_eq!(Facets::ggx(0.0), Facets::ggx(LEAST_ALPHA));
    assert_ne!(Facets::ggx(0.002), Facets::ggx(LEAST_ALPHA));
    near(Facets::ggx(0.0).d(Vec3::Z), 1.0 / (PI * 1e-6), 1.0);
}

/// Round and stretched, with long tails and without.
fn kinds() -> Vec<Facets> {
    let mut all: Vec<Facets> = [0.1, 0.4, 1.0].map(Facets::ggx).to_vec();
    all.push(Facets::new(Distribution::Ggx, (0.6, 0.15)));
    all.push(Facets::new(Distribution::Beckmann, (0.2, 0.2)));
    all.push(Facets::new(Distribution::Beckmann, (0.9, 0.9)));
    all.push(Facets::new(Distribution::Beckmann, (0.2, 0.8)));
    all
}

#[test]
fn projected_areas_add_up() {
    for g in kinds() {
        // Walter et al. 2007, equation 4: the projected area of all facets is that of the surface.
        near(above(|h| f64::from(g.d(h) * h.z)), 1.0, 2e-4);
        for wo in directions_above(5, 0.1) {
            // Heitz 2014, equation 14: so is that of the visible ones from any side.
            near(above(|h| f64::from(g.g1(wo) * g.d(h) * wo.dot(h).max(0.0))), f64::from(wo.z), 2e-4);
            near(above(|h| f64::from(g.visible_normal_pdf(wo, h))), 1.0, 4e-4);
        }
    }
}

#[test]
fn visible_normals_are_drawn_as_they_are_seen() {
    let threshold = sidak(0.01, kinds().len() * 5);
    let mut seed = 100;
    for g in kinds() {
        for wo in directions_above(5, 0.05) {
            seed += 1;
            let test = ChiSquare { seed, ..Default::default() };
            let pdf = |h: Vec3| if h.z > 0.0 { g.visible_normal_pdf(wo, h) } else { 0.0 };
            let r = test.run(|_, u| Some(g.sample_visible_normal(wo, u)), pdf);
            assert!(r.p_value > threshold, "{g:?}, wo {wo}: {r:?}");
            assert_eq!(r.drawn, 1.0);
        }
    }
}

/// White facets keep what the quadrature of their lobe says, between the nodes of the table too.
#[test]
fn the_table_of_losses_holds_what_white_facets_lose() {
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for alpha in [0.08, 0.25, 0.5, 0.77, 1.0] {
            let g = Facets::new(distribution, (alpha, alpha));
            let losses = Losses::new(&g);
            for wo in directions_above(6, 0.05) {
                let kept = above(|wi| {
                    let h = (wo + wi).normalize();
                    f64::from(g.d(h) * g.g2_reflection(wo, wi) / (4.0 * wo.z))
                });
                near(1.0 - f64::from(losses.at(wo.z)), kept, 2.5e-3);
            }
        }
    }
    // Nothing is lost by smooth ones.
    assert!(Losses::new(&Facets::ggx(0.0)).at(0.5) < 1e-3);
}
