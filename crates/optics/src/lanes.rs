//! What the four lanes of a path are, and how colours enter and leave them.
//!
//! Colours enter through [`Spectrum::at`](crate::Spectrum::at) or, from textures, through [`Lanes::reflectance`],
//! [`Lanes::unbounded`] and [`Lanes::illuminant`], and leave through
//! [`Lanes::to_film`]; all between is the same in every mode. Only RGB mode exists so far: lanes red, green, blue of
//! linear Rec.709 and an idle one, which no colour fills.

use crate::Light;
use kirkas_scene::{ParamSpec, ParamType};

/// The lanes of one path. Each path carries its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes {
    mode: Mode,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Rgb,
}

impl Lanes {
    /// Red, green, blue and an idle lane.
    pub const RGB: Self = Lanes { mode: Mode::Rgb };

    /// A weight of 1 in every lane in use: what a path starts with.
    pub fn one(&self) -> Light {
        match self.mode {
            Mode::Rgb => Light([1.0, 1.0, 1.0, 0.0]),
        }
    }

    /// A colour that reflects or transmits; clamped to 0..1, NaN is 0.
    pub fn reflectance(&self, rgb: [f32; 3]) -> Light {
        self.fill(rgb.map(|x| x.max(0.0).min(1.0)))
    }

    /// A colour-like quantity without upper bound (absorption, the classics' coefficients); negative and NaN are 0.
    pub fn unbounded(&self, rgb: [f32; 3]) -> Light {
        self.fill(rgb.map(|x| x.max(0.0)))
    }

    /// The colour of something that shines; negative and NaN are 0.
    pub fn illuminant(&self, rgb: [f32; 3]) -> Light {
        self.fill(rgb.map(|x| x.max(0.0)))
    }

    /// An evaluated parameter, as the models take it, by its table row: colours as [`Lanes::reflectance`] where the
    /// row's range ends at 1, else [`Lanes::unbounded`]; numbers (the mean of `rgb`) clamped into the range, in every lane.
    pub fn parameter(&self, row: &ParamSpec, rgb: [f32; 3]) -> Light {
        let (low, high) = (row.range.0 as f32, row.range.1 as f32);
        match row.ty {
            ParamType::NumberTexture | ParamType::Number => {
                Light::splat(((rgb[0] + rgb[1] + rgb[2]) / 3.0).max(low).min(high))
            }
            _ if high <= 1.0 => self.reflectance(rgb),
            _ => self.unbounded(rgb),
        }
    }

    /// Light as film RGB (linear Rec.709).
    pub fn to_film(&self, light: Light) -> [f32; 3] {
        match self.mode {
            Mode::Rgb => [light.0[0], light.0[1], light.0[2]],
        }
    }

    #[inline]
    pub(crate) fn fill(&self, rgb: [f32; 3]) -> Light {
        match self.mode {
            Mode::Rgb => Light([rgb[0], rgb[1], rgb[2], 0.0]),
        }
    }
}
