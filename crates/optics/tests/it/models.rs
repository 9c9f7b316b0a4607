//! Parameter sets for every model, and models made from them.

use crate::extremes::grey;
use crate::samples;
use kirkas_geometry::Vec3;
use kirkas_optics::bsdf::{Parts, part_names, texture_rows};
use kirkas_optics::{Bsdf, BsdfModel, ColorMode, Interface, Lanes, Light, Palette, SPECS};
use kirkas_scene::{Catalog, Entity, Kind, Map, Node, ParamType, Params, TypeSpec, Value};

/// A model with parameters, between two media.
pub struct Case {
    pub label: String,
    pub model: BsdfModel,
    pub bsdf: Bsdf,
    pub interface: Interface,
    /// Made of others.
    pub is_composed: bool,
    /// As bright both ways.
    pub is_reciprocal: bool,
    /// Sends out no more power than it gets; else at most this many times as much radiance.
    pub is_bounded: bool,
    /// Light that crosses it is scaled as physics has it.
    pub scales_radiance: bool,
}

impl Case {
    /// The refractive index on `w`'s side.
    pub fn eta(&self, w: Vec3) -> f64 {
        f64::from(self.interface.seen_from(w).0)
    }
}

pub fn parse(pairs: &[(&str, Value)]) -> Map {
    pairs.iter().fold(Map::default(), |m, (n, v)| m.with(n, v.clone()))
}

/// A parameter set in short: `name=value` words, colours as `r,g,b`, `@gold` for a metal's constants, and
/// `outside`, the index above.
pub fn set(words: &str) -> (Map, f32) {
    let mut outside = 1.0;
    let mut map = Map::default();
    for word in words.split_whitespace() {
        let (name, text) = word.split_once('=').expect("name=value");
        let numbers: Option<Vec<f64>> = text.split(',').map(|x| x.parse().ok()).collect();
        let value = match (text, numbers) {
            _ if text.starts_with('@') => Value::from(Map::default().with("material", &text[1..])),
            ("true" | "false", _) => Value::from(text == "true"),
            (_, None) if name == "materials" => {
                Value::List(text.split(',').map(|x| Node::new(Value::from(x))).collect())
            }
            (_, None) => Value::from(text),
            (_, Some(one)) if one.len() == 1 && name != "weights" => Value::Float(one[0]),
            (_, Some(many)) => Value::List(many.into_iter().map(|x| Node::new(Value::Float(x))).collect()),
        };
        match (name, &value) {
            ("outside", Value::Float(x)) => outside = *x as f32,
            _ => map = map.with(name, value),
        }
    }
    (map, outside)
}

/// The palette and the lanes of a render.
#[derive(Clone, Copy)]
pub enum Colors {
    Rgb,
    Spectral(f32),
}

/// Make a model from its parameters alone, `outside` the refractive index above it.
pub fn build(type_name: &str, params: &Map, outside: f32) -> Case {
    build_in(Colors::Rgb, type_name, params, outside)
}

/// The same in a spectral render.
pub fn build_in(colors: Colors, type_name: &str, params: &Map, outside: f32) -> Case {
    let (mode, lanes) = match colors {
        Colors::Rgb => (ColorMode::Rgb, Lanes::RGB),
        Colors::Spectral(u) => (ColorMode::Spectral, Lanes::spectral(u)),
    };
    build_with(&samples::palette(mode), lanes, type_name, params, outside)
}

