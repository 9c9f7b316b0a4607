//! Problems as plain text, one per line: `path:line:column "underlined": message | help`, further places below it.

use kirkas_formats::Failure;
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_scene::{Diagnostic, Sources};

/// Files in memory.
pub fn files(files: &[(&str, &str)]) -> FileAccess {
    bytes(&files.iter().map(|(p, t)| (*p, t.as_bytes())).collect::<Vec<_>>())
}

/// Binary files in memory.
pub fn bytes(files: &[(&str, &[u8])]) -> FileAccess {
    let files = MemoryFiles(files.iter().map(|(p, t)| (p.to_string(), t.to_vec())).collect());
    FileAccess::new(Box::new(files), Limits::default())
}

/// All problems of a failure.
pub fn failure(failure: &Failure) -> String {
    failure.diagnostics.iter().map(|d| diagnostic(&failure.sources, d)).collect::<Vec<_>>().join("\n")
}

/// One problem.
pub fn diagnostic(sources: &Sources, d: &Diagnostic) -> String {
    let place = |span: kirkas_scene::Span| {
        let source = sources.get(span.source).expect("the span is in a known source");
        let (line, column) = sources.line_column(span).expect("the span has a line");
        let text = source.text.get(span.start as usize..span.end as usize).expect("the span lies in the text");
        format!("{}:{line}:{column} {text:?}", source.path)
    };
    let mut labels = d.labels.iter();
    let mut out = labels.next().map_or(String::new(), |(span, label)| format!("{}: {label}: ", place(*span)));
    out += &d.message;
    if let Some(help) = &d.help {
        out += &format!(" | {help}");
    }
    for (span, label) in labels {
        out += &format!("\n  {}: {label}", place(*span));
    }
    out
}
