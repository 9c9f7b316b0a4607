//! Textures: closed forms, pictures of known texels, and what is said about wrong ones.

use kirkas_geometry::DVec3;
use kirkas_images::{ChannelData, ExrCompression, Image, Texts, write_exr, write_png8, write_png16};
use kirkas_render::textures::{COMMON, ColorSource, NumberSource, TEXTURES, TextureNames, TexturePoint, Textures};
use kirkas_scene::{
    Assets, Catalog, Description, Diagnostic, Entity, Fallback, Kind, Map, MeshData, Name, Node, ParamSpec, ParamType,
    Params, SourceId, Span, TypeSpec, Value,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Files by full path; a source's folder is given by the description's sources.
#[derive(Default)]
struct TestAssets {
    files: BTreeMap<String, Vec<u8>>,
}

impl Assets for TestAssets {
    fn mesh(&self, _: Option<SourceId>, path: &str) -> Result<Arc<MeshData>, Diagnostic> {
        Err(Diagnostic::error("unreadable-file", format!("there is no file `{path}`")))
    }

    fn bytes(&self, from: Option<SourceId>, path: &str) -> Result<Arc<[u8]>, Diagnostic> {
        let full = if from.is_some() { format!("scenes/{path}") } else { path.to_string() };
        let found = self.files.get(&full).map(|bytes| bytes.as_slice().into());
        found.ok_or_else(|| Diagnostic::error("unreadable-file", format!("there is no file `{full}`")))
    }
}

fn catalog() -> Catalog {
    Catalog { types: TEXTURES.to_vec(), common: vec![(Kind::Texture, COMMON)] }
}

fn compile(textures: &[(&str, &str, Map)], assets: &TestAssets) -> Result<Textures, Vec<Diagnostic>> {
    let mut d = Description::default();
    for (name, type_name, params) in textures {
        d.add(Kind::Texture, Entity::new(name, type_name, params.clone())).expect("different names");
    }
    Textures::compile(&d, &catalog(), assets)
}

/// One texture, called `t`.
fn one(type_name: &str, params: Map) -> Textures {
    compile(&[("t", type_name, params)], &TestAssets::default()).expect("a sound texture")
}

fn picture(bytes: Vec<u8>, params: Map) -> Textures {
    let assets = TestAssets { files: [("p.png".to_string(), bytes)].into() };
    compile(&[("t", "image", params.with("file", "p.png"))], &assets).expect("a sound picture")
}

fn png(width: u32, height: u32, samples: &[u8]) -> Vec<u8> {
    write_png8(width, height, samples, &Texts::new()).expect("a sound picture")
}

fn solid(x: f64, y: f64, z: f64) -> TexturePoint {
    TexturePoint::at([0.0; 2], DVec3::new(x, y, z), DVec3::splat(1e3))
}

fn flat(u: f32, v: f32) -> TexturePoint {
    TexturePoint::at([u, v], DVec3::ZERO, DVec3::ZERO)
}

const T: ColorSource = ColorSource::Texture(0);

fn red(textures: &Textures, point: TexturePoint) -> f32 {
    textures.color(T, &point)[0]
}

fn colors(a: f64, b: f64) -> Map {
    Map::default().with("a", a).with("b", b)
}

fn step(name: &str, value: impl Into<Value>) -> Vec<Node> {
    vec![Node::new(Map::default().with(name, value))]
}

#[test]
fn a_solid_checker_follows_the_parity_of_its_cubes_at_negative_coordinates_too() {
    let t = one("checker", colors(0.25, 0.75).with("mapping", "solid"));
    for (x, y, z, is_odd) in [
        (0.5, 0.5, 0.5, false),
        (1.5, 0.5, 0.5, true),
        (-0.5, 0.5, 0.5, true),
        (-0.5, -0.5, 0.5, false),
        (-0.5, -0.5, -0.5, true),
        (-1.5, -0.5, -0.5, false),
        (2.0, 0.0, 0.0, false),
        (-1e-9, 0.0, 0.0, true),
    ] {
        assert_eq!(red(&t, solid(x, y, z)), if is_odd { 0.75 } else { 0.25 }, "{x} {y} {z}");
    }
}

#[test]
fn a_checker_has_scale_squares_per_unit_and_follows_its_transform() {
    let t = one("checker", colors(0.0, 1.0).with("scale", 4.0));
    assert_eq!(red(&t, flat(0.1, 0.1)), 0.0);
    assert_eq!(red(&t, flat(0.3, 0.1)), 1.0);
    assert_eq!(red(&t, flat(0.3, 0.3)), 0.0);
    assert_eq!(red(&t, flat(-0.1, 0.1)), 1.0);
    // Placed at twice the size, and then one unit to the right.
    let steps = [step("scale", 2.0), step("translate", [1.0, 0.0, 0.0])].concat();
    let t = one("checker", colors(0.0, 1.0).with("mapping", "solid").with("transform", steps.clone()));
    assert_eq!(red(&t, solid(1.1, 0.1, 0.1)), 0.0);
    assert_eq!(red(&t, solid(2.9, 1.9, 1.9)), 0.0);
    assert_eq!(red(&t, solid(3.1, 0.1, 0.1)), 1.0);
    assert_eq!(red(&t, solid(0.9, 0.1, 0.1)), 1.0);
    let t = one("checker", colors(0.0, 1.0).with("transform", steps));
    assert_eq!(red(&t, flat(1.1, 0.1)), 0.0);
    assert_eq!(red(&t, flat(3.1, 0.1)), 1.0);
}

#[test]
fn a_solid_texture_is_fixed_to_the_object_or_to_the_world() {
    let point = TexturePoint::at([0.0; 2], DVec3::splat(0.5), DVec3::new(1.5, 0.5, 0.5));
    let solid = colors(0.0, 1.0).with("mapping", "solid");
    assert_eq!(red(&one("checker", solid.clone()), point), 0.0);
    assert_eq!(red(&one("checker", solid.with("space", "world")), point), 1.0);
}

/// The noise behind a texture with one octave, where it is not cut off.
fn noise_of(textures: &Textures, p: DVec3) -> f64 {
    // `noise` with a = 1 and b = 0 answers N + 1/2.
    f64::from(red(textures, solid(p.x, p.y, p.z))) - 0.5
}

#[test]
fn noise_is_zero_at_lattice_points() {
    let t = one("noise", colors(1.0, 0.0));
    for (x, y, z) in [(0, 0, 0), (1, 2, 3), (-1, -7, 4), (255, 256, 257), (-256, 1000, -1)] {
        assert_eq!(noise_of(&t, DVec3::new(x.into(), y.into(), z.into())), 0.0);
    }
}

#[test]
fn noise_has_the_values_of_the_reference_implementation() {
    let t = one("noise", colors(1.0, 0.0));
    for (p, value) in REFERENCE {
        let got = noise_of(&t, DVec3::from_array(p));
        assert!((got - value).abs() < 1e-7, "{p:?}: {got} is not {value}");
    }
}

/// Computed by a separate Python program after the listing in Perlin 2002.
#[allow(clippy::approx_constant)] // The customary first point.
const REFERENCE: [([f64; 3], f64); 6] = [
    ([3.14, 42.0, 7.0], 0.13691995878400012),
    ([0.5, 0.5, 0.5], -0.25),
    ([-0.25, 1.75, 2.125], -0.07883389721973799),
    ([255.9, 255.1, -255.3], -0.05684112293653021),
    ([10.1, -20.2, 30.3], 0.3410360150525964),
    ([100.625, 0.375, 0.875], 0.44027990628040925),
];

#[test]
fn noise_stays_in_range_and_is_continuous_and_repeats() {
    let t = one("noise", colors(1.0, 0.0));
    let unit = |k: u64| f64::from(kirkas_geometry::hash::unit_f32(kirkas_geometry::hash::combine(3, k) as u32));
    let (mut low, mut high, mut sum) = (0.0_f64, 0.0_f64, 0.0);
    const N: u64 = 100_000;
    for k in 0..N {
        let p = DVec3::new(unit(3 * k), unit(3 * k + 1), unit(3 * k + 2)) * 512.0 - 256.0;
        let value = noise_of(&t, p);
        (low, high, sum) = (low.min(value), high.max(value), sum + value);
        let beside = noise_of(&t, p + DVec3::new(1e-4, -1e-4, 1e-4));
        assert!((value - beside).abs() < 1e-3, "jumps at {p}");
        if k % 100 == 0 {
            assert!((noise_of(&t, p + DVec3::new(256.0, 0.0, -256.0)) - value).abs() < 1e-6);
        }
    }
    // Weights of the texture are cut off at 1/2; the noise itself reaches nearly 1.
    assert!(low == -0.5 && high == 0.5);
    assert!((sum / N as f64).abs() < 5e-3);
    // Across a face of the lattice the value is continuous too.
    for k in 0..100 {
        let (y, z) = (unit(k) * 9.0, unit(k + 500) * 9.0);
        let (a, b) = (noise_of(&t, DVec3::new(3.0 - 1e-7, y, z)), noise_of(&t, DVec3::new(3.0, y, z)));
        assert!((a - b).abs() < 1e-6);
    }
}

#[test]
fn points_at_infinity_get_a_colour_as_well() {
    for type_name in ["checker", "noise", "marble", "wood"] {
        let params = if type_name == "checker" { colors(0.2, 0.8).with("mapping", "solid") } else { colors(0.2, 0.8) };
        let t = one(type_name, params);
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300, f64::MAX] {
            let value = red(&t, solid(x, 0.3, x));
            assert!((0.19..=0.81).contains(&value), "{type_name} at {x}: {value}");
        }
    }
}

