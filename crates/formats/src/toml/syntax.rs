//! From text to a tree of values; several syntax errors at once.

use super::value::Converter;
use ::toml::de::DeTable;
use kirkas_scene::{Diagnostic, Map, SourceId, Span};

/// More syntax errors than this are echoes of the first ones.
const MOST_ERRORS: usize = 10;

/// A line of a megabyte may hold a million errors: do not look at all of them.
const MOST_LOOKED_AT: usize = 100;

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
    for error in errors.iter().take(MOST_LOOKED_AT) {
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
    let begins = |start: &str| message.starts_with(start);
    let (said, help) = match message {
        "duplicate key" => ("this name is already taken", "a name stands once in its table: rename or remove one"),
        "string values must be quoted, expected literal string" if span.start == span.end => {
            ("a value is missing", "write `name = value`")
        }
        "string values must be quoted, expected literal string" => ("a text must stand in quotes", "write `\"...\"`"),
        _ if message.contains("recursion") => {
            ("nested more than 80 levels deep", "bring these values nearer to the surface")
        }
        _ if begins("unquoted keys cannot be empty") => {
            ("a name is missing", "write a name of letters, digits, `_` and `-`")
        }
        _ if begins("invalid unquoted key") => {
            ("this name needs quotes", "only letters a-z, digits, `_` and `-` stand without")
        }
        _ if begins("invalid basic string") || begins("invalid literal string") => {
            ("this text does not end", "close it with the quote that it began with")
        }
        _ if begins("unclosed array") => ("this list does not end", "close it with `]`"),
        _ if begins("unclosed inline table") => ("this table does not end", "close it with `}`"),
        _ if begins("unclosed table") || begins("unclosed array table") => {
            ("this header does not end", "close it with `]`")
        }
        _ if begins("key with no value") => ("this name has no value", "write `name = value`"),
        _ if begins("missing comma") => {
            ("a comma or an end is missing", "put a comma between values, and close what was opened")
        }
        _ if begins("unexpected key or value") => ("one line says one thing", "begin a new line here"),
        _ if begins("unexpected leading zero") => ("a number does not begin with 0", "leave the leading zeros out"),
        _ if begins("missing escaped value") => {
            ("a backslash begins a sign such as `\\n`", "write `\\\\` for the backslash itself")
        }
        _ if begins("invalid boolean") => {
            ("neither `true` nor `false`", "write `true` or `false`, or put a text in quotes")
        }
        _ if begins("invalid mantissa") || begins("invalid fraction") => {
            ("a digit is missing beside the point", "write `0.5` and `5.0`")
        }
        _ => (
            message.strip_suffix(", expected nothing").unwrap_or(message),
            "see https://toml.io for how TOML is written",
        ),
    };
    Diagnostic::error("syntax", said).at(span, "here").help(help)
}
