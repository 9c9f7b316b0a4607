//! Physics by number: rendered pictures against closed forms (`references/analytic.json` of the project's notes).

use crate::support::{Rgb, assert_near, expose, grey, pixels, prepared, render, seen};
use std::f64::consts::PI;

/// A white background above the plane of y = 0, black below.
const WHITE_ABOVE: &str = "[background]\ntype = \"gradient\"\nstops = [[-1, 0], [0, 0], [0, 1], [1, 1]]\n";
const WHITE_BELOW: &str = "[background]\ntype = \"gradient\"\nstops = [[-1, 1], [0, 1], [0, 0], [1, 0]]\n";

/// A diver looks up: all above the water is in a disc of 2 asin(1/n).
#[test]
fn snells_window_is_97_degrees_wide() {
    let scene = |width: u32, height: u32| {
        format!(
            "{WHITE_ABOVE}[film]\nwidth = {width}\nheight = {height}\nfilter = \"point\"\n[sampler]\nsamples = 1\n
             [integrator]\nmin_contribution = 0\n
             [cameras.diver]\ntype = \"perspective\"\nposition = [0, -3, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\nfov = 120\nfov_axis = \"horizontal\"
             [materials.water]\ntype = \"dielectric\"\nior = 1.333\n[objects.sea]\ntype = \"plane\"\nmaterial = \"water\"\n"
        )
    };
    // Across a row: where the light begins and ends.
    let width = 8000;
    let row = pixels(&render(&scene(width, 1)));
    let lit: Vec<usize> = (0..row.len()).filter(|&i| row[i][1] > 0.0).collect();
    assert_eq!(lit.len(), lit[lit.len() - 1] - lit[0] + 1, "one window, without holes");
    let half = lit.len() as f64 / f64::from(width) * 60.0_f64.to_radians().tan();
    let angle = 2.0 * half.atan().to_degrees();
    let pixel = 2.0 * 60.0_f64.to_radians().tan() / f64::from(width) * 0.44_f64.to_degrees();
    assert!((angle - 97.213_252_783_380_5).abs() < pixel, "{angle} +- {pixel}");
    // The whole disc, by its area.
    let side = 300;
    let disc = pixels(&render(&scene(side, side)));
    let share = disc.iter().filter(|p| p[1] > 0.0).count() as f64 / disc.len() as f64;
    let angle = 2.0 * (2.0 * (share / PI).sqrt() * 60.0_f64.to_radians().tan()).atan().to_degrees();
    assert!((angle - 97.213_252_783_380_5).abs() < 0.1, "{angle}");
    // The camera's exposure does not depend on the water it stands in: straight up only Fresnel's 2 % are missing.
    let up = disc[(side * side / 2 + side / 2) as usize][1];
    assert_near(up, 1.0 - (0.333_f64 / 2.333).powi(2), 1e-4);
}

/// A ray that meets the surface of glass at `degrees` from its normal.
fn at_angle(body: &str, degrees: f64) -> f64 {
    let (s, c) = degrees.to_radians().sin_cos();
    grey(body, [5.0 * s, 5.0 * c, 0.0], [0.0; 3], 1)
}

#[test]
fn glass_mirrors_what_fresnel_says() {
    let glass = |fresnel: &str| {
        format!("{WHITE_ABOVE}[integrator]\nmin_contribution = 0\nmax_depth = 1\n[materials.glass]\ntype = \"dielectric\"\n{fresnel}
                 [objects.sea]\ntype = \"plane\"\nmaterial = \"glass\"\n")
    };
    assert_near(at_angle(&glass(""), 0.0), 0.04, 1e-5);
    assert_near(at_angle(&glass(""), 60.0), 0.089_186_712_802_2, 1e-5);
    // Brewster's angle: the half that is polarised across is mirrored, ((n^2 - 1) / (n^2 + 1))^2 of it.
    assert_near(at_angle(&glass(""), 56.309_932_474_020_2), 0.5 * (1.25_f64 / 3.25).powi(2), 1e-4);
    let schlick = 0.04 + 0.96 * 0.5_f64.powi(5);
    assert_near(at_angle(&glass("fresnel = \"schlick\""), 60.0), schlick, 1e-5);
    let constant = glass("fresnel = \"constant\"\nreflectance = 0.3");
    assert_near(at_angle(&constant, 0.0), 0.3, 1e-6);
    assert_near(at_angle(&constant, 80.0), 0.3, 1e-6);
    assert_near(at_angle(&glass("reflectance = 0.5"), 0.0), 0.02, 1e-5);
    assert_near(at_angle(&glass("ior = 2.0"), 0.0), 1.0 / 9.0, 1e-5);
}

