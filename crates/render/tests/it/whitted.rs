//! The recursive tracer's rules, each in a scene whose answer can be computed by hand.

use crate::support::{Rgb, assert_near, expose, grey, one_pixel, pixel, prepared, prepared_with, render, seen};
use kirkas_render::integrators::MediumStack;
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, Statistics};

const UP_Z: Rgb = [0.0, 0.0, 5.0];
const ORIGIN: Rgb = [0.0; 3];

/// Two coated mirrors at z = 0 and z = 10; only ambient light, of which a surface sends a quarter back.
fn hall(integrator: &str) -> f64 {
    let body = format!(
        "[integrator]\n{integrator}\n[lights.a]\ntype = \"ambient\"\n
         [materials.coat]\ntype = \"phong\"\ndiffuse = 0.25\nreflect = 0.5\n
         [objects.near]\ntype = \"plane\"\nmaterial = \"coat\"\nnormal = [0, 0, 1]\n
         [objects.far]\ntype = \"plane\"\nmaterial = \"coat\"\npoint = [0, 0, 10]\nnormal = [0, 0, -1]\n"
    );
    grey(&body, UP_Z, ORIGIN, 1)
}

#[test]
fn recursion_ends_at_the_depth() {
    for (depth, sum) in [(0, 1.0), (1, 1.5), (2, 1.75), (5, 1.96875)] {
        assert_eq!(hall(&format!("max_depth = {depth}\nmin_contribution = 0")), 0.25 * sum);
    }
}

/// A ray of exactly the least contribution is still sent.
#[test]
fn recursion_ends_below_the_least_contribution() {
    assert_eq!(hall("min_contribution = 0.25"), 0.25 * 1.75);
    assert_eq!(hall("min_contribution = 0.2500001"), 0.25 * 1.5);
    assert_eq!(hall("min_contribution = 1"), 0.25);
    // The brightest channel decides.
    let body = "[integrator]\nmin_contribution = 0.5\n[background]\ncolor = 1\n[materials.m]\ntype = \"mirror\"\nreflectance = [0.1, 0.6, 0.1]
                [objects.o]\ntype = \"plane\"\nnormal = [0, 0, 1]\nmaterial = \"m\"\n";
    let [r, g, b] = seen(body, UP_Z, ORIGIN, 1);
    assert!((r - 0.1).abs() < 1e-7 && (g - 0.6).abs() < 1e-7 && r == b);
}

#[test]
fn ambient_light_can_be_scaled_and_has_a_colour_of_its_own() {
    assert_eq!(hall("max_depth = 0\nambient = 2"), 0.5);
    assert_eq!(hall("max_depth = 0\nambient = 0"), 0.0);
    let body = |material: &str| {
        format!("[lights.a]\ntype = \"ambient\"\ncolor = [1, 0.5, 0.25]\nintensity = 2\ngroup = \"hack\"\n[materials.m]\n{material}
                 [objects.o]\ntype = \"sphere\"\nmaterial = \"m\"\n[film]\nlight_groups = true\nwidth = 1\nheight = 1\nfilter = \"point\"\n
                 [sampler]\nsamples = 1\n[cameras.c]\ntype = \"perspective\"\n")
    };
    let film = render(&body("type = \"phong\"\ndiffuse = 0.5\nambient = [0.25, 0.5, 1]"));
    assert_eq!(pixel(&film, 0, 0), [0.5, 0.5, 0.5]);
    let plane = film.layout.groups.iter().position(|g| g == "hack").expect("the light's group");
    assert_eq!(film.tiles[0].plane_mean(0, plane), [0.5; 3]);
    assert_eq!(pixel(&render(&body("type = \"lambert\"\nreflectance = 0.25")), 0, 0), [0.5, 0.25, 0.125]);
    assert_eq!(pixel(&render(&body("type = \"mirror\"")), 0, 0), [0.0; 3]);
}

/// A floor at z = 0 that a lamp lights with brightness 1, and what stands at z = 2 between them; the eye looks from the side.
fn under(shadows: &str, lamp: &str, between: &str) -> Rgb {
    let body = format!(
        "[integrator]\nshadows = \"{shadows}\"\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n
         [objects.floor]\ntype = \"disk\"\nradius = 0.5\nnormal = [0, 0, 1]\nmaterial = \"white\"\n{lamp}\n{between}\n
         [materials.red]\ntype = \"dielectric\"\ntransmittance = [0.5, 0.25, 1]\n
         [materials.green]\ntype = \"phong\"\ntransmit = [0.5, 1, 0]\nior = 1\n[materials.grey]\ntype = \"lambert\"\n
         [materials.coated]\ntype = \"phong\"\n"
    );
    seen(&body, [3.0, 0.0, 1.0], ORIGIN, 1)
}