/// The same, with files of its own.
pub fn build_with(palette: &Palette, lanes: Lanes, type_name: &str, params: &Map, outside: f32) -> Case {
    let catalog = Catalog { types: SPECS.iter().collect(), common: Vec::new() };
    let entity = Entity::new("it", type_name, params.clone());
    let params = Params::new(&entity, Kind::Material, &catalog).expect("a listed model");
    let model = BsdfModel::prepare(&params, palette).expect("a listed model");
    let rgb = |v: f64| [v as f32; 3];
    let slots: Vec<Light> = texture_rows(model.spec())
        .map(|row| {
            let value = match row.ty {
                ParamType::NumberTexture => rgb(params.number(row.name)),
                ParamType::VectorTexture => params.vector(row.name).map(|x| x as f32),
                _ => params.color(row.name).map(|x| x as f32),
            };
            lanes.parameter(row, value)
        })
        .collect();
    let parts = TestParts::new(palette, lanes, &params, outside);
    // A composed model bounds what its first part that bounds anything does.
    let of_parts = parts.0.iter().map(|p| p.interface).find(|i| i.eta_below != outside && !model.is_opaque());
    let below = model.medium().map_or(of_parts.map_or(outside, |i| i.eta_below), |m| m.ior.at_d_line());
    let interface = Interface::new(outside, below);
    let bsdf = model.at(&lanes, &slots, interface, &parts);
    let written = |name: &str| params.entity.params.get(name).and_then(Node::text);
    let classic = written("form") == Some("classic");
    let lopsided = classic && type_name.contains("phong");
    let is_constant = written("fresnel").map_or(type_name.contains("phong"), |word| word == "constant");
    let label = format!("{type_name} {:?}", entity.params.iter().map(|(n, v)| (&n.text, &v.value)).collect::<Vec<_>>());
    Case {
        label,
        // Measurements by slices of one direction are reciprocal up to their noise only.
        is_reciprocal: !(lopsided || written("file").is_some_and(|f| f.ends_with(".bsdf")))
            && parts.0.iter().all(|p| p.is_reciprocal),
        is_bounded: !classic && parts.0.iter().all(|p| p.is_bounded),
        scales_radiance: !(is_constant && model.medium().is_some()) && parts.0.iter().all(|p| p.scales_radiance),
        is_composed: !parts.0.is_empty(),
        model,
        bsdf,
        interface,
    }
}

/// The materials that composed ones are made of here, by name; `tests/reference/parts.py` has them as well.
const PARTS: [(&str, &str, &str); 8] = [
    ("wall", "lambert", "reflectance=0.9,0.6,0.3"),
    ("clay", "oren_nayar", "reflectance=0.3,0.5,0.7 roughness=0.6"),
    ("gloss", "ward", "diffuse=0.05 specular=0.5,0.6,0.7 roughness=0.3"),
    ("metal", "rough_conductor", "ior=0.2 k=3.5,2.5,1.9 roughness=0.4 anisotropy=0.5"),
    ("frost", "rough_dielectric", "roughness=0.3 ior=1.4"),
    ("glass", "dielectric", "ior=1.4"),
    ("silver", "mirror", "reflectance=0.9"),
    ("both", "sum", "materials=wall,metal weights=0.5,0.5"),
];

/// Before the name of a part: all its colours are grey.
pub const GREY: &str = "grey_";

/// Built once per case; the relief of a bump map rises by 0.4 along x and falls by 0.2 along y.
struct TestParts(Vec<Case>);

impl TestParts {
    fn new(palette: &Palette, lanes: Lanes, params: &Params, outside: f32) -> Self {
        let part = |name: &str| {
            let plain = name.trim_start_matches(GREY);
            let (_, type_name, words) = PARTS.iter().find(|p| p.0 == plain).expect("a part");
            let params = set(words).0;
            let params = if plain == name { params } else { grey(&params).expect("a part without dispersion") };
            build_with(palette, lanes, type_name, &params, outside)
        };
        TestParts(part_names(params).into_iter().map(|(name, _)| part(name)).collect())
    }
}

impl Parts for TestParts {
    fn part(&self, number: usize) -> Bsdf {
        self.0[number].bsdf.clone()
    }
    fn slopes(&self, _: usize) -> (f32, f32) {
        (0.4, -0.2)
    }
}

/// At least three sets for each type; a listed model without them fails.
pub fn parameter_sets(type_name: &str) -> Vec<(Map, f32)> {
    if type_name == "measured" {
        return samples::LISTED.iter().map(|file| (parse(&[("file", Value::from(*file))]), 1.0)).collect();
    }
    short_sets(type_name).iter().map(|words| set(words)).collect()
}