#[test]
fn a_sphere_of_glass_mirrors_4_percent_at_its_middle() {
    let ball = "[background]\ntype = \"gradient\"\nup = [0, 0, 1]\nstops = [[-1, 0], [0, 0], [0, 1], [1, 1]]\n[integrator]\nmax_depth = 1
                [materials.glass]\ntype = \"dielectric\"\n[objects.ball]\ntype = \"sphere\"\nmaterial = \"glass\"\n";
    assert_near(grey(ball, [0.0, 0.0, 5.0], [0.0; 3], 1), 0.04, 1e-5);
}

#[test]
fn a_metal_mirrors_what_schlick_says() {
    let metal = |kind: &str| {
        format!(
            "{WHITE_ABOVE}[materials.metal]\ntype = \"mirror\"\nreflectance = 0.5\nfresnel = \"{kind}\"\n[objects.sea]\ntype = \"plane\"\nmaterial = \"metal\"\n"
        )
    };
    assert_near(at_angle(&metal("schlick"), 60.0), 0.5 + 0.5 * 0.5_f64.powi(5), 1e-5);
    assert_near(at_angle(&metal("constant"), 60.0), 0.5, 1e-6);
}

/// A pane passes light after any number of reflections inside: (1 - r) / (1 + r), and less where it absorbs.
#[test]
fn a_pane_of_glass_passes_the_whole_series() {
    let pane = |background: &str, absorption: f64| {
        format!("{background}[integrator]\nmin_contribution = 0\nmax_depth = 40\n[materials.glass]\ntype = \"dielectric\"\nabsorption = {absorption:?}
                 [objects.pane]\ntype = \"box\"\nmin = [-500, -2, -500]\nmax = [500, 0, 500]\nmaterial = \"glass\"\n")
    };
    assert_near(at_angle(&pane(WHITE_BELOW, 0.0), 0.0), 0.923_076_923_077, 1e-5);
    assert_near(at_angle(&pane(WHITE_ABOVE, 0.0), 0.0), 0.076_923_076_923_1, 1e-5);
    assert_near(at_angle(&pane(WHITE_BELOW, 0.5), 0.0), 0.339_111_122_903, 1e-5);
    assert_near(at_angle(&pane(WHITE_ABOVE, 0.5), 0.0), 0.044_990_080_415_5, 1e-5);
    // Without polarisation the mean of R enters the series, not each alone.
    let r = 0.089_186_712_802_2;
    assert_near(at_angle(&pane(WHITE_BELOW, 0.0), 60.0), (1.0 - r) / (1.0 + r), 1e-5);
}

#[test]
fn light_fades_exponentially_in_coloured_glass() {
    let body = "[background]\ncolor = 1\n[materials.glass]\ntype = \"dielectric\"\nior = 1.5\nfresnel = \"constant\"\nreflectance = 0
                absorption = [0.5, 0.25, 0]\n[objects.glass]\ntype = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = \"glass\"\n";
    let [r, g, b] = seen(body, [0.0, 0.0, 4.0], [0.0; 3], 1);
    assert_near(r, 0.367_879_441_171_442, 1e-6);
    assert_near(g, 0.606_530_659_712_633, 1e-6);
    assert_eq!(b, 1.0);
}

// ---- irradiance

/// What a lamp sends to the origin of a grey floor of y = 0, from the floor's brightness: E = pi L / rho.
fn irradiance_towards(lamp: &str, normal: &str, eye: Rgb) -> f64 {
    let body = format!(
        "{lamp}\n[materials.grey]\ntype = \"lambert\"\nreflectance = 0.5\n
         [objects.floor]\ntype = \"disk\"\nradius = 0.25\nnormal = {normal}\nmaterial = \"grey\"\n"
    );
    grey(&body, eye, [0.0; 3], 16) * PI / 0.5
}

fn irradiance(lamp: &str) -> f64 {
    irradiance_towards(lamp, "[0, 1, 0]", [3.0, 0.4, 0.2])
}

fn glowing(shape: &str) -> String {
    format!("[materials.lamp]\ntype = \"emitter\"\nsamples = 4096\n[objects.lamp]\nmaterial = \"lamp\"\n{shape}")
}

