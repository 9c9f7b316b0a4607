//! The measurements of an RGL file: colours or spectra at the vertices of a grid per slice.

use super::in_lanes;
use super::tensor_file::TensorFile;
use super::warp::{Blend, split};
use crate::lanes::ColorMode;
use crate::spectrum::curve::Curve;
use crate::spectrum::observer::observer;
use crate::{Lanes, Light};

/// Values by slice, y, x and channel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Values {
    width: usize,
    height: usize,
    pub(super) channels: Channels,
    all: Vec<f32>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Channels {
    /// Red, green and blue.
    Rgb,
    /// At wavelengths, nm, rising.
    Waves(Vec<f32>),
}

impl Channels {
    pub(super) fn count(&self) -> usize {
        match self {
            Channels::Rgb => 3,
            Channels::Waves(waves) => waves.len(),
        }
    }
}

/// What red, green and blue under D65 get from a value at each wavelength.
pub(super) fn colour_weights(waves: &[f32]) -> Vec<[f64; 3]> {
    let only = |k: usize| {
        let pairs = waves.iter().enumerate().map(|(j, &w)| (f64::from(w), f64::from(u8::from(j == k))));
        observer().color_of_reflectance(Curve::of_pairs(&pairs.collect::<Vec<_>>(), true).samples())
    };
    (0..waves.len()).map(only).collect()
}

impl Values {
    pub(super) fn read(file: &TensorFile, slices: &[usize; 2], mode: ColorMode) -> Result<Self, String> {
        let (name, waves) = match file.has("spectra") {
            true => ("spectra", Some(file.floats("wavelengths", 1)?.values)),
            false => ("rgb", None),
        };
        let tensor = file.floats(name, 5)?;
        let channels = waves.as_ref().map_or(3, Vec::len);
        tensor.check(name, &[slices[0], slices[1], channels])?;
        let (height, width) = (tensor.shape[3], tensor.shape[4]);
        let texels = width * height;
        let value = |texel: usize, c: usize| tensor.values[(texel / texels * channels + c) * texels + texel % texels];
        let texel_count = tensor.values.len() / channels;
        let all = |count: usize, of: &dyn Fn(usize, usize) -> f32| {
            (0..texel_count).flat_map(|t| (0..count).map(move |c| (t, c))).map(|(t, c)| of(t, c)).collect()
        };
        match waves {
            Some(waves) if !(waves.len() >= 2 && waves.windows(2).all(|w| w[0] < w[1])) => {
                Err("its field `wavelengths` does not rise".into())
            }
            Some(waves) if mode == ColorMode::Spectral => {
                Ok(Values { width, height, channels: Channels::Waves(waves), all: all(channels, &value) })
            }
            Some(waves) => {
                let weights = colour_weights(&waves);
                let colour = |texel: usize, c: usize| {
                    let sum = weights.iter().enumerate().map(|(k, w)| w[c] * f64::from(value(texel, k)));
                    sum.sum::<f64>() as f32
                };
                Ok(Values { width, height, channels: Channels::Rgb, all: all(3, &colour) })
            }
            None => Ok(Values { width, height, channels: Channels::Rgb, all: all(3, &value) }),
        }
    }

    /// The corners around a point, in all slices: where their channels begin, and their weights.
    #[inline]
    fn corners(&self, blend: &Blend, (x, y): (f32, f32), mut visit: impl FnMut(usize, f32)) {
        let ((x, dx), (y, dy)) = (split(x, self.width), split(y, self.height));
        let channels = self.channels.count();
        for (slice, weight) in blend.iter() {
            let first = (slice * self.height + y) * self.width + x;
            for (at, w) in [
                (first, (1.0 - dx) * (1.0 - dy)),
                (first + 1, dx * (1.0 - dy)),
                (first + self.width, (1.0 - dx) * dy),
                (first + self.width + 1, dx * dy),
            ] {
                visit(at * channels, weight * w);
            }
        }
    }

    pub(super) fn channel(&self, blend: &Blend, u: (f32, f32), channel: usize) -> f32 {
        let mut sum = 0.0;
        self.corners(blend, u, |at, w| sum += w * self.all[at + channel]);
        sum
    }

    /// In a path's lanes, not negative.
    pub(super) fn at(&self, blend: &Blend, u: (f32, f32), lanes: &Lanes) -> Light {
        match &self.channels {
            Channels::Rgb => {
                let mut rgb = [0.0; 3];
                self.corners(blend, u, |at, w| {
                    for (sum, v) in rgb.iter_mut().zip(&self.all[at..at + 3]) {
                        *sum += w * v;
                    }
                });
                in_lanes(rgb, lanes)
            }
            Channels::Waves(waves) => {
                let places = lanes.wavelengths().map(|nm| {
                    let next = waves.partition_point(|&w| w <= nm).clamp(1, waves.len() - 1);
                    let share = (nm - waves[next - 1]) / (waves[next] - waves[next - 1]);
                    (next - 1, share.max(0.0).min(1.0))
                });
                let mut sums = [0.0; 4];
                self.corners(blend, u, |at, w| {
                    for (sum, (k, share)) in sums.iter_mut().zip(places) {
                        let (a, b) = (self.all[at + k], self.all[at + k + 1]);
                        *sum += w * (a + (b - a) * share);
                    }
                });
                Light(sums).map(|x| x.max(0.0))
            }
        }
    }
}
