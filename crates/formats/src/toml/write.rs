//! A description as TOML that reads back exactly and that a person likes to read.

use super::read::VERSION;
use kirkas_scene::{Description, Entity, Kind, Map, Node, Value};

/// Lines are filled up to about here.
const WIDTH: usize = 100;

/// The whole description as one text, sections in the order of [`Kind::ALL`]. `read` gives an equal description again.
pub fn write(description: &Description) -> String {
    let mut out = format!("version = {VERSION}\n");
    if !description.title.is_empty() {
        out += &format!("title = {}\n", text(&description.title));
    }
    if !description.description.is_empty() {
        out += &format!("description = {}\n", long_text(&description.description));
    }
    for kind in Kind::ALL {
        for entity in description.all(kind) {
            write_entity(&mut out, kind, entity);
        }
    }
    out
}

fn write_entity(out: &mut String, kind: Kind, entity: &Entity) {
    match kind.is_single() {
        true => *out += &format!("\n[{}]\n", kind.section()),
        false => *out += &format!("\n[{}.{}]\n", kind.section(), key(&entity.name.text)),
    }
    if entity.type_name.text != kind.default_type().unwrap_or_default() {
        *out += &format!("type = {}\n", text(&entity.type_name.text));
    }
    for (name, node) in entity.params.iter() {
        let start = format!("{} = ", key(&name.text));
        *out += &start;
        write_value(out, node, start.len());
        out.push('\n');
    }
}

/// On one line if it fits, else a list with filled lines. Inline tables stay on one line, as TOML 1.0 wants them.
fn write_value(out: &mut String, node: &Node, column: usize) {
    let line = inline(node);
    let Value::List(items) = &node.value else {
        *out += &line;
        return;
    };
    if column + line.len() <= WIDTH {
        *out += &line;
        return;
    }
    *out += "[";
    let mut width = WIDTH;
    for item in items {
        let item = inline(item);
        if width + item.len() + 2 > WIDTH {
            *out += "\n   ";
            width = 3;
        }
        width += item.len() + 2;
        *out += " ";
        *out += &item;
        *out += ",";
    }
    *out += "\n]";
}

fn inline(node: &Node) -> String {
    match &node.value {
        Value::Bool(b) => b.to_string(),
        Value::Int(i) => i.to_string(),
        Value::Float(f) => float(*f),
        Value::Text(t) => text(t),
        Value::List(items) => format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Map(Map(entries)) if entries.is_empty() => "{}".into(),
        Value::Map(Map(entries)) => {
            let entry = |(name, node): &(kirkas_scene::Name, Node)| format!("{} = {}", key(&name.text), inline(node));
            format!("{{ {} }}", entries.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
    }
}

/// The shortest decimal that reads back to the same bits, always with a point or an exponent.
fn float(f: f64) -> String {
    match f {
        f if f.is_nan() => "nan".into(),
        f if f.is_infinite() => if f > 0.0 { "inf" } else { "-inf" }.into(),
        f => format!("{f:?}"),
    }
}

fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare { name.into() } else { text(name) }
}

fn text(t: &str) -> String {
    format!("\"{}\"", escaped(t, false))
}

/// Several lines as several lines.
fn long_text(t: &str) -> String {
    if t.contains('\n') { format!("\"\"\"\n{}\"\"\"", escaped(t, true)) } else { text(t) }
}

fn escaped(t: &str, lines: bool) -> String {
    let mut out = String::with_capacity(t.len());
    let mut chars = t.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if lines && chars.peek().is_some_and(|&next| next != '"') => out.push('"'),
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            '\n' if lines => out.push('\n'),
            '\n' => out += "\\n",
            '\t' => out += "\\t",
            '\r' => out += "\\r",
            c if c.is_control() => out += &format!("\\u{:04X}", c as u32),
            c => out.push(c),
        }
    }
    out
}
