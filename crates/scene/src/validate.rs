//! Checks a description against the catalogue: names, types, ranges, references.

use crate::diagnostic::unknown_name;
use crate::params::read_color;
use crate::transforms::{read_motion, read_transform};
use crate::waves;
use crate::{
    Catalog, Description, Diagnostic, Entity, Fallback, Kind, Name, Node, ParamSpec, ParamType, TypeSpec, Value,
};

/// Everything that is wrong with `description`, in written order.
pub fn validate(description: &Description, catalog: &Catalog) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for kind in Kind::ALL {
        for entity in description.all(kind) {
            match catalog.find(kind, &entity.type_name.text) {
                Some(spec) => check_entity(description, catalog, entity, spec, &mut found),
                None => found.push(unknown_type(catalog, kind, entity)),
            }
        }
    }
    found
}

fn unknown_type(catalog: &Catalog, kind: Kind, entity: &Entity) -> Diagnostic {
    let names: Vec<&str> = catalog.of_kind(kind).map(|t| t.name).collect();
    if entity.type_name.text.is_empty() {
        return Diagnostic::error("missing-type", format!("{} `{}` has no type", kind.singular(), entity.name.text))
            .at(entity.name.span, "needs a `type`")
            .help(format!("add `type = \"...\"`, one of: {}", names.join(", ")));
    }
    let span = if entity.type_name.span.is_some() { entity.type_name.span } else { entity.name.span };
    unknown_name(&format!("{} type", kind.singular()), &entity.type_name.text, span, names)
}

fn check_entity(
    d: &Description,
    catalog: &Catalog,
    entity: &Entity,
    spec: &'static TypeSpec,
    found: &mut Vec<Diagnostic>,
) {
    let rows: Vec<&ParamSpec> = catalog.rows(spec).collect();
    for (name, node) in entity.params.iter() {
        match rows.iter().find(|r| r.name == name.text) {
            Some(row) => check_value(d, row, name, node, found),
            None => {
                let what = format!("parameter of {} `{}`", spec.kind.singular(), spec.name);
                found.push(unknown_name(&what, &name.text, name.span, rows.iter().map(|r| r.name).collect::<Vec<_>>()));
            }
        }
    }
    for row in rows.iter().filter(|r| r.fallback == Fallback::Required) {
        if entity.params.get(row.name).is_none() {
            let owner = if entity.name.text.is_empty() { spec.name } else { &entity.name.text };
            let span = if entity.name.span.is_some() { entity.name.span } else { entity.span };
            found.push(
                Diagnostic::error(
                    "missing-parameter",
                    format!("{} `{owner}` lacks `{}`", spec.kind.singular(), row.name),
                )
                .at(span, format!("`{}` is required", row.name))
                .help(format!("add `{} = ...`: {}", row.name, row.doc)),
            );
        }
    }
}

