//! What is read is what was written, and back.

use crate::show::{diagnostic, failure, files};
use kirkas_formats::toml::{apply_override, read, write};
use kirkas_scene::{Description, Entity, Kind, Map, Name, Node, Span, Value};
use proptest::prelude::*;

fn read_one(text: &str) -> Description {
    read(&files(&[("s.toml", text)]), "s.toml").unwrap_or_else(|f| panic!("{}", failure(&f)))
}

#[test]
fn a_scene_is_read_in_written_order_with_spans() {
    let text = r##"
title = "Two balls"
version = 1
[film]
width = 320
[objects.zebra]
type = "sphere"
radius = 1
center = [0, 1.5, -2e3]
[objects.ant]
type = "sphere"
transform = [{ scale = 2 }, { rotate = [0, 1, 0, 90] }]
[materials.red]
type = "lambert"
reflectance = "#ff0000"
"##;
    let d = read_one(text);
    assert_eq!(d.title, "Two balls");
    let names: Vec<&str> = d.all(Kind::Object).iter().map(|e| e.name.text.as_str()).collect();
    assert_eq!(names, ["zebra", "ant"]);
    let zebra = d.find(Kind::Object, "zebra").unwrap();
    let said: Vec<&str> = zebra.params.iter().map(|(n, _)| n.text.as_str()).collect();
    assert_eq!(said, ["radius", "center"]);
    assert_eq!(zebra.params.get("center").unwrap().numbers(), Some([0.0, 1.5, -2000.0]));
    let underlined = |span: Span| &text[span.start as usize..span.end as usize];
    assert_eq!(underlined(zebra.name.span), "zebra");
    assert_eq!(underlined(zebra.span), "[objects.zebra]");
    assert_eq!(underlined(zebra.type_name.span), "\"sphere\"");
    assert_eq!(underlined(zebra.params.entry("center").unwrap().0.span), "center");
    assert_eq!(underlined(zebra.params.get("center").unwrap().list().unwrap()[1].span), "1.5");
    let film = d.single(Kind::Film).unwrap();
    assert_eq!((film.type_name.text.as_str(), film.name.text.as_str()), ("image", ""));
    assert!(d.single(Kind::Sampler).is_none());
}

#[test]
fn a_byte_order_mark_and_windows_lines_do_no_harm() {
    let d = read_one("\u{feff}[film]\r\nwidth = 7\r\n");
    assert_eq!(d.single(Kind::Film).unwrap().params.get("width").unwrap().number(), Some(7.0));
    assert_eq!(read_one("").without_spans(), read_one("\n").without_spans());
}

#[test]
fn included_things_come_first_and_the_later_word_wins() {
    let all = files(&[
        (
            "main.toml",
            "include = ['lib/a.toml', 'b.toml']\n[film]\nwidth = 3\n[objects.c]\ntype = 'sphere'\n[sampler]\ntype='independent'",
        ),
        (
            "lib/a.toml",
            "include = '../deep/d.toml'\ntitle = 'A'\n[film]\nwidth = 1\nheight = 1\n[objects.a]\ntype = 'mesh'\nfile = 'x.ply'",
        ),
        (
            "b.toml",
            "include = ['deep/d.toml']\n[film]\nwidth = 2\n[objects.b]\ntype = 'sphere'\n[sampler]\nsamples = 4",
        ),
        ("deep/d.toml", "[objects.d]\ntype = 'sphere'"),
    ]);
    let d = read(&all, "main.toml").unwrap();
    let names: Vec<&str> = d.all(Kind::Object).iter().map(|e| e.name.text.as_str()).collect();
    assert_eq!(names, ["d", "a", "b", "c"], "`deep/d.toml` is read once");
    let film = d.single(Kind::Film).unwrap();
    assert_eq!(film.params.get("width").unwrap().number(), Some(3.0));
    assert_eq!(film.params.get("height").unwrap().number(), Some(1.0));
    assert_eq!(d.title, "A");
    let sampler = d.single(Kind::Sampler).unwrap();
    assert_eq!(
        (sampler.type_name.text.as_str(), sampler.params.0.len()),
        ("independent", 0),
        "another type starts afresh"
    );
    let mesh = d.find(Kind::Object, "a").unwrap().params.get("file").unwrap();
    assert_eq!(d.sources.folder(mesh.span.source), "lib");
    assert_eq!(all.record().len(), 4);
}