fn pane(name: &str, z: f64, material: &str) -> String {
    format!(
        "[objects.{name}]\ntype = \"rectangle\"\ncenter = [0, 0, {z:?}]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nmaterial = \"{material}\"\n"
    )
}

#[test]
fn shadows_are_none_opaque_or_transparent() {
    let bulb = "[lights.l]\ntype = \"point\"\nposition = [0, 0, 4]\nintensity = 16\n";
    let sun = "[lights.l]\ntype = \"directional\"\ndirection = [0, 0, -1]\n";
    let near = |a: Rgb, b: Rgb| assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-6), "{a:?} is not {b:?}");
    for lamp in [bulb, sun] {
        let under = |shadows, between: &str| under(shadows, lamp, between);
        for shadows in ["none", "opaque", "transparent"] {
            near(under(shadows, ""), [1.0; 3]);
        }
        let wall = pane("wall", 2.0, "grey");
        near(under("none", &wall), [1.0; 3]);
        near(under("opaque", &wall), [0.0; 3]);
        near(under("transparent", &wall), [0.0; 3]);
        near(under("transparent", &pane("coated", 2.0, "coated")), [0.0; 3]);
        // Tints multiply.
        let panes = pane("a", 2.0, "red") + &pane("b", 1.5, "green");
        near(under("none", &panes), [1.0; 3]);
        near(under("opaque", &panes), [0.0; 3]);
        near(under("transparent", &panes), [0.25, 0.25, 0.0]);
        // In and out of a body.
        let body = "[objects.b]\ntype = \"box\"\nmin = [-1, -1, 1.9]\nmax = [1, 1, 2.1]\nmaterial = \"red\"\n";
        near(under("transparent", body), [0.25, 0.0625, 1.0]);
        near(under("transparent", &(body.to_string() + &wall)), [0.0; 3]);
    }
    // What stands behind the lamp is no matter, nor when the ray was tinted on its way.
    near(under("transparent", bulb, &(pane("a", 2.0, "red") + &pane("behind", 4.5, "grey"))), [0.5, 0.25, 1.0]);
    for shadows in ["opaque", "transparent"] {
        near(under(shadows, bulb, &pane("behind", 4.5, "grey")), [1.0; 3]);
        near(under(shadows, bulb, &pane("behind", 4.5, "red")), [1.0; 3]);
        near(under(shadows, sun, &pane("behind", 1e5, "grey")), [0.0; 3]);
    }
}

#[test]
fn light_that_is_there_for_no_surface_is_not_asked_for() {
    let count = |body: &str| {
        let p = prepared(&one_pixel(
            &format!("[lights.l]\ntype = \"point\"\nposition = [0, 0, 9]\n{body}"),
            UP_Z,
            ORIGIN,
            1,
        ));
        expose(&p, 0..1).1
    };
    let floor = |material: &str| {
        format!("[materials.m]\n{material}\n[objects.o]\ntype = \"disk\"\nnormal = [0, 0, 1]\nmaterial = \"m\"\n")
    };
    assert_eq!(count(&floor("type = \"lambert\"")).shadow_rays, 1);
    assert_eq!(count(&(floor("type = \"lambert\"") + "[integrator]\nshadows = \"none\"\n")).shadow_rays, 0);
    assert_eq!(count(&floor("type = \"lambert\"\nreflectance = 0")).shadow_rays, 0);
    assert_eq!(count(&floor("type = \"mirror\"")).shadow_rays, 0);
    assert_eq!(count(&floor("type = \"dielectric\"")).shadow_rays, 0);
    assert_eq!(count(&floor("type = \"phong\"\nreflect = 0.5")).shadow_rays, 1);
    let behind = floor("type = \"lambert\"").replace("[0, 0, 1]", "[0, 0, -1]");
    assert_eq!(count(&behind).shadow_rays, 1, "the back, which the eye sees, is lit as well");
}

