//! Just enough JSON to write a schema.

/// A JSON value; objects keep their order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Json {
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Map(Vec<(String, Json)>),
}

impl Json {
    pub(crate) fn text(text: impl Into<String>) -> Json {
        Json::Text(text.into())
    }

    pub(crate) fn texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> Json {
        Json::List(texts.into_iter().map(Json::text).collect())
    }

    pub(crate) fn map<const N: usize>(entries: [(&str, Json); N]) -> Json {
        Json::Map(entries.into_iter().map(|(k, v)| (k.to_string(), v)).collect())
    }

    /// With one more entry, if it is a map.
    pub(crate) fn with(mut self, name: &str, value: Json) -> Json {
        if let Json::Map(entries) = &mut self {
            entries.push((name.to_string(), value));
        }
        self
    }

    /// Indented by two spaces; lists of plain values on one line.
    pub(crate) fn pretty(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, 0);
        out.push('\n');
        out
    }

    fn write(&self, out: &mut String, depth: usize) {
        match self {
            Json::Bool(b) => *out += if *b { "true" } else { "false" },
            Json::Number(n) if n.is_finite() => {
                let shortest = format!("{n:?}");
                *out += shortest.strip_suffix(".0").unwrap_or(&shortest);
            }
            Json::Number(_) => *out += "null",
            Json::Text(t) => write_text(out, t),
            Json::List(items) if items.iter().all(|i| !matches!(i, Json::List(_) | Json::Map(_))) => {
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    *out += if i == 0 { "" } else { ", " };
                    item.write(out, depth);
                }
                out.push(']');
            }
            Json::List(items) => {
                let write = |out: &mut String, item: &Json| item.write(out, depth + 1);
                write_block(out, depth, ['[', ']'], items, write);
            }
            Json::Map(entries) => write_block(out, depth, ['{', '}'], entries, |out, (name, value)| {
                write_text(out, name);
                *out += ": ";
                value.write(out, depth + 1);
            }),
        }
    }
}

fn write_block<T>(out: &mut String, depth: usize, ends: [char; 2], items: &[T], write: impl Fn(&mut String, &T)) {
    out.push(ends[0]);
    for (i, item) in items.iter().enumerate() {
        *out += if i == 0 { "\n" } else { ",\n" };
        *out += &"  ".repeat(depth + 1);
        write(out, item);
    }
    if !items.is_empty() {
        out.push('\n');
        *out += &"  ".repeat(depth);
    }
    out.push(ends[1]);
}

fn write_text(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => *out += "\\\"",
            '\\' => *out += "\\\\",
            '\n' => *out += "\\n",
            c if (c as u32) < 0x20 => *out += &format!("\\u{:04x}", c as u32),
            c => out.push(c),
        }
    }
    out.push('"');
}
