//! Source texts and places in them.

/// A source file of a description, by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SourceId(pub u32);

/// A range of bytes in a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Which text.
    pub source: SourceId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// For values that nobody wrote (defaults, generated scenes).
    pub const NONE: Span = Span { source: SourceId(u32::MAX), start: 0, end: 0 };

    /// A range of `source`.
    pub fn new(source: SourceId, start: usize, end: usize) -> Self {
        Span { source, start: start as u32, end: end as u32 }
    }

    /// True when it points into a text.
    pub fn is_some(&self) -> bool {
        self.source.0 != u32::MAX
    }

    /// From the start of this to the end of `other` (same source).
    pub fn to(self, other: Span) -> Span {
        Span { end: other.end, ..self }
    }
}

/// One text: a file, an override on the command line, a binary file (empty text).
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// The path as the user knows it, or `-D` for an override.
    pub path: String,
    /// The whole text; empty for binary files.
    pub text: String,
}

/// All texts of a description.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sources(pub Vec<Source>);

impl Sources {
    /// Add a text.
    pub fn add(&mut self, path: impl Into<String>, text: impl Into<String>) -> SourceId {
        self.0.push(Source { path: path.into(), text: text.into() });
        SourceId((self.0.len() - 1) as u32)
    }

    /// Look one up.
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.0.get(id.0 as usize)
    }

    /// The folder that paths in `id` are relative to ("" for the root folder).
    pub fn folder(&self, id: SourceId) -> &str {
        self.get(id).and_then(|s| s.path.rfind('/').map(|i| &s.path[..i])).unwrap_or("")
    }

    /// Line and column (from 1, in characters) of a byte position.
    pub fn line_column(&self, span: Span) -> Option<(usize, usize)> {
        let text = &self.get(span.source)?.text;
        let mut at = (span.start as usize).min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        let before = &text[..at];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Some((before.matches('\n').count() + 1, before[line_start..].chars().count() + 1))
    }
}
