//! Shining meshes are asked piece by piece: the same light as from the whole.

use crate::support::{assert_agree, expose, prepared};
use kirkas_accel::Query;
use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_geometry::{DVec3, Ray, Vec3};
use kirkas_optics::Lanes;
use kirkas_render::Prepared;
use kirkas_render::scene::SECONDARY;
use std::f64::consts::PI;
use std::fmt::Write;

/// A wavy sheet of `n * n * 2` triangles over the unit square, with texture coordinates.
fn sheet(n: usize) -> String {
    let (mut vertices, mut uvs, mut faces) = (String::new(), String::new(), String::new());
    for i in 0..=n {
        for j in 0..=n {
            let (x, z) = (i as f64 / n as f64, j as f64 / n as f64);
            let y = if (i + 2 * j) % 3 == 0 { 0.1 } else { 0.0 };
            write!(vertices, "[{x}, {y}, {z}], ").unwrap();
            write!(uvs, "{x}, {z}, ").unwrap();
            if i < n && j < n {
                let a = i * (n + 1) + j;
                write!(faces, "{a}, {}, {}, {}, {}, {}, ", a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2).unwrap();
            }
        }
    }
    format!("type = \"mesh\"\nvertices = [{vertices}]\nuvs = [{uvs}]\nfaces = [{faces}]\n")
}

/// A textured sheet above, one behind that moves and is stretched, one that stands, over a floor.
fn scene(integrator: &str) -> String {
    let sheet = sheet(8);
    format!(
        "[integrator]\n{integrator}\nmax_depth = 3\n[film]\nwidth = 12\nheight = 9\nfilter = \"box\"\n\
         [sampler]\ntype = \"independent\"\nsamples = 1024\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0, 3, 6]\nlook_at = [0, 0.6, 0]\nfov = 50\nshutter = [0, 1]\n\
         [textures.spots]\ntype = \"checker\"\nscale = 4\na = 0\nb = [1, 0.7, 0.3]\n\
         [materials.spotted]\ntype = \"emitter\"\nradiance = \"spots\"\nintensity = 3\ntwo_sided = true\n\
         [materials.lamp]\ntype = \"emitter\"\nradiance = [1, 2, 3]\nreflectance = 0.3\n\
         [materials.white]\ntype = \"lambert\"\nreflectance = 0.6\n\
         [objects.floor]\ntype = \"plane\"\nmaterial = \"white\"\n\
         [objects.above]\n{sheet}material = \"spotted\"\ntransform = [{{ scale = 5 }}, {{ translate = [-3, 1.5, -3] }}]\n\
         [objects.behind]\n{sheet}material = \"lamp\"\ntransform = [{{ rotate = [1, 0, 0, 80] }}]\n\
         motion = [{{ time = 0, transform = [{{ scale = [3, 1, 1] }}, {{ translate = [-1, 1, -2] }}] }}, \
         {{ time = 1, transform = [{{ scale = [3, 1, 1] }}, {{ translate = [-1, 1.5, -2] }}] }}]\n"
    )
}

fn exposed(integrator: &str) -> (Prepared, kirkas_render::Film) {
    let p = prepared(&scene(integrator));
    let film = expose(&p, 0..p.samples).0;
    (p, film)
}

#[test]
fn pieces_give_the_light_that_whole_lamps_give() {
    let (p, pieces) = exposed("type = \"path\"");
    assert!(p.scene.pieces.len() == 256 && p.scene.lights.len() == 2, "{}", p.scene.pieces.len());
    for integrator in ["type = \"path\"\nlight_selection = \"uniform\"", "type = \"path_simple\""] {
        let (p, whole) = exposed(integrator);
        assert_eq!(p.scene.lights.len(), 2);
        assert_agree(integrator, &pieces, &whole);
    }
}

#[test]
fn a_piece_is_sampled_with_the_density_that_rays_are_told() {
    let p = prepared(&scene("type = \"path\""));
    let (scene, from, time) = (&p.scene, DVec3::new(0.5, 0.4, -0.3), 0.3);
    let mut integral = 0.0;
    let mut probability = 0.0;
    let mut compared = 0;
    let look = |direction: Vec3| {
        let ray = Ray {
            origin: from.as_vec3(),
            direction,
            t_min: 0.0,
            t_max: f32::INFINITY,
            time: time as f32,
            mask: SECONDARY,
        };
        let hit = scene.accel.closest_hit(&ray, Query::ALL, 0, &mut Default::default())?;
        Some(scene.surface(&ray, &hit))
    };
    let lights = scene.lights.len() as u32;
    for number in 0..lights + scene.pieces.len() as u32 {
        let chance = scene.picker.probability(from, DVec3::ZERO, number);
        assert!(number >= lights || chance == 0.0, "a lamp in pieces is picked as a whole");
        probability += f64::from(chance);
        for i in 0..20 {
            let u = owen_sobol_2d(i, 5);
            let Some(s) = scene.sample_picked(&Lanes::RGB, number, from, time, u).filter(|_| number >= lights) else {
                continue;
            };
            let Some(hit) = look(s.direction.as_vec3()) else { continue };
            if (hit.position - s.target.unwrap().position).length() > 1e-3 {
                continue;
            }
            // Close to an edge a ray may find the neighbour.
            let Some(found) = scene.pickable_of(&hit).filter(|n| *n == number) else { continue };
            let pdf = scene.light_pdf(found, &hit, from, time);
            assert!((pdf - s.pdf).abs() <= 1e-3 * s.pdf, "{pdf} instead of {}", s.pdf);
            compared += 1;
        }
    }
    assert!((probability - 1.0).abs() < 1e-4 && compared > 300, "{probability} {compared}");

    // Over all that is seen, what is told is at most the whole; what hides behind something else is missing.
    const RAYS: u32 = 40_000;
    for i in 0..RAYS {
        let Some(hit) = look(square_to_uniform_sphere(owen_sobol_2d(i, 3))) else { continue };
        let Some(number) = scene.pickable_of(&hit) else { continue };
        let chance = f64::from(scene.picker.probability(from, DVec3::ZERO, number));
        integral += chance * f64::from(scene.light_pdf(number, &hit, from, time)) * 4.0 * PI / f64::from(RAYS);
    }
    assert!(integral > 0.6 && integral < 1.01, "{integral}");
}
