//! Scenes whose radiance is 1 by construction, for every sampler, camera, integrator and accelerator that is listed.

use crate::support::{expose, noisy, prepared};
use kirkas_render::camera::CAMERAS;
use kirkas_render::catalog::ACCELERATORS;
use kirkas_render::integrators::INTEGRATORS;
use kirkas_render::sampler::SAMPLERS;

/// Integrators that follow no light from one matte surface to another, nor from the sky to a matte surface.
const MIRRORS_ONLY: [&str; 1] = ["whitted"];

/// Integrators whose pixels do not err each by itself: a particle is seen in many.
const SHARED_PARTICLES: [&str; 1] = ["light"];

struct Scene {
    name: &'static str,
    body: &'static str,
    /// Light bounces off matte or rough surfaces.
    is_matte: bool,
}

const SCENES: [Scene; 10] = [
    Scene { name: "nothing before a white sky", body: "[background]\ncolor = 1\n", is_matte: false },
    Scene {
        name: "inside a lamp",
        body: "[materials.lamp]\ntype = \"emitter\"\ntwo_sided = true\n[objects.room]\ntype = \"sphere\"\nradius = 20\nmaterial = \"lamp\"\n",
        is_matte: false,
    },
    // M = E + rho M = 1 with rho = E = 1/2.
    Scene {
        name: "inside a lamp that reflects",
        body: "[materials.lamp]\ntype = \"emitter\"\nintensity = 0.5\nreflectance = 0.5\ntwo_sided = true\n[objects.room]\ntype = \"sphere\"\nradius = 20\nmaterial = \"lamp\"\n",
        is_matte: true,
    },
    Scene {
        name: "a perfect mirror",
        body: "[background]\ncolor = 1\n[materials.silver]\ntype = \"mirror\"\nreflectance = 1\n[objects.ring]\ntype = \"torus\"\nmaterial = \"silver\"\n",
        is_matte: false,
    },
    Scene {
        name: "clear glass",
        body: "[background]\ncolor = 1\n[materials.glass]\ntype = \"dielectric\"\n[objects.ball]\ntype = \"sphere\"\nmaterial = \"glass\"\n",
        is_matte: false,
    },
    Scene {
        name: "perfect white under the sky",
        body: "[background]\ncolor = 1\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n[objects.ring]\ntype = \"torus\"\nmaterial = \"white\"\n",
        is_matte: true,
    },
    Scene {
        name: "a holed blend of white and silver under the sky",
        body: "[background]\ncolor = 1\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n[materials.silver]\ntype = \"mirror\"\nreflectance = 1\n[materials.net]\ntype = \"mask\"\nmaterial = \"white\"\nopacity = 0.6\n[materials.mixed]\ntype = \"blend\"\nfirst = \"net\"\nsecond = \"silver\"\namount = 0.4\n[materials.sheet]\ntype = \"two_sided\"\nfront = \"mixed\"\n[objects.ring]\ntype = \"torus\"\nmaterial = \"sheet\"\n",
        is_matte: true,
    },
    Scene {
        name: "a ball of mist that swallows nothing",
        body: "[background]\ncolor = 1\n[materials.hull]\ntype = \"hull\"\ninterior = \"mist\"\n[objects.ball]\ntype = \"sphere\"\nmaterial = \"hull\"\n[media.mist]\ntype = \"homogeneous\"\nscattering = 1.5\nphase = \"lobe\"\n[phases.lobe]\ntype = \"henyey_greenstein\"\ng = 0.7\n",
        is_matte: true,
    },
    // rho / (1 - rho) I / (pi R^2) = 1 with rho = 1/2 and R = 20.
    Scene {
        name: "a room around a point",
        body: "[materials.half]\ntype = \"lambert\"\nreflectance = 0.5\n[objects.room]\ntype = \"sphere\"\nradius = 20\nmaterial = \"half\"\n[lights.bulb]\ntype = \"point\"\nunit = \"W/sr\"\nintensity = 1256.6370614359173\n",
        is_matte: true,
    },
    // M = rho (F L + (1 - F) M) = 1 with rho = 1/2 and F = (1/4)^2.
    Scene {
        name: "a room around a lamp",
        body: "[materials.half]\ntype = \"lambert\"\nreflectance = 0.5\n[objects.room]\ntype = \"sphere\"\nradius = 20\nmaterial = \"half\"\n[materials.lamp]\ntype = \"emitter\"\nintensity = 17\n[objects.lamp]\ntype = \"sphere\"\nradius = 5\nmaterial = \"lamp\"\nvisible = false\n",
        is_matte: true,
    },
];

#[track_caller]
fn check(scene: &Scene, integrator: &str, sampler: &str, camera: &str, accelerator: &str, pixels: u32) {
    if scene.is_matte && MIRRORS_ONLY.contains(&integrator) {
        return;
    }
    let settings = match integrator {
        "whitted" => "max_depth = 40\nmin_contribution = 0\n",
        "light" => "particles = 2048\n",
        "photon" => "photons = 4096\n",
        _ => "",
    };
    let p = prepared(&format!(
        "[integrator]\ntype = \"{integrator}\"\n{settings}[sampler]\ntype = \"{sampler}\"\nsamples = 64\n[accelerator]\ntype = \"{accelerator}\"\n\
         [film]\nwidth = {pixels}\nheight = {pixels}\n[cameras.eye]\ntype = \"{camera}\"\nposition = [0.3, 1.2, 2.2]\nlook_at = [0, 0, 0]\n{}",
        scene.body
    ));
    let (film, _) = expose(&p, 0..64);
    let (mean, variance) = noisy(&film);
    for (m, v) in mean.iter().zip(&variance) {
        // Some thousand values: six standard errors, and what a tree of 40 bounces cuts off. Particles also find what covers too little
        // of a pixel for one of its 64 rays to see, and so to count it as not sky.
        let unseen = if SHARED_PARTICLES.contains(&integrator) { 1.0 / 64.0 } else { 0.0 };
        let slack = 6.0 * v.sqrt() + 2e-3 + unseen;
        assert!((m - 1.0).abs() < slack, "{}: {m} by {integrator} {sampler} {camera} {accelerator}", scene.name);
    }
    // All pixels together; the channels of each share their noise, and those that particles fly to share the particles.
    if SHARED_PARTICLES.contains(&integrator) {
        return;
    }
    let (all, pixels) = (mean.iter().sum::<f64>() / mean.len() as f64, mean.len() as f64 / 3.0);
    let slack = 5.0 * variance.iter().step_by(3).sum::<f64>().sqrt() / pixels + 1e-3;
    assert!((all - 1.0).abs() < slack, "{}: {all} by {integrator} {sampler} {camera} {accelerator}", scene.name);
}

#[test]
fn the_answer_is_one_for_every_integrator() {
    for scene in &SCENES {
        for integrator in INTEGRATORS {
            check(scene, integrator.spec.name, "sobol", "perspective", "bvh8", 6);
        }
    }
}

#[test]
fn the_answer_is_one_for_every_sampler_and_camera() {
    for scene in &SCENES {
        for integrator in INTEGRATORS {
            for sampler in SAMPLERS {
                for camera in CAMERAS {
                    check(scene, integrator.spec.name, sampler.name, camera.name, "bvh8", 2);
                }
            }
        }
    }
}

#[test]
fn the_answer_is_one_for_every_accelerator() {
    for scene in &SCENES {
        for integrator in INTEGRATORS {
            for (accelerator, _) in ACCELERATORS {
                check(scene, integrator.spec.name, "sobol", "perspective", accelerator.name, 2);
            }
        }
    }
}
