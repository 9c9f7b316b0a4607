//! The same scene a million times smaller and larger; no speckles at grazing light, no light through closed walls.

use crate::support::{Rgb, assert_agree, expose, pixels, prepared, prepared_with};
use kirkas_images::to_srgb8;
use kirkas_images::{RgbImage, ToneCurve};
use kirkas_render::film::AovSet;
use kirkas_render::{Film, Options};

/// Replace every number after `@` by itself times `s`, and after `@@` by itself times `s` squared.
fn scaled(template: &str, s: f64) -> String {
    let mut out = String::new();
    let mut rest = template;
    while let Some(at) = rest.find('@') {
        out += &rest[..at];
        rest = &rest[at + 1..];
        let factor = match rest.strip_prefix('@') {
            Some(r) => {
                rest = r;
                s * s
            }
            None => s,
        };
        let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(rest.len());
        let number: f64 = rest[..end].parse().expect("a number after @");
        out += &format!("{:?}", number * factor);
        rest = &rest[end..];
    }
    out + rest
}

const STILL_LIFE: &str = r#"
[film]
width = 160
height = 120
filter = "point"
[sampler]
samples = 1
[cameras.c]
type = "perspective"
position = [@0.3, @2.1, @5.2]
look_at = [@0, @0.6, @0]
fov = 42
[background]
type = "gradient"
stops = [[-1, 0.1], [1, [0.3, 0.5, 0.9]]]
[lights.key]
type = "point"
position = [@-2.5, @3.5, @2.2]
intensity = @@14
[lights.spot]
type = "spot"
position = [@2, @4, @1]
direction = [-0.4, -1, -0.1]
intensity = @@6
[lights.sky]
type = "ambient"
intensity = 0.1
[lights.sun]
type = "directional"
direction = [0.9, -0.25, -0.6]
intensity = 0.4
[materials.floor]
type = "lambert"
reflectance = [0.6, 0.5, 0.4]
[materials.red]
type = "phong"
diffuse = [0.5, 0.1, 0.1]
specular = 0.3
reflect = 0.2
[materials.glass]
type = "dielectric"
[materials.mirror]
type = "mirror"
reflectance = 0.8
[objects.floor]
type = "plane"
material = "floor"
[objects.ball]
type = "sphere"
center = [@-1.2, @0.6, @0]
radius = @0.6
material = "red"
[objects.lens]
type = "sphere"
center = [@0.2, @0.5, @1.3]
radius = @0.5
material = "glass"
[objects.block]
type = "box"
min = [@0.6, @0, @-1.2]
max = [@1.7, @1.1, @-0.2]
material = "mirror"
[objects.ring]
type = "torus"
center = [@1.4, @0.3, @0.9]
axis = [0.2, 1, 0.1]
major_radius = @0.4
minor_radius = @0.15
material = "red"
[objects.hat]
type = "cone"
from = [@-0.4, @0, @-1.4]
to = [@-0.4, @1.5, @-1.4]
radius = @0.5
material = "floor"
[objects.can]
type = "cylinder"
from = [@-2.2, @0, @-1]
to = [@-2.2, @1, @-1]
radius = @0.4
material = "red"
[objects.tent]
type = "mesh"
vertices = [[@-0.9, @0, @1.2], [@-0.4, @0, @1.3], [@-0.7, @0, @1.7], [@-0.6, @0.6, @1.4]]
faces = [0, 3, 1, 1, 3, 2, 2, 3, 0]
normals = "flat"
material = "mirror"
[objects.stack]
type = "group"
template = true
[objects.bead]
type = "sphere"
center = [@0, @0.2, @0]
radius = @0.2
material = "floor"
parent = "stack"
[objects.placed]
type = "instance"
of = "stack"
transform = [{ scale = [1, 2, 1] }, { rotate = [0, 0, 1, 20] }, { translate = [@2.1, @0, @0.1] }]
"#;