#[test]
fn backs_are_black_without_shade_back() {
    let body = |integrator: &str, normal: &str, material: &str| {
        format!("[integrator]\n{integrator}\n[background]\ncolor = 0.5\n[lights.l]\ntype = \"directional\"\ndirection = [0, 0, -1]\n[lights.a]\ntype = \"ambient\"
                 color = 0.25\n[materials.m]\n{material}\n[objects.o]\ntype = \"disk\"\nnormal = {normal}\nmaterial = \"m\"\n")
    };
    let white = "type = \"phong\"\ndiffuse = 1\nreflect = 1";
    let see =
        |integrator: &str, normal: &str, material: &str| grey(&body(integrator, normal, material), UP_Z, ORIGIN, 1);
    let (front, back) = ("[0, 0, 1]", "[0, 0, -1]");
    for normal in [front, back] {
        assert_near(see("", normal, white), 1.75, 1e-6);
    }
    assert_near(see("shade_back = false", front, white), 1.75, 1e-6);
    assert_eq!(see("shade_back = false", back, white), 0.0);
    // The inside of glass is no back, and a lamp's back shines if it is two-sided.
    let glass = "type = \"dielectric\"\nfresnel = \"constant\"\nreflectance = 0";
    assert_near(see("shade_back = false", back, glass), 0.5, 1e-6);
    assert_near(see("shade_back = false", back, "type = \"emitter\"\ntwo_sided = true"), 1.0, 1e-6);
}

fn statistics(body: &str) -> Statistics {
    let p = prepared(&one_pixel(body, UP_Z, ORIGIN, 4));
    expose(&p, 0..4).1
}

/// Two rough mirrors face each other: each sample sends n rays, each of which sends one, and so on to the depth.
#[test]
fn glossy_rays_are_many_at_the_first_bounce_and_single_deeper() {
    let hall = |depth: u32, n: u32| {
        statistics(&format!(
            "[integrator]\nmax_depth = {depth}\nglossy_samples = {n}\nmin_contribution = 0\n[materials.rough]\ntype = \"rough_mirror\"\nroughness = 0.01\n
             [objects.near]\ntype = \"plane\"\nmaterial = \"rough\"\nnormal = [0, 0, 1]\n
             [objects.far]\ntype = \"plane\"\nmaterial = \"rough\"\npoint = [0, 0, 10]\nnormal = [0, 0, -1]\n"
        ))
        .glossy_rays
    };
    assert_eq!(hall(0, 8), 0);
    assert_eq!(hall(1, 8), 4 * 8);
    assert_eq!(hall(3, 8), 4 * 8 * 3);
    assert_eq!(hall(1, 1), 4);
    // Glass that is rough sends both kinds.
    let glass = statistics("[integrator]\nmax_depth = 1\nglossy_samples = 8\n[materials.rough]\ntype = \"rough_dielectric\"\nroughness = 0.01
        [objects.near]\ntype = \"plane\"\nmaterial = \"rough\"\nnormal = [0, 0, 1]\n");
    assert_eq!((glass.glossy_rays, glass.reflected_rays, glass.refracted_rays), (4 * 16, 0, 0));
}

#[test]
fn shadow_rays_are_many_at_the_first_surface_and_single_deeper() {
    let s = statistics("[integrator]\nmax_depth = 2\n[materials.lamp]\ntype = \"emitter\"\nsamples = 8\n[materials.coat]\ntype = \"phong\"\nreflect = 0.5
        [lights.l]\ntype = \"point\"\nposition = [0, 2, 5]\n
        [objects.lamp]\ntype = \"sphere\"\ncenter = [0, -3, 5]\nradius = 0.5\nmaterial = \"lamp\"
        [objects.near]\ntype = \"plane\"\nmaterial = \"coat\"\nnormal = [0, 0, 1]\n
        [objects.far]\ntype = \"plane\"\nmaterial = \"coat\"\npoint = [0, 0, 10]\nnormal = [0, 0, -1]\n");
    assert_eq!(s.reflected_rays, 4 * 2);
    assert_eq!(s.shadow_rays, 4 * ((8 + 1) + 2 * (1 + 1)));
    assert_eq!((s.samples, s.camera_rays, s.hits), (4, 4, 12));
}

