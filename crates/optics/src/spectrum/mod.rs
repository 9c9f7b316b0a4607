//! Colours as a scene keeps them, ready to be asked by the lanes of any path: [`Spectrum::at`].
//!
//! A [`Palette`] makes them when the scene is compiled. Colours that are only known at a hit (textures) go through
//! [`Lanes`] instead. Reflectances and absorptions of a colour are those of Jakob & Hanika (2019) under daylight D65; what
//! shines in a colour has such a spectrum times D65, so white light on a white surface is (1, 1, 1) in both modes, and greys are
//! constant.

pub mod curve;
pub mod file;
pub mod illuminants;
pub mod observer;
mod paint;
pub mod sigmoid;
mod tables;

use crate::index::OpticalConstants;
use crate::lanes::ColorMode;
use crate::measured::MeasuredData;
use crate::{Lanes, Light};
use curve::Curve;
pub use paint::Paint;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Makes [`Spectrum`]s for the way in which a render carries colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Palette {
    mode: ColorMode,
    /// Files that the scene names, by source and path.
    spectra: BTreeMap<(u32, String), Vec<(f64, f64)>>,
    constants: BTreeMap<(u32, String), OpticalConstants>,
    measured: BTreeMap<(u32, String), Arc<MeasuredData>>,
}

/// A compiled colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    rgb: [f32; 3],
    waves: Waves,
}

/// What wavelengths see.
#[derive(Clone, Debug, PartialEq)]
enum Waves {
    /// The same everywhere.
    Even(f32),
    /// A sigmoid times a scale.
    Smooth(sigmoid::Coefficients, f32),
    /// Daylight D65 of this luminance.
    White(f32),
    /// Daylight D65 times a sigmoid times a scale.
    Shining(sigmoid::Coefficients, f32),
    /// Samples times a scale.
    Sampled(Curve, f32),
}

impl Palette {
    /// For paths with [`Lanes::RGB`].
    pub const RGB: Self = Palette {
        mode: ColorMode::Rgb,
        spectra: BTreeMap::new(),
        constants: BTreeMap::new(),
        measured: BTreeMap::new(),
    };

    /// For renders that carry colour this way.
    pub fn new(mode: ColorMode) -> Self {
        Palette { mode, ..Palette::RGB }
    }

    /// How colour is carried.
    pub fn mode(&self) -> ColorMode {
        self.mode
    }

    /// A colour that reflects or transmits; clamped to 0..1, NaN is 0.
    pub fn reflectance(&self, rgb: [f32; 3]) -> Spectrum {
        let rgb = rgb.map(|x| x.max(0.0).min(1.0));
        let waves = match self.mode {
            ColorMode::Spectral if !is_grey(rgb) => Waves::Smooth(sigmoid::solve(rgb), 1.0),
            _ => Waves::Even(rgb[0]),
        };
        Spectrum { rgb, waves }
    }

    /// A colour-like quantity without upper bound (absorption, the classics' coefficients); negative and NaN are 0.
    pub fn unbounded(&self, rgb: [f32; 3]) -> Spectrum {
        let rgb = rgb.map(|x| x.max(0.0));
        let waves = match self.mode {
            ColorMode::Spectral if !is_grey(rgb) => {
                let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
                Waves::Smooth(sigmoid::solve(rgb.map(|x| x / scale)), scale)
            }
            _ => Waves::Even(rgb[0]),
        };
        Spectrum { rgb, waves }
    }

    /// The colour of something that shines; negative and NaN are 0.
    pub fn illuminant(&self, rgb: [f32; 3]) -> Spectrum {
        let Spectrum { rgb, waves } = self.unbounded(rgb);
        let waves = match waves {
            Waves::Smooth(c, scale) => Waves::Shining(c, scale),
            Waves::Even(x) => Waves::White(x),
            other => other,
        };
        Spectrum { rgb, waves }
    }
}

fn is_grey(rgb: [f32; 3]) -> bool {
    rgb[0] == rgb[1] && rgb[1] == rgb[2]
}

impl Spectrum {
    /// Nothing at all.
    pub const BLACK: Self = Spectrum { rgb: [0.0; 3], waves: Waves::Even(0.0) };

    /// What the lanes of a path see of it.
    #[inline]
    pub fn at(&self, lanes: &Lanes) -> Light {
        match lanes.mode() {
            ColorMode::Rgb => Light([self.rgb[0], self.rgb[1], self.rgb[2], 0.0]),
            ColorMode::Spectral => self.at_wavelengths(lanes),
        }
    }

    fn at_wavelengths(&self, lanes: &Lanes) -> Light {
        let smooth = |c, scale: f32| Light(lanes.wavelengths().map(|w| sigmoid::at_wavelength(c, w) * scale));
        match &self.waves {
            Waves::Even(x) => Light::splat(*x),
            Waves::Smooth(c, scale) => smooth(c, *scale),
            Waves::White(scale) => lanes.white() * *scale,
            Waves::Shining(c, scale) => lanes.white() * smooth(c, *scale),
            Waves::Sampled(curve, scale) => curve.at(lanes) * *scale,
        }
    }

    /// [`Spectrum::at`] times `factor`.
    #[inline]
    pub fn scaled_at(&self, lanes: &Lanes, factor: f64) -> Light {
        match lanes.mode() {
            ColorMode::Rgb => lanes.illuminant(self.rgb.map(|c| (f64::from(c) * factor) as f32)),
            ColorMode::Spectral => self.at_wavelengths(lanes) * factor as f32,
        }
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