fn bytes(film: &Film) -> Vec<[u8; 3]> {
    let image: RgbImage = film.to_rgb();
    let bytes = to_srgb8(&image, 0.0, ToneCurve::Linear);
    bytes.chunks(3).map(|c| [c[0], c[1], c[2]]).collect()
}

#[test]
fn a_scene_looks_the_same_at_any_size() {
    let picture = |s: f64| {
        let p = prepared(&scaled(STILL_LIFE, s));
        bytes(&expose(&p, 0..1).0)
    };
    let life_size = picture(1.0);
    let shades: std::collections::BTreeSet<_> = life_size.iter().collect();
    assert!(shades.len() > 1000, "there is something to see");
    for s in [1e-6, 1e-3, 1e3, 1e6] {
        let other = picture(s);
        let near = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).all(|c| a[c].abs_diff(b[c]) <= 1);
        let same = life_size.iter().zip(&other).filter(|p| near(*p)).count();
        let share = same as f64 / life_size.len() as f64;
        assert!(share >= 0.999, "{s}: {:.3} % are the same", 100.0 * share);
    }
}

/// Closed convex bodies around the origin, of about unit size.
const BODIES: [(&str, &str); 8] = [
    ("sphere", "type = \"sphere\"\nradius = @0.9"),
    ("box", "type = \"box\"\nmin = [@-0.6, @-0.5, @-0.4]\nmax = [@0.6, @0.5, @0.4]"),
    ("cylinder", "type = \"cylinder\"\nfrom = [@0, @-0.7, @0]\nto = [@0, @0.7, @0]\nradius = @0.6"),
    ("cone", "type = \"cone\"\nfrom = [@0, @-0.5, @0]\nto = [@0, @0.8, @0]\nradius = @0.7"),
    ("frustum", "type = \"cone\"\nfrom = [@0, @-0.5, @0]\nto = [@0, @0.6, @0]\nradius = @0.7\ntop_radius = @0.3"),
    (
        "mesh",
        "type = \"mesh\"\nnormals = \"flat\"\nvertices = [[@0.8, @0, @0], [@-0.8, @0, @0], [@0, @0.9, @0], [@0, @-0.9, @0], [@0, @0, @0.7], [@0, @0, @-0.7]]\nfaces = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5]",
    ),
    ("disk", "type = \"disk\"\nradius = @0.9\nnormal = [0.3, 0.5, 0.8]"),
    ("rectangle", "type = \"rectangle\"\nedge_u = [@1, @0.2, @0]\nedge_v = [@0, @1, @-0.4]"),
];

/// Ways in which a body is put into the scene: as it is, turned, and as an instance of an instance, stretched.
const WAYS: [&str; 3] = [
    "[objects.o]\nmaterial = \"white\"\nBODY\n",
    "[objects.o]\nmaterial = \"white\"\nBODY\ntransform = [{ rotate = [1, 2, 3, 40] }, { scale = [1.1, 0.8, 1.3] }, { translate = [@0.1, @-0.1, @0.05] }]\n",
    "[objects.inner]\ntype = \"group\"\ntemplate = true\n[objects.o]\nmaterial = \"white\"\nparent = \"inner\"\nBODY\n[objects.outer]\ntype = \"group\"\ntemplate = true
     [objects.i]\ntype = \"instance\"\nof = \"inner\"\nparent = \"outer\"\ntransform = [{ scale = [1.2, 0.9, 1] }, { rotate = [1, 0, 1, 30] }]
     [objects.j]\ntype = \"instance\"\nof = \"outer\"\ntransform = [{ rotate = [0, 1, 0, 25] }, { scale = 0.9 }]\n",
];

const WHITE: &str = "[materials.white]\ntype = \"lambert\"\nreflectance = 1\n";

/// Integrators that show what a lamp lights directly.
const DIRECT: [&str; 2] = ["type = \"whitted\"\n", "type = \"path\"\nmax_depth = 1\n"];

