//! What fills a closed surface: refractive index, priority among overlapping fillings, absorption.

use crate::index::Index;
use crate::{Light, Spectrum};
use kirkas_geometry::elementary::exp_f32;

/// A clear, evenly absorbing filling.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Refractive index.
    pub ior: Index,
    /// Where fillings overlap, the highest priority wins (Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray
    /// Traced Images").
    pub priority: i32,
    /// Absorption coefficient per scene unit.
    pub absorption: Spectrum,
}

impl Medium {
    /// Vacuum, and near enough air.
    pub const VACUUM: Self = Medium { ior: Index::Even(1.0), priority: i32::MIN, absorption: Spectrum::BLACK };
}

/// What is left of light after `distance`: `exp(-absorption distance)` (Beer & Lambert).
pub fn transmittance(absorption: Light, distance: f32) -> Light {
    absorption.map(|a| if a > 0.0 { exp_f32(-a * distance) } else { 1.0 })
}