#[test]
fn the_irradiance_below_area_lights_is_the_closed_form() {
    let square = "type = \"rectangle\"\ncenter = [0, 1, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]";
    let corner = "type = \"rectangle\"\ncenter = [0.5, 1, 0.5]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]";
    let disk = "type = \"disk\"\ncenter = [0, 1, 0]\nnormal = [0, -1, 0]";
    let ring = "type = \"disk\"\ncenter = [0, 1, 0]\nnormal = [0, -1, 0]\ninner_radius = 0.5";
    let sphere = "type = \"sphere\"\ncenter = [0, 2, 0]";
    // Lambert's polygon in the frame x, y, z -> x, z, -y.
    let triangle = "type = \"triangle\"\nvertices = [[1, 1, 0], [-1, 1, 1], [0, 1, -1]]";
    let mesh =
        "type = \"mesh\"\nvertices = [[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]]\nfaces = [0, 1, 2, 0, 2, 3]";
    let truths = [
        (square, 1.740_839_502_734_21),
        (corner, 0.435_209_875_683_552),
        (disk, PI * 0.5),
        (ring, PI * (0.5 - 0.2)),
        (sphere, PI * 0.25),
        (triangle, 0.943_574_809_119_968),
        (mesh, 1.740_839_502_734_21),
    ];
    for (shape, truth) in truths {
        assert_near(irradiance(&glowing(shape)), truth, 0.002);
    }
}

/// A sphere that the floor sees whole, off its normal: E = pi L (R / D)^2 cos(theta).
#[test]
fn a_tilted_floor_gets_the_cosine() {
    let sphere = glowing("type = \"sphere\"\ncenter = [0, 2, 0]\nradius = 0.5");
    let tilted = irradiance_towards(&sphere, "[0.8, 0.6, 0]", [3.0, 1.0, 0.2]);
    assert_near(tilted, PI / 16.0 * 0.6, 0.002);
}

/// Groups, instances, stretching, motion: the same lamp by other ways.
#[test]
fn a_lamp_shines_the_same_however_it_got_to_its_place() {
    let head = "[materials.lamp]\ntype = \"emitter\"\nsamples = 4096\n";
    let square = "type = \"rectangle\"\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]";
    let stretched = format!(
        "{head}[objects.lamp]\nmaterial = \"lamp\"\n{square}\ntransform = [{{ scale = [2, 5, 2] }}, {{ translate = [0, 1, 0] }}]"
    );
    let instanced = format!(
        "{head}[objects.g]\ntype = \"group\"\ntemplate = true\n[objects.lamp]\nmaterial = \"lamp\"\nparent = \"g\"\n{square}
         transform = [{{ scale = [1, 1, 4] }}]\n[objects.i]\ntype = \"instance\"\nof = \"g\"\ntransform = [{{ scale = [2, 3, 0.5] }}, {{ translate = [0, 1, 0] }}]"
    );
    let moved = format!(
        "{head}[objects.lamp]\nmaterial = \"lamp\"\n{square}\nmotion = [{{ time = -1, transform = [{{ scale = 2 }}] }}, {{ time = 1, transform = [{{ scale = 2 }}, {{ translate = [0, 2, 0] }}] }}]"
    );
    let ball = format!(
        "{head}[objects.g]\ntype = \"group\"\ntemplate = true\n[objects.lamp]\ntype = \"sphere\"\nradius = 0.25\nmaterial = \"lamp\"\nparent = \"g\"
         [objects.i]\ntype = \"instance\"\nof = \"g\"\ntransform = [{{ scale = 4 }}, {{ rotate = [1, 1, 0, 50] }}, {{ translate = [0, 2, 0] }}]"
    );
    for (lamp, truth) in [
        (&stretched, 1.740_839_502_734_21),
        (&instanced, 1.740_839_502_734_21),
        (&moved, 1.740_839_502_734_21),
        (&ball, PI * 0.25),
    ] {
        assert_near(irradiance(lamp), truth, 0.002);
    }
}

