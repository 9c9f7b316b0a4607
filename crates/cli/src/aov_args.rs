//! `--aov NAME[:args]`: which extra layers, and how they look as pictures.

use crate::problem::Problem;
use kirkas_render::film::AovSet;
use kirkas_render::film::aov::AOVS;
use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::{Diagnostic, Sources, Span};

/// One layer asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct AovArg {
    /// One of [`AOVS`].
    pub name: &'static str,
    /// `depth:near:far`: what is white and what is black.
    pub range: Option<(f32, f32)>,
}

/// Read `depth:9:10`.
pub fn parse(texts: &[String]) -> Result<Vec<AovArg>, Problem> {
    let mut found: Vec<AovArg> = Vec::new();
    for text in texts.iter().filter(|t| !t.is_empty()) {
        let mut sources = Sources::default();
        let source = sources.add("--aov", text);
        let (name, args) = text.split_once(':').map_or((text.as_str(), None), |(n, a)| (n, Some(a)));
        let fail = |d: Diagnostic| Problem::in_sources(&sources, vec![d]);
        let span = Span::new(source, 0, name.len());
        let Some(known) = AOVS.iter().map(|a| a.0).find(|n| *n == name) else {
            return Err(fail(unknown_name("AOV", name, span, AOVS.map(|a| a.0))));
        };
        let range = match args {
            None => None,
            Some(args) => Some(near_far(known, args).ok_or_else(|| {
                let whole = Span::new(source, name.len() + 1, text.len());
                let (message, cure) = match known {
                    "depth" => ("`depth` takes two different numbers", "write `depth:NEAR:FAR`, such as `depth:9:10`"),
                    _ => ("only `depth` takes arguments", "leave them out"),
                };
                fail(Diagnostic::error("bad-aov", message).at(whole, "not understood").help(cure))
            })?),
        };
        found.retain(|a| a.name != known);
        found.push(AovArg { name: known, range });
    }
    Ok(found)
}

fn near_far(name: &str, args: &str) -> Option<(f32, f32)> {
    let (near, far) = args.split_once(':').filter(|_| name == "depth")?;
    let (near, far): (f32, f32) = (near.parse().ok()?, far.parse().ok()?);
    (near.is_finite() && far.is_finite() && near != far).then_some((near, far))
}

/// What the film must keep.
pub fn set(aovs: &[AovArg]) -> AovSet {
    AovSet::from_names(aovs.iter().map(|a| a.name)).unwrap_or_default()
}

/// As typed.
pub fn text(aovs: &[AovArg]) -> String {
    let one = |a: &AovArg| match a.range {
        Some((near, far)) => format!("{}:{near}:{far}", a.name),
        None => a.name.to_string(),
    };
    aovs.iter().map(one).collect::<Vec<_>>().join(",")
}