#[test]
fn octaves_add_up_at_half_the_strength_and_twice_the_pace() {
    let (one_octave, three) = (one("noise", colors(1.0, 0.0)), one("noise", colors(1.0, 0.0).with("octaves", 3_i64)));
    for k in 0..100 {
        let p = DVec3::new(0.013, 0.017, 0.011) * f64::from(k);
        let n = |factor: f64| noise_of(&one_octave, p * factor);
        let sum = n(1.0) + n(2.0) / 2.0 + n(4.0) / 4.0;
        // Only where neither is cut off.
        if sum.abs() < 0.5 && n(1.0).abs() < 0.5 && n(2.0).abs() < 0.5 && n(4.0).abs() < 0.5 {
            assert!((noise_of(&three, p) - sum).abs() < 1e-6);
        }
    }
}

#[test]
fn marble_and_wood_without_octaves_are_plain_sines() {
    let params = colors(1.0, 0.0).with("octaves", 0_i64).with("frequency", 3.0).with("amplitude", 5.0);
    let (marble, wood) = (one("marble", params.clone()), one("wood", params));
    for k in -20..20 {
        let x = 0.137 * f64::from(k);
        let expected = 0.5 + 0.5 * (3.0 * x).sin();
        assert!((f64::from(red(&marble, solid(x, 7.7, -3.3))) - expected).abs() < 1e-6);
        let (c, s) = (0.6, 0.8);
        let ring = 0.5 + 0.5 * (3.0 * x.abs()).sin();
        assert!((f64::from(red(&wood, solid(c * x, 123.0, s * x))) - ring).abs() < 1e-6);
    }
}