fn normals(film: &Film) -> Vec<(Rgb, f32)> {
    film.pixels()
        .map(|(_, _, t, i)| {
            let a = t.aovs.as_ref().expect("kept");
            (std::array::from_fn(|c| f64::from(a.mean(i, 1 + c))), a.hits[i] as f32)
        })
        .collect()
}

/// On a convex body nothing lies between a lit point and the sun: every pixel shows the cosine.
#[test]
fn grazing_light_leaves_no_speckles() {
    let to_sun: Rgb = [0.8, 0.0, 0.6];
    for (s, integrator) in [1e-6, 1.0, 1e6].into_iter().flat_map(|s| DIRECT.map(|i| (s, i))) {
        for (name, body) in BODIES {
            for (way, placed) in WAYS.iter().enumerate() {
                for lamp in [
                    "[lights.l]\ntype = \"directional\"\ndirection = [-0.8, 0, -0.6]\n".to_string(),
                    "[lights.l]\ntype = \"point\"\nposition = [@80000, @0, @60000]\nintensity = @@10000000000\n"
                        .to_string(),
                ] {
                    let toml = scaled(
                        &format!(
                            "[integrator]\n{integrator}{WHITE}{lamp}{}[film]\nwidth = 32\nheight = 32\nfilter = \"point\"\n[sampler]\nsamples = 1
                             [cameras.c]\ntype = \"orthographic\"\nposition = [@-2, @1, @4]\nlook_at = [0, 0, 0]\nheight = @2.4\n",
                            placed.replace("BODY", body)
                        ),
                        s,
                    );
                    let options =
                        Options { aovs: AovSet::from_names(["normals"]).expect("it exists"), ..Options::default() };
                    let (film, _) = expose(&prepared_with(&toml, &[], &options), 0..1);
                    let mut lit = 0;
                    for ((n, hits), (_, _, tile, i)) in normals(&film).into_iter().zip(film.pixels()) {
                        if hits == 0.0 {
                            continue;
                        }
                        // Flat things show the side that the eye sees.
                        let cos = (0..3).map(|c| n[c] * to_sun[c]).sum::<f64>();
                        let flat = name == "disk" || name == "rectangle";
                        let away = (0..3).map(|c| n[c] * [-2.0, 1.0, 4.0][c]).sum::<f64>() < 0.0;
                        let truth = if flat && away { (-cos).max(0.0) } else { cos.max(0.0) };
                        let value = f64::from(tile.mean(i)[1]);
                        assert!(
                            (value - truth).abs() < 2e-3,
                            "{integrator}: {name} {way} at {s}: {value} is not {truth}"
                        );
                        lit += usize::from(value > 0.0);
                    }
                    assert!(lit > 30, "{integrator}: {name} {way} at {s}: {lit} lit pixels");
                }
            }
        }
    }
}

/// All light, bounced as it may: the picture of a small scene is that of a large one, but for noise.
#[test]
fn a_traced_path_looks_the_same_at_any_size() {
    let picture = |s: f64| {
        let words = "[integrator]\ntype = \"path\"\n[materials.lamp]\ntype = \"emitter\"\nradiance = 2\n\
                     [objects.lamp]\ntype = \"disk\"\ncenter = [@0.5, @3, @0.5]\nnormal = [0, -1, 0]\nradius = @0.8\nmaterial = \"lamp\"\n";
        let small = STILL_LIFE.replace("width = 160\nheight = 120", "width = 24\nheight = 18");
        let plain = small
            .replace("samples = 1", "type = \"independent\"\nsamples = 300")
            .replace("intensity = 0.1", "intensity = 0");
        let p = prepared(&scaled(&format!("{words}{plain}"), s));
        expose(&p, 0..300).0
    };
    let life_size = picture(1.0);
    for s in [1e-6, 1e6] {
        assert_agree(&format!("{s} times as large"), &picture(s), &life_size);
    }
}

