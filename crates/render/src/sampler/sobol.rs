//! Owen-scrambled Sobol' pairs: each use gets its own scramble of the first two Sobol' dimensions. Any power of two of samples
//! is a (0, m, 2)-net, so images converge faster than with random numbers, and more samples can be added at any time.
//!
//! # Parameters
//! `samples` per pixel; `seed`; for adaptive sampling `error`, `min_samples` and `max_samples`.
//!
//! # Example
//! ```toml
//! [sampler]
//! type = "sobol"
//! samples = 64
//! ```
//!
//! # Limits
//! Pairs are independent of each other: no dimension above two is stratified jointly.
//!
//! # References
//! Owen 1995; Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4).

use kirkas_geometry::low_discrepancy::{owen_sobol_1d, owen_sobol_2d};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// The rows of samplers to whose samples more can be added.
pub const ROWS: &[ParamSpec] = &[
    ParamSpec::integer("samples", 16, (1.0, 1_073_741_824.0), "Samples per pixel."),
    SEED,
    ParamSpec::number(
        "error",
        0.0,
        "Adaptive sampling: blocks of 8x8 pixels are sampled until their error is below this; 0 = off.",
    )
    .range(NOT_NEGATIVE),
    ParamSpec::integer(
        "min_samples",
        64,
        (2.0, 1_073_741_824.0),
        "With `error`: no block stops before so many samples per pixel.",
    ),
    ParamSpec::integer(
        "max_samples",
        65_536,
        (1.0, 1_073_741_824.0),
        "With `error`: samples per pixel at most; `samples` does not count.",
    ),
];

/// The row that every sampler takes.
pub const SEED: ParamSpec =
    ParamSpec::integer("seed", 0, (0.0, 9.0e15), "Another seed gives another, equally good picture.");

/// The table.
pub const SPEC: TypeSpec =
    TypeSpec { kind: Kind::Sampler, name: "sobol", doc: "Owen-scrambled Sobol' pairs.", params: ROWS };

pub(super) fn pair(index: u32, seed: u64) -> (f32, f32) {
    owen_sobol_2d(index, seed)
}

/// The first of the pair, sooner.
pub(super) fn one(index: u32, seed: u64) -> f32 {
    owen_sobol_1d(index, seed)
}