/// A rough mirror under a sky that is white on one side: half, with less noise than as many independent rays.
#[test]
fn glossy_rays_are_stratified() {
    let body = "[background]\ntype = \"gradient\"\nup = [1, 0, 0]\nstops = [[-1, 0], [0, 0], [0, 1], [1, 1]]
        [integrator]\nglossy_samples = 64\nmin_contribution = 0\n[materials.rough]\ntype = \"rough_mirror\"\nroughness = 0.1\n
        [objects.near]\ntype = \"plane\"\nmaterial = \"rough\"\nnormal = [0, 0, 1]\n[film]\nwidth = 16\nheight = 16\nfilter = \"point\"
        [sampler]\nsamples = 1\n[cameras.c]\ntype = \"perspective\"\nfov = 0.01\n";
    let film = render(body);
    let values: Vec<f64> = crate::support::pixels(&film).iter().map(|p| p[1]).collect();
    let mean = values.iter().sum::<f64>() / 256.0;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 255.0;
    // All of GGX at this roughness but the masked 1 % comes back.
    assert!((mean - 0.494).abs() < 0.01, "{mean}");
    assert!(variance < 0.25 * 0.25 / 64.0, "{variance}: independent rays have {}", 0.25 / 64.0);
}

/// Without rays of its own (at the last depth) a glossy surface shows the highlights of area lights by shading.
#[test]
fn a_glossy_surface_finds_area_lights_with_its_rays_or_by_shading_never_both() {
    let see = |depth: u32| {
        grey(
            &format!("[integrator]\nmax_depth = {depth}\nglossy_samples = 1024\nmin_contribution = 0\n[materials.lamp]\ntype = \"emitter\"\nsamples = 1024\n
             [materials.rough]\ntype = \"rough_mirror\"\nroughness = 0.3\n[objects.floor]\ntype = \"disk\"\nnormal = [0, 0, 1]\nmaterial = \"rough\"\n
             [objects.lamp]\ntype = \"disk\"\ncenter = [-3, 0, 4]\nnormal = [3, 0, -4]\nradius = 1\nmaterial = \"lamp\"\n"),
            [3.0, 0.0, 4.0],
            ORIGIN,
            8,
        )
    };
    let (shaded, traced) = (see(0), see(1));
    assert!(shaded > 0.1 && (shaded / traced - 1.0).abs() < 0.01, "{shaded} {traced}");
}

// ---- bodies in bodies

#[test]
fn a_stack_of_bodies_keeps_their_order() {
    let all = |s: MediumStack| s.materials().to_vec();
    let s = MediumStack::EMPTY;
    assert_eq!(all(s), []);
    assert_eq!(all(s.left(3)), []);
    let s = s.entered(3).entered(5).entered(3);
    assert_eq!(all(s), [3, 5, 3]);
    assert_eq!(all(s.left(3)), [3, 5], "the last one entered is left");
    assert_eq!(all(s.left(5)), [3, 3]);
    assert_eq!(all(s.left(7)), [3, 5, 3]);
    assert_eq!(all(s.left(3).left(3)), [5]);
    let full = (0..MediumStack::MOST as u32).fold(MediumStack::EMPTY, MediumStack::entered);
    assert_eq!(full.materials().len(), MediumStack::MOST);
    assert_eq!(full.entered(99), full, "more are not told apart");
    assert_eq!(all(full.left(0))[0], 1);
    assert_eq!(full.left(11).materials().len(), 11);
}

#[test]
fn the_highest_priority_rules_and_the_last_entered_among_equals() {
    let p = prepared(&one_pixel(
        "[materials.air]\ntype = \"lambert\"\n[materials.low]\ntype = \"dielectric\"\nior = 1.1\npriority = 1
         [materials.mid]\ntype = \"dielectric\"\nior = 1.2\npriority = 2\n[materials.also_mid]\ntype = \"dielectric\"\nior = 1.3\npriority = 2
         [materials.high]\ntype = \"dielectric\"\nior = 1.4\npriority = 3\n",
        UP_Z,
        ORIGIN,
        1,
    ));
    let scene = &p.scene;
    let [low, mid, also_mid, high] = [1_u32, 2, 3, 4];
    let stack = |m: &[u32]| m.iter().fold(MediumStack::EMPTY, |s, &m| s.entered(m));
    let ior = |m: &[u32]| scene.body_of(&stack(m)).map(|b| b.ior.at_d_line());
    assert_eq!(ior(&[]), None);
    assert_eq!(ior(&[low]), Some(1.1));
    assert_eq!(ior(&[low, high]), Some(1.4));
    assert_eq!(ior(&[high, low]), Some(1.4));
    assert_eq!(ior(&[mid, also_mid]), Some(1.3));
    assert_eq!(ior(&[also_mid, mid]), Some(1.2));
    // (inside, boundary, entering, covered)
    let table: [(&[u32], u32, bool, bool); 14] = [
        (&[], mid, true, false),
        (&[], mid, false, false),
        (&[low], mid, true, false),
        (&[mid], mid, true, false),
        (&[mid], also_mid, true, false),
        (&[high], mid, true, true),
        (&[low, high], mid, true, true),
        (&[mid], mid, false, false),
        (&[mid, low], mid, false, false),
        (&[mid, low], low, false, true),
        (&[low, high], low, false, true),
        (&[mid, also_mid], mid, false, true),
        (&[mid, also_mid], also_mid, false, false),
        (&[high], low, false, false),
    ];
    for (inside, boundary, entering, covered) in table {
        assert_eq!(scene.is_covered(&stack(inside), boundary, entering), covered, "{inside:?} {boundary} {entering}");
    }
}

