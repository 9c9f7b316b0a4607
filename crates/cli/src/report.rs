//! Problems as text: the source line, the offending words underlined, the cure. The one place that renders them.

use kirkas_scene::{Diagnostic, Severity, Sources, Span};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource};
use std::fmt;
use std::io::{IsTerminal, Write};

/// Columns of running text, and of problems where stderr is no terminal.
const WIDTH: usize = 100;
/// Problems shown in full.
const MOST: usize = 20;

/// Write all diagnostics to stderr.
pub fn print(sources: &Sources, diagnostics: &[Diagnostic]) {
    let text = render(sources, diagnostics);
    // Nobody can be told that stderr is closed.
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// A line for the user, on stderr.
pub fn note(text: impl fmt::Display) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// In lines of at most [`WIDTH`] columns; those after the first as far to the right as the text begins.
pub fn wrapped(text: &str) -> String {
    let indent = &text[..text.len() - text.trim_start().len()];
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split_whitespace() {
        if !line.is_empty() && indent.len() + line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    lines.push(line);
    lines.iter().map(|l| format!("{indent}{l}")).collect::<Vec<_>>().join("\n")
}

fn render(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    let mut text = String::new();
    let handler = handler();
    for diagnostic in diagnostics.iter().take(MOST) {
        let shown = Shown::new(sources, diagnostic);
        if handler.render_report(&mut text, &shown).is_err() {
            text += &format!("{diagnostic}\n");
        }
    }
    if diagnostics.len() > MOST {
        text += &format!("... and {} more\n", diagnostics.len() - MOST);
    }
    text
}

fn handler() -> GraphicalReportHandler {
    let is_terminal = std::io::stderr().is_terminal();
    let has_colour = is_terminal && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    let theme = if has_colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let width = std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok()).filter(|_| is_terminal).unwrap_or(WIDTH);
    GraphicalReportHandler::new_themed(theme).with_links(false).without_syntax_highlighting().with_width(width)
}

/// A diagnostic beside the text it points into.
#[derive(Debug)]
struct Shown {
    diagnostic: Diagnostic,
    source: Option<NamedSource<String>>,
    labels: Vec<LabeledSpan>,
    /// Places in other texts.
    related: Vec<Shown>,
}

impl Shown {
    fn new(sources: &Sources, diagnostic: &Diagnostic) -> Self {
        let mut diagnostic = diagnostic.clone();
        let labels = std::mem::take(&mut diagnostic.labels);
        let Some(main) = labels.first().map(|l| l.0.source) else {
            return Shown { diagnostic, source: None, labels: Vec::new(), related: Vec::new() };
        };
        let (here, elsewhere): (Vec<_>, Vec<_>) = labels.into_iter().partition(|l| l.0.source == main);
        let text = sources.get(main);
        // A label at the very end needs a line to stand in.
        let whole_lines = |t: &str| if t.ends_with('\n') { t.to_string() } else { format!("{t}\n") };
        let source = text.filter(|s| !s.text.is_empty()).map(|s| NamedSource::new(&s.path, whole_lines(&s.text)));
        if let (None, Some(binary)) = (&source, text) {
            diagnostic.message = format!("{}: {}", binary.path, diagnostic.message);
        }
        let labels = match &source {
            Some(_) => {
                here.iter().enumerate().map(|(i, l)| label(i == 0, l, text.map_or(0, |t| t.text.len()))).collect()
            }
            None => Vec::new(),
        };
        let beside = |(span, words): (Span, String)| {
            let other = Diagnostic { labels: vec![(span, words.clone())], ..Diagnostic::warning("", words) };
            Shown::new(sources, &other)
        };
        Shown { diagnostic, source, labels, related: elsewhere.into_iter().map(beside).collect() }
    }
}

fn label(is_main: bool, (span, words): &(Span, String), length: usize) -> LabeledSpan {
    let start = (span.start as usize).min(length);
    let range = start..(span.end as usize).clamp(start, length);
    match is_main {
        true => LabeledSpan::new_primary_with_span(Some(words.clone()), range),
        false => LabeledSpan::new_with_span(Some(words.clone()), range),
    }
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl std::error::Error for Shown {}

impl miette::Diagnostic for Shown {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        (!self.diagnostic.code.is_empty()).then(|| Box::new(self.diagnostic.code) as Box<dyn fmt::Display>)
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity {
            _ if self.diagnostic.code.is_empty() => miette::Severity::Advice,
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.diagnostic.help.as_ref().map(|h| Box::new(h) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.source.as_ref().map(|s| s as &dyn miette::SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        (!self.labels.is_empty())
            .then(|| Box::new(self.labels.iter().cloned()) as Box<dyn Iterator<Item = LabeledSpan>>)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn miette::Diagnostic> + 'a>> {
        if self.related.is_empty() {
            return None;
        }
        Some(Box::new(self.related.iter().map(|r| r as &dyn miette::Diagnostic)))
    }
}
