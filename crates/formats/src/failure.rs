//! What a reader answers when it cannot give what was asked: the problems, and the texts they point into.

use kirkas_scene::files::{FileAccess, FileError};
use kirkas_scene::{Diagnostic, Sources};

/// Why a file could not be read: at least one error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Failure {
    /// The texts that the spans in `diagnostics` point into.
    pub sources: Sources,
    /// What is wrong, in written order.
    pub diagnostics: Vec<Diagnostic>,
}

impl Failure {
    /// Problems in these texts.
    pub fn new(sources: Sources, diagnostics: Vec<Diagnostic>) -> Self {
        Failure { sources, diagnostics }
    }

    /// One problem in one text, made by a caller that knows only the text's path.
    pub fn one(sources: Sources, diagnostic: Diagnostic) -> Self {
        Failure { sources, diagnostics: vec![diagnostic] }
    }

    /// The first problem as one that stands without its text: `path:line:column` goes into the message.
    pub fn into_diagnostic(self) -> Diagnostic {
        let more = self.diagnostics.len().saturating_sub(1);
        let sources = self.sources;
        let Some(first) = self.diagnostics.into_iter().next() else {
            return Diagnostic::error("unreadable", "the file cannot be read");
        };
        let mut alone = standing_alone(&sources, first);
        if more > 0 {
            alone.message += &format!(" (and {more} more problems in this file)");
        }
        alone
    }
}

/// The same problem without spans: `path:line:column` goes into the message.
pub fn standing_alone(sources: &Sources, mut diagnostic: Diagnostic) -> Diagnostic {
    let labels = std::mem::take(&mut diagnostic.labels);
    let place = labels.first().and_then(|(span, _)| {
        let (line, column) = sources.line_column(*span)?;
        Some(format!("{}:{line}:{column}: ", sources.get(span.source)?.path))
    });
    if let Some(place) = place {
        diagnostic.message.insert_str(0, &place);
    }
    diagnostic
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Failure::one(Sources::default(), diagnostic)
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, d) in self.diagnostics.iter().enumerate() {
            let gap = if i == 0 { "" } else { "\n" };
            write!(f, "{gap}{d}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Failure {}

/// A text file as read.
#[derive(Clone, Debug, PartialEq)]
pub struct TextFile {
    /// Its path from the root folder.
    pub path: String,
    /// Its text, without a byte order mark.
    pub text: String,
}

/// Texts longer than this are refused: a scene keeps its long arrays in mesh files.
const LONGEST_TEXT: usize = 512 << 20;

/// Read `path`, relative to `folder`, as UTF-8.
pub fn read_text(files: &FileAccess, folder: &str, path: &str) -> Result<TextFile, Diagnostic> {
    let (path, bytes) = files.read(folder, path).map_err(|e| file_problem(&e))?;
    if bytes.len() > LONGEST_TEXT {
        let message =
            format!("`{path}` is a text of {} MiB, but {} are allowed", bytes.len() >> 20, LONGEST_TEXT >> 20);
        return Err(Diagnostic::error("file-too-large", message).help("keep long arrays in binary PLY files beside it"));
    }
    let text = utf8(&path, &bytes)?.to_string();
    Ok(TextFile { path, text })
}

/// `bytes` of the file `path` as UTF-8, without a byte order mark.
pub fn utf8<'a>(path: &str, bytes: &'a [u8]) -> Result<&'a str, Diagnostic> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| {
        let before = &bytes[..e.valid_up_to()];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let utf16 = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
        let help = if utf16 { "it looks like UTF-16; save it as UTF-8" } else { "save it as UTF-8" };
        let byte = bytes.get(e.valid_up_to()).copied().unwrap_or_default();
        Diagnostic::error("not-text", format!("`{path}` is not UTF-8 text: byte 0x{byte:02x} in line {line}"))
            .help(help)
    })
}

/// A file problem for the user, without a place (add one with [`Diagnostic::at`]).
pub fn file_problem(error: &FileError) -> Diagnostic {
    let (code, help) = match error {
        FileError::NotFound(_) => ("file-not-found", "check the name; paths are relative to the file that names them"),
        FileError::Outside(_) => ("file-outside", "a scene reads only below its root folder; move the file there"),
        FileError::TooLarge { .. } => ("file-too-large", "split the file, or raise the limit"),
        FileError::TooMany(_) => ("too-many-files", "join some of the files, or raise the limit"),
        FileError::Other { .. } => ("file-unreadable", "check that it is a file that you may read"),
    };
    Diagnostic::error(code, error.to_string()).help(help)
}
