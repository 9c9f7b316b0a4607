//! Lights are sampled with the density that rays which find them by themselves are told.

use crate::support::prepared;
use kirkas_accel::Query;
use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_geometry::{DVec3, Ray, Vec3};
use kirkas_optics::Lanes;
use kirkas_render::scene::{SECONDARY, Scene, SurfaceHit};
use kirkas_testkit::{ChiSquare, integrate_sphere};
use std::f64::consts::PI;

const HEAD: &str = "[cameras.eye]\ntype = \"perspective\"\nposition = [0, 0, 0]\nlook_at = [0, 0, 1]\nshutter = [0, 1]\n\
    [materials.glow]\ntype = \"emitter\"\ntwo_sided = true\n[objects.lamp]\nmaterial = \"glow\"\n";

/// One lamp each, seen from the origin.
const LAMPS: [(&str, &str); 9] = [
    ("rectangle", "type = \"rectangle\"\ncenter = [0.3, 0.5, 2]\nedge_u = [2, 0, 0.5]\nedge_v = [0, 1, 0]\n"),
    ("disk", "type = \"disk\"\ncenter = [1, 2, 0.5]\nnormal = [0, 1, 1]\nradius = 0.7\n"),
    ("box", "type = \"box\"\nmin = [1, 1, 1]\nmax = [2, 3, 4]\n"),
    ("box around", "type = \"box\"\nmin = [-1, -1, -1]\nmax = [2, 3, 4]\n"),
    ("sphere", "type = \"sphere\"\ncenter = [0, 3, 1]\nradius = 1.2\n"),
    ("sphere around", "type = \"sphere\"\ncenter = [0, 0.3, 0]\nradius = 1.2\n"),
    (
        "mesh",
        "type = \"mesh\"\nvertices = [[1, 0, 2], [2, 0, 2], [1, 1, 2.5], [-1, 1, 1]]\nfaces = [0, 1, 2, 0, 2, 3]\n",
    ),
    (
        "moving",
        "type = \"rectangle\"\ncenter = [0, 0, 2]\nedge_u = [2, 0, 0]\nedge_v = [0, 1, 0]\n\
         motion = [{ time = 0, transform = [{ scale = [1, 2, 1] }, { rotate = [1, 0, 0, 40] }] }, { time = 1, transform = [{ scale = [1, 2, 1] }, { rotate = [1, 0, 0, 40] }, { translate = [0.5, 0, 0] }] }]\n",
    ),
    (
        "moving ball",
        "type = \"sphere\"\ncenter = [0, 0, 3]\n\
         motion = [{ time = 0, transform = [{ scale = 0.5 }] }, { time = 1, transform = [{ scale = 0.5 }, { translate = [1, 0, 0] }] }]\n",
    ),
];

const TIME: f32 = 0.5;

fn look(scene: &Scene, direction: Vec3) -> Option<SurfaceHit> {
    let ray = Ray { origin: Vec3::ZERO, direction, t_min: 0.0, t_max: f32::INFINITY, time: TIME, mask: SECONDARY };
    let hit = scene.accel.closest_hit(&ray, Query::ALL, 0, &mut Default::default())?;
    Some(scene.surface(&ray, &hit))
}

#[test]
fn a_ray_towards_a_sampled_point_is_told_the_density_of_the_sample() {
    for (what, lamp) in LAMPS {
        let p = prepared(&format!("{HEAD}{lamp}"));
        let mut compared = 0;
        for i in 0..300 {
            let u = owen_sobol_2d(i, 5);
            let Some(s) = p.scene.sample_light(&Lanes::RGB, &p.scene.lights[0], DVec3::ZERO, f64::from(TIME), u) else {
                continue;
            };
            let hit = look(&p.scene, s.direction.as_vec3()).unwrap_or_else(|| panic!("{what}: missed"));
            // A box's own far side is hidden by its near one.
            if (hit.position - s.target.unwrap().position).length() > 1e-3 {
                continue;
            }
            assert_eq!(p.scene.light_of(&hit), Some(0), "{what}");
            let pdf = p.scene.light_pdf(0, &hit, DVec3::ZERO, f64::from(TIME));
            assert!((pdf - s.pdf).abs() <= 1e-4 * s.pdf, "{what}: {pdf} instead of {}", s.pdf);
            compared += 1;
        }
        assert!(compared > 100, "{what}: {compared}");
    }
}

#[test]
fn the_density_integrates_to_one_over_all_that_rays_can_see() {
    const RAYS: u32 = 40_000;
    for (what, lamp) in LAMPS.into_iter().filter(|l| l.0 != "box") {
        let p = prepared(&format!("{HEAD}{lamp}"));
        let density = |i| {
            let hit = look(&p.scene, square_to_uniform_sphere(owen_sobol_2d(i, 3)))?;
            Some(f64::from(p.scene.light_pdf(0, &hit, DVec3::ZERO, f64::from(TIME))))
        };
        let integral = (0..RAYS).filter_map(density).sum::<f64>() * 4.0 * PI / f64::from(RAYS);
        assert!((integral - 1.0).abs() < 0.01, "{what}: {integral}");
    }
}

const SKIES: [&str; 4] = [
    "color = [0.2, 0.5, 1]\n",
    "type = \"gradient\"\nup = [1, 2, 0]\nstops = [[-0.5, 0.2], [0.5, 0.6], [0.9, 0.1]]\n",
    "type = \"gradient\"\nstops = [[-1, 0], [0, 0], [0, 1], [1, 1]]\n",
    "type = \"gradient\"\nup = [0, 0, -1]\nstops = [[-1, 1], [0.25, 0], [0.5, [0, 0, 3]], [1, 0]]\n",
];

fn sky(words: &str) -> kirkas_render::Prepared {
    prepared(&format!("{HEAD}{}[background]\n{words}", LAMPS[0].1))
}

#[test]
fn backgrounds_are_sampled_in_proportion_to_what_they_send() {
    for words in SKIES {
        let p = sky(words);
        let number = p.scene.background_light.unwrap();
        let light = &p.scene.lights[number as usize];
        let sample = |u| p.scene.sample_light(&Lanes::RGB, light, DVec3::ZERO, 0.0, u);
        let pdf = |d: Vec3| p.scene.background.seen(&Lanes::RGB, d.as_dvec3().normalize()).1;
        let result = ChiSquare::default().run(|_, u| sample(u).map(|s| s.direction.as_vec3()), pdf);
        assert!(result.p_value > 1e-3, "{words}: {result:?}");

        let total = integrate_sphere(|d| p.scene.background.radiance(&Lanes::RGB, d).sum());
        for i in 0..200 {
            let s = sample(owen_sobol_2d(i, 1)).unwrap();
            let truth = pdf(s.direction.as_vec3());
            assert!((s.pdf - truth).abs() <= 1e-4 * truth, "{words}: {} instead of {truth}", s.pdf);
            assert!((s.light.sum() / total - 1.0).abs() < 1e-3, "{words}: {} of {total}", s.light.sum());
        }
    }
}

#[test]
fn a_black_background_is_no_light() {
    assert_eq!(sky("color = 0\n").scene.background_light, None);
}

#[test]
fn every_light_of_a_scene_can_be_picked() {
    let p = sky(SKIES[0]);
    let picker = &p.scene.picker;
    let sum: f32 = (0..p.scene.lights.len() as u32).map(|n| picker.probability(DVec3::ZERO, DVec3::Y, n)).sum();
    assert!((sum - 1.0).abs() < 1e-6);
    assert!((0..p.scene.lights.len() as u32).all(|n| picker.probability(DVec3::ZERO, DVec3::Y, n) > 0.0));
}