fn short_sets(type_name: &str) -> &'static [&'static str] {
    match type_name {
        "lambert" => &["", "reflectance=0.9,0.2,0.05", "reflectance=1 outside=1.33"],
        "phong" | "blinn_phong" => &[
            "diffuse=0.5,0.4,0.1 specular=0.3 exponent=20",
            "diffuse=0 specular=0.9,0.7,0.1 exponent=200",
            "diffuse=0 specular=1 exponent=0",
            "diffuse=0 specular=1 exponent=1.5",
            "diffuse=0.4 specular=0.5 exponent=8 form=classic",
            "diffuse=0.2 specular=0.1 exponent=5 reflect=0.3 transmit=0.4 outside=1.2",
            "diffuse=0.1 specular=0.1 reflect=0.5 transmit=0.8 fresnel=exact",
            "diffuse=0.1 specular=0.1 reflect=0.5 ior=2 fresnel=schlick",
        ],
        "mirror" => &["", "reflectance=0.9,0.2,0.05", "reflectance=0.9,0.2,0 fresnel=schlick"],
        "dielectric" => &[
            "",
            "ior=1.1 fresnel=schlick transmittance=0.3,0.2,0.9 outside=1.33",
            "ior=2.4 reflectance=0.5",
            "ior=1.5 film_thickness=400",
            "reflectance=0.25 transmittance=0.5 fresnel=constant",
        ],
        "rough_mirror" => &[
            "reflectance=1 roughness=0.5",
            "reflectance=0.9,0.2,0 roughness=0.15 fresnel=schlick",
            "roughness=1",
            "roughness=0.4 anisotropy=0.6 compensation=true",
            "roughness=0.3 anisotropy=-0.5 distribution=beckmann fresnel=schlick reflectance=0.5",
            "roughness=0.8 distribution=beckmann compensation=true",
        ],
        "rough_dielectric" => &[
            "roughness=0.3",
            "ior=1.1 roughness=0.5 fresnel=schlick transmittance=0.3,0.2,0.9 outside=1.33",
            "ior=2.4 roughness=0.15 reflectance=0.5",
            "reflectance=0.25 transmittance=0.5 roughness=0.8 fresnel=constant",
            "roughness=0.4 anisotropy=0.5 distribution=beckmann",
            "roughness=0.3 anisotropy=-0.7",
            "roughness=0.3 film_thickness=600 film_ior=2.1",
            "roughness=0.6 compensation=true",
            "roughness=0.9 distribution=beckmann compensation=true ior=1.9 transmittance=0.5,0.9,0.2",
        ],
        "conductor" => &[
            "ior=0.2 k=3.5,2.5,1.9",
            "ior=1.5 k=4 reflectance=0.5 outside=1.33",
            "ior=@gold",
            "ior=@gold film_thickness=350 film_ior=1.5",
        ],
        "rough_conductor" => &[
            "ior=0.2 k=3.5,2.5,1.9 roughness=0.5",
            "ior=1.5 k=4 roughness=0.15 outside=1.33",
            "ior=@copper roughness=1",
            "ior=0.2 k=3 roughness=0.6 anisotropy=-0.5 distribution=beckmann",
            "ior=0.2 k=3.5,2.5,1.9 roughness=0.5 compensation=true",
            "ior=2.9 k=3.1 roughness=0.3 film_thickness=150 film_ior=2.3 compensation=true",
        ],
        "emitter" => &["", "intensity=5 reflectance=0.2,0.5,0.9", "radiance=1,2,3 unit=nit"],
        "hull" => &["", "outside=1.33", "priority=3"],
        "oren_nayar" => &[
            "",
            "reflectance=1 roughness=1",
            "reflectance=0.8,0.6,0.4 roughness=0.5 form=full",
            "reflectance=0.9 roughness=1.5 form=full",
            "reflectance=0.8,0.6,0.4 roughness=0.5 form=qualitative",
        ],
        "cook_torrance" => &[
            "diffuse=0.1,0.2,0.3 specular=0.5,0.6,0.7 roughness=0.3",
            "diffuse=0.2 specular=0.8 roughness=0.5 form=classic fresnel=schlick ior=1.8",
            "diffuse=0 specular=1 roughness=0.8 fresnel=constant outside=1.33",
        ],
        "ashikhmin_shirley" => &[
            "diffuse=0.3,0.5,0.2 specular=0.04,0.1,0.2 exponent_u=30 exponent_v=30",
            "diffuse=0 specular=0.9,0.8,0.7 exponent_u=200 exponent_v=10",
            "diffuse=0.8 specular=0.5 exponent_u=3 exponent_v=40",
        ],
        "lafortune" => &[
            "diffuse=0.1,0.2,0.3 lobes=-0.86,-0.86,0.9,16,0.3,0.25,0.2,0.71,0.71,0.69,15,0.05,0.06,0.1",
            "diffuse=0 lobes=-1,-1,1,40,6,6,6",
            "diffuse=0.2 lobes=-0.9,-0.6,0.8,5.5,0.3,0.2,0.1,-0.5,-0.5,1.05,30,0.3,0.3,0.3,0.6,0.5,0.4,3,0.1,0.1,0.2",
        ],
        "ward" => &[
            "diffuse=0.3,0.2,0.1 specular=0.5,0.6,0.7 roughness=0.3",
            "diffuse=0 specular=1 roughness=0.4 anisotropy=0.6",
            "diffuse=0.2 specular=0.3 roughness=0.5 anisotropy=-0.5 form=classic",
        ],
        "plastic" => &[
            "reflectance=0.6,0.3,0.1",
            "reflectance=1",
            "reflectance=0.9,0.5,0.2 ior=1.9 outside=1.33",
            "reflectance=0.6,0.3,0.1 specular=0.5 ior=1.3 saturates=false outside=1.5",
        ],
        "rough_plastic" => &[
            "reflectance=0.6,0.3,0.1 roughness=0.3",
            "reflectance=1 roughness=0.6 anisotropy=0.5",
            "reflectance=0.9,0.5,0.2 ior=1.9 roughness=0.1 specular=0.5,0.6,0.7 outside=1.33",
            "reflectance=0.6,0.3,0.1 roughness=0.7 ior=1.3 saturates=false distribution=beckmann",
        ],
        "thin_dielectric" => &["", "ior=2.4 transmittance=0.5,0.9,0.2", "ior=1.33 outside=1.5 reflectance=0.5"],
        "microfacet_table" => &[
            "diffuse=0.1,0.2,0.3 reflectance=0.5,0.6,0.3 spread=0.4",
            "shape=ring angle=0.5 spread=0.2 reflectance=1 fresnel=constant",
            "shape=grooves angle=0.6 spread=0.3 reflectance=0.5,0.6,0.7",
            "shape=cross spread=0.5",
            "shape=table columns=4 table=1,1,1,1,3,0.5,3,0.5,0.1,2,0.1,2,0.2,0.2,0.2,0.2,0,0,0,0.1",
        ],
        "principled" => &[
            "",
            "base_color=0.6,0.3,0.1 roughness=0.2 specular=0.5 specular_color=0.9,0.5,0.7 diffuse_roughness=0.8 ior=1.8",
            "base_color=0.8,0.5,0.2 metalness=1 roughness=0.4 anisotropy=0.5 specular_color=0.9,0.8,0.7",
            "base_color=0.8,0.5,0.2 metalness=0.4 coat=1 coat_roughness=0.2 coat_color=0.9,0.8,0.7 roughness=0.4",
            "base_color=1 fuzz=0.8 fuzz_color=0.9,0.6,0.7 fuzz_roughness=0.4 specular=0",
            "base_color=1 coat=0.5 fuzz=0.3 roughness=0.5 coat_roughness=0.1 outside=1.33",
        ],
        "velvet" => &[
            "diffuse=0.1,0.2,0.3 sheen=0.5,0.4,0.6 roughness=0.3",
            "diffuse=0 sheen=1 roughness=0.1",
            "diffuse=0.2 sheen=0.7 roughness=1",
        ],
        "sum" => &[
            "materials=wall,metal weights=0.4,0.6",
            "materials=gloss weights=0.7",
            "materials=wall,clay,gloss",
            "materials=frost,silver weights=0.5,0.5",
            "materials=glass,metal weights=0.3,0.4 outside=1.2",
            "materials=clay,gloss form=classic",
        ],
        "blend" => &[
            "first=wall second=metal amount=0.3",
            "first=frost second=clay amount=0.6",
            "first=both second=gloss amount=0.5",
            "first=glass second=silver amount=0.25",
            "first=wall second=clay amount=1",
        ],
        "mask" => &["material=clay opacity=0.5", "material=frost", "material=both opacity=0"],
        "two_sided" => &["front=wall back=metal", "front=gloss", "front=frost back=silver"],
        "normal_map" => &[
            "material=wall normals=0.8,0.4,0.9",
            "material=metal normals=0.6,0.65,0.95",
            "material=frost normals=0.35,0.6,0.9",
            "material=glass normals=0.6,0.45,0.9",
            "material=both normals=0.2,0.2,0.7 strength=2",
            "material=silver normals=0.6,0.7,0.9",
            "material=clay",
        ],
        other => panic!("no parameter sets for `{other}`: add at least three here"),
    }
}