/// Straight above its middle a torus hides no lit point of its upper half.
#[test]
fn a_torus_lit_along_its_axis_has_no_speckles() {
    for (s, integrator) in [1e-6, 1.0, 1e6].into_iter().flat_map(|s| DIRECT.map(|i| (s, i))) {
        let toml = scaled(
            &format!("[integrator]\n{integrator}{WHITE}[lights.l]\ntype = \"directional\"\n[objects.o]\ntype = \"torus\"\nmajor_radius = @1\nminor_radius = @0.4\nmaterial = \"white\"
                [film]\nwidth = 64\nheight = 64\nfilter = \"point\"\n[sampler]\nsamples = 1
                [cameras.c]\ntype = \"orthographic\"\nposition = [@0, @5, @2]\nlook_at = [0, 0, 0]\nheight = @3\n"),
            s,
        );
        let options = Options { aovs: AovSet::from_names(["normals"]).expect("it exists"), ..Options::default() };
        let (film, _) = expose(&prepared_with(&toml, &[], &options), 0..1);
        for ((n, hits), (_, _, tile, i)) in normals(&film).into_iter().zip(film.pixels()) {
            if hits > 0.0 {
                let value = f64::from(tile.mean(i)[1]);
                assert!((value - n[1].max(0.0)).abs() < 1e-4, "{integrator} at {s}: {value} is not {}", n[1]);
            }
        }
    }
}

/// Bright lamps outside, a camera inside: closed walls let nothing in.
#[test]
fn no_light_leaks_into_closed_bodies() {
    let lamps = "[lights.sun]\ntype = \"directional\"\ndirection = [-1, -0.7, -0.4]\nintensity = 1000
        [lights.bulb]\ntype = \"point\"\nposition = [@1.2, @-1, @0.9]\nintensity = @@1000
        [materials.lamp]\ntype = \"emitter\"\nradiance = 1000\nsamples = 2\ntwo_sided = true
        [objects.lamp]\ntype = \"sphere\"\ncenter = [@-2.5, @0.3, @0.2]\nradius = @0.7\nmaterial = \"lamp\"
        [objects.panel]\ntype = \"rectangle\"\ncenter = [@0, @3, @0]\nedge_u = [@4, 0, 0]\nedge_v = [0, 0, @4]\nmaterial = \"lamp\"
        [background]\ncolor = 1000\n";
    let ring = ("torus", "type = \"torus\"\nmajor_radius = @0.7\nminor_radius = @0.5");
    let integrators = ["type = \"whitted\"\n", "type = \"path\"\nmax_depth = 6\n"];
    for (s, integrator) in [1e-6, 1.0, 1e6].into_iter().flat_map(|s| integrators.map(|i| (s, i))) {
        for (name, body) in BODIES.iter().filter(|b| !["disk", "rectangle"].contains(&b.0)).chain([&ring]) {
            for (way, placed) in WAYS.iter().enumerate() {
                // Close to the wall, looking along it.
                let eye = if *name == "torus" { "[@0.5, @0.05, @0.45]" } else { "[@0.1, @-0.05, @0.02]" };
                let toml = scaled(
                    &format!(
                        "[integrator]\n{integrator}{WHITE}{lamps}{}[film]\nwidth = 24\nheight = 24\nfilter = \"box\"\n[sampler]\nsamples = 4
                         [cameras.c]\ntype = \"perspective\"\nposition = {eye}\nlook_at = [@1, @-3, @0.2]\nfov = 150\n",
                        placed.replace("BODY", body)
                    ),
                    s,
                );
                let (film, _) = expose(&prepared(&toml), 0..4);
                let leaks = pixels(&film).iter().filter(|p| **p != [0.0; 3]).count();
                assert_eq!(leaks, 0, "{name} {way} at {s} by {integrator}");
            }
        }
    }
}
