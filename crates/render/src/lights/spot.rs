//! A spot light: full within its hotspot cone, nothing outside its falloff cone, smooth between them.
//!
//! # Parameters
//! `position`, `direction`; `hotspot` and `falloff_angle`, half angles from the axis; `intensity`, `color`, `unit`;
//! `attenuation` as for points.
//!
//! # Example
//! ```toml
//! [lights.stage]
//! type = "spot"
//! position = [0, 5, 0]
//! direction = [0, -1, 0]
//! hotspot = 15
//! falloff_angle = 25
//! ```
//!
//! # Limits
//! Between the cones the light falls by `s^2 (3 - 2 s)` in the cosine of the angle, as POV-Ray and pbrt have it; real
//! luminaires have measured curves.
//!
//! # References
//! Warn 1983, "Lighting Controls for Synthetic Images"; Pharr, Jakob & Humphreys 2023, section 12.2.1.

use super::emit::EmittedRay;
use super::point::{ATTENUATION, COLOR, INTENSITY, POSITION, UNIT, point_target, towards};
use super::tree::LightBounds;
use super::{Cone, LightSample, units};
use core::f64::consts::PI;
use kirkas_geometry::elementary::{acos, cos};
use kirkas_geometry::warp::square_to_uniform_cone;
use kirkas_geometry::{Bounds3, DVec3, Frame};
use kirkas_optics::{Lanes, Palette, Spectrum};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Light,
    name: "spot",
    doc: "A cone of light from one point.",
    params: &[
        POSITION,
        ParamSpec::vector("direction", [0.0, -1.0, 0.0], "Its axis."),
        ParamSpec::number("hotspot", 20.0, "Half angle within which it is full.").unit("degrees").range((0.0, 180.0)),
        ParamSpec::number("falloff_angle", 30.0, "Half angle beyond which there is nothing.")
            .unit("degrees")
            .range((0.0, 180.0)),
        INTENSITY,
        COLOR,
        UNIT,
        ATTENUATION,
    ],
};

/// The light.
#[derive(Clone)]
pub struct SpotLight {
    position: DVec3,
    axis: DVec3,
    cos_hotspot: f64,
    cos_falloff: f64,
    intensity: Spectrum,
    attenuation: Option<[f64; 3]>,
}

impl SpotLight {
    /// From its parameters.
    pub fn new(p: &Params, palette: &Palette) -> Self {
        let cosine = |name| cos(f64::to_radians(p.number(name)));
        let cos_falloff = cosine("falloff_angle");
        let cos_hotspot = cosine("hotspot").max(cos_falloff);
        let solid_angle = effective_solid_angle(cos_hotspot, cos_falloff);
        let unit = p.text("unit").unwrap_or("plain");
        SpotLight {
            position: DVec3::from_array(p.vector("position")),
            axis: DVec3::from_array(p.vector("direction")).normalize_or(DVec3::NEG_Y),
            cos_hotspot,
            cos_falloff,
            intensity: units::light(palette, p.number("intensity"), &palette.light(p, "color"), unit, solid_angle),
            attenuation: p.optional_vector("attenuation"),
        }
    }

    /// Its power, all lanes together, W.
    pub fn power(&self) -> f64 {
        effective_solid_angle(self.cos_hotspot, self.cos_falloff) * self.intensity.sum()
    }

    /// Where it is, and its cones.
    pub fn reach(&self, power: f64) -> LightBounds {
        let (hotspot, falloff) = (acos(self.cos_hotspot), acos(self.cos_falloff));
        LightBounds {
            bounds: Bounds3::around_f64(self.position, self.position),
            normals: Cone { axis: self.axis, angle: hotspot },
            spread: falloff - hotspot,
            power,
        }
    }

    /// Share of the full light at an angle from the axis, given its cosine.
    pub fn profile(&self, cosine: f64) -> f64 {
        if cosine >= self.cos_hotspot {
            return 1.0;
        }
        if cosine <= self.cos_falloff {
            return 0.0;
        }
        let s = (cosine - self.cos_falloff) / (self.cos_hotspot - self.cos_falloff);
        s * s * (3.0 - 2.0 * s)
    }

    /// What arrives at `from`.
    pub fn sample(&self, lanes: &Lanes, from: DVec3) -> Option<LightSample> {
        let (direction, r) = towards(self.position, from)?;
        let share = self.profile(-direction.dot(self.axis));
        let light = self.intensity.at(lanes) * (share * units::falloff(self.attenuation, r)) as f32;
        let target = Some(point_target(self.position));
        (share > 0.0).then_some(LightSample { direction, target, light, pdf: 0.0 })
    }

    /// A ray that leaves it, drawn evenly from its outer cone.
    pub fn emit(&self, lanes: &Lanes, time: f64, u: (f32, f32)) -> EmittedRay {
        let height = 1.0 - self.cos_falloff;
        let local = square_to_uniform_cone(u, height as f32);
        let direction = Frame::from_z(self.axis.as_vec3()).to_world(local).as_dvec3().normalize();
        let power = self.intensity.scaled_at(lanes, self.profile(f64::from(local.z)) * 2.0 * PI * height);
        let straight = EmittedRay::new(self.position.as_vec3(), direction, time, power);
        EmittedRay { attenuation: self.attenuation, ..straight }
    }
}

/// Half of the light between the cones counts: the smooth step's mean is 1/2.
fn effective_solid_angle(cos_hotspot: f64, cos_falloff: f64) -> f64 {
    2.0 * PI * ((1.0 - cos_hotspot) + 0.5 * (cos_hotspot - cos_falloff))
}
