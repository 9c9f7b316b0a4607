//! A point light: the same in all directions, fading by `1/r^2`, or by the classics' `1/(a r^2 + b r + c)`.
//!
//! # Parameters
//! `position`; `intensity`, `color`, `unit`; `attenuation = [a, b, c]`, absent = `1/r^2`.
//!
//! # Example
//! ```toml
//! [lights.bulb]
//! type = "point"
//! position = [0, 3, 0]
//! intensity = 800
//! unit = "lm"
//! ```
//!
//! # Limits
//! A point has no size: shadows are hard, and mirrors do not show it. With `attenuation` energy is not conserved.
//!
//! # References
//! I / r^2: the same power crosses every sphere around the light.

use super::emit::{EmittedRay, any_direction};
use super::tree::LightBounds;
use super::{LightSample, Target, units};
use core::f64::consts::PI;
use kirkas_geometry::{Bounds3, DVec3};
use kirkas_optics::{Lanes, Palette, Spectrum};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// Position.
pub const POSITION: ParamSpec = ParamSpec::vector("position", [0.0, 0.0, 0.0], "Where it is.").unit("scene units");
/// Intensity.
pub const INTENSITY: ParamSpec = ParamSpec::number("intensity", 1.0, "How strong, in `unit`.").range(NOT_NEGATIVE);
/// Colour.
pub const COLOR: ParamSpec = ParamSpec::color("color", [1.0, 1.0, 1.0], "Colour of the light.");
/// Unit.
pub const UNIT: ParamSpec = ParamSpec::choice(
    "unit",
    &["plain", "W", "lm", "cd", "W/sr"],
    "`plain`: a white surface facing the light at distance 1 looks as bright as the number; W and lm: whole power.",
);
/// Attenuation.
pub const ATTENUATION: ParamSpec = ParamSpec::new(
    "attenuation",
    ParamType::Vector,
    Fallback::Absent,
    "[a, b, c] for 1 / (a r^2 + b r + c), as the classics have it; absent = 1 / r^2.",
)
.range(NOT_NEGATIVE);

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Light,
    name: "point",
    doc: "The same in all directions from one point.",
    params: &[POSITION, INTENSITY, COLOR, UNIT, ATTENUATION],
};

/// The light.
#[derive(Clone)]
pub struct PointLight {
    position: DVec3,
    intensity: Spectrum,
    attenuation: Option<[f64; 3]>,
}

impl PointLight {
    /// From its parameters.
    pub fn new(p: &Params, palette: &Palette) -> Self {
        let unit = p.text("unit").unwrap_or("plain");
        PointLight {
            position: DVec3::from_array(p.vector("position")),
            intensity: units::light(palette, p.number("intensity"), &palette.light(p, "color"), unit, 4.0 * PI),
            attenuation: p.optional_vector("attenuation"),
        }
    }

    /// Its power, all lanes together, W.
    pub fn power(&self) -> f64 {
        4.0 * PI * self.intensity.sum()
    }

    /// Where it is, and that it shines all around.
    pub fn reach(&self, power: f64) -> LightBounds {
        LightBounds::all_around(Bounds3::around_f64(self.position, self.position), power)
    }

    /// What arrives at `from`.
    pub fn sample(&self, lanes: &Lanes, from: DVec3) -> Option<LightSample> {
        let (direction, r) = towards(self.position, from)?;
        let light = self.intensity.at(lanes) * units::falloff(self.attenuation, r) as f32;
        Some(LightSample { direction, target: Some(point_target(self.position)), light, pdf: 0.0 })
    }

    /// A ray that leaves it.
    pub fn emit(&self, lanes: &Lanes, time: f64, u: (f32, f32)) -> EmittedRay {
        let (direction, solid_angle) = any_direction(u);
        let power = self.intensity.scaled_at(lanes, solid_angle);
        let straight = EmittedRay::new(self.position.as_vec3(), direction, time, power);
        EmittedRay { attenuation: self.attenuation, ..straight }
    }
}

/// Unit direction and distance; `None` at the same place.
pub fn towards(position: DVec3, from: DVec3) -> Option<(DVec3, f64)> {
    let d = position - from;
    let r = d.length();
    (r > 0.0).then(|| (d / r, r))
}

/// A target without a surface.
pub fn point_target(position: DVec3) -> Target {
    Target { position, error: DVec3::ZERO, normal: DVec3::ZERO }
}
