//! Tone curves: how scene light becomes what a screen can show.
//!
//! A curve maps a linear channel value (after exposure) to a linear display value in `[0, 1]`, each channel
//! for itself; the sRGB code is applied after it.
//!
//! References: J. Hable, "Filmic Tonemapping Operators", 2010
//! (<http://filmicworlds.com/blog/filmic-tonemapping-operators/>); K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016
//! (<https://knarkowicz.wordpress.com/2016/01/06/aces-filmic-tone-mapping-curve/>).

use crate::image::RgbImage;
use crate::srgb::{linear_to_srgb8, linear_to_srgb16};
use kirkas_geometry::elementary::pow;

/// The tone curves, by the names of the option `--tone`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ToneCurve {
    /// Clip what is brighter than white.
    #[default]
    Linear,
    /// Hable's filmic curve: soft toe and shoulder, white at 5.6.
    Filmic,
    /// Narkowicz's fit of the ACES curve: more contrast, white at about 7.2.
    Aces,
}

impl ToneCurve {
    /// All curves.
    pub const ALL: [Self; 3] = [Self::Linear, Self::Filmic, Self::Aces];

    /// The name a user types.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Filmic => "filmic",
            Self::Aces => "aces",
        }
    }

    /// One line for a manual.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Linear => "clip what is brighter than white; keeps numbers comparable",
            Self::Filmic => "Hable 2010: soft shadows and highlights, white at 5.6",
            Self::Aces => "Narkowicz 2016, a fit of ACES: strong contrast, white at about 7.2",
        }
    }

    /// The curve of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|curve| curve.name() == name)
    }

    /// The display value in `[0, 1]` of a scene value; NaN and what is below 0 give 0.
    pub fn apply(self, x: f32) -> f32 {
        if x.is_nan() || x <= 0.0 {
            return 0.0;
        }
        let x = x.min(1e4);
        match self {
            Self::Linear => x.min(1.0),
            // Hable doubles the exposure ("exposure bias") before the curve and scales white, W = 11.2, to 1.
            Self::Filmic => (hable(2.0 * x) / hable(11.2)).min(1.0),
            Self::Aces => ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).min(1.0),
        }
        .max(0.0)
    }
}

fn hable(x: f32) -> f32 {
    let [a, b, c, d, e, f] = [0.15f32, 0.50, 0.10, 0.20, 0.02, 0.30];
    // The paper's `- E / F` is the curve at 0; written as itself it cancels exactly there.
    let curve = |x: f32| (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f);
    curve(x) - curve(0.0)
}

/// The sRGB bytes of a picture, three to a pixel; `exposure` in stops (one stop doubles the light).
pub fn to_srgb8(image: &RgbImage, exposure: f32, curve: ToneCurve) -> Vec<u8> {
    develop(image, exposure, curve).map(linear_to_srgb8).collect()
}

/// The sRGB sixteen-bit codes of a picture, three to a pixel; `exposure` in stops.
pub fn to_srgb16(image: &RgbImage, exposure: f32, curve: ToneCurve) -> Vec<u16> {
    develop(image, exposure, curve).map(linear_to_srgb16).collect()
}

fn develop(image: &RgbImage, exposure: f32, curve: ToneCurve) -> impl Iterator<Item = f32> + '_ {
    let scale = pow(2.0, f64::from(exposure)) as f32;
    image.pixels.iter().flatten().map(move |&value| curve.apply(value * scale))
}