#[test]
fn point_lights_fade_with_the_square_or_with_the_classics_polynomial() {
    let lamp = |height: f64, more: &str| {
        irradiance(&format!("[lights.l]\ntype = \"point\"\nposition = [0, {height:?}, 0]\nunit = \"W/sr\"\n{more}"))
    };
    assert_near(lamp(1.0, ""), 1.0, 1e-6);
    assert_near(lamp(4.0, ""), 1.0 / 16.0, 1e-6);
    assert_near(lamp(4.0, "attenuation = [0.5, 0.25, 3]"), 1.0 / 12.0, 1e-6);
    assert_near(lamp(4.0, "attenuation = [0, 0, 1]\nintensity = 3"), 3.0, 1e-6);
    // Off the normal: the cosine, and the longer way.
    let aside = irradiance("[lights.l]\ntype = \"point\"\nposition = [0, 3, 4]\nunit = \"W/sr\"\n");
    assert_near(aside, 0.6 / 25.0, 1e-6);
}

#[test]
fn units_of_light_mean_what_they_say() {
    let point = |unit: &str, intensity: f64| {
        irradiance(&format!(
            "[lights.l]\ntype = \"point\"\nposition = [0, 1, 0]\nunit = \"{unit}\"\nintensity = {intensity:?}"
        ))
    };
    assert_near(point("plain", 1.0), PI, 1e-6);
    assert_near(point("W/sr", 2.0), 2.0, 1e-6);
    assert_near(point("W", 4.0 * PI), 1.0, 1e-6);
    assert_near(point("cd", 683.0), 1.0, 1e-6);
    assert_near(point("lm", 683.0 * 4.0 * PI), 1.0, 1e-6);
    let sun = |unit: &str, intensity: f64| {
        irradiance(&format!("[lights.l]\ntype = \"directional\"\nunit = \"{unit}\"\nintensity = {intensity:?}"))
    };
    assert_near(sun("plain", 0.5), 0.5 * PI, 1e-6);
    assert_near(sun("lux", 1366.0), 2.0, 1e-6);
    assert_near(sun("W/m2", 3.0), 3.0, 1e-6);
    let tilted = irradiance("[lights.l]\ntype = \"directional\"\nunit = \"W/m2\"\ndirection = [3, -4, 0]");
    assert_near(tilted, 0.8, 1e-6);
    // Full in the hot spot, half (on average) up to the falloff cone: the power goes into that many steradians.
    let (hot, end) = (20.0_f64.to_radians().cos(), 30.0_f64.to_radians().cos());
    let solid_angle = 2.0 * PI * (1.0 - 0.5 * (hot + end));
    let spot = |unit: &str, intensity: f64| {
        irradiance(&format!(
            "[lights.l]\ntype = \"spot\"\nposition = [0, 1, 0]\nunit = \"{unit}\"\nintensity = {intensity:?}"
        ))
    };
    assert_near(spot("W", solid_angle), 1.0, 1e-6);
    assert_near(spot("lm", 683.0 * solid_angle), 1.0, 1e-6);
    assert_near(spot("cd", 683.0), 1.0, 1e-6);
}

#[test]
fn watts_and_lumens_count_the_light_of_all_channels() {
    let body = |unit: &str, intensity: f64| {
        format!("[lights.l]\ntype = \"point\"\nposition = [0, 1, 0]\ncolor = [0.5, 0.25, 1]\nunit = \"{unit}\"\nintensity = {intensity:?}
                 [materials.white]\ntype = \"lambert\"\nreflectance = 1\n[objects.floor]\ntype = \"plane\"\nmaterial = \"white\"\n")
    };
    let e = |unit: &str, intensity: f64| seen(&body(unit, intensity), [3.0, 0.4, 0.2], [0.0; 3], 1).map(|l| l * PI);
    let watt = e("W", 4.0 * PI);
    assert_near((watt[0] + watt[1] + watt[2]) / 3.0, 1.0, 1e-6);
    assert_near(watt[2] / watt[1], 4.0, 1e-6);
    let luminance = |e: Rgb| 0.2126 * e[0] + 0.7152 * e[1] + 0.0722 * e[2];
    assert_near(luminance(e("cd", 683.0)), 1.0, 1e-6);
    assert_near(luminance(e("lm", 683.0 * 4.0 * PI)), 1.0, 1e-6);
    assert_near(e("plain", 1.0)[0], 0.5 * PI, 1e-6);
}

