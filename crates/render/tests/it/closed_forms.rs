//! Light whose amount is known in closed form, as `path` finds it. The values are those of the literature (Howell's catalogue of
//! view factors; Lambert's formula for polygons; Born & Wolf for slabs).

use crate::support::{assert_near, assert_shows, one_pixel, render, seen};
use kirkas_render::Film;
use std::f64::consts::{E, PI};

const DIRECT: &str = "[integrator]\ntype = \"path\"\nmax_depth = 1\n";
const DEEP: &str = "[integrator]\ntype = \"path\"\nmax_depth = 4000\n";
const WHITE: &str = "[materials.white]\ntype = \"lambert\"\nreflectance = 1\n[materials.lamp]\ntype = \"emitter\"\n";
/// A white floor at y = 0; a pixel that looks at its origin shows the irradiance there over pi.
const FLOOR: &str =
    "[objects.floor]\ntype = \"rectangle\"\nedge_u = [1, 0, 0]\nedge_v = [0, 0, -1]\nmaterial = \"white\"\n";
const ORIGIN: [f64; 3] = [0.0; 3];

/// The pixel at which light from the origin arrives, of independent samples: they know their own noise.
fn look(body: &str, from: [f64; 3], samples: u32) -> Film {
    let toml = one_pixel(body, from, ORIGIN, samples);
    render(&toml.replace("[sampler]\n", "[sampler]\ntype = \"independent\"\n"))
}

/// Irradiance at the origin, from above, under a lamp of radiance 1.
#[track_caller]
fn check_irradiance(lamp: &str, truth: f64) {
    let body = format!("{DIRECT}{WHITE}{FLOOR}[objects.lamp]\nmaterial = \"lamp\"\n{lamp}");
    assert_shows(&look(&body, [3.0, 0.6, 0.1], 4096), truth / PI, 1e-2);
}

#[test]
fn polygons_discs_and_spheres_light_a_point_as_the_formulas_say() {
    // A square of edge 2 above its middle; of edge 1 above its corner; Lambert's polygon.
    let square = |center: &str, edge: f64| {
        format!("type = \"rectangle\"\ncenter = {center}\nedge_u = [{edge}, 0, 0]\nedge_v = [0, 0, {edge}]\n")
    };
    check_irradiance(&square("[0, 1, 0]", 2.0), 1.740_839_502_734_21);
    check_irradiance(&square("[0.5, 1, 0.5]", 1.0), 0.435_209_875_683_552);
    let triangle = "type = \"mesh\"\nvertices = [[1, 1, 0], [0, 1, 1], [-1, 1, -1]]\nfaces = [0, 1, 2]\n";
    let flipped = triangle.replace("[0, 1, 2]", "[0, 2, 1]");
    let lit = |mesh: &str| {
        let body = format!("{DIRECT}{WHITE}{FLOOR}[objects.lamp]\nmaterial = \"lamp\"\n{mesh}");
        seen(&body, [3.0, 0.6, 0.1], ORIGIN, 16_384)[1] * PI
    };
    assert_near(lit(triangle) + lit(&flipped), 0.943_574_809_119_968, 2e-3);
    // A disc: pi r^2 / (r^2 + h^2). A sphere: pi (R / D)^2, and times the cosine where it is off the normal.
    check_irradiance("type = \"disk\"\ncenter = [0, 1, 0]\nnormal = [0, -1, 0]\nradius = 1\n", PI * 0.5);
    check_irradiance("type = \"sphere\"\ncenter = [0, 2, 0]\nradius = 1\n", PI * 0.25);
    check_irradiance("type = \"sphere\"\ncenter = [1.2, 1.6, 0]\nradius = 0.5\n", PI / 16.0 * 0.8);
}

