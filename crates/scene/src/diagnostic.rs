//! Problems as values: what, where, and how to mend it. One place (the command line) renders them.

use crate::Span;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene works, but something is approximated, ignored or suspicious.
    Warning,
    /// The scene cannot be used.
    Error,
}

/// One problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// A stable short name, such as `unknown-name`.
    pub code: &'static str,
    /// How bad.
    pub severity: Severity,
    /// One sentence that names the offender.
    pub message: String,
    /// Places, each with a few words; the first is the main one.
    pub labels: Vec<(Span, String)>,
    /// The cure.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Diagnostic { code, severity: Severity::Error, message: message.into(), labels: Vec::new(), help: None }
    }

    /// A warning.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Self::error(code, message) }
    }

    /// Point at a place.
    pub fn at(mut self, span: Span, label: impl Into<String>) -> Self {
        if span.is_some() {
            self.labels.push((span, label.into()));
        }
        self
    }

    /// Say the cure.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// True for errors.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)?;
        if let Some(help) = &self.help {
            write!(f, " ({help})")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostic {}

/// The candidate nearest to a misspelt `name`, if one is near enough to be what was meant.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    candidates
        .into_iter()
        .map(|c| (strsim::damerau_levenshtein(&lower, &c.to_lowercase()), c))
        .filter(|(d, c)| *d <= 1 + c.len().max(name.len()) / 4)
        .min_by_key(|(d, c)| (*d, c.len()))
        .map(|(_, c)| c)
}

/// "unknown material `glas`; did you mean `glass`?", with the known names as help where none is near.
pub fn unknown_name<'a>(
    what: &str,
    name: &str,
    span: Span,
    known: impl IntoIterator<Item = &'a str> + Clone,
) -> Diagnostic {
    let near = nearest(name, known.clone());
    let message = match near {
        Some(n) => format!("unknown {what} `{name}`; did you mean `{n}`?"),
        None => format!("unknown {what} `{name}`"),
    };
    let mut names: Vec<&str> = known.into_iter().collect();
    names.sort_unstable();
    names.dedup();
    const MOST: usize = 24;
    let listed = names.iter().take(MOST).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    let help = match (near, names.is_empty()) {
        (Some(n), _) if names.len() == 1 => format!("write `{n}`"),
        (Some(n), _) => format!("write `{n}`, or one of: {listed}{more}"),
        (None, false) => format!("write one of: {listed}{more}"),
        (None, true) => format!("the scene defines no {what}; define one, or remove this"),
    };
    Diagnostic::error("unknown-name", message).at(span, "not known").help(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        assert_eq!(nearest("glas", ["gold", "glass"]), Some("glass"));
        assert_eq!(nearest("Lambrt", ["lambert", "phong"]), Some("lambert"));
        assert_eq!(nearest("xyzzy", ["lambert", "phong"]), None);
    }
}