/// Every listed model with every one of its sets.
pub fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    for spec in SPECS {
        let sets = parameter_sets(spec.name);
        assert!(sets.len() >= 3, "`{}` wants three parameter sets", spec.name);
        all.extend(sets.iter().map(|(params, outside)| build(spec.name, params, *outside)));
    }
    all
}

/// Five directions above, the last one grazing, and two below.
pub fn outgoing() -> Vec<Vec3> {
    let mut all = kirkas_testkit::furnace::directions_above(5, 0.04);
    all.push(Vec3::new(0.3, -0.5, -0.8).normalize());
    all.push(Vec3::new(-0.9, 0.1, -0.15).normalize());
    all
}

#[test]
fn the_list_holds_each_model_once_with_its_rows() {
    let mut names: Vec<&str> = SPECS.iter().map(|s| s.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), SPECS.len());
    assert!(SPECS.iter().all(|s| s.kind == Kind::Material && !s.doc.is_empty()));
    let spec = |name: &str| SPECS.iter().find(|s| s.name == name).unwrap();
    let rows = |name: &str| spec(name).params.iter().map(|p| p.name).collect::<Vec<_>>();
    assert_eq!(rows("lambert"), ["reflectance"]);
    let phong =
        ["diffuse", "specular", "exponent", "form", "ambient", "reflect", "transmit", "ior", "fresnel", "priority"];
    assert_eq!((rows("phong"), rows("blinn_phong")), (phong.to_vec(), phong.to_vec()));
    assert_eq!(
        rows("dielectric"),
        [
            "ior",
            "fresnel",
            "reflectance",
            "transmittance",
            "absorption",
            "priority",
            "interior",
            "film_thickness",
            "film_ior"
        ]
    );
    let rough = [
        "ior",
        "fresnel",
        "reflectance",
        "transmittance",
        "absorption",
        "priority",
        "roughness",
        "anisotropy",
        "distribution",
        "interior",
        "film_thickness",
        "film_ior",
        "compensation",
    ];
    assert_eq!(rows("rough_dielectric"), rough);
    let textured: Vec<&str> = texture_rows(spec("phong")).map(|r| r.name).collect();
    assert_eq!(textured, ["diffuse", "specular", "exponent", "ambient", "reflect", "transmit"]);
}