#[test]
fn what_is_written_is_pleasant_to_read() {
    let text = r##"version = 1
title = "Pleasant"
description = """
First line,
and "second" \\ one.
"""

[film]
width = 320
tone = "filmic"

[integrator]

[background]
type = "gradient"
stops = [[-1.0, [0.0, 0.0, 0.0]], [1.0, "#ffeedd"]]

[cameras.main]
type = "perspective"
position = [0, 1.5, 5]

[materials."old brass"]
type = "lambert"
reflectance = [0.8, 0.1, 1e-7]

[objects.heap]
type = "mesh"
vertices = [
    [0.125, 10000.25, -3.0], [0.125, 10000.25, -3.0], [0.125, 10000.25, -3.0],
    [0.125, 10000.25, -3.0], [0.125, 10000.25, -3.0],
]
transform = [{ scale = 2 }, { look_at = { from = [0, 0, 0], to = [1, 2, 3] } }]
material = "old brass"
"##;
    assert_eq!(write(&read_one(text)), text);
}

#[test]
fn an_override_reaches_any_value() {
    let mut d = read_one("[lights.lamp]\ntype = 'point'\ncolor = [1, 2, 3]");
    for text in [
        "integrator.max_depth=3",
        "integrator.shadows=none",
        " lights.lamp.color.1 = 0.5 ",
        "lights.lamp.type=spot",
        "lights.lamp.tint=#ff8800",
        "lights.lamp.file = maps/3d map.png",
        "film.crop=[0, {a = 1}]",
        "film.camera=\"top\"",
        "film.day=2024-01-01",
    ] {
        apply_override(&mut d, text).unwrap_or_else(|e| panic!("{text}: {}", diagnostic(&d.sources, &e)));
    }
    let written = write(&d);
    assert_eq!(
        written,
        "version = 1\n\n[film]\ncrop = [0, { a = 1 }]\ncamera = \"top\"\nday = \"2024-01-01\"\n\n[integrator]\nmax_depth = 3\n\
         shadows = \"none\"\n\n[lights.lamp]\ntype = \"spot\"\ncolor = [1, 0.5, 3]\ntint = \"#ff8800\"\nfile = \"maps/3d map.png\"\n"
    );
    let span = d.single(Kind::Integrator).unwrap().params.get("max_depth").unwrap().span;
    let source = d.sources.get(span.source).unwrap();
    assert_eq!((source.path.as_str(), &source.text[span.start as usize..span.end as usize]), ("-D", "3"));
}

fn value() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        any::<bool>().prop_map(Value::Bool),
        any::<i64>().prop_map(Value::Int),
        any::<f64>().prop_filter("nan is not equal to itself", |f| !f.is_nan()).prop_map(Value::Float),
        ".*".prop_map(Value::Text),
        Just(Value::Text("\u{0}\r\n\t\"\\\u{7f}\u{85}\u{2028}".into())),
    ];
    leaf.prop_recursive(4, 60, 12, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone().prop_map(Node::new), 0..30).prop_map(Value::List),
            map(inner).prop_map(Value::Map),
        ]
    })
}

fn map(value: impl Strategy<Value = Value>) -> impl Strategy<Value = Map> {
    let entries = prop::collection::vec((name(), value), 0..5);
    entries.prop_map(|entries| {
        let mut map = Map::default();
        entries.into_iter().filter(|(n, _)| n != "type").for_each(|(n, v)| map.set(Name::new(n), Node::new(v)));
        map
    })
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z_]{1,8}", "[a-z0-9_.-]{0,4}", ".{0,6}", Just("1.5".into()), Just("inf".into())]
}

fn description() -> impl Strategy<Value = Description> {
    let entity = (0..Kind::ALL.len(), name(), "[a-z_]{0,6}|.{0,3}", map(value()));
    (prop::collection::vec(entity, 0..12), "(?s).{0,20}", "(?s).{0,20}").prop_map(|(entities, title, about)| {
        let mut d = Description::default();
        (d.title, d.description) = (title, about);
        for (kind, name, type_name, params) in entities {
            let kind = Kind::ALL[kind];
            let name = if kind.is_single() { "" } else { &name };
            let _ = d.add(kind, Entity::new(name, &type_name, params));
        }
        d
    })
}

proptest! {
    #[test]
    fn every_description_round_trips(d in description()) {
        let text = write(&d);
        let back = read(&files(&[("s.toml", &text)]), "s.toml");
        let back = back.map_err(|f| TestCaseError::fail(format!("{}\n{text}", failure(&f))))?;
        prop_assert_eq!(back.clone().without_spans(), d, "{}", text);
        prop_assert_eq!(write(&back), text);
    }
}
