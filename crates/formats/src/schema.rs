//! The JSON Schema (draft 2020-12) of native TOML, cut from the catalogue's tables: an editor with a TOML language server
//! completes and checks a scene by it. Put `#:schema kirkas.schema.json` at the head of a scene.

use crate::json::Json;
use kirkas_scene::{Catalog, Fallback, Kind, ParamSpec, ParamType, TypeSpec};

/// The whole schema as text.
pub fn json_schema(catalog: &Catalog) -> String {
    let mut properties = vec![
        (
            "version".to_string(),
            described(Json::map([("const", Json::Number(1.0))]), "The version of the scene format."),
        ),
        ("title".to_string(), described(of_type("string"), "What the picture is called.")),
        ("description".to_string(), described(of_type("string"), "A few words about it.")),
        (
            "include".to_string(),
            described(
                any_of([of_type("string"), list(of_type("string"), None)]),
                "Scene files that are read first, relative to this one.",
            ),
        ),
    ];
    let mut definitions = Vec::new();
    for kind in Kind::ALL {
        let reference = reference(kind.singular());
        let section = match kind.is_single() {
            true => reference,
            false => of_type("object").with("additionalProperties", reference),
        };
        properties.push((kind.section().to_string(), section));
        definitions.push((kind.singular().to_string(), any_type(catalog, kind)));
        for spec in catalog.of_kind(kind) {
            definitions.push((definition_name(spec), one_type(catalog, spec)));
        }
    }
    definitions.push(("transform".into(), transform()));
    definitions.push(("motion".into(), motion()));
    definitions.push(("wave_color".into(), wave_color()));
    definitions.push(("wave_index".into(), wave_index()));
    Json::map([
        ("$schema", Json::text("https://json-schema.org/draft/2020-12/schema")),
        ("title", Json::text("Kirkas scene")),
        ("description", Json::text("Native scene format of the Kirkas ray tracer.")),
        ("type", Json::text("object")),
        ("properties", Json::Map(properties)),
        ("additionalProperties", Json::Bool(false)),
        ("$defs", Json::Map(definitions)),
    ])
    .pretty()
}

/// A thing of this kind: `type` chooses which.
fn any_type(catalog: &Catalog, kind: Kind) -> Json {
    let types: Vec<&TypeSpec> = catalog.of_kind(kind).collect();
    let mut type_ = Json::map([("enum", Json::texts(types.iter().map(|t| t.name)))]);
    if let Some(default) = kind.default_type() {
        type_ = type_.with("default", Json::text(default));
    }
    let mut any = of_type("object")
        .with("properties", Json::map([("type", described(type_, &format!("Which {}.", kind.singular())))]));
    if !types.is_empty() {
        any = any.with("oneOf", Json::List(types.iter().map(|t| reference(&definition_name(t))).collect()));
    }
    any
}

fn one_type(catalog: &Catalog, spec: &'static TypeSpec) -> Json {
    let mut properties = vec![("type".to_string(), described(Json::map([("const", Json::text(spec.name))]), spec.doc))];
    let mut required = Vec::new();
    if spec.kind.default_type() != Some(spec.name) {
        required.push("type");
    }
    for row in catalog.rows(spec) {
        if row.fallback == Fallback::Required {
            required.push(row.name);
        }
        properties.push((row.name.to_string(), parameter(row)));
    }
    Json::map([
        ("title", Json::text(format!("{} {}", spec.kind.singular(), spec.name))),
        ("description", Json::text(spec.doc)),
        ("type", Json::text("object")),
        ("properties", Json::Map(properties)),
        ("required", Json::texts(required)),
        ("additionalProperties", Json::Bool(false)),
    ])
}

fn parameter(row: &ParamSpec) -> Json {
    let unit = if row.unit.is_empty() { String::new() } else { format!(" Unit: {}.", row.unit) };
    let schema = described(value(row), &format!("{}{unit}", row.doc));
    match row.fallback {
        Fallback::Required | Fallback::Absent => schema,
        Fallback::Bool(b) => schema.with("default", Json::Bool(b)),
        Fallback::Number(n) => schema.with("default", Json::Number(n)),
        Fallback::Text(t) => schema.with("default", Json::text(t)),
        Fallback::Vector2(v) => schema.with("default", numbers(&v)),
        Fallback::Vector(v) => schema.with("default", numbers(&v)),
    }
}

