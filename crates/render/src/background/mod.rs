//! Backgrounds: what rays see that hit nothing. Camera, mirror and refraction rays see them; `path` lights surfaces with them as
//! well, `whitted` does not.
//!
//! Contract: `sample` draws a direction with the density that `pdf` gives for it, per solid angle, and finds every direction
//! from which light comes.

pub mod gradient;
pub mod hosek_wilkie;
pub mod image;
pub mod map_distribution;
pub mod sun;
pub mod sun_sky;

use crate::lights::LightSample;
use core::f64::consts::PI;
use gradient::GradientBackground;
use image::ImageBackground;
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::{Lanes, Light, Palette};
use kirkas_scene::{Assets, Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use sun_sky::SunSky;

/// Every background type.
pub const BACKGROUNDS: &[&TypeSpec] = &[&gradient::CONSTANT, &gradient::GRADIENT, &image::SPEC, &sun_sky::SPEC];

/// What every background takes.
pub const COMMON: &[ParamSpec] = &[ParamSpec::new(
    "medium",
    ParamType::Reference(Kind::Medium),
    Fallback::Absent,
    "Medium that fills all space which no body fills; the background shines through it from infinitely far, so through any fog not at all.",
)];

/// A compiled background.
#[derive(Clone, Debug)]
pub enum Background {
    /// One colour, or radiance by elevation.
    Gradient(GradientBackground),
    /// A picture.
    Image(ImageBackground),
    /// Daylight.
    SunSky(Box<SunSky>),
}

impl Background {
    /// From its parameters.
    pub fn new(p: &Params, palette: &Palette, assets: &dyn Assets) -> Result<Self, Diagnostic> {
        Ok(match p.spec().name {
            "image" => Background::Image(ImageBackground::new(p, assets)?),
            "sun_sky" => Background::SunSky(Box::new(SunSky::new(p)?)),
            _ => Background::Gradient(GradientBackground::new(p, palette)),
        })
    }

    /// True when it sends nothing from anywhere.
    pub fn is_black(&self) -> bool {
        match self {
            Background::Gradient(b) => b.is_black(),
            Background::Image(b) => b.is_black(),
            Background::SunSky(b) => b.is_black(),
        }
    }

    /// The power that it sends into a sphere of this radius, all lanes together, W.
    pub fn power(&self, radius: f64) -> f64 {
        PI * radius * radius * self.total_radiance()
    }

    /// The integral of radiance over all directions, all lanes together, W/m2.
    pub fn total_radiance(&self) -> f64 {
        match self {
            Background::Gradient(b) => b.total_radiance(),
            Background::Image(b) => b.total_radiance(),
            Background::SunSky(b) => b.total_radiance(),
        }
    }

    /// Radiance from `direction` (any length).
    pub fn radiance(&self, lanes: &Lanes, direction: Vec3) -> Light {
        self.radiance_exactly(lanes, direction.as_dvec3().normalize_or_zero())
    }

    /// A direction from which light comes. `u` in the unit square.
    pub fn sample(&self, lanes: &Lanes, u: (f32, f32)) -> Option<LightSample> {
        let (direction, radiance, pdf) = match self {
            Background::Image(b) => b.sample(u).map(|(d, color, pdf)| (d, lanes.illuminant(color), pdf)),
            Background::Gradient(b) => b.sample(u).map(|(d, pdf)| (d, self.radiance_exactly(lanes, d), pdf)),
            Background::SunSky(b) => b.sample(u).map(|(d, pdf)| (d, self.radiance_exactly(lanes, d), pdf)),
        }?;
        let light = radiance * (1.0 / pdf) as f32;
        light.is_finite().then_some(LightSample { direction, target: None, light, pdf: pdf as f32 })
    }

    /// Radiance from `direction` (unit), and the density per solid angle with which [`Background::sample`] gives it.
    pub fn seen(&self, lanes: &Lanes, direction: DVec3) -> (Light, f32) {
        let (radiance, pdf) = match self {
            Background::Image(b) => {
                let (color, pdf) = b.seen(direction);
                (lanes.illuminant(color), pdf)
            }
            Background::Gradient(b) => (self.radiance_exactly(lanes, direction), b.pdf(direction)),
            Background::SunSky(b) => (self.radiance_exactly(lanes, direction), b.pdf(direction)),
        };
        (radiance, pdf as f32)
    }

    /// `direction` is a unit vector: a sun is narrow.
    fn radiance_exactly(&self, lanes: &Lanes, direction: DVec3) -> Light {
        match self {
            Background::Gradient(b) => b.radiance(lanes, direction.as_vec3()),
            Background::Image(b) => lanes.illuminant(b.radiance(direction)),
            Background::SunSky(b) => lanes.illuminant(b.radiance(direction)),
        }
    }
}