/// What a white face of the xz plane shows on the average, seen from straight above in a picture of one pixel.
#[track_caller]
fn check_mean_over_face(height: f64, body: &str, truth: f64) {
    let toml = format!(
        "{DIRECT}{WHITE}{body}[film]\nwidth = 1\nheight = 1\nfilter = \"box\"\n[sampler]\ntype = \"independent\"\nsamples = 65536\n\
         [cameras.eye]\ntype = \"orthographic\"\nposition = [0, 9, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\nheight = {height:?}\n"
    );
    assert_shows(&render(&toml), truth, 5e-3);
}

#[test]
fn form_factors_of_squares_and_discs() {
    // Parallel unit squares at distance 1; perpendicular ones with a common edge; coaxial discs. The lamps are hidden from the eye.
    let hidden = "[objects.lamp]\nmaterial = \"lamp\"\nvisible = false\n";
    let parallel =
        format!("{FLOOR}{hidden}type = \"rectangle\"\ncenter = [0, 1, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]\n");
    check_mean_over_face(1.0, &parallel, 0.199_824_895_698_387);
    let wall = format!(
        "{FLOOR}{hidden}type = \"rectangle\"\ncenter = [0, 0.5, -0.5]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\n"
    );
    check_mean_over_face(1.0, &wall, 0.200_043_776_075_403);
    for (radius, truth) in [(1.0, 0.381_966_011_250_105), (2.0, 0.763_932_022_500_21)] {
        let discs = format!(
            "[objects.floor]\ntype = \"disk\"\nnormal = [0, 1, 0]\nmaterial = \"white\"\n\
             {hidden}type = \"disk\"\ncenter = [0, 1, 0]\nnormal = [0, -1, 0]\nradius = {radius:?}\n"
        );
        // The disc fills pi / 4 of the picture.
        check_mean_over_face(2.0, &discs, truth * PI / 4.0);
    }
}

#[test]
fn light_bounces_in_closed_rooms_as_often_as_it_must() {
    // A lamp of radius 1 within a room of radius 2: M = rho (F21 + F22 M) with F21 = 1/4, F22 = 3/4.
    for rho in [0.2, 0.5, 0.9] {
        let body = format!(
            "{DEEP}{WHITE}[materials.wall]\ntype = \"lambert\"\nreflectance = {rho}\n\
             [objects.room]\ntype = \"sphere\"\nradius = 2\nmaterial = \"wall\"\n[objects.lamp]\ntype = \"sphere\"\nmaterial = \"lamp\"\n"
        );
        let truth = rho * 0.25 / (1.0 - 0.75 * rho);
        let toml = one_pixel(&body, [0.0, 0.0, 1.8], [1.0, 0.5, 1.9], 16_384);
        assert_shows(&render(&toml.replace("[sampler]\n", "[sampler]\ntype = \"independent\"\n")), truth, 2e-2);
    }
    // A convex body in light from everywhere shows its reflectance.
    let convex = format!(
        "{DEEP}[background]\ncolor = 1\n[materials.half]\ntype = \"lambert\"\nreflectance = 0.5\n[objects.ball]\ntype = \"sphere\"\nmaterial = \"half\"\n"
    );
    assert_shows(&look(&convex, [3.0, 1.0, 0.2], 4096), 0.5, 1e-2);
}

#[test]
fn a_room_that_glows_and_reflects_shows_the_glow_over_what_is_lost() {
    let room = "type = \"sphere\"\nradius = 2\n";
    let tent = "type = \"mesh\"\nvertices = [[-3, -2, -2], [3, -2, -2], [0, -2, 4], [0, 3, 0]]\n\
                faces = [0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0]\n";
    for (shape, glow, rho) in [(room, 0.3, 0.2), (room, 1.0, 0.8), (tent, 0.3, 0.5), (tent, 2.0, 0.9)] {
        for integrator in ["path", "path_simple"] {
            let body = format!(
                "[integrator]\ntype = \"{integrator}\"\nmax_depth = 4000\n[materials.glow]\ntype = \"emitter\"\n\
                 intensity = {glow:?}\nreflectance = {rho}\ntwo_sided = true\n[objects.room]\nmaterial = \"glow\"\n{shape}"
            );
            assert_shows(&look(&body, [0.3, 0.1, 0.4], 16_384), glow / (1.0 - rho), 2e-2);
        }
    }
}

