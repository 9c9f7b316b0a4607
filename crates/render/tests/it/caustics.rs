//! The curves that a mirroring ring draws on the floor within it, against their closed forms.

use crate::support::{expose, pixel, prepared};
use std::f64::consts::PI;

/// Parallel light in a mirroring ring: the envelope of the mirrored rays is a nephroid, its cusp half a radius from the middle.
#[test]
fn a_mirroring_ring_draws_a_nephroid_with_its_cusp_at_half_the_radius() {
    let (irradiance, pixels_wide) = (PI, 160);
    let body = format!(
        "[integrator]\ntype = \"photon\"\nphotons = 200000\nradius = 0.02\nmax_depth = 2\n\
         [materials.silver]\ntype = \"mirror\"\nreflectance = 1\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n\
         [objects.ring]\ntype = \"cylinder\"\nfrom = [0, 0, 0]\nto = [0, 0.05, 0]\ncaps = false\nmaterial = \"silver\"\nvisible = false\n\
         [objects.floor]\ntype = \"rectangle\"\nedge_u = [0, 0, 3]\nedge_v = [3, 0, 0]\nmaterial = \"white\"\n\
         [lights.sun]\ntype = \"directional\"\nunit = \"W/m2\"\nintensity = {irradiance}\ndirection = [1, -0.05, 0]\n\
         [film]\nwidth = {pixels_wide}\nheight = 1\nfilter = \"box\"\n\
         [cameras.eye]\ntype = \"orthographic\"\nposition = [0, 1, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\nheight = 0.0125\n"
    );
    // Along the axis, from -1 to 1, the light of one reflection ends in a spike at the cusp.
    let film = expose(&prepared(&body), 0..8).0;
    let row: Vec<f64> = (0..pixels_wide).map(|x| pixel(&film, x, 0)[1]).collect();
    let place = |x: usize| (x as f64 + 0.5) / f64::from(pixels_wide) * 2.0 - 1.0;
    let inside = (0..row.len()).filter(|&x| (0.1..0.9).contains(&place(x)));
    let cusp = place(inside.max_by(|&a, &b| row[a].total_cmp(&row[b])).unwrap());
    println!("cusp at {cusp}");
    assert!((cusp - 0.5).abs() < 0.03, "the cusp is at {cusp}: {row:.2?}");
}

/// A lamp on the rim of a mirroring ring of radius 1: the mirrored ray from the rim at angle t, measured from the lamp, goes on to
/// the rim at 2 t, and these chords touch a cardioid. (Along the floor; how high the lamp hangs changes the brightness only.)
#[test]
fn a_lamp_on_the_rim_of_a_mirroring_ring_draws_a_cardioid_with_its_cusp_at_a_third_of_the_radius() {
    let (wide, step) = (161_u32, 2.0 / 161.0);
    for integrator in ["type = \"light\"\nparticles = 200000", "type = \"photon\"\nphotons = 200000\nradius = 0.02"] {
        let body = format!(
            "[integrator]\n{integrator}\nmax_depth = 2\n\
             [materials.silver]\ntype = \"mirror\"\nreflectance = 1\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n\
             [objects.ring]\ntype = \"cylinder\"\nfrom = [0, 0, 0]\nto = [0, 1.2, 0]\ncaps = false\nmaterial = \"silver\"\nvisible = false\n\
             [objects.floor]\ntype = \"rectangle\"\nedge_u = [0, 0, 2]\nedge_v = [2, 0, 0]\nmaterial = \"white\"\n\
             [lights.lamp]\ntype = \"point\"\nposition = [-0.999, 1, 0]\nintensity = 10\n\
             [film]\nwidth = {wide}\nheight = {wide}\nfilter = \"box\"\n\
             [cameras.eye]\ntype = \"orthographic\"\nposition = [0, 2, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\nheight = 2\n"
        );
        let film = expose(&prepared(&body), 0..16).0;
        let place = |i: u32| (f64::from(i) + 0.5) * step - 1.0;
        let cell = |at: f64| (((at + 1.0) / step) as u32).min(wide - 1);
        // What the ring adds to the light that comes straight from the lamp, which falls off with the cube of the distance.
        let mirrored = |x: u32, y: u32| {
            let squared = (place(x) + 0.999).powi(2) + place(y).powi(2) + 1.0;
            pixel(&film, x, y)[1] - 10.0 / PI / squared.powf(1.5)
        };
        // The brightest place of the upper half of a column, and of the half of the axis beyond the middle.
        let column =
            |x: f64| (0..wide / 2).max_by(|&a, &b| mirrored(cell(x), a).total_cmp(&mirrored(cell(x), b))).unwrap();
        let axis = |y: u32| (cell(0.1)..cell(0.9)).max_by(|&a, &b| mirrored(a, y).total_cmp(&mirrored(b, y))).unwrap();
        let cusp = place(axis(wide / 2));
        println!("{integrator}: cusp at {cusp}");
        assert!((cusp - 1.0 / 3.0).abs() < 0.04, "{integrator}: the cusp is at {cusp}");
        for degrees in [50.0_f64, 60.0, 70.0, 80.0] {
            let t = degrees.to_radians();
            let (x, y) = (-(2.0 * t.cos() + (2.0 * t).cos()) / 3.0, (2.0 * t.sin() + (2.0 * t).sin()) / 3.0);
            let edge = -place(column(x));
            println!("{degrees}: at {x:.4} the edge is {edge:.4} from the axis; the cardioid {y:.4}");
            assert!((edge - y).abs() < 0.02, "{integrator}: at {x} the edge is {edge} from the axis, not {y}");
        }
    }
}
