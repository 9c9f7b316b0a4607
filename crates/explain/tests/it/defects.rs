//! Scenes of the gallery with something wrong in them: it is found, and the culprit named. Where nothing is wrong, nothing is found.

use crate::support::{expose, scene, scene_with, scenes};
use kirkas_explain::{Finding, explain, findings};
use kirkas_geometry::hash::combine;
use kirkas_images::{ChannelData, ExrCompression, Image, Window, write_exr};
use kirkas_render::Prepared;
use rayon::prelude::*;

/// Where the defect shows.
enum Where {
    /// In a black pixel in which this object is seen; "" is none.
    Black(&'static str),
    /// Where this object is seen all around.
    Sees(&'static str),
    /// In the pixel of the largest variance.
    Noisiest,
}
use Where::{Black, Noisiest, Sees};

struct Defect {
    scene: &'static str,
    set: &'static [&'static str],
    place: Where,
    /// The finding.
    code: &'static str,
    /// Who is to blame.
    culprit: &'static str,
}

const fn defect(
    scene: &'static str,
    set: &'static [&'static str],
    place: Where,
    code: &'static str,
    culprit: &'static str,
) -> Defect {
    Defect { scene, set, place, code, culprit }
}

const CORNELL: &str = "light/cornell_box.toml";
const CAUSTICS: &str = "light/glass_caustics.toml";
const WHITTED: &str = "lecture/whitted.toml";
const SPOTS: &str = "lecture/spot_light.toml";
const OFFSET: &str = "lecture/surface_offset.toml";

const DEFECTS: &[Defect] = &[
    // Black materials.
    defect(CORNELL, &["materials.white.reflectance=0"], Black("back"), "black", "white"),
    defect(CORNELL, &["materials.red.reflectance=0"], Black("left"), "black", "red"),
    defect(
        WHITTED,
        &["materials.chrome.diffuse=0", "materials.chrome.reflect=0", "materials.chrome.specular=0"],
        Black("mirror_ball"),
        "black",
        "chrome",
    ),
    // Low depth.
    defect(CORNELL, &["integrator.max_depth=0"], Black("back"), "black", "back"),
    defect(WHITTED, &["integrator.max_depth=1"], Sees("glass_ball"), "depth-limit", "glass_ball"),
    defect("lecture/refraction.toml", &["integrator.max_depth=1"], Sees("ball"), "depth-limit", "ball"),
    defect(CAUSTICS, &["integrator.type=path", "integrator.max_depth=1"], Sees("ball"), "depth-limit", "ball"),
    // Blocked lights.
    defect(
        CORNELL,
        &["objects.lamp.center=[278, -10, 279.5]", "objects.lamp.edge_u=[-130, 0, 0]", "integrator.max_depth=1"],
        Black("back"),
        "black",
        "floor",
    ),
    defect(OFFSET, &["lights.bounce.color=0"], Black("backdrop"), "black", "lamp"),
    defect(OFFSET, &["integrator.type=path", "integrator.max_depth=1"], Black("backdrop"), "black", "lamp"),
    // Lights that send nothing.
    defect(SPOTS, &["lights.bounce.color=0"], Black("backdrop"), "black", "spot_"),
    defect(CORNELL, &["objects.lamp.edge_u=[-130, 0, 0]", "integrator.max_depth=1"], Black("floor"), "black", "lamp"),
    defect(WHITTED, &["background.stops=[[-1, 0], [1, 0]]"], Black(""), "black", "background"),
    // Flipped normals.
    defect(
        CORNELL,
        &["integrator.type=whitted", "integrator.shade_back=false", "objects.back.faces=[0, 2, 1, 0, 3, 2]"],
        Black("back"),
        "black",
        "back",
    ),
    defect(
        CORNELL,
        &["integrator.type=whitted", "integrator.shade_back=false", "objects.left.faces=[0, 2, 1, 0, 3, 2]"],
        Black("left"),
        "black",
        "left",
    ),
    // Surfaces that shade themselves.
    defect(OFFSET, &["integrator.surface_offset=false"], Sees("ball"), "shadow-acne", "ball"),
    defect(OFFSET, &["integrator.surface_offset=false"], Sees("column"), "shadow-acne", "column"),
    // Inside of a body.
    defect(
        CAUSTICS,
        &["integrator.type=path", "cameras.main.position=[-1.15, 0.62, 0.35]", "materials.glass.absorption=4000"],
        Black("ball"),
        "black",
        "glass",
    ),
    // Numbers that are none, or absurd.
    defect("lecture/textures.toml", &[], Black("picture"), "black", "sunrise"),
    defect(CORNELL, &["materials.lamp.radiance=1e14"], Sees("back"), "not-finite", "lamp"),
    // A near-delta lobe and a small lamp.
    defect(CAUSTICS, &["integrator.type=path", "materials.lamp.intensity=6000"], Noisiest, "firefly", "lamp"),
    // More light than arrives.
    defect(
        WHITTED,
        &["integrator.type=path", "materials.chrome.diffuse=0.95"],
        Sees("mirror_ball"),
        "energy",
        "chrome",
    ),
];

