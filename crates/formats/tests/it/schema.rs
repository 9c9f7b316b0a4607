//! The schema and the manual tell all that the catalogue knows.

use kirkas_formats::{manual, schema};
use kirkas_scene::spec::{NOT_NEGATIVE, POSITIVE};
use kirkas_scene::{Catalog, Fallback, Kind, ParamSpec, ParamType, TypeSpec};
use serde_json::{Value, json};

static BALL: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "ball",
    doc: "A \"round\" thing | solid.",
    params: &[
        ParamSpec::number("radius", 1.5, "How large.").range(POSITIVE).unit("m"),
        ParamSpec::new("center", ParamType::Vector, Fallback::Required, "Where."),
        ParamSpec::choice("side", &["out", "in"], "Which side."),
        ParamSpec::integer("rings", 3, (1.0, 9.0), "How many."),
        ParamSpec::color("tint", [1.0, 0.5, 0.0], "Colour."),
        ParamSpec::new("colors", ParamType::Gradient, Fallback::Absent, "Colours.").range(NOT_NEGATIVE),
    ],
};
static CUBE: TypeSpec = TypeSpec { kind: Kind::Object, name: "cube", doc: "Not round.", params: &[] };
static FILM: TypeSpec = TypeSpec { kind: Kind::Film, name: "image", doc: "Pixels.", params: &[] };
static COMMON: [ParamSpec; 3] = [
    ParamSpec::new("material", ParamType::Reference(Kind::Material), Fallback::Absent, "Of what."),
    ParamSpec::new("transform", ParamType::Transform, Fallback::Absent, "Where to."),
    ParamSpec::new("motion", ParamType::Motion, Fallback::Absent, "How it moves."),
];

fn catalog() -> Catalog {
    Catalog { types: vec![&BALL, &CUBE, &FILM], common: vec![(Kind::Object, &COMMON)] }
}

#[test]
fn the_schema_is_json_and_holds_every_type_and_parameter() {
    let schema: Value = serde_json::from_str(&schema::json_schema(&catalog())).expect("valid JSON");
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let object = &schema["$defs"]["object"];
    assert_eq!(object["oneOf"], json!([{"$ref": "#/$defs/object.ball"}, {"$ref": "#/$defs/object.cube"}]));
    assert_eq!(object["properties"]["type"]["enum"], json!(["ball", "cube"]));
    let ball = &schema["$defs"]["object.ball"];
    assert_eq!(ball["description"], "A \"round\" thing | solid.");
    assert_eq!(ball["required"], json!(["type", "center"]));
    assert_eq!(ball["additionalProperties"], false);
    let of = &ball["properties"];
    assert_eq!(
        of["radius"],
        json!({"type": "number", "exclusiveMinimum": 0, "description": "How large. Unit: m.", "default": 1.5})
    );
    assert_eq!(of["side"], json!({"enum": ["out", "in"], "description": "Which side.", "default": "out"}));
    assert_eq!(
        of["rings"],
        json!({"type": "integer", "minimum": 1, "maximum": 9, "description": "How many.", "default": 3})
    );
    assert_eq!(of["tint"]["default"], json!([1, 0.5, 0]));
    assert_eq!(of["transform"]["$ref"], "#/$defs/transform");
    assert!(of["material"].is_object());
    assert_eq!(schema["$defs"]["film.image"]["required"], json!([]), "the default type needs no `type`");
}

#[test]
fn every_reference_in_the_schema_leads_somewhere() {
    fn walk<'a>(value: &'a Value, found: &mut Vec<&'a str>) {
        match value {
            Value::Array(items) => items.iter().for_each(|v| walk(v, found)),
            Value::Object(map) => {
                found.extend(map.get("$ref").and_then(Value::as_str));
                map.values().for_each(|v| walk(v, found));
            }
            _ => {}
        }
    }
    let schema: Value = serde_json::from_str(&schema::json_schema(&catalog())).unwrap();
    let mut found = Vec::new();
    walk(&schema, &mut found);
    assert!(found.len() > 10);
    for reference in found {
        assert!(schema.pointer(&reference[1..]).is_some(), "{reference}");
    }
}

#[test]
fn the_manual_has_a_row_for_every_parameter() {
    let page = manual::markdown(&catalog());
    for line in [
        "### object `ball`",
        "| `radius` | number, m, above 0 | `1.5` | How large. |",
        "| `center` | `[x, y, z]` | required | Where. |",
        "| `side` | `\"out\"`, `\"in\"` | `\"out\"` | Which side. |",
        "| `tint` | colour, 0 or more | `[1, 0.5, 0]` | Colour. |",
        "### Every object",
        "| `material` | name of a material | none | Of what. |",
    ] {
        assert!(page.lines().any(|l| l == line), "{line}\n{page}");
    }
}