/// Slabs along z that only refract: what arrives is the product of all true boundaries' and all bodies' transmittances.
fn through_slabs(slabs: &[(f64, f64, f64, i32, f64)], eye: f64) -> f64 {
    let mut body = String::from("[integrator]\nmax_depth = 20\nmin_contribution = 0\n[background]\ncolor = 1\n");
    for (i, (from, to, ior, priority, absorption)) in slabs.iter().enumerate() {
        body += &format!(
            "[materials.m{i}]\ntype = \"dielectric\"\nreflectance = 0\nior = {ior:?}\npriority = {priority}\nabsorption = {absorption:?}
             [objects.o{i}]\ntype = \"box\"\nmin = [-50, -50, {from:?}]\nmax = [50, 50, {to:?}]\nmaterial = \"m{i}\"\n"
        );
    }
    grey(&body, [0.0, 0.0, eye], [0.0, 0.0, eye - 1.0], 1)
}

/// From the eye on: indices one after the other, and what they absorb.
fn expected(indices: &[f64], absorbed: f64) -> f64 {
    let pass = |w: &[f64]| 1.0 - ((w[0] - w[1]) / (w[0] + w[1])).powi(2);
    indices.windows(2).map(pass).product::<f64>() * (-absorbed).exp()
}

#[test]
fn ice_in_a_drink_in_a_glass() {
    // Written (from, to, index, priority, absorption), each overlapping the next.
    let glass_front = (3.0, 4.0, 1.5, 2, 0.1);
    let glass_back = (-4.0, -3.0, 1.5, 2, 0.1);
    let water = (-3.5, 3.5, 1.33, 1, 0.05);
    let ice = (-1.0, 1.0, 1.2, 3, 0.3);
    let drink = [glass_front, glass_back, water, ice];
    let absorbed = 2.0 * 0.1 + 4.0 * 0.05 + 2.0 * 0.3;
    let truth = expected(&[1.0, 1.5, 1.33, 1.2, 1.33, 1.5, 1.0], absorbed);
    assert_near(through_slabs(&drink, 9.0), truth, 1e-5);
    // Whatever the order in which they are written.
    let other = [ice, glass_back, water, glass_front];
    assert_near(through_slabs(&other, 9.0), truth, 1e-5);
    // Without priorities the last entered rules, until it is left.
    let flat = [(3.0, 4.0, 1.5, 0, 0.1), (-3.5, 3.5, 1.33, 0, 0.05)];
    assert_near(through_slabs(&flat, 9.0), expected(&[1.0, 1.5, 1.33, 1.0], 0.05 + 7.0 * 0.05), 1e-5);
    // One body whole inside another of higher rank is not there.
    let hidden = [(-2.0, 2.0, 1.5, 1, 0.1), (-1.0, 1.0, 1.2, 0, 9.0)];
    assert_near(through_slabs(&hidden, 9.0), expected(&[1.0, 1.5, 1.0], 0.4), 1e-5);
    // And one of higher rank is, with the outer one around it.
    let inside = [(-2.0, 2.0, 1.5, 0, 0.1), (-1.0, 1.0, 1.2, 1, 0.2)];
    assert_near(through_slabs(&inside, 9.0), expected(&[1.0, 1.5, 1.2, 1.5, 1.0], 0.2 + 0.4), 1e-5);
}

/// Boundaries that a body of higher rank covers are passed, but not without end.
#[test]
fn a_path_through_too_many_covered_boundaries_is_given_up() {
    let hidden = |n: usize| -> Vec<_> {
        let slab = |i: usize| (2.0 - 0.01 * i as f64 - 0.005, 2.0 - 0.01 * i as f64, 1.3, 0, 0.0);
        std::iter::once((-3.0, 3.0, 1.5, 1, 0.0)).chain((0..n).map(slab)).collect()
    };
    assert_near(through_slabs(&hidden(127), 9.0), 0.96 * 0.96, 1e-5);
    assert_eq!(through_slabs(&hidden(129), 9.0), 0.0);
}