/// An EXR picture that is no number everywhere.
fn no_numbers() -> Vec<u8> {
    let window = Window { x: 0, y: 0, width: 4, height: 4 };
    let mut image = Image { data: window, display: window, ..Image::default() };
    ["R", "G", "B"].iter().for_each(|c| image.push(*c, ChannelData::F32(vec![f32::NAN; 16])));
    write_exr(&image, ExrCompression::None).expect("a picture")
}

const SIZE: u32 = 40;
const SAMPLES: u32 = 64;

fn prepared(d: &Defect) -> Prepared {
    let film = ["film.width=40", "film.height=40", "sampler.samples=64"];
    // What the integrator is comes before what it is set to.
    let set: Vec<&str> = d.set.iter().copied().chain(film).collect();
    match d.culprit {
        "sunrise" => scene_with(d.scene, &set, &[("lecture/parts/sunrise.png", no_numbers())]),
        _ => scene(d.scene, &set),
    }
}

/// The object that all samples of a pixel see first.
fn seen(p: &Prepared, pixel: (u32, u32)) -> String {
    let e = explain(p, pixel, 0..1, "", "", &mut |_| {});
    e.trees[0].rays[0].hit.as_ref().map_or(String::new(), |h| h.object.clone())
}

fn pixel_of(p: &Prepared, place: &Where) -> Option<(u32, u32)> {
    let film = expose(p);
    let bright = |x: u32, y: u32| {
        let (_, _, tile, i) = film.pixels().find(|f| (f.0, f.1) == (x, y)).expect("inside");
        tile.mean(i).iter().sum::<f32>()
    };
    // From the middle outwards, so that edges are far.
    let far = |(x, y): &(u32, u32)| x.abs_diff(SIZE / 2).pow(2) + y.abs_diff(SIZE / 2).pow(2);
    let mut all: Vec<(u32, u32)> = (1..SIZE - 1).flat_map(|y| (1..SIZE - 1).map(move |x| (x, y))).collect();
    all.sort_by_key(far);
    let around = |(x, y): (u32, u32), o: &str| (x - 1..=x + 1).all(|x| (y - 1..=y + 1).all(|y| seen(p, (x, y)) == o));
    match place {
        Sees(object) => all.into_iter().find(|&at| around(at, object)),
        Black(object) => {
            let dark: Vec<(u32, u32)> = all.into_iter().filter(|at| bright(at.0, at.1) == 0.0).collect();
            // Shadows may be narrow.
            let inner = dark.iter().copied().find(|&at| around(at, object));
            inner.or_else(|| dark.iter().copied().find(|&at| seen(p, at) == *object))
        }
        Noisiest => {
            let noise = |f: &(u32, u32, &kirkas_render::film::Tile, usize)| f.2.moments(f.3).1.iter().sum::<f64>();
            film.pixels().max_by(|a, b| noise(a).total_cmp(&noise(b))).map(|f| (f.0, f.1))
        }
    }
}

fn found(p: &Prepared, pixel: (u32, u32), samples: u32) -> Vec<Finding> {
    findings(&explain(p, pixel, 0..samples, "", "", &mut |_| {}))
}

#[test]
fn what_is_wrong_is_found_and_the_culprit_named() {
    let check = |d: &Defect| {
        let p = prepared(d);
        let Some(at) = pixel_of(&p, &d.place) else { return Some(format!("{} {:?}: shows nowhere", d.scene, d.set)) };
        let all = found(&p, at, SAMPLES);
        let is_named = all.iter().any(|f| f.code == d.code && f.text.contains(d.culprit));
        (!is_named).then(|| format!("{} {:?}: not `{}` with `{}` but {all:#?}", d.scene, d.set, d.code, d.culprit))
    };
    let missed: Vec<String> = DEFECTS.par_iter().filter_map(check).collect();
    assert!(DEFECTS.len() >= 20);
    assert!(missed.len() * 10 <= DEFECTS.len(), "{} of {}: {missed:#?}", missed.len(), DEFECTS.len());
    println!("{} of {} defects were named", DEFECTS.len() - missed.len(), DEFECTS.len());
}

#[test]
fn nothing_is_found_where_nothing_is_wrong() {
    const PIXELS: u64 = 8;
    // Particles are told of all together, and take long; their integrators are those of the other scenes but for them.
    let healthy = |name: &String| {
        let p = scene(
            name,
            &[
                "film.width=48",
                "film.height=48",
                "sampler.samples=32",
                "integrator.type=path",
                "integrator.max_depth=200",
            ],
        );
        let pixels = (0..PIXELS).map(|k| combine(k, 11)).map(|h| ((h % 48) as u32, (h >> 32) as u32 % 48));
        pixels
            .map(|at| (at, explain(&p, at, 0..32, "", "", &mut |_| {})))
            // Where a scene is black it is no false finding to say why.
            .filter(|(_, e)| e.value != [0.0; 3])
            .flat_map(|(at, e)| {
                findings(&e).into_iter().map(move |f| format!("{name} at {at:?}: {} {}", f.code, f.text))
            })
            .collect::<Vec<_>>()
    };
    let all = scenes();
    let false_ones: Vec<String> = all.par_iter().flat_map(healthy).collect();
    let pixels = all.len() * PIXELS as usize;
    assert!(pixels >= 200);
    assert!(false_ones.len() * 50 <= pixels, "{} of {pixels}: {false_ones:#?}", false_ones.len());
}
