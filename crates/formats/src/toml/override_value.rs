//! `-D path.to.value=VALUE`.

use super::{syntax, value::Converter};
use ::toml::de::DeValue;
use kirkas_scene::{Description, Diagnostic, Node, Span, Value};

/// Set one value of a description from the command line: `integrator.max_depth=3`, `lights.lamp.color=[1, 0, 0]`.
///
/// VALUE is written as in TOML; a bare word is a text (`integrator.shadows=none`). The text becomes a source named `-D`,
/// also when it is wrong, so that the error's spans can be shown.
pub fn apply_override(description: &mut Description, text: &str) -> Result<(), Diagnostic> {
    let source = description.sources.add("-D", text);
    let Some((path, value)) = text.split_once('=').filter(|(_, v)| !v.trim().is_empty()) else {
        return Err(Diagnostic::error("bad-override", format!("`{text}` sets nothing"))
            .at(Span::new(source, 0, text.len()), "no value")
            .help("write `-D path.to.value=VALUE`, such as `-D integrator.max_depth=3`"));
    };
    let path_span = Span::new(source, 0, path.trim_end().len());
    let offset = path.len() + 1 + (value.len() - value.trim_start().len());
    let value = value.trim();
    let span = Span::new(source, offset, offset + value.len());
    let node = match DeValue::parse(value) {
        Ok(parsed) if !matches!(parsed.get_ref(), DeValue::Datetime(_)) => {
            let mut converter = Converter::new(source, offset);
            let node = converter.node(parsed.get_ref(), parsed.span());
            if let Some(problem) = converter.problems.into_iter().next() {
                return Err(problem);
            }
            node
        }
        Err(error) if value.starts_with(['[', '{', '"', '\'']) => {
            let range = error.span().unwrap_or(0..value.len());
            return Err(syntax::problem(error.message(), Span::new(source, range.start + offset, range.end + offset)));
        }
        _ => Node::spanned(Value::Text(value.to_string()), span),
    };
    description.set(path.trim(), path_span, node)
}