/// A camera inside bodies: what it sees is not n^2 times brighter, and its own path absorbs.
#[test]
fn a_camera_inside_bodies_keeps_its_exposure() {
    assert_near(through_slabs(&[(-1.0, 1.0, 1.5, 0, 0.1)], 0.0), expected(&[1.5, 1.0], 0.1), 1e-5);
    let drink = [(-3.5, 3.5, 1.33, 1, 0.05), (-1.0, 1.0, 1.2, 3, 0.3)];
    assert_near(through_slabs(&drink, 0.0), expected(&[1.2, 1.33, 1.0], 0.3 + 2.5 * 0.05), 1e-5);
    assert_near(through_slabs(&drink, 2.0), expected(&[1.33, 1.2, 1.33, 1.0], 0.6 + 3.5 * 0.05), 1e-5);
    let classic = "[background]\ncolor = 1\n[materials.m]\ntype = \"dielectric\"\nfresnel = \"constant\"\nreflectance = 0\n[objects.o]\ntype = \"sphere\"\nmaterial = \"m\"\n";
    assert_near(grey(classic, ORIGIN, [0.0, 0.0, -1.0], 1), 1.0, 1e-6);
    // Inside something that is no body, all is dark but what it sends back.
    let wall = "[background]\ncolor = 1\n[objects.o]\ntype = \"sphere\"\n";
    assert_eq!(grey(wall, ORIGIN, [0.0, 0.0, -1.0], 1), 0.0);
}

/// From inside glass at 60 degrees nothing leaves: all is mirrored, at any number of bounces.
#[test]
fn beyond_the_critical_angle_all_is_mirrored() {
    let body = |ior: f64| {
        format!(
            "[integrator]\nmax_depth = 1\n[background]\ncolor = 0.5\n[materials.m]\ntype = \"dielectric\"\nior = {ior:?}\n[objects.sea]\ntype = \"plane\"\nmaterial = \"m\"\n"
        )
    };
    let (s, c) = 60.0_f64.to_radians().sin_cos();
    let statistics = |ior: f64| {
        let p = prepared(&one_pixel(&body(ior), [-s, -c, 0.0], ORIGIN, 1));
        let (film, stats) = expose(&p, 0..1);
        (pixel(&film, 0, 0)[1], stats.reflected_rays, stats.refracted_rays)
    };
    let (light, mirrored, refracted) = statistics(1.5);
    assert_eq!((mirrored, refracted), (1, 0));
    // The sky is seen as from outside: the mirrored ray is still in the water, n^2 brighter than its background.
    assert_near(light, 0.5 / 2.25, 1e-5);
    let (_, mirrored, refracted) = statistics(1.1);
    assert_eq!((mirrored, refracted), (1, 1));
}

// ---- lamps, and what is half there

#[test]
fn a_lamp_is_seen_in_a_mirror_and_through_glass() {
    let scene = |material: &str, z: f64| {
        format!("[integrator]\nmax_depth = 2\n[materials.lamp]\ntype = \"emitter\"\nintensity = 3\n[materials.m]\n{material}\n[objects.o]\ntype = \"box\"
                 min = [-9, -9, -1]\nmax = [9, 9, 0]\nmaterial = \"m\"\n[objects.lamp]\ntype = \"disk\"\ncenter = [0, 0, {z:?}]\nnormal = [0, 0, {:?}]\nmaterial = \"lamp\"\n", -z.signum())
    };
    assert_near(grey(&scene("type = \"mirror\"\nreflectance = 0.5", 9.0), UP_Z, ORIGIN, 1), 1.5, 1e-6);
    assert_near(grey(&scene("type = \"dielectric\"", -9.0), UP_Z, ORIGIN, 1), 3.0 * 0.96 * 0.96, 1e-5);
}