#[test]
fn marble_is_shaken_by_amplitude_times_noise() {
    let noise = one("noise", colors(1.0, 0.0));
    let marble = one("marble", colors(1.0, 0.0).with("octaves", 1_i64).with("frequency", 2.0).with("amplitude", 3.0));
    for k in 0..100 {
        let p = DVec3::new(0.11, 0.07, 0.05) * f64::from(k);
        let n = noise_of(&noise, p);
        if n.abs() < 0.5 {
            let expected = 0.5 + 0.5 * (2.0 * p.x + 3.0 * n).sin();
            assert!((f64::from(red(&marble, solid(p.x, p.y, p.z))) - expected).abs() < 1e-6);
        }
    }
}

/// Four texels: top row 0 and 51, bottom row 102 and 255, as plain numbers.
fn four_texels(params: Map) -> Textures {
    picture(png(2, 2, &[0, 51, 102, 255]), params.with("encoding", "linear"))
}

#[test]
fn bilinear_is_exact_at_texel_centres_and_halfway_between() {
    let t = four_texels(Map::default());
    assert_eq!(red(&t, flat(0.25, 0.75)), 0.0);
    assert_eq!(red(&t, flat(0.75, 0.75)), 51.0 / 255.0);
    assert_eq!(red(&t, flat(0.25, 0.25)), 102.0 / 255.0);
    assert_eq!(red(&t, flat(0.75, 0.25)), 1.0);
    let middle = red(&t, flat(0.5, 0.5));
    assert!((middle - 0.4).abs() < 1e-6, "{middle}");
    let edge = red(&t, flat(0.5, 0.25));
    assert!((edge - 0.7).abs() < 1e-6, "{edge}");
    // A quarter of the way from the bottom left to the bottom right.
    let quarter = red(&t, flat(0.375, 0.25));
    assert!((quarter - 0.55).abs() < 1e-6, "{quarter}");
}

