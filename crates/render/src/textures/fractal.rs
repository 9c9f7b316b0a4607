//! Octaves of noise, each finer and weaker than the one before, down to what a sample can show.
//!
//! Perlin 1985, "An Image Synthesizer" (sums of octaves, turbulence); Ebert et al. 2003, "Texturing and Modeling", sections 2 and 14
//! (clamping: octaves finer than a sample fade into their mean).

use super::perlin::noise;
use super::taps::Taps;
use super::{PatternPoint, TextureInput};
use kirkas_geometry::DVec3;
use kirkas_scene::ParamSpec;

/// The most octaves: beyond, a layer is finer than any pixel and weaker than any step of colour.
pub(super) const OCTAVES: (f64, f64) = (0.0, 32.0);
/// The row `style`.
pub(super) const STYLE: ParamSpec = ParamSpec::choice(
    "style",
    &["fractal", "turbulence"],
    "octaves as they are, which roll, or without their signs, which makes creases",
);
/// The row `lacunarity`.
pub(super) const LACUNARITY: ParamSpec =
    ParamSpec::number("lacunarity", 2.0, "how much finer each octave is than the one before").range((1.0, 16.0));
/// The row `gain`.
pub(super) const GAIN: ParamSpec =
    ParamSpec::number("gain", 0.5, "how strong each octave is beside the one before").range((0.0, 4.0));

/// A sum of octaves: `noise(p) + gain noise(lacunarity p) + gain^2 noise(lacunarity^2 p) + ...`
#[derive(Clone, Debug)]
pub(super) struct Fractal {
    octaves: u32,
    lacunarity: f64,
    gain: f64,
    has_creases: bool,
}

/// Noise cells per sample up to which an octave is shown whole, and from which it is gone.
const FADE: (f64, f64) = (0.4, 1.1);
/// Of the finest detail per sample up to which one look is enough.
const ONE_LOOK: f64 = 0.25;
/// The mean of the noise without its sign.
const MEAN_WITHOUT_SIGN: f64 = 0.22;
/// The most places along the ellipse of a sample.
const MOST_TAPS: u32 = 4;

impl Fractal {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Fractal {
            octaves: input.params.integer("octaves").clamp(0, OCTAVES.1 as i64) as u32,
            lacunarity: input.params.number("lacunarity"),
            gain: input.params.number("gain"),
            has_creases: input.params.text("style") == Some("turbulence"),
        }
    }

    /// The sum at `p` for a sample that covers `width`.
    pub(super) fn value(&self, p: DVec3, width: f64) -> f64 {
        let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
        for _ in 0..self.octaves {
            let shown = shown(frequency * width);
            let mean = if self.has_creases { MEAN_WITHOUT_SIGN } else { 0.0 };
            if shown == 0.0 {
                sum += mean * amplitude;
            } else {
                let n = noise(p * frequency);
                let n = if self.has_creases { n.abs() } else { n };
                sum += (mean + (n - mean) * shown) * amplitude;
            }
            frequency *= self.lacunarity;
            amplitude *= self.gain;
        }
        sum
    }

    /// Cells of the finest octave per unit.
    pub(super) fn finest(&self) -> f64 {
        (1..self.octaves).fold(1.0, |f, _| f * self.lacunarity)
    }
}

/// The part of an octave that is left where a sample covers so many of its cells.
fn shown(cells: f64) -> f64 {
    let (whole, gone) = FADE;
    if cells <= whole {
        return 1.0;
    }
    let t = ((gone - cells) / (gone - whole)).max(0.0);
    t * t * (3.0 - 2.0 * t)
}

impl PatternPoint<'_> {
    /// The mean of `value`, which knows its place and the width to show, over what the sample covers. Detail of the pattern is no
    /// finer than `finest` per unit.
    pub(super) fn solid_mean(&self, finest: f64, value: impl Fn(DVec3, f64) -> f64) -> f64 {
        let long = self.axes[0].length().max(self.axes[1].length());
        // Hardly anything to filter: one look.
        if !(long * finest > ONE_LOOK) {
            return value(self.position, long);
        }
        let taps = Taps::along(self.axes.map(|a| a.to_array()), MOST_TAPS);
        let width = taps.widest();
        taps.mean(self.position.to_array(), |place, _| value(DVec3::from_array(place), width))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::low_discrepancy::owen_sobol_2d;

    #[test]
    fn the_mean_of_noise_without_its_sign_is_the_constant() {
        let n = 1 << 16;
        let at = |i: u32| {
            let ((x, y), (z, _)) = (owen_sobol_2d(i, 1), owen_sobol_2d(i, 2));
            DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * 256.0
        };
        let mean = (0..n).map(|i| noise(at(i)).abs()).sum::<f64>() / f64::from(n);
        assert!((mean - MEAN_WITHOUT_SIGN).abs() < 0.002, "{mean}");
    }

    #[test]
    fn octaves_finer_than_a_sample_fade_into_their_mean() {
        let f = |has_creases| Fractal { octaves: 6, lacunarity: 2.0, gain: 0.5, has_creases };
        let p = DVec3::new(0.3, 1.7, 2.2);
        assert_eq!(f(false).value(p, 100.0), 0.0);
        let sum = (0..6).fold(0.0, |s, k| s + MEAN_WITHOUT_SIGN * 0.5_f64.powi(k));
        assert!((f(true).value(p, 100.0) - sum).abs() < 1e-12);
        // Two octaves left of six.
        let two = Fractal { octaves: 2, ..f(false) };
        assert_eq!(f(false).value(p, 0.3), two.value(p, 0.3));
    }
}