#[test]
fn a_type_that_is_no_material_is_no_model() {
    static OTHER: TypeSpec = TypeSpec { kind: Kind::Material, name: "nothing", doc: "", params: &[] };
    let catalog = Catalog { types: vec![&OTHER], common: Vec::new() };
    let entity = Entity::new("it", "nothing", Map::default());
    assert!(BsdfModel::prepare(&Params::new(&entity, Kind::Material, &catalog).unwrap(), &Palette::RGB).is_none());
}

#[test]
fn every_manual_head_has_its_parts() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/bsdf/");
    for spec in SPECS {
        let text = std::fs::read_to_string(format!("{folder}{}.rs", spec.name)).unwrap();
        for part in ["## Parameters", "## Example", "## Limits", "## References"] {
            assert!(text.contains(&format!("//! {part}")), "{} lacks {part}", spec.name);
        }
        assert!(text.starts_with(&format!("//! # {}\n", spec.name)) && text.contains("//! ```toml"));
        for row in spec.params {
            assert!(text.contains(&format!("//! | `{}` |", row.name)), "{} does not explain `{}`", spec.name, row.name);
        }
    }
}

#[test]
fn media_are_read_from_the_rows() {
    let glass =
        parse(&[("ior", Value::Float(1.7)), ("priority", Value::Int(3)), ("absorption", Value::from([0.1, 0.2, 0.3]))]);
    for name in ["dielectric", "rough_dielectric"] {
        let m = build(name, &glass, 1.0).model.medium().cloned().unwrap();
        assert_eq!((m.ior.at_d_line(), m.priority, m.absorption.rgb()), (1.7, 3, [0.1, 0.2, 0.3]));
    }
    for name in ["phong", "blinn_phong"] {
        let with = |v: Value| {
            build(name, &parse(&[("transmit", v), ("ior", Value::Float(1.3)), ("priority", Value::Int(2))]), 1.0)
        };
        let m = with(Value::Float(0.5)).model.medium().cloned().unwrap();
        assert_eq!((m.ior.at_d_line(), m.priority, m.absorption.rgb()), (1.3, 2, [0.0; 3]));
        assert!(with(Value::from("a_texture")).model.medium().is_some());
        assert!(with(Value::Float(0.0)).model.medium().is_none());
        assert!(build(name, &Map::default(), 1.0).model.medium().is_none());
    }
    for name in ["lambert", "mirror", "rough_mirror", "emitter"] {
        assert!(build(name, &Map::default(), 1.0).model.medium().is_none());
    }
}

/// A hit carries its model about: it must stay small.
#[test]
fn a_model_at_a_point_is_small() {
    assert!(size_of::<Bsdf>() <= 288, "{}", size_of::<Bsdf>());
}
