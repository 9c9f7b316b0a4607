//! From text to a tree of values; several syntax errors at once.

use super::value::Converter;
use ::toml::de::DeTable;
use kirkas_scene::{Diagnostic, Map, SourceId, Span};

/// More syntax errors than this are echoes of the first ones.
const MOST_ERRORS: usize = 10;

/// Parse a whole text.
pub(super) fn parse(source: SourceId, text: &str) -> Result<Map, Vec<Diagnostic>> {
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(problems(source, text, &errors));
    }
    let mut converter = Converter::new(source, 0);
    let map = converter.table(root.get_ref());
    if converter.problems.is_empty() { Ok(map) } else { Err(converter.problems) }
}

/// One error per line: what follows on the same line is an echo.
fn problems(source: SourceId, text: &str, errors: &[::toml::de::Error]) -> Vec<Diagnostic> {
    let mut found: Vec<(usize, Diagnostic)> = Vec::new();
    for error in errors {
        let range = error.span().unwrap_or(text.len()..text.len());
        let start = range.start.min(text.len());
        let line_start = text.as_bytes()[..start].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        if found.len() >= MOST_ERRORS {
            break;
        }
        if found.iter().all(|(line, _)| *line != line_start) {
            let span = Span::new(source, start, range.end.clamp(start, text.len()));
            found.push((line_start, problem(error.message(), span)));
        }
    }
    found.sort_by_key(|(line, _)| *line);
    found.into_iter().map(|(_, d)| d).collect()
}

/// A syntax error in the words of someone who wants to help.
pub(super) fn problem(message: &str, span: Span) -> Diagnostic {
    let (message, help) = match message {
        "duplicate key" => ("this name is already taken", "a name stands once in its table: rename or remove one"),
        "recursion limit" | "cannot recurse further; max recursion depth met" => {
            ("nested more than 80 levels deep", "bring these values nearer to the surface")
        }
        m if m.starts_with("string values must be quoted") => ("a text must stand in quotes", "write `\"...\"`"),
        m if m.contains("unclosed array") => (m, "close it with `]`"),
        m if m.contains("unclosed inline table") => (m, "close it with `}`"),
        m if m.contains("unclosed table") => (m, "close the header with `]`"),
        m if m.contains("missing assignment") || m.contains("key with no value") => (m, "write `name = value`"),
        m if m.contains("invalid basic string") || m.contains("invalid literal string") => (m, "close it with the quote it began with"),
        m => (m, "see https://toml.io for how TOML is written"),
    };
    Diagnostic::error("syntax", message).at(span, "here").help(help)
}