fn check_value(d: &Description, row: &ParamSpec, name: &Name, node: &Node, found: &mut Vec<Diagnostic>) {
    let mismatch = |expected: &str| {
        Diagnostic::error("wrong-type", format!("`{}` takes {expected}, not {}", name.text, node.value.article()))
            .at(node.span, format!("expected {expected}"))
            .help(format!("`{}`: {}", name.text, row.doc))
    };
    let reference = |kind: Kind, text: &str, span, found: &mut Vec<Diagnostic>| {
        if d.find(kind, text).is_none() {
            let names: Vec<&str> = d.all(kind).iter().map(|e| e.name.text.as_str()).collect();
            found.push(unknown_name(kind.singular(), text, span, names));
        }
    };
    let like_color = |t: &str| t.starts_with('#');
    let list_of = |n: usize| node.list().is_some_and(|l| l.len() == n && l.iter().all(|x| x.number().is_some()));
    match row.ty {
        ParamType::Bool if !matches!(node.value, Value::Bool(_)) => found.push(mismatch("true or false")),
        ParamType::Integer if !matches!(node.value, Value::Int(_)) => found.push(mismatch("a whole number")),
        ParamType::Number if node.number().is_none() => found.push(mismatch("a number")),
        ParamType::Text | ParamType::Path if node.text().is_none() => found.push(mismatch("a text")),
        ParamType::Vector2 if !list_of(2) => found.push(mismatch("two numbers [x, y]")),
        ParamType::Vector if !list_of(3) => found.push(mismatch("three numbers [x, y, z]")),
        ParamType::Color | ParamType::ColorTexture if waves::is_color(node) => {}
        ParamType::Color | ParamType::ColorTexture if node.map().is_some() => found.push(mismatch(waves::COLORS)),
        ParamType::Index if waves::is_index(node) => return,
        ParamType::Index if node.map().is_some() => found.push(mismatch(waves::INDICES)),
        ParamType::Index if node.number().is_none() => found.push(mismatch("a number or a table by wavelength")),
        ParamType::Color if read_color(&node.value).is_none() => {
            found.push(mismatch("a colour: [r, g, b], a grey, or \"#rrggbb\""))
        }
        ParamType::Choice(words) => match node.text() {
            Some(t) if words.contains(&t) => {}
            Some(t) => {
                found.push(unknown_name(&format!("value of `{}`:", name.text), t, node.span, words.iter().copied()))
            }
            None => found.push(mismatch("one of its words")),
        },
        ParamType::Reference(kind) => match node.text() {
            Some(t) => reference(kind, t, node.span, found),
            None => found.push(mismatch(&format!("the name of a {}", kind.singular()))),
        },
        ParamType::References(kind) => match node.list() {
            Some(l) if l.iter().all(|n| n.text().is_some()) => {
                for n in l {
                    reference(kind, n.text().unwrap_or_default(), n.span, found);
                }
            }
            _ => found.push(mismatch(&format!("a list of names of {}", kind.section()))),
        },
        ParamType::ColorTexture if read_color(&node.value).is_none() => match node.text() {
            Some(t) if like_color(t) => found.push(mismatch("a colour like \"#rrggbb\" (six hexadecimal digits)")),
            Some(t) => reference(Kind::Texture, t, node.span, found),
            None => found.push(mismatch("a colour or the name of a texture")),
        },
        ParamType::NumberTexture if node.number().is_none() => match node.text() {
            Some(t) => reference(Kind::Texture, t, node.span, found),
            None => found.push(mismatch("a number or the name of a texture")),
        },
        ParamType::VectorTexture if !list_of(3) => match node.text() {
            Some(t) => reference(Kind::Texture, t, node.span, found),
            None => found.push(mismatch("three numbers [x, y, z] or the name of a texture")),
        },
        ParamType::Transform => found.extend(read_transform(node).err()),
        ParamType::Motion => found.extend(read_motion(node).err()),
        ParamType::Numbers if !node.list().is_some_and(|l| l.iter().all(|n| n.number().is_some())) => {
            found.push(mismatch("a list of numbers"));
        }
        ParamType::Vectors if !node.list().is_some_and(|l| l.iter().all(|n| n.numbers::<3>().is_some())) => {
            found.push(mismatch("a list of [x, y, z]"));
        }
        ParamType::Gradient => {
            let stop =
                |n: &Node| n.list().filter(|l| l.len() == 2).and_then(|l| l[0].number().zip(read_color(&l[1].value)));
            let stops: Option<Vec<f64>> =
                node.list().and_then(|l| l.iter().map(|n| stop(n).map(|s| s.0)).collect::<Option<Vec<_>>>());
            if !stops.is_some_and(|s| !s.is_empty() && s.windows(2).all(|w| w[0] <= w[1])) {
                found.push(mismatch("a list of [position, colour] with rising positions"));
            }
        }
        _ => {}
    }
    check_range(row, name, node, found);
}

/// Every number in `node` must be finite and in the row's range.
fn check_range(row: &ParamSpec, name: &Name, node: &Node, found: &mut Vec<Diagnostic>) {
    if matches!(row.ty, ParamType::Transform | ParamType::Motion | ParamType::Gradient) {
        return;
    }
    if let Some(l) = node.list() {
        l.iter().for_each(|n| check_range(row, name, n, found));
        return;
    }
    let Some(v) = node.number() else { return };
    let (low, high) = row.range;
    if v.is_finite() && v >= low && v <= high {
        return;
    }
    let allowed = match (low, high) {
        _ if !v.is_finite() => "must be finite".to_string(),
        (l, h) if l == f64::MIN_POSITIVE && h == f64::INFINITY => "must be above 0".to_string(),
        (l, h) if h == f64::INFINITY => format!("must be at least {l}"),
        (l, h) => format!("must be from {l} to {h}"),
    };
    let unit = if row.unit.is_empty() { String::new() } else { format!(" {}", row.unit) };
    found.push(
        Diagnostic::error("out-of-range", format!("`{}` is {v}{unit}, but it {allowed}", name.text))
            .at(node.span, allowed)
            .help(format!("`{}`: {}", name.text, row.doc)),
    );
}
