//! Independent random numbers, by hash: the plainest sampler, to compare others against.
//!
//! # Parameters
//! As for `sobol`.
//!
//! # Example
//! ```toml
//! [sampler]
//! type = "independent"
//! samples = 64
//! ```
//!
//! # Limits
//! Error falls as 1/sqrt(n) only.
//!
//! # References
//! Whitted 1980 sampled regularly; Cook 1986, "Stochastic Sampling in Computer Graphics".

use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_scene::{Kind, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Sampler,
    name: "independent",
    doc: "Independent random numbers.",
    params: super::sobol::ROWS,
};

pub(super) fn pair(index: u32, seed: u64) -> (f32, f32) {
    let h = combine(seed, u64::from(index));
    (unit_f32(h as u32), unit_f32((h >> 32) as u32))
}
