//! Quantities over wavelength: samples every 5 nm from 380 nm to 780 nm, straight lines between them.
//!
//! The range holds all but 2e-6 of what the observer's y-bar sees.

use crate::{Lanes, Light};
use std::sync::Arc;

/// Samples of a curve.
pub const SAMPLES: usize = 81;
/// Wavelength of the first sample, nm.
pub const FIRST: f64 = 380.0;
/// Wavelength of the last sample, nm.
pub const LAST: f64 = 780.0;
/// Between samples, nm.
pub const STEP: f64 = 5.0;

/// A quantity by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(Arc<[f32; SAMPLES]>);

/// Wavelength of sample `i`, nm.
pub fn wavelength(i: usize) -> f64 {
    FIRST + STEP * i as f64
}

/// The value of samples at a wavelength in nm; beyond the ends, that at the end.
#[inline]
pub(crate) fn interpolate(samples: &[f32; SAMPLES], nanometres: f32) -> f32 {
    let (i, share) = place(nanometres);
    samples[i] + (samples[i + 1] - samples[i]) * share
}

/// The sample before a wavelength in nm, and how far it lies towards the next, in 0..1.
#[inline]
pub(super) fn place(nanometres: f32) -> (usize, f32) {
    let place = ((nanometres - FIRST as f32) * (1.0 / STEP as f32)).max(0.0);
    let i = (place as usize).min(SAMPLES - 2);
    (i, (place - i as f32).min(1.0))
}

impl Curve {
    /// From its values at [`wavelength`]s.
    pub fn new(samples: [f32; SAMPLES]) -> Self {
        Curve(Arc::new(samples))
    }

    /// From a function of the wavelength in nm.
    pub fn of(value: impl Fn(f64) -> f64) -> Self {
        Curve::new(core::array::from_fn(|i| value(wavelength(i)) as f32))
    }

    /// From measured pairs of wavelength (nm, rising) and value. Each sample is the mean, weighted by a tent 10 nm wide, of
    /// straight lines between the pairs, so narrow lines keep their power; beyond the pairs the first and last go on
    /// (`extends`), or nothing is.
    pub fn of_pairs(pairs: &[(f64, f64)], extends: bool) -> Self {
        const PARTS: i32 = 64;
        let sample = |i: usize| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for k in -PARTS + 1..PARTS {
                let nanometres = wavelength(i) + STEP * f64::from(k) / f64::from(PARTS);
                let weight = f64::from(PARTS - k.abs());
                sum += weight * at_pairs(pairs, nanometres, extends);
                weights += weight;
            }
            (sum / weights) as f32
        };
        Curve::new(core::array::from_fn(sample))
    }

    /// Its samples.
    pub fn samples(&self) -> &[f32; SAMPLES] {
        &self.0
    }

    /// The value at a wavelength in nm.
    #[inline]
    pub fn at_wavelength(&self, nanometres: f32) -> f32 {
        interpolate(&self.0, nanometres)
    }

    /// The value in each lane, by the lane's wavelength.
    #[inline]
    pub fn at(&self, lanes: &Lanes) -> Light {
        Light(lanes.wavelengths().map(|w| self.at_wavelength(w)))
    }
}

/// Straight lines between pairs.
pub fn at_pairs(pairs: &[(f64, f64)], x: f64, extends: bool) -> f64 {
    let next = pairs.partition_point(|p| p.0 <= x);
    match (next.checked_sub(1).map(|i| pairs[i]), pairs.get(next)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * ((x - a.0) / (b.0 - a.0)),
        (Some(only), None) if extends || only.0 == x => only.1,
        (None, Some(only)) if extends => only.1,
        _ => 0.0,
    }
}
