//! Media against closed forms, against their plain twin, and one way of storing them against another.

use crate::support::{
    assert_agree, assert_near, assert_shows, expose, grey, one_pixel, prepared, prepared_with, render,
};
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options};

/// A box of 2 along every axis around the origin, filled with `name`.
fn boxed(name: &str) -> String {
    format!(
        "[materials.hull]\ntype = \"hull\"\ninterior = \"{name}\"\n
         [objects.box]\ntype = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = \"hull\"\n"
    )
}

/// A grid volume of one density.
fn even_volume(size: [i32; 3], density: f32) -> Vec<u8> {
    let mut bytes = b"VOL\x03".to_vec();
    [1, size[0], size[1], size[2], 1].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    [-1.0_f32, -1.0, -1.0, 1.0, 1.0, 1.0].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    let count = size.iter().product::<i32>() as usize;
    bytes.extend(std::iter::repeat_n(density.to_le_bytes(), count).flatten());
    bytes
}

#[test]
fn light_fades_by_beer_and_lambert_in_every_kind_of_medium() {
    let sky = "[background]\ncolor = 1\n";
    for integrator in ["path", "path_simple"] {
        let body = format!(
            "{sky}[integrator]\ntype = \"{integrator}\"\n{}[media.ink]\ntype = \"homogeneous\"\nabsorption = 0.5\n",
            boxed("ink")
        );
        let scene = one_pixel(&body, [0.0, 0.0, 5.0], [0.0; 3], 40_000);
        assert_shows(&render(&scene), 0.367879441171442, 1e-2);
    }
    // "Beer-Lambert sigma=0.5,d=2": without scattering nothing is drawn, so one sample is exact.
    let ink = format!("{sky}[integrator]\ntype = \"path\"\n{}[media.ink]\ntype = \"homogeneous\"\n", boxed("ink"));
    assert_near(grey(&format!("{ink}absorption = 0.5\n"), [0.0, 0.0, 5.0], [0.0; 3], 1), 0.367879441171442, 1e-6);
    // What shines in the dark: e / a (1 - exp(-2 a)).
    let glow = ink.replace("color = 1", "color = 0");
    let seen = grey(&format!("{glow}absorption = 0.5\nemission = 3\n"), [0.0, 0.0, 5.0], [0.0; 3], 1);
    assert_near(seen, 6.0 * (1.0 - 0.367879441171442), 1e-6);
    assert_near(grey(&format!("{glow}emission = 3\n"), [0.0, 0.0, 5.0], [0.0; 3], 1), 6.0, 1e-6);
    // Through a grid of density 2, on average.
    let p = prepared_with(
        &one_pixel(
            &format!(
                "{sky}[integrator]\ntype = \"path\"\n{}[media.ink]\ntype = \"grid\"\nfile = \"a.vol\"\nabsorption = 0.25\n",
                boxed("ink")
            ),
            [0.0, 0.0, 5.0],
            [0.0; 3],
            40_000,
        ),
        &[("a.vol", &even_volume([9, 3, 17], 2.0))],
        &Options::default(),
    );
    assert_shows(&expose(&p, 0..40_000).0, 0.367879441171442, 1e-2);
}