/// White behind (-z), black before.
const WHITE_BELOW: &str =
    "[background]\ntype = \"gradient\"\nup = [0, 0, 1]\nstops = [[-1, 1], [0, 1], [0, 0], [1, 0]]\n";
const WHITE_ABOVE: &str =
    "[background]\ntype = \"gradient\"\nup = [0, 0, 1]\nstops = [[-1, 0], [0, 0], [0, 1], [1, 1]]\n";

#[track_caller]
fn check_pane(background: &str, absorption: f64, from: [f64; 3], truth: f64) {
    let body = format!(
        "{DEEP}{background}[materials.glass]\ntype = \"dielectric\"\nior = 1.5\nabsorption = {absorption:?}\n\
         [objects.pane]\ntype = \"box\"\nmin = [-900, -900, -1]\nmax = [900, 900, 0]\nmaterial = \"glass\"\n"
    );
    assert_shows(&look(&body, from, 65_536), truth, 2e-2);
}

#[test]
fn panes_of_glass_let_through_and_mirror_what_all_orders_together_give() {
    let above = [0.0, 0.0, 5.0];
    check_pane(WHITE_BELOW, 0.0, above, 0.923_076_923_077);
    check_pane(WHITE_ABOVE, 0.0, above, 0.076_923_076_923);
    let (s, c) = 60.0_f64.to_radians().sin_cos();
    // Light is not polarised here: (1 - R) / (1 + R) of the mean R of both polarisations, 0.0891867128 (the true pane, which
    // polarises what it mirrors back and forth, lets 0.84813 through).
    check_pane(WHITE_BELOW, 0.0, [5.0 * s, 0.0, 5.0 * c], 0.910_813_287_2 / 1.089_186_712_8);
    // With tau = 1/e inside.
    check_pane(WHITE_BELOW, 1.0, above, 0.339_111_122_903);
    check_pane(WHITE_ABOVE, 1.0, above, 0.044_990_080_415_5);
}

#[test]
fn a_body_that_only_absorbs_obeys_beer_and_lambert() {
    let body = format!(
        "{DEEP}[background]\ncolor = 1\n[materials.ink]\ntype = \"dielectric\"\nior = 1\nabsorption = 0.5\n\
         [objects.block]\ntype = \"box\"\nmin = [-9, -9, -2]\nmax = [9, 9, 0]\nmaterial = \"ink\"\n"
    );
    assert_near(seen(&body, [0.0, 0.0, 5.0], ORIGIN, 64)[1], 1.0 / E, 1e-5);
}

/// Single scattering by GGX facets with Smith's height-correlated shadowing loses this much.
#[test]
fn rough_metal_in_a_furnace_shows_its_directional_albedo() {
    for (alpha, mu, truth) in [
        (0.1, 1.0, 0.988_315_9),
        (0.25, 0.5, 0.857_263_6),
        (0.5, 1.0, 0.687_848_7),
        (0.5, 0.2, 0.789_929_2),
        (1.0, 1.0, 0.306_852_9),
        (1.0, 0.5, 0.450_693_8),
    ] {
        let body = format!(
            "{DIRECT}[background]\ncolor = 1\n[materials.metal]\ntype = \"rough_mirror\"\nroughness = {alpha:?}\nreflectance = 1\n\
             [objects.sheet]\ntype = \"rectangle\"\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nmaterial = \"metal\"\n"
        );
        let sine = (1.0_f64 - mu * mu).sqrt();
        assert_shows(&look(&body, [5.0 * sine, 0.0, 5.0 * mu], 16_384), truth, 1e-2);
    }
}
