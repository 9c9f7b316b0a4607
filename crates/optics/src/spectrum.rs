//! Colours as a scene keeps them, ready to be asked by the lanes of any path: [`Spectrum::at`].
//!
//! A [`Palette`] makes them when the scene is compiled. Colours that are only known at a hit (textures) go through
//! [`Lanes`] instead.

use crate::{Lanes, Light};

/// Makes [`Spectrum`]s for the way in which a render carries colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Palette {}

/// A compiled colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrum {
    rgb: [f32; 3],
}

impl Palette {
    /// For paths with [`Lanes::RGB`].
    pub const RGB: Self = Palette {};

    /// A colour that reflects or transmits; clamped to 0..1, NaN is 0.
    pub fn reflectance(&self, rgb: [f32; 3]) -> Spectrum {
        Spectrum { rgb: rgb.map(|x| x.max(0.0).min(1.0)) }
    }

    /// A colour-like quantity without upper bound (absorption, the classics' coefficients); negative and NaN are 0.
    pub fn unbounded(&self, rgb: [f32; 3]) -> Spectrum {
        Spectrum { rgb: rgb.map(|x| x.max(0.0)) }
    }

    /// The colour of something that shines; negative and NaN are 0.
    pub fn illuminant(&self, rgb: [f32; 3]) -> Spectrum {
        Spectrum { rgb: rgb.map(|x| x.max(0.0)) }
    }
}

impl Spectrum {
    /// Nothing at all.
    pub const BLACK: Self = Spectrum { rgb: [0.0; 3] };

    /// What the lanes of a path see of it.
    #[inline]
    pub fn at(&self, lanes: &Lanes) -> Light {
        lanes.fill(self.rgb)
    }

    /// [`Spectrum::at`] times `factor`.
    #[inline]
    pub fn scaled_at(&self, lanes: &Lanes, factor: f64) -> Light {
        lanes.fill(self.rgb.map(|c| (f64::from(c) * factor) as f32))
    }

    /// Its colour, linear Rec.709.
    pub fn rgb(&self) -> [f32; 3] {
        self.rgb
    }

    /// Its luminance (Rec.709 weights).
    pub fn luminance(&self) -> f32 {
        0.2126 * self.rgb[0] + 0.7152 * self.rgb[1] + 0.0722 * self.rgb[2]
    }

    /// Red, green and blue together: what samples are shared out by, so that no density depends on a path's lanes.
    pub fn sum(&self) -> f64 {
        self.rgb.iter().map(|&c| f64::from(c)).sum()
    }

    /// True when it is 0 everywhere.
    pub fn is_black(&self) -> bool {
        self.rgb == [0.0; 3]
    }
}
