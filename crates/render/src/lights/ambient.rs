//! Ambient light: the same everywhere, from nowhere: the classics' stand-in for all indirect light.
//!
//! # Parameters
//! `color`, `intensity`: every surface gains this times its ambient colour.
//!
//! # Example
//! ```toml
//! [lights.ambient]
//! type = "ambient"
//! color = [0.1, 0.1, 0.1]
//! ```
//!
//! # Limits
//! A total hack: it knows no shadows, no corners, no distance. Only `whitted` uses it.
//!
//! # References
//! Phong 1975.

use super::point::COLOR;
use kirkas_optics::{Palette, Spectrum};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Light,
    name: "ambient",
    doc: "The classics' stand-in for indirect light.",
    params: &[COLOR, ParamSpec::number("intensity", 1.0, "Scales the colour.").range(NOT_NEGATIVE)],
};

/// What every surface gains, times its ambient colour.
pub fn radiance(p: &Params, palette: &Palette) -> Spectrum {
    palette.shine(&palette.light(p, "color"), p.number("intensity"))
}