/// "Chandrasekhar isotropic halfspace": the radiance under an even sky is the plane albedo, that under a beam the BRDF.
#[test]
fn a_half_space_that_scatters_evenly_is_as_bright_as_chandrasekhar_says() {
    let slab = |albedo: f64, sky: &str| {
        format!(
            "{sky}[integrator]\ntype = \"path\"\n[materials.hull]\ntype = \"hull\"\ninterior = \"milk\"\n
             [objects.slab]\ntype = \"box\"\nmin = [-1e3, -80, -1e3]\nmax = [1e3, 0, 1e3]\nmaterial = \"hull\"\n
             [media.milk]\ntype = \"homogeneous\"\nscattering = {albedo}\nabsorption = {}\n",
            1.0 - albedo
        )
    };
    let sky = "[background]\ntype = \"gradient\"\nstops = [[-1, 0], [0, 0], [0, 1], [1, 1]]\n";
    for (albedo, straight, slanted) in [
        (0.5, 0.11522587770720483, 0.1601444334352351),
        (0.8, 0.28525450271857467, 0.3679697649511867),
        (0.99, 0.7527207171602976, 0.8151398983552156),
    ] {
        let scene = |from| render(&one_pixel(&slab(albedo, sky), from, [0.0; 3], 30_000));
        assert_shows(&scene([0.0, 4.0, 0.0]), straight, 1.5e-2);
        assert_shows(&scene([4.0 * 0.75_f64.sqrt(), 2.0, 0.0]), slanted, 1.5e-2);
    }
    let beam = "[lights.sun]\ntype = \"directional\"\ndirection = [0, -1, 0]\nunit = \"W/m2\"\nintensity = 1\n";
    let film = render(&one_pixel(&slab(0.8, beam), [0.0, 4.0, 0.0], [0.0; 3], 30_000));
    assert_shows(&film, 0.08130607341794109, 1.5e-2);
}

/// A camera with few pixels and independent samples, whose noise is what it says.
fn picture(integrator: &str, body: &str, samples: u32) -> Film {
    let p = prepared_with(
        &format!(
            "[integrator]\ntype = \"{integrator}\"\n[film]\nwidth = 8\nheight = 6\nfilter = \"box\"\n[sampler]\ntype = \"independent\"\n
             [cameras.eye]\ntype = \"perspective\"\nposition = [0.2, 0.5, 4]\nlook_at = [0, 0, 0]\nfov = 45\n{body}"
        ),
        &[("even.vol", &even_volume([20, 9, 12], 0.5))],
        &Options::default(),
    );
    expose(&p, 0..samples).0
}

const ROOM: &str = "
[materials.grey]
type = \"lambert\"
reflectance = [0.7, 0.6, 0.5]
[objects.floor]
type = \"rectangle\"
center = [0, -1.2, 0]
edge_u = [8, 0, 0]
edge_v = [0, 0, -8]
material = \"grey\"
[materials.lamp]
type = \"emitter\"
radiance = [4, 3, 2]
[objects.bulb]
type = \"sphere\"
center = [-1.6, 1.6, -0.5]
radius = 0.4
material = \"lamp\"
[lights.sun]
type = \"directional\"
direction = [-0.5, -1, -0.4]
[background]
color = [0.1, 0.2, 0.3]
";
const HAZE: &str = "scattering = [1.4, 0.7, 0.2]\nabsorption = [0.1, 0.2, 0.4]\nphase = \"haze\"\n
[phases.haze]\ntype = \"henyey_greenstein\"\ng = 0.6\n";

#[test]
fn media_traced_and_their_plain_twin_agree() {
    let cases = [
        ("coloured haze in a box", format!("{ROOM}{}[media.m]\ntype = \"homogeneous\"\n{HAZE}", boxed("m"))),
        (
            "a cloud that glows, of air's molecules",
            format!(
                "{ROOM}{}[media.m]\ntype = \"cloud\"\nresolution = 20\ntransform = [{{ translate = [-0.5, -0.5, -0.5] }}, {{ scale = 2.2 }}, {{ rotate = [0, 1, 0, 30] }}]
                 scattering = [5, 3, 2]\nabsorption = [0.2, 0.1, 1]\nemission = [0.1, 0.2, 0.4]\nphase = \"air\"\n[phases.air]\ntype = \"rayleigh\"\n",
                boxed("m")
            ),
        ),
        (
            "milky glass in fog",
            format!(
                "{}medium = \"fog\"\n[materials.opal]\ntype = \"dielectric\"\nabsorption = [0.3, 0.1, 0]\ninterior = \"milk\"\n[objects.ball]\ntype = \"sphere\"\nmaterial = \"opal\"
                 [media.milk]\ntype = \"homogeneous\"\nscattering = [2, 1, 0.5]\n[media.fog]\ntype = \"homogeneous\"\nscattering = [0.02, 0.04, 0.1]\nabsorption = 0.02\nemission = [0.1, 0.2, 0.3]\nphase = \"drops\"\n[phases.drops]\ntype = \"droplet\"\nreflections = 2\n",
                ROOM.replace("[background]", "[background]\ntype = \"constant\"")
            ),
        ),
    ];
    for (what, body) in cases {
        let path = picture("path", &body, 1500);
        let simple = picture("path_simple", &body, 3000);
        let finding = picture("path_simple\"\nnext_event = false # \"", &body, 3000);
        assert_agree(&format!("{what}, asking lights"), &path, &simple);
        assert_agree(&format!("{what}, finding lights"), &path, &finding);
    }
}

