//! Values by wavelength, as scenes write them in place of a plain colour or refractive index: a table with one entry.
//!
//! Colours: `{ blackbody = 2700 }` (K), `{ illuminant = "D65" }`, `{ spectrum = "lamp.spd" }`. Indices: `{ material = "gold" }`,
//! `{ file = "Au.yml" }` of refractiveindex.info, `{ cauchy = [A, B, ...] }` and `{ sellmeier = [B1, .., C1, ..] }` with
//! wavelengths in micrometres.

use crate::{Name, Node};

/// What may stand for a colour.
pub const COLORS: &str = "{ blackbody = KELVIN }, { illuminant = \"D65\" } or { spectrum = \"FILE\" }";
/// What may stand for a refractive index.
pub const INDICES: &str =
    "{ material = \"N-BK7\" }, { file = \"x.yml\" }, { cauchy = [A, B] } or { sellmeier = [B1, .., C1, ..] }";

fn only_entry(node: &Node) -> Option<(&str, &Node)> {
    match node.map()?.0.as_slice() {
        [(Name { text, .. }, value)] => Some((text, value)),
        _ => None,
    }
}

/// True for one of [`COLORS`].
pub fn is_color(node: &Node) -> bool {
    match only_entry(node) {
        Some(("blackbody", v)) => v.number().is_some_and(|k| (100.0..=1e6).contains(&k)),
        Some(("illuminant" | "spectrum", v)) => v.text().is_some(),
        _ => false,
    }
}

/// True for one of [`INDICES`].
pub fn is_index(node: &Node) -> bool {
    let count = |v: &Node| match v.list() {
        Some(l) if l.iter().all(|n| n.number().is_some_and(f64::is_finite)) => l.len(),
        _ => 0,
    };
    match only_entry(node) {
        Some(("material" | "file", v)) => v.text().is_some(),
        Some(("cauchy", v)) => count(v) > 0,
        Some(("sellmeier", v)) => count(v) > 0 && count(v) % 2 == 0,
        _ => false,
    }
}