#[test]
fn nearest_takes_the_texel_that_holds_the_point() {
    let t = four_texels(Map::default().with("filter", "nearest"));
    assert_eq!(red(&t, flat(0.0, 0.0)), 0.4);
    assert_eq!(red(&t, flat(0.49, 0.51)), 0.0);
    assert_eq!(red(&t, flat(0.51, 0.99)), 0.2);
    assert_eq!(red(&t, flat(0.99, 0.01)), 1.0);
}

#[test]
fn pictures_wrap_as_told() {
    let at = |wrap: &str, u: f32, v: f32| {
        red(&four_texels(Map::default().with("wrap", wrap).with("filter", "nearest")), flat(u, v))
    };
    // The bottom row, from left to right: 0.4, 1.
    for (wrap, expected) in [
        ("repeat", [0.4, 1.0, 0.4, 1.0, 0.4, 1.0]),
        ("clamp", [0.4, 0.4, 0.4, 1.0, 1.0, 1.0]),
        ("mirror", [1.0, 0.4, 0.4, 1.0, 1.0, 0.4]),
        ("black", [0.0, 0.0, 0.4, 1.0, 0.0, 0.0]),
    ] {
        let seen = [-0.75, -0.25, 0.25, 0.75, 1.25, 1.75].map(|u| at(wrap, u, 0.25));
        assert_eq!(seen, expected, "{wrap}");
    }
    // Upwards likewise: the left column from the bottom is 0.4, 0.
    assert_eq!(at("repeat", 0.25, 1.25), 0.4);
    assert_eq!(at("mirror", 0.25, 1.25), 0.0);
    assert_eq!(at("clamp", 0.25, 7.0), 0.0);
    assert_eq!(at("black", 0.25, 1.25), 0.0);
    // Filtering reaches over the border: halfway between the last column and the first.
    let t = four_texels(Map::default());
    assert!((red(&t, flat(1.0, 0.25)) - 0.7).abs() < 1e-6);
    assert!((red(&t, flat(0.0, 0.25)) - 0.7).abs() < 1e-6);
    for wild in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
        for wrap in ["repeat", "clamp", "mirror", "black"] {
            let value = red(&four_texels(Map::default().with("wrap", wrap)), flat(wild, wild));
            assert!((0.0..=1.0).contains(&value), "{wrap} at {wild}: {value}");
        }
    }
}

#[test]
fn scale_and_offset_place_the_picture() {
    let nearest = Map::default().with("filter", "nearest");
    let t = four_texels(nearest.with("scale", [2.0, 1.0]).with("offset", [0.5, 0.0]));
    // u = 0.125 is 0.75 of the picture.
    assert_eq!(red(&t, flat(0.125, 0.25)), 1.0);
    assert_eq!(red(&t, flat(0.375, 0.25)), 0.4);
}