fn value(row: &ParamSpec) -> Json {
    let number = || ranged("number", row.range);
    let color = || {
        let hex = of_type("string").with("pattern", Json::text("^#[0-9a-fA-F]{6}$"));
        [number(), list(number(), Some(3)), hex]
    };
    match row.ty {
        ParamType::Bool => of_type("boolean"),
        ParamType::Integer => ranged("integer", row.range),
        ParamType::Number => number(),
        ParamType::Text | ParamType::Path | ParamType::Reference(_) => of_type("string"),
        ParamType::References(_) => list(of_type("string"), None),
        ParamType::Choice(words) => Json::map([("enum", Json::texts(words.iter().copied()))]),
        ParamType::Vector2 => list(number(), Some(2)),
        ParamType::Vector => list(number(), Some(3)),
        ParamType::Color => {
            let [grey, rgb, hex] = color();
            any_of([grey, rgb, hex, reference("wave_color")])
        }
        ParamType::Index => any_of([number(), reference("wave_index")]),
        ParamType::ColorTexture => {
            let [grey, rgb, _] = color();
            let named = described(of_type("string"), "\"#rrggbb\", or the name of a texture");
            any_of([grey, rgb, named, reference("wave_color")])
        }
        ParamType::NumberTexture => any_of([number(), described(of_type("string"), "the name of a texture")]),
        ParamType::VectorTexture => {
            any_of([list(number(), Some(3)), described(of_type("string"), "the name of a texture")])
        }
        ParamType::Transform => reference("transform"),
        ParamType::Motion => reference("motion"),
        ParamType::Numbers => list(number(), None),
        ParamType::Vectors => list(list(number(), Some(3)), None),
        ParamType::Gradient => list(
            of_type("array")
                .with("prefixItems", Json::List(vec![of_type("number"), any_of(color())]))
                .with("minItems", Json::Number(2.0))
                .with("maxItems", Json::Number(2.0)),
            None,
        ),
    }
}

/// As `kirkas_scene::waves` reads colours.
fn wave_color() -> Json {
    let entry = |name: &str, value: Json, text: &str| described(only(name, value), text);
    any_of([
        entry("blackbody", ranged("number", (100.0, 1e6)), "temperature in K"),
        entry("illuminant", of_type("string"), "CIE illuminant by name"),
        entry("spectrum", of_type("string"), "file of two columns, wavelength in nm and value"),
    ])
}

/// As `kirkas_scene::waves` reads refractive indices.
fn wave_index() -> Json {
    let numbers = || list(of_type("number"), None);
    any_of([
        described(only("material", of_type("string")), "a material by name"),
        described(only("file", of_type("string")), "a .yml file of refractiveindex.info"),
        described(only("cauchy", numbers()), "[A, B, ...] of n = A + B / l^2 + ..., l in micrometres"),
        described(
            only("sellmeier", numbers()),
            "[B1, .., C1, ..] of n^2 = 1 + B1 l^2 / (l^2 - C1) + ..., l in micrometres",
        ),
    ])
}

/// A table with this one entry.
fn only(name: &str, value: Json) -> Json {
    of_type("object")
        .with("properties", Json::map([(name, value)]))
        .with("required", Json::texts([name]))
        .with("additionalProperties", Json::Bool(false))
}

/// As `kirkas_scene::transforms` reads it.
fn transform() -> Json {
    let number = || of_type("number");
    let object = |name: &str, value: Json| {
        of_type("object")
            .with("properties", Json::Map(vec![(name.to_string(), value)]))
            .with("required", Json::texts([name]))
            .with("additionalProperties", Json::Bool(false))
    };
    let point = || list(number(), Some(3));
    let look_at = of_type("object")
        .with("properties", Json::map([("from", point()), ("to", point()), ("up", point())]))
        .with("required", Json::texts(["from", "to"]));
    let step = any_of([
        object("translate", point()),
        object("rotate", described(list(number(), Some(4)), "axis x, y, z and degrees")),
        object("scale", any_of([number(), point()])),
        object("look_at", look_at),
        object("matrix", described(any_of([list(number(), Some(12)), list(number(), Some(16))]), "by rows")),
    ]);
    described(any_of([list(step.clone(), None), step]), "Steps, applied in written order.")
}

fn motion() -> Json {
    let key = of_type("object")
        .with("properties", Json::map([("time", of_type("number")), ("transform", reference("transform"))]))
        .with("required", Json::texts(["time"]))
        .with("additionalProperties", Json::Bool(false));
    described(list(key, None), "Key frames with rising times.")
}

fn definition_name(spec: &TypeSpec) -> String {
    format!("{}.{}", spec.kind.singular(), spec.name)
}

fn of_type(name: &str) -> Json {
    Json::map([("type", Json::text(name))])
}

fn ranged(name: &str, (low, high): (f64, f64)) -> Json {
    let mut schema = of_type(name);
    if low == f64::MIN_POSITIVE {
        schema = schema.with("exclusiveMinimum", Json::Number(0.0));
    } else if low.is_finite() {
        schema = schema.with("minimum", Json::Number(low));
    }
    if high.is_finite() { schema.with("maximum", Json::Number(high)) } else { schema }
}

fn list(item: Json, length: Option<usize>) -> Json {
    let schema = of_type("array").with("items", item);
    match length {
        Some(n) => schema.with("minItems", Json::Number(n as f64)).with("maxItems", Json::Number(n as f64)),
        None => schema,
    }
}

fn numbers(values: &[f64]) -> Json {
    Json::List(values.iter().map(|&v| Json::Number(v)).collect())
}

fn any_of<const N: usize>(choices: [Json; N]) -> Json {
    Json::map([("anyOf", Json::List(choices.into()))])
}

fn reference(definition: &str) -> Json {
    Json::map([("$ref", Json::text(format!("#/$defs/{definition}")))])
}

fn described(schema: Json, text: &str) -> Json {
    schema.with("description", Json::text(text))
}
