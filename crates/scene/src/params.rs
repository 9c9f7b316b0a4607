//! Typed reading of an entity's parameters, with the defaults of its table. The description must have been validated:
//! a value of the wrong type reads as its default.

use crate::{Catalog, Entity, Fallback, ParamSpec, Span, TypeSpec, Value};
use kirkas_geometry::elementary::pow;

/// An entity beside its table.
#[derive(Clone, Copy)]
pub struct Params<'a> {
    /// What was written.
    pub entity: &'a Entity,
    spec: &'static TypeSpec,
    common: &'static [ParamSpec],
}

impl<'a> Params<'a> {
    /// Pair an entity with its table; `None` if its type is not in the catalogue.
    pub fn new(entity: &'a Entity, kind: crate::Kind, catalog: &Catalog) -> Option<Self> {
        let spec = catalog.find(kind, &entity.type_name.text)?;
        Some(Params { entity, spec, common: catalog.common(kind) })
    }

    /// The table.
    pub fn spec(&self) -> &'static TypeSpec {
        self.spec
    }

    fn fallback(&self, name: &str) -> Fallback {
        let row = self.spec.params.iter().chain(self.common).find(|p| p.name == name);
        debug_assert!(row.is_some(), "`{name}` is not in the table of `{}`", self.spec.name);
        row.map_or(Fallback::Absent, |r| r.fallback)
    }

    /// True when it was written.
    pub fn has(&self, name: &str) -> bool {
        self.entity.params.get(name).is_some()
    }

    /// Where it was written (the entity's own place if it was not).
    pub fn span(&self, name: &str) -> Span {
        self.entity.params.get(name).map_or(self.entity.name.span, |n| n.span)
    }

    /// A number.
    pub fn number(&self, name: &str) -> f64 {
        match (self.entity.params.get(name).and_then(|n| n.number()), self.fallback(name)) {
            (Some(v), _) => v,
            (None, Fallback::Number(v)) => v,
            _ => 0.0,
        }
    }

    /// A number, if written.
    pub fn optional_number(&self, name: &str) -> Option<f64> {
        let _ = self.fallback(name);
        self.entity.params.get(name).and_then(|n| n.number())
    }

    /// A number as f32.
    pub fn f32(&self, name: &str) -> f32 {
        self.number(name) as f32
    }

    /// A whole number.
    pub fn integer(&self, name: &str) -> i64 {
        self.number(name) as i64
    }

    /// A truth value.
    pub fn bool(&self, name: &str) -> bool {
        match (self.entity.params.get(name).map(|n| &n.value), self.fallback(name)) {
            (Some(Value::Bool(b)), _) => *b,
            (_, Fallback::Bool(b)) => b,
            _ => false,
        }
    }

    /// A text, choice, path or reference, or its default.
    pub fn text(&self, name: &str) -> Option<&'a str> {
        match (self.entity.params.get(name).and_then(|n| n.text()), self.fallback(name)) {
            (Some(t), _) => Some(t),
            (None, Fallback::Text(t)) => Some(t),
            _ => None,
        }
    }

    /// Three numbers, or the default.
    pub fn vector(&self, name: &str) -> [f64; 3] {
        match (self.entity.params.get(name).and_then(|n| n.numbers::<3>()), self.fallback(name)) {
            (Some(v), _) => v,
            (None, Fallback::Vector(v)) => v,
            _ => [0.0; 3],
        }
    }

    /// Three numbers, if written.
    pub fn optional_vector(&self, name: &str) -> Option<[f64; 3]> {
        let _ = self.fallback(name);
        self.entity.params.get(name).and_then(|n| n.numbers::<3>())
    }

    /// Two numbers, or the default.
    pub fn vector2(&self, name: &str) -> [f64; 2] {
        match (self.entity.params.get(name).and_then(|n| n.numbers::<2>()), self.fallback(name)) {
            (Some(v), _) => v,
            (None, Fallback::Vector2(v)) => v,
            _ => [0.0; 2],
        }
    }

    /// A linear Rec.709 colour, if written as one (not as a texture's name).
    pub fn optional_color(&self, name: &str) -> Option<[f64; 3]> {
        let _ = self.fallback(name);
        self.entity.params.get(name).and_then(|n| read_color(&n.value))
    }

    /// A linear Rec.709 colour, or the default.
    pub fn color(&self, name: &str) -> [f64; 3] {
        match (self.optional_color(name), self.fallback(name)) {
            (Some(c), _) => c,
            (None, Fallback::Vector(v)) => v,
            (None, Fallback::Number(v)) => [v; 3],
            _ => [0.0; 3],
        }
    }
}

/// A colour as written: grey, `[r, g, b]` (both linear) or `"#rrggbb"` (sRGB).
pub fn read_color(value: &Value) -> Option<[f64; 3]> {
    match value {
        Value::Int(i) => Some([*i as f64; 3]),
        Value::Float(f) => Some([*f; 3]),
        Value::List(l) if l.len() == 3 => Some([l[0].number()?, l[1].number()?, l[2].number()?]),
        Value::Text(t) => {
            let hex = t.strip_prefix('#').filter(|h| h.len() == 6 && h.bytes().all(|b| b.is_ascii_hexdigit()))?;
            let channel = |i: usize| u8::from_str_radix(&hex[i..i + 2], 16).ok().map(srgb_to_linear);
            Some([channel(0)?, channel(2)?, channel(4)?])
        }
        _ => None,
    }
}

/// IEC 61966-2-1.
fn srgb_to_linear(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { pow((c + 0.055) / 1.055, 2.4) }
}
