//! A directional light: infinitely far away, parallel, without falloff; the sun, nearly.
//!
//! # Parameters
//! `direction` in which the light travels; `intensity`, `color`, `unit`.
//!
//! # Example
//! ```toml
//! [lights.sun]
//! type = "directional"
//! direction = [-1, -2, -1]
//! intensity = 0.9
//! ```
//!
//! # Limits
//! Shadows are hard; the real sun is half a degree wide.
//!
//! # References
//! Irradiance on a surface: E cos(theta).

use super::pick::Reach;
use super::point::COLOR;
use super::{LightSample, units};
use core::f64::consts::PI;
use kirkas_geometry::DVec3;
use kirkas_optics::{Lanes, Palette, Spectrum};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Light,
    name: "directional",
    doc: "Parallel light from infinitely far.",
    params: &[
        ParamSpec::vector("direction", [0.0, -1.0, 0.0], "The way the light travels."),
        ParamSpec::number("intensity", 1.0, "How strong, in `unit`.").range(NOT_NEGATIVE),
        COLOR,
        ParamSpec::choice(
            "unit",
            &["plain", "lux", "W/m2"],
            "`plain`: a white surface facing the light looks as bright as the number.",
        ),
    ],
};

/// The light.
#[derive(Clone)]
pub struct DirectionalLight {
    towards: DVec3,
    irradiance: Spectrum,
}

impl DirectionalLight {
    /// From its parameters.
    pub fn new(p: &Params, palette: &Palette) -> Self {
        let unit = p.text("unit").unwrap_or("plain");
        DirectionalLight {
            towards: -DVec3::from_array(p.vector("direction")).normalize_or(DVec3::NEG_Y),
            irradiance: units::light(palette, p.number("intensity"), &palette.light(p, "color"), unit, 1.0),
        }
    }

    /// The power that crosses a disk of this radius, all lanes together, W.
    pub fn power(&self, radius: f64) -> f64 {
        PI * radius * radius * self.irradiance.sum()
    }

    /// That it comes from one direction, infinitely far.
    pub fn reach(&self) -> Reach {
        Reach::Far { irradiance: self.irradiance.sum(), towards: Some(self.towards) }
    }

    /// What arrives anywhere.
    pub fn sample(&self, lanes: &Lanes) -> Option<LightSample> {
        Some(LightSample { direction: self.towards, target: None, light: self.irradiance.at(lanes), pdf: 0.0 })
    }
}