#[test]
fn a_lamp_shines_from_its_front_or_from_both_sides() {
    let lamp = |more: &str, normal: &str| {
        format!("[materials.lamp]\ntype = \"emitter\"\nsamples = 1\n{more}\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n
                 [objects.floor]\ntype = \"disk\"\nradius = 0.5\nnormal = [0, 0, 1]\nmaterial = \"white\"\n
                 [objects.lamp]\ntype = \"disk\"\nradius = 0.01\ncenter = [0, 0, 1]\nnormal = {normal}\nmaterial = \"lamp\"\n")
    };
    let (down, up) = ("[0, 0, -1]", "[0, 0, 1]");
    let (from_above, lit) = ([0.0, 0.0, 5.0], [3.0, 0.0, 0.5]);
    for (more, above, below) in [("", 1.0, 0.0), ("two_sided = true", 1.0, 1.0)] {
        assert_eq!(grey(&lamp(more, up), from_above, [0.0, 0.0, 1.0], 1), above);
        assert_eq!(grey(&lamp(more, down), from_above, [0.0, 0.0, 1.0], 1), below);
        // A small lamp lights by area times cosines over distance squared.
        assert_near(grey(&lamp(more, down), lit, ORIGIN, 16), 1e-4 / 1.0001, 1e-3);
        assert_near(grey(&lamp(more, up), lit, ORIGIN, 16), below * 1e-4 / 1.0001, 1e-3);
    }
}

fn veil(name: &str, z: f64, alpha: f64, radiance: f64) -> String {
    format!("[materials.{name}]\ntype = \"emitter\"\nradiance = {radiance:?}\nalpha = {alpha:?}\n[objects.{name}]\ntype = \"rectangle\"\ncenter = [0, 0, {z:?}]
             edge_u = [4, 0, 0]\nedge_v = [0, 4, 0]\nmaterial = \"{name}\"\n")
}

#[test]
fn a_veil_covers_as_often_as_its_alpha_says() {
    const N: u32 = 16384;
    let close = |value: f64, truth: f64| {
        assert!((value - truth).abs() < 4.0 * (truth * (1.0 - truth) / f64::from(N)).sqrt(), "{value} {truth}")
    };
    for alpha in [0.1, 0.5, 0.75] {
        close(grey(&veil("a", 0.0, alpha, 1.0), UP_Z, ORIGIN, N), alpha);
    }
    assert_eq!(grey(&veil("a", 0.0, 0.0, 1.0), UP_Z, ORIGIN, 64), 0.0);
    assert_eq!(grey(&veil("a", 0.0, 1.0, 1.0), UP_Z, ORIGIN, 64), 1.0);
    // Two veils are two coins: the second is seen where the first is not.
    let two = veil("a", 1.0, 0.4, 0.0) + &veil("b", 0.0, 0.5, 1.0);
    close(grey(&two, UP_Z, ORIGIN, N), 0.6 * 0.5);
    // Shadows throw coins as well, of either kind.
    for shadows in ["opaque", "transparent"] {
        let shaded = format!(
            "[integrator]\nshadows = \"{shadows}\"\n[lights.l]\ntype = \"directional\"\ndirection = [0, 0, -1]\n[materials.white]\ntype = \"lambert\"\nreflectance = 1
             [objects.floor]\ntype = \"disk\"\nradius = 0.5\nnormal = [0, 0, 1]\nmaterial = \"white\"\n{}",
            veil("a", 2.0, 0.3, 0.0)
        );
        close(grey(&shaded, [3.0, 0.0, 1.0], ORIGIN, N), 0.7);
    }
}

/// Hidden from the camera alone: mirrors show it, and its shadow falls.
#[test]
fn what_is_not_visible_is_hidden_from_the_camera_only() {
    let scene = |more: &str| {
        format!("[lights.l]\ntype = \"directional\"\ndirection = [0, 0, -1]\n[materials.white]\ntype = \"lambert\"\nreflectance = 1
             [objects.floor]\ntype = \"plane\"\nnormal = [0, 0, 1]\nmaterial = \"white\"\n[objects.o]\ntype = \"sphere\"\ncenter = [0, 0, 2]\nmaterial = \"white\"\n{more}\n")
    };
    let above = [0.0, 0.0, 9.0];
    assert_near(grey(&scene(""), above, ORIGIN, 1), 1.0, 1e-6);
    assert_eq!(grey(&scene("visible = false"), above, ORIGIN, 1), 0.0, "the floor below, in shadow");
    let mirror = "[materials.m]\ntype = \"mirror\"\nreflectance = 0.5\n[materials.lamp]\ntype = \"emitter\"\n[objects.floor]\ntype = \"plane\"
        normal = [0, 0, 1]\nmaterial = \"m\"\n[objects.o]\ntype = \"sphere\"\ncenter = [0, 0, 2]\nmaterial = \"lamp\"\nvisible = false\n";
    assert_near(grey(mirror, above, ORIGIN, 1), 0.5, 1e-6);
}