#[test]
fn codes_are_decoded_before_they_are_filtered() {
    let bytes = png(2, 1, &[0, 255]);
    let srgb = picture(bytes.clone(), Map::default().with("wrap", "clamp"));
    // Halfway between black and white is half the light, not the code 127.
    assert!((red(&srgb, flat(0.5, 0.5)) - 0.5).abs() < 1e-6);
    let grey = png(1, 1, &[188]);
    let linear = ((188.0 / 255.0 + 0.055) / 1.055_f64).powf(2.4) as f32;
    for (encoding, expected) in [("auto", linear), ("srgb", linear), ("linear", 188.0 / 255.0)] {
        let t = picture(grey.clone(), Map::default().with("encoding", encoding));
        assert!((red(&t, flat(0.3, 0.3)) - expected).abs() < 1e-7, "{encoding}");
    }
    let deep = write_png16(1, 1, &[48_316], &Texts::new()).expect("a sound picture");
    let t = picture(deep, Map::default());
    assert!((red(&t, flat(0.3, 0.3)) - ((48_316.0 / 65_535.0 + 0.055) / 1.055_f64).powf(2.4) as f32).abs() < 1e-7);
}

#[test]
fn float_pictures_are_linear_not_multiplied_by_alpha_and_finite() {
    let mut image = Image::new(2, 1);
    for (name, values) in [("R", [3.0, f32::INFINITY]), ("G", [0.5, 1.0]), ("B", [0.0, f32::NAN]), ("A", [0.5, 1.0])] {
        image.push(name, ChannelData::F32(values.to_vec()));
    }
    let bytes = write_exr(&image, ExrCompression::None).expect("a sound picture");
    let t = picture(bytes, Map::default().with("filter", "nearest"));
    assert_eq!(t.color(T, &flat(0.25, 0.5)), [6.0, 1.0, 0.0]);
    assert_eq!(t.color(T, &flat(0.75, 0.5)), [0.0, 1.0, 0.0]);
    assert_eq!(t.alpha(NumberSource::Texture(0), &flat(0.25, 0.5)), 0.5);
}

#[test]
fn numbers_are_means_and_masks_take_the_alpha_channel() {
    let with_alpha = picture(png(1, 1, &[255, 0, 51, 128]), Map::default().with("encoding", "linear"));
    let (n, p) = (NumberSource::Texture(0), flat(0.5, 0.5));
    assert!((with_alpha.number(n, &p) - 0.4).abs() < 1e-6);
    assert!((with_alpha.alpha(n, &p) - 128.0 / 255.0).abs() < 1e-6);
    let without = picture(png(1, 1, &[255, 0, 51]), Map::default().with("encoding", "linear"));
    assert!((without.alpha(n, &p) - 0.4).abs() < 1e-6);
    assert_eq!(without.alpha(NumberSource::Constant(0.3), &p), 0.3);
    assert_eq!(without.number(NumberSource::Constant(0.3), &p), 0.3);
    // Through a texture made of textures, the mask stays a mask.
    let assets = TestAssets { files: [("p.png".to_string(), png(1, 1, &[255, 255, 255, 0]))].into() };
    let leaf = Map::default().with("file", "p.png");
    let both = [("c", "checker", Map::default().with("a", "leaf").with("b", 1.0)), ("leaf", "image", leaf)];
    let t = compile(&both, &assets).expect("sound textures");
    assert_eq!(t.alpha(n, &flat(0.5, 0.5)), 0.0);
    assert_eq!(t.alpha(n, &flat(1.5, 0.5)), 1.0);
    assert_eq!(t.number(n, &flat(0.5, 0.5)), 1.0);
}

