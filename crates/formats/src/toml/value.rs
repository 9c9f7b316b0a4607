//! TOML values into values of the description, in written order.

use ::toml::de::{DeTable, DeValue};
use kirkas_scene::{Diagnostic, Map, Name, Node, SourceId, Span, Value};
use std::ops::Range;

/// Converts one text's values and gathers what is wrong with them.
pub(super) struct Converter {
    source: SourceId,
    offset: usize,
    pub(super) problems: Vec<Diagnostic>,
}

impl Converter {
    /// For values parsed from `source` at byte `offset`.
    pub(super) fn new(source: SourceId, offset: usize) -> Self {
        Converter { source, offset, problems: Vec::new() }
    }

    pub(super) fn table(&mut self, table: &DeTable) -> Map {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let mut map = Vec::with_capacity(entries.len());
        for (key, value) in entries {
            let name = Name { text: key.get_ref().to_string(), span: self.span(key.span()) };
            map.push((name, self.node(value.get_ref(), value.span())));
        }
        Map(map)
    }

    pub(super) fn node(&mut self, value: &DeValue, range: Range<usize>) -> Node {
        let span = self.span(range);
        let value = match value {
            DeValue::String(s) => Value::Text(s.to_string()),
            DeValue::Boolean(b) => Value::Bool(*b),
            DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
                Ok(v) => Value::Int(v),
                Err(_) => self.refuse(span, "this whole number is too large", "write it as a float, such as 1e20"),
            },
            DeValue::Float(f) => match f.as_str().parse::<f64>() {
                Ok(v) if v.is_finite() || !f.as_str().contains(|c: char| c.is_ascii_digit()) => Value::Float(v),
                _ => self.refuse(span, "this number is too large", "numbers go up to about 1.8e308"),
            },
            DeValue::Datetime(_) => {
                self.refuse(span, "a date is not a value in a scene", "put it in quotes if it is a text")
            }
            DeValue::Array(items) => Value::List(items.iter().map(|v| self.node(v.get_ref(), v.span())).collect()),
            DeValue::Table(table) => Value::Map(self.table(table)),
        };
        Node { value, span }
    }

    fn refuse(&mut self, span: Span, message: &str, help: &str) -> Value {
        self.problems.push(Diagnostic::error("bad-value", message).at(span, "here").help(help));
        Value::Int(0)
    }

    fn span(&self, range: Range<usize>) -> Span {
        Span::new(self.source, range.start + self.offset, range.end + self.offset)
    }
}