// ---- shading normals, skies, nonsense

/// A flat face in the plane z = 0 whose written normal leans by 53 degrees towards +x.
fn leaning(material: &str, rest: &str) -> f64 {
    let obj = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvn 0.8 0 0.6\nf 1//1 2//1 3//1\n";
    let body = format!(
        "{rest}\n[materials.m]\n{material}\n[objects.o]\ntype = \"mesh\"\nfile = \"face.obj\"\nmaterial = \"m\"\n"
    );
    let toml = one_pixel(&body, UP_Z, ORIGIN, 1);
    let p = prepared_with(&toml, &[("face.obj", obj.as_bytes())], &Options::default());
    pixel(&expose(&p, 0..1).0, 0, 0)[1]
}

#[test]
fn a_leaning_normal_shades_but_lets_no_light_through() {
    let lit = |shadows: &str, x: f64, z: f64| {
        let sun = format!(
            "[integrator]\nshadows = \"{shadows}\"\n[lights.l]\ntype = \"directional\"\ndirection = [{:?}, 0, {:?}]\n",
            -x, -z
        );
        leaning("type = \"lambert\"\nreflectance = 1", &sun)
    };
    for shadows in ["opaque", "none"] {
        assert_near(lit(shadows, 0.8, 0.6), 1.0, 1e-6);
        assert_near(lit(shadows, 0.0, 1.0), 0.6, 1e-6);
        // Above the leaning face but below the true one; and the other way round.
        assert_eq!(lit(shadows, 0.96, -0.28), 0.0);
        assert_eq!(lit(shadows, -0.96, 0.28), 0.0);
    }
}

#[test]
fn a_ray_that_a_leaning_normal_sends_into_the_surface_is_dropped() {
    let sky = "[background]\ncolor = 1\n";
    assert_eq!(leaning("type = \"mirror\"", sky), 0.0);
    assert!(leaning("type = \"dielectric\"\nfresnel = \"constant\"\nreflectance = 0", sky) > 0.99);
}

#[test]
fn a_gradient_runs_between_its_stops() {
    let sky = |y: f64| {
        let body = "[background]\ntype = \"gradient\"\nup = [0, 2, 0]\nstops = [[-0.5, 0.2], [0.5, 0.6], [0.9, 0.1]]\n";
        grey(body, ORIGIN, [(1.0 - y * y).sqrt(), y, 0.0], 1)
    };
    for (y, truth) in [(-0.9, 0.2), (-0.5, 0.2), (-0.25, 0.3), (0.0, 0.4), (0.25, 0.5), (0.7, 0.35), (0.95, 0.1)] {
        assert_near(sky(y), truth, 1e-5);
    }
}

/// Half of the samples see something absurdly bright: they are counted, located and left out.
#[test]
fn absurd_light_is_left_out_and_told() {
    for (radiance, intensity) in [(1.0, 1e30), (1.0, 1e300)] {
        let absurd = veil("sun", 0.0, 0.5, radiance) + "[background]\ncolor = 0.25\n";
        let absurd = absurd.replace("type = \"emitter\"", &format!("type = \"emitter\"\nintensity = {intensity:?}"));
        let p = prepared(&one_pixel(&absurd, UP_Z, ORIGIN, 64));
        let take = |samples| {
            let mut film = Film::new(p.film.clone());
            p.renderer(8).render(&mut film, samples, &Undisturbed);
            film
        };
        let mut film = take(0..64);
        let tile = &film.tiles[0];
        assert!((16..48).contains(&tile.counts[0].invalid), "{:?}", tile.counts);
        assert_eq!((film.invalid_samples(), tile.counts[0].taken), (u64::from(tile.counts[0].invalid), 64));
        assert_eq!(tile.invalid.len(), 16, "as many places are kept");
        assert!(tile.invalid.iter().all(|id| (id.x, id.y) == (0, 0) && id.sample < 64));
        assert_eq!(pixel(&film, 0, 0), [0.25; 3]);
        let more = take(64..128);
        let sum = film.invalid_samples() + more.invalid_samples();
        film.merge(&more).expect("they fit");
        assert_eq!((film.invalid_samples(), film.tiles[0].counts[0].taken), (sum, 128));
        assert_eq!(film.tiles[0].mean(0), [0.25; 3]);
    }
}
