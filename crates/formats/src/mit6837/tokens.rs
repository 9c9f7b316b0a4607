//! Words, braces and numbers of a scene text, with their places.

use kirkas_scene::{Diagnostic, SourceId, Span};

/// A word or a brace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub text: &'a str,
    pub span: Span,
}

impl Token<'_> {
    /// For messages: cut when long.
    pub fn shown(&self) -> String {
        match self.text.char_indices().nth(40) {
            Some((end, _)) => format!("{}...", &self.text[..end]),
            None => self.text.to_string(),
        }
    }
}

/// Reads tokens; blanks and comments (`#` or `//` to the line's end) lie between them.
#[derive(Clone)]
pub(super) struct Tokens<'a> {
    text: &'a str,
    at: usize,
    source: SourceId,
}

impl<'a> Tokens<'a> {
    pub fn new(text: &'a str, source: SourceId) -> Self {
        Tokens { text, at: 0, source }
    }

    /// The next token.
    pub fn next(&mut self) -> Option<Token<'a>> {
        let bytes = self.text.as_bytes();
        loop {
            let b = *bytes.get(self.at)?;
            if b == b'#' || bytes[self.at..].starts_with(b"//") {
                while bytes.get(self.at).is_some_and(|&b| b != b'\n') {
                    self.at += 1;
                }
            } else if b <= b' ' {
                self.at += 1;
            } else {
                break;
            }
        }
        let start = self.at;
        let is_brace = |b: u8| b == b'{' || b == b'}';
        self.at += 1;
        if !is_brace(bytes[start]) {
            while bytes.get(self.at).is_some_and(|&b| b > b' ' && !is_brace(b)) {
                self.at += 1;
            }
        }
        // Tokens end at ASCII bytes, so these are whole characters.
        let text = self.text.get(start..self.at)?;
        Some(Token { text, span: Span::new(self.source, start, self.at) })
    }

    /// The next token, left where it is.
    pub fn peek(&self) -> Option<Token<'a>> {
        self.clone().next()
    }

    fn end(&self) -> Span {
        Span::new(self.source, self.text.trim_end().len(), self.text.trim_end().len())
    }

    /// A token that must follow.
    pub fn expect(&mut self, what: &str, after: Token) -> Result<Token<'a>, Diagnostic> {
        self.next().ok_or_else(|| {
            Diagnostic::error("cut-off", format!("the file ends where {what} should follow `{}`", after.shown()))
                .at(self.end(), "the end")
                .at(after.span, "this is incomplete")
                .help("the file may have been cut off")
        })
    }

    /// A finite number.
    pub fn number(&mut self, after: Token) -> Result<(f64, Span), Diagnostic> {
        let token = self.expect("a number", after)?;
        match token.text.parse::<f64>() {
            Ok(v) if v.is_finite() => Ok((v, token.span)),
            Ok(_) => Err(Diagnostic::error("not-finite", format!("`{}` is not a finite number", token.shown()))
                .at(token.span, "not finite")
                .help("write an ordinary number")),
            Err(_) => Err(Diagnostic::error(
                "not-a-number",
                format!("`{}` takes a number here, not `{}`", after.shown(), token.shown()),
            )
            .at(token.span, "expected a number")
            .at(after.span, "for this")
            .help("write a number such as `1`, `-0.5` or `2e-3`")),
        }
    }

    /// A whole number from 0 up.
    pub fn count(&mut self, after: Token) -> Result<(usize, Span), Diagnostic> {
        let token = self.expect("a whole number", after)?;
        let count = token.text.parse::<u32>().map_err(|_| {
            Diagnostic::error(
                "not-a-number",
                format!("`{}` takes a whole number, not `{}`", after.shown(), token.shown()),
            )
            .at(token.span, "expected 0, 1, 2, ...")
            .help("count from 0")
        })?;
        Ok((count as usize, token.span))
    }

    /// Several numbers, and the place of all of them.
    pub fn numbers<const N: usize>(&mut self, after: Token) -> Result<([f64; N], Span), Diagnostic> {
        let mut out = [0.0; N];
        let mut span = after.span;
        for (i, o) in out.iter_mut().enumerate() {
            let (v, place) = self.number(after)?;
            *o = v;
            span = if i == 0 { place } else { span.to(place) };
        }
        Ok((out, span))
    }

    /// `{`
    pub fn open(&mut self, owner: Token) -> Result<(), Diagnostic> {
        let token = self.expect("`{`", owner)?;
        if token.text == "{" {
            return Ok(());
        }
        Err(Diagnostic::error(
            "expected-brace",
            format!("`{}` must be followed by `{{`, not `{}`", owner.shown(), token.shown()),
        )
        .at(token.span, "expected `{`")
        .help(format!("write `{} {{ ... }}`", owner.shown())))
    }

    /// The next word inside the block of `owner`; `None` at its `}`.
    pub fn entry(&mut self, owner: Token) -> Result<Option<Token<'a>>, Diagnostic> {
        match self.next() {
            Some(t) if t.text == "}" => Ok(None),
            Some(t) => Ok(Some(t)),
            None => Err(Diagnostic::error("never-closed", format!("the block of `{}` is never closed", owner.shown()))
                .at(self.end(), "the file ends here")
                .at(owner.span, "opened here")
                .help("add the missing `}`; the file may have been cut off")),
        }
    }
}