#[test]
fn textures_can_be_made_of_textures_in_any_order() {
    let t = compile(
        &[
            ("outer", "checker", Map::default().with("a", "inner").with("b", "#ffffff")),
            ("inner", "checker", Map::default().with("a", 0.1).with("b", 0.2).with("scale", 2.0)),
        ],
        &TestAssets::default(),
    )
    .expect("sound textures");
    assert_eq!(red(&t, flat(0.25, 0.25)), 0.1);
    assert_eq!(red(&t, flat(0.75, 0.25)), 0.2);
    assert_eq!(red(&t, flat(1.25, 0.25)), 1.0);
    assert_eq!((t.names().find("outer"), t.names().find("inner"), t.names().find("other")), (Some(0), Some(1), None));
}

#[test]
fn a_texture_made_of_itself_is_one_error_that_shows_the_chain() {
    let place = |start: usize| Span::new(SourceId(0), start, start + 1);
    let uses = |name: &str, start: usize| {
        let mut map = Map::default();
        map.set(Name::new("a"), Node::spanned(name, place(start)));
        map
    };
    let errors = compile(
        &[
            ("entry", "noise", uses("a", 1)),
            ("a", "checker", uses("b", 2)),
            ("b", "marble", uses("c", 3)),
            ("c", "wood", uses("a", 4)),
        ],
        &TestAssets::default(),
    )
    .expect_err("a cycle");
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].message, "texture `a` is made of itself: `a` -> `b` -> `c` -> `a`");
    let labels: Vec<_> = errors[0].labels.iter().map(|(span, text)| (span.start, text.as_str())).collect();
    assert_eq!(labels, [(2, "`a` uses `b`"), (3, "`b` uses `c`"), (4, "`c` uses `a`")]);
    assert!(errors[0].help.is_some());
    let own = compile(&[("t", "noise", uses("t", 7))], &TestAssets::default()).expect_err("a cycle");
    assert_eq!(own[0].message, "texture `t` is made of itself: `t` -> `t`");
}

#[test]
fn deep_or_exploding_textures_are_refused_not_suffered() {
    // Each level doubles the lookups.
    let doubling: Vec<(String, Map)> = (0..40)
        .map(|i| (format!("t{i}"), Map::default().with("a", format!("t{}", i + 1)).with("b", format!("t{}", i + 1))))
        .collect();
    let mut list: Vec<(&str, &str, Map)> = doubling.iter().map(|(n, m)| (n.as_str(), "noise", m.clone())).collect();
    list.push(("t40", "noise", Map::default()));
    let errors = compile(&list, &TestAssets::default()).expect_err("2^40 lookups");
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].message, "texture `t31` needs more than 1000 lookups of other textures at each point");

    let chain: Vec<(String, Map)> =
        (0..100_000).map(|i| (format!("t{i}"), Map::default().with("a", format!("t{}", i + 1)))).collect();
    let mut description = Description::default();
    for (name, map) in chain {
        description.all_mut(Kind::Texture).push(Entity::new(&name, "noise", map));
    }
    description.all_mut(Kind::Texture).push(Entity::new("t100000", "noise", Map::default()));
    let errors = Textures::compile(&description, &catalog(), &TestAssets::default()).expect_err("too deep");
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].code, "texture-too-deep");
}