/// The lamp itself, as the camera sees it: 2 x 3 scene units.
#[test]
fn lamps_look_as_bright_as_their_unit_says() {
    let lamp = |unit: &str, intensity: f64, more: &str| {
        let body = format!(
            "[materials.lamp]\ntype = \"emitter\"\nunit = \"{unit}\"\nintensity = {intensity:?}\n{more}
             [objects.lamp]\ntype = \"rectangle\"\nedge_u = [2, 0, 0]\nedge_v = [0, 3, 0]\nmaterial = \"lamp\"\n"
        );
        grey(&body, [0.0, 0.0, 4.0], [0.0; 3], 1)
    };
    assert_near(lamp("plain", 2.0, ""), 2.0, 1e-6);
    assert_near(lamp("W/m2/sr", 2.0, "radiance = 0.25"), 0.5, 1e-6);
    assert_near(lamp("nit", 683.0, ""), 1.0, 1e-6);
    assert_near(lamp("W", 6.0 * PI, ""), 1.0, 1e-6);
    assert_near(lamp("W", 6.0 * PI, "two_sided = true"), 0.5, 1e-6);
    assert_near(lamp("lm", 683.0 * 6.0 * PI, ""), 1.0, 1e-6);
    // An instance twice as large spreads the same power over four times the area.
    let grown = "[materials.lamp]\ntype = \"emitter\"\nunit = \"W\"\nintensity = 100\n[objects.g]\ntype = \"group\"\ntemplate = true
                 [objects.lamp]\ntype = \"rectangle\"\nedge_u = [2, 0, 0]\nedge_v = [0, 3, 0]\nmaterial = \"lamp\"\nparent = \"g\"
                 [objects.i]\ntype = \"instance\"\nof = \"g\"\ntransform = [{ scale = 2 }]\n";
    assert_near(grey(grown, [0.0, 0.0, 4.0], [0.0; 3], 1), 100.0 / (24.0 * PI), 1e-6);
}

/// A spot's cones as a row of pixels: full, half in the middle of the cosines, nothing.
#[test]
fn a_spot_is_full_in_its_hotspot_and_ends_at_its_falloff() {
    let toml = "[film]\nwidth = 400\nheight = 1\nfilter = \"point\"\n[sampler]\nsamples = 1\n[cameras.plan]\ntype = \"orthographic\"
        position = [0, 5, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\nheight = 0.01\n
        [lights.l]\ntype = \"spot\"\nposition = [0, 1, 0]\nunit = \"W/sr\"\nhotspot = 20\nfalloff_angle = 40
        [materials.white]\ntype = \"lambert\"\nreflectance = 1\n[objects.floor]\ntype = \"plane\"\nmaterial = \"white\"\n";
    let film = render(toml);
    let (hot, end) = (20.0_f64.to_radians().cos(), 40.0_f64.to_radians().cos());
    for (i, p) in pixels(&film).iter().enumerate() {
        let x = (i as f64 + 0.5 - 200.0) * 0.01;
        let cos = 1.0 / (1.0 + x * x).sqrt();
        let s = ((cos - end) / (hot - end)).clamp(0.0, 1.0);
        // Cosine at the floor and distance: cos^3.
        let truth = s * s * (3.0 - 2.0 * s) * cos * cos * cos / PI;
        assert!((p[1] - truth).abs() < 1e-6, "{x}: {} is not {truth}", p[1]);
    }
}

/// The error of 4096 stratified shadow rays is far below that of as many random ones, and a pixel's own variance tells it.
#[test]
fn the_film_knows_its_noise() {
    let lamp = glowing("type = \"rectangle\"\ncenter = [0, 1, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]")
        .replace("samples = 4096", "samples = 1");
    let body = format!("{lamp}\n[sampler]\ntype = \"independent\"\nsamples = 4096\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n[objects.floor]\ntype = \"plane\"\nmaterial = \"white\"
        [film]\nwidth = 8\nheight = 8\nfilter = \"point\"\n[cameras.c]\ntype = \"perspective\"\nposition = [3, 0.4, 0.2]\nlook_at = [0, 0, 0]\nfov = 0.01\n");
    let p = prepared(&body);
    let (film, _) = expose(&p, 0..4096);
    let truth = 1.740_839_502_734_21 / PI;
    let mut z2 = 0.0;
    for (_, _, tile, i) in film.pixels() {
        let sigma = f64::from(tile.variance_of_mean(i)[1]).sqrt();
        let z = (f64::from(tile.mean(i)[1]) - truth) / sigma;
        assert!(sigma > 0.0 && z.abs() < 4.5, "{z}");
        z2 += z * z;
    }
    // Chi-square with 64 degrees of freedom: 64 +- 11.
    assert!((25.0..110.0).contains(&z2), "{z2}");
}