#[test]
fn a_grid_of_one_density_is_a_homogeneous_medium() {
    let scene = |medium: &str| format!("{ROOM}{}[media.m]\n{medium}\n{HAZE}", boxed("m"));
    let even = picture("path", &scene("type = \"homogeneous\""), 1500);
    let doubled = HAZE.replace("[1.4, 0.7, 0.2]", "[2.8, 1.4, 0.4]").replace("[0.1, 0.2, 0.4]", "[0.2, 0.4, 0.8]");
    for bounds in ["local", "global"] {
        let body =
            scene(&format!("type = \"grid\"\nfile = \"even.vol\"\nmajorants = \"{bounds}\"")).replace(HAZE, &doubled);
        assert_agree(bounds, &even, &picture("path", &body, 1500));
    }
}

#[test]
fn bounds_change_the_work_and_not_the_picture() {
    let cloud = |bounds: &str| {
        format!(
            "{ROOM}{}[media.m]\ntype = \"cloud\"\nresolution = 40\nmajorants = \"{bounds}\"\ntransform = [{{ translate = [-0.5, -0.5, -0.5] }}, {{ scale = 2 }}]\nscattering = 12\n",
            boxed("m")
        )
    };
    assert_agree("bounds", &picture("path", &cloud("local"), 1000), &picture("path", &cloud("global"), 1000));
}

#[test]
fn media_give_the_same_bits_for_any_flock() {
    let p = prepared(&format!(
        "[integrator]\ntype = \"path\"\n[film]\nwidth = 16\nheight = 12\n[sampler]\nsamples = 8\n
         [cameras.eye]\ntype = \"perspective\"\nposition = [0, 0.5, 4]\nlook_at = [0, 0, 0]\nfov = 45\n{ROOM}{}
         [media.m]\ntype = \"cloud\"\nresolution = 30\ntransform = [{{ translate = [-0.5, -0.5, -0.5] }}, {{ scale = 2 }}]\nscattering = [9, 12, 15]\n",
        boxed("m")
    ));
    let sums = |flock: usize| {
        let mut film = Film::new(p.film.clone());
        p.renderer(flock).render(&mut film, 0..8, &Undisturbed);
        film.tiles.iter().flat_map(|t| t.sums.clone()).collect::<Vec<_>>()
    };
    let one = sums(1);
    assert!(one == sums(7) && one == sums(1000));
}

#[test]
fn whitted_says_that_it_sees_no_media_and_looks_through_hulls() {
    let scene = format!(
        "{}[media.m]\ntype = \"homogeneous\"\nscattering = 1\n[cameras.eye]\ntype = \"perspective\"\n[background]\ncolor = 1\n",
        boxed("m")
    );
    let codes = |toml: &str| prepared(toml).warnings.iter().map(|w| w.code).collect::<Vec<_>>();
    assert_eq!(codes(&format!("[integrator]\ntype = \"whitted\"\n{scene}")), ["no-media"]);
    assert!(codes(&format!("[integrator]\ntype = \"path\"\n{scene}")).is_empty());
    // A floor under the box, under the sun: as bright as without the box.
    let floor = "[objects.floor]\ntype = \"plane\"\n[lights.sun]\ntype = \"directional\"\n";
    let lit =
        |body: &str| grey(&format!("[integrator]\ntype = \"whitted\"\n{floor}{body}"), [0.0, 5.0, 0.1], [0.0; 3], 1);
    let filled = format!("{}[media.m]\ntype = \"homogeneous\"\nscattering = 1\n", boxed("m"));
    assert!(lit("") > 0.0 && lit("") == lit(&filled));
}