#[test]
fn a_mesh_brings_textures_of_its_own_with_its_own_folder() {
    let assets = TestAssets {
        files: [
            ("scenes/p.png".to_string(), png(1, 1, &[255])),
            ("p.png".to_string(), png(1, 1, &[0])),
            ("models/car/p.png".to_string(), png(1, 1, &[0, 255, 0])),
        ]
        .into(),
    };
    let mut params = Map::default();
    params.set(Name::new("file"), Node::spanned("p.png", Span::new(SourceId(0), 0, 5)));
    let mut t = compile(&[("paint", "image", params)], &assets).expect("a sound texture");
    let own = [
        Entity::new("paint", "image", Map::default().with("file", "p.png")),
        Entity::new("mixed", "checker", Map::default().with("a", "paint")),
    ];
    let names = t.add(&own, "models/car", &catalog(), &assets).expect("sound textures");
    assert_eq!((names.find("paint"), names.find("mixed")), (Some(1), Some(2)));
    let p = flat(0.5, 0.5);
    assert_eq!(t.color(ColorSource::Texture(0), &p), [1.0; 3]);
    assert_eq!(t.color(ColorSource::Texture(1), &p), [0.0, 1.0, 0.0]);
    assert_eq!(t.color(ColorSource::Texture(2), &p), [0.0, 1.0, 0.0]);
    assert_eq!(t.names().find("mixed"), None);

    let wrong = [Entity::new("x", "checker", Map::default().with("a", "pait").with("b", "paint"))];
    let errors = t.add(&wrong, "", &catalog(), &assets).expect_err("unknown names");
    assert_eq!(errors.len(), 2);
    assert!(errors[0].message.starts_with("unknown texture `pait`"), "{}", errors[0].message);
    // Nothing was added.
    assert_eq!(
        t.add(&[Entity::new("y", "noise", Map::default())], "", &catalog(), &assets).map(|n| n.find("y")),
        Ok(Some(3))
    );
}

#[test]
fn pictures_that_cannot_be_read_say_which_and_where() {
    let span = Span::new(SourceId(0), 5, 9);
    let fails = |path: &str, files: &[(&str, &[u8])]| {
        let files = files.iter().map(|(name, bytes)| (name.to_string(), bytes.to_vec())).collect();
        let mut params = Map::default();
        params.set(Name::new("file"), Node::spanned(path, span));
        let mut errors = compile(&[("t", "image", params)], &TestAssets { files }).expect_err("no picture");
        assert_eq!((errors.len(), errors[0].labels[0].0), (1, span));
        errors.remove(0)
    };
    assert_eq!(fails("no.png", &[]).message, "there is no file `scenes/no.png`");
    let noise = fails("n.png", &[("scenes/n.png", b"not a picture at all")]);
    assert_eq!(noise.message, "the picture `n.png` cannot be read: not a picture of a known format");
    assert!(noise.help.is_some());
    let whole = png(4, 4, &[7; 16]);
    let cut = fails("cut.png", &[("scenes/cut.png", &whole[..whole.len() / 2])]);
    assert!(
        cut.message.starts_with("the picture `cut.png` cannot be read: this PNG file is damaged"),
        "{}",
        cut.message
    );
}

static MATERIAL: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "test",
    doc: "",
    params: &[
        ParamSpec::reflectance("color", [0.5; 3], ""),
        ParamSpec::number_texture("amount", 0.25, (0.0, 1.0), ""),
        ParamSpec::new("ambient", ParamType::ColorTexture, Fallback::Absent, ""),
    ],
};

#[test]
fn materials_find_constants_textures_and_defaults() {
    let catalog = Catalog { types: vec![&MATERIAL], common: Vec::new() };
    let textures = one("noise", Map::default());
    let check = |map: Map, test: fn(&TextureNames, &Params)| {
        let entity = Entity::new("m", "test", map);
        test(textures.names(), &Params::new(&entity, Kind::Material, &catalog).expect("a listed type"));
    };
    check(Map::default(), |names, params| {
        assert_eq!(names.color(params, "color"), ColorSource::Constant([0.5; 3]));
        assert_eq!(names.number(params, "amount"), NumberSource::Constant(0.25));
        assert_eq!(names.optional_color(params, "ambient"), None);
    });
    let written = Map::default().with("color", "#ff0000").with("amount", "t").with("ambient", "t");
    check(written, |names, params| {
        assert_eq!(names.color(params, "color"), ColorSource::Constant([1.0, 0.0, 0.0]));
        assert_eq!(names.number(params, "amount"), NumberSource::Texture(0));
        assert_eq!(names.optional_color(params, "ambient"), Some(ColorSource::Texture(0)));
    });
    check(Map::default().with("color", "t").with("amount", 0.75), |names, params| {
        assert_eq!(names.color(params, "color"), ColorSource::Texture(0));
        assert_eq!(names.number(params, "amount"), NumberSource::Constant(0.75));
    });
}
