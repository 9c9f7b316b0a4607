//! Refractive indices by wavelength: by name, from refractiveindex.info files, by Cauchy's and Sellmeier's formulas, or plain.

pub mod file;
pub mod formula;
pub mod known;

use crate::lanes::{ColorMode, PRIMARIES};
use crate::spectrum::curve::{Curve, SAMPLES};
use crate::spectrum::observer::observer;
use crate::{Lanes, Light};
use formula::Formula;

/// The real part of a refractive index.
#[derive(Clone, Debug, PartialEq)]
pub enum Index {
    /// The same at all wavelengths.
    Even(f32),
    /// By wavelength.
    Curve(Curve),
}

/// A refractive index as measured: `n + i k`.
#[derive(Clone, Debug, PartialEq)]
pub struct OpticalConstants {
    /// The real part.
    pub n: Source,
    /// The imaginary part (extinction coefficient), if known.
    pub k: Option<Source>,
}

/// A quantity over wavelength as published.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Pairs of wavelength (nm, rising) and value.
    Pairs(Vec<(f64, f64)>),
    /// One of the published formulas, valid within this range of wavelengths, nm.
    Formula(Formula, (f64, f64)),
}

/// The constants of a metal as lanes take them.
#[derive(Clone, Debug, PartialEq)]
pub struct MetalCurves {
    n: Curve,
    k: Curve,
    /// Stand-ins for red, green and blue: the reflectance at normal incidence has the colour of the metal under D65.
    rgb: [(f32, f32); 3],
}

impl Source {
    /// The value at a wavelength in nm; beyond where it is known, that at the end.
    pub fn at(&self, nanometres: f64) -> f64 {
        match self {
            Source::Pairs(pairs) => crate::spectrum::curve::at_pairs(pairs, nanometres, true),
            Source::Formula(formula, (low, high)) => formula.at(nanometres.clamp(*low, *high) / 1000.0),
        }
    }

    /// As a curve.
    pub fn curve(&self) -> Curve {
        Curve::of(|w| self.at(w))
    }
}

impl Index {
    /// In each lane.
    #[inline]
    pub fn at(&self, lanes: &Lanes) -> Light {
        match self {
            Index::Even(n) => Light::splat(*n),
            Index::Curve(curve) => curve.at(lanes),
        }
    }

    /// In the hero's lane.
    #[inline]
    pub fn of_hero(&self, lanes: &Lanes) -> f32 {
        match self {
            Index::Even(n) => *n,
            Index::Curve(curve) => curve.at_wavelength(lanes.wavelengths()[lanes.hero()]),
        }
    }

    /// At Fraunhofer's d line, 587.6 nm: the one that stands for all where one must.
    pub fn at_d_line(&self) -> f32 {
        match self {
            Index::Even(n) => *n,
            Index::Curve(curve) => curve.at_wavelength(587.6),
        }
    }

    /// True when wavelengths part at its boundary.
    #[inline]
    pub fn is_dispersive(&self) -> bool {
        matches!(self, Index::Curve(_))
    }
}

impl MetalCurves {
    /// From measured constants, `None` without an imaginary part.
    pub fn new(constants: &OpticalConstants) -> Option<Self> {
        let (n, k) = (constants.n.curve(), constants.k.as_ref()?.curve());
        let reflectance: [f32; SAMPLES] =
            core::array::from_fn(|i| normal_reflectance(n.samples()[i].into(), k.samples()[i].into()) as f32);
        let color = observer().color_of_reflectance(&reflectance);
        // Keep n at the primary's wavelength and take the k that gives the colour's reflectance
        // (r = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), solved for k); n gives way where no k does.
        let rgb = core::array::from_fn(|c| {
            let r = color[c].clamp(0.0, 0.999);
            let least_n = (1.0 - r.sqrt()) / (1.0 + r.sqrt());
            let most_n = (1.0 + r.sqrt()) / (1.0 - r.sqrt());
            let n = f64::from(n.at_wavelength(PRIMARIES[c])).clamp(least_n, most_n);
            let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
            (n as f32, k2.max(0.0).sqrt() as f32)
        });
        Some(MetalCurves { n, k, rgb })
    }

    /// `(n, k)` in each lane.
    pub fn at(&self, lanes: &Lanes) -> (Light, Light) {
        match lanes.mode() {
            ColorMode::Spectral => (self.n.at(lanes), self.k.at(lanes)),
            ColorMode::Rgb => {
                let [r, g, b] = self.rgb;
                (Light([r.0, g.0, b.0, 1.0]), Light([r.1, g.1, b.1, 0.0]))
            }
        }
    }
}

/// Reflectance of a metal at normal incidence, from vacuum.
fn normal_reflectance(n: f64, k: f64) -> f64 {
    ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
}
