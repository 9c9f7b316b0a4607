//! Words and lines of an OBJ or MTL file, with their places.

use kirkas_scene::{SourceId, Span};

/// A word and where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    /// Its bytes, never empty (but a rest of a line may be).
    pub bytes: &'a [u8],
    /// Position of the first byte.
    pub start: usize,
}

impl<'a> Word<'a> {
    pub fn span(&self, source: SourceId) -> Span {
        Span::new(source, self.start, self.start + self.bytes.len())
    }

    /// As text; bytes that are not UTF-8 are replaced.
    pub fn text(&self) -> std::borrow::Cow<'a, str> {
        String::from_utf8_lossy(self.bytes)
    }

    /// As text for a message, cut when it is long.
    pub fn shown(&self) -> String {
        const MOST: usize = 40;
        let text = String::from_utf8_lossy(&self.bytes[..self.bytes.len().min(4 * MOST)]);
        match text.char_indices().nth(MOST) {
            Some((end, _)) => format!("{}...", &text[..end]),
            None => text.into_owned(),
        }
    }

    /// As a number, which may be infinite or NaN.
    pub fn number(&self) -> Option<f32> {
        std::str::from_utf8(self.bytes).ok()?.parse().ok()
    }
}

/// Walks over the words of a line, and over lines. `\` at a line's end joins it with the next; `#` starts a comment.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

fn is_end(b: u8) -> bool {
    b == b'\n' || b == b'\r'
}

impl<'a> Lines<'a> {
    /// From the first byte (after a byte order mark).
    pub fn new(bytes: &'a [u8]) -> Self {
        Lines { bytes, at: if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 } }
    }

    /// From the line that starts at `at`.
    pub fn from(bytes: &'a [u8], at: usize) -> Self {
        Lines { bytes, at }
    }

    /// Where the next byte is read.
    pub fn position(&self) -> usize {
        self.at
    }

    /// The next word of this line.
    #[inline]
    pub fn word(&mut self) -> Option<Word<'a>> {
        loop {
            match *self.bytes.get(self.at)? {
                b'\\' if self.bytes[self.at + 1..].starts_with(b"\n") => self.at += 2,
                b'\\' if self.bytes[self.at + 1..].starts_with(b"\r\n") => self.at += 3,
                b'\\' if self.bytes[self.at + 1..].starts_with(b"\r") => self.at += 2,
                b'#' => {
                    self.skip_rest();
                    return None;
                }
                b if is_end(b) => return None,
                b if b <= b' ' => self.at += 1,
                _ => break,
            }
        }
        let start = self.at;
        while let Some(&b) = self.bytes.get(self.at) {
            let joins = b == b'\\' && self.bytes.get(self.at + 1).is_some_and(|&n| is_end(n));
            if b <= b' ' || joins {
                break;
            }
            self.at += 1;
        }
        Some(Word { bytes: &self.bytes[start..self.at], start })
    }

    /// All that is left of this line, without blanks around it: names and paths may hold spaces.
    pub fn rest(&mut self) -> Word<'a> {
        let start = self.at;
        self.skip_rest();
        let line = &self.bytes[start..self.at];
        let first = line.iter().position(|&b| b > b' ').unwrap_or(line.len());
        let last = line.iter().rposition(|&b| b > b' ').map_or(first, |i| i + 1);
        Word { bytes: &line[first..last], start: start + first }
    }

    fn skip_rest(&mut self) {
        let left = &self.bytes[self.at..];
        self.at += left.iter().position(|&b| is_end(b)).unwrap_or(left.len());
    }

    /// Go to the next line; false at the end of the file.
    pub fn next_line(&mut self) -> bool {
        while self.word().is_some() {}
        if self.at < self.bytes.len() {
            self.at += 1;
        }
        self.at < self.bytes.len()
    }
}
