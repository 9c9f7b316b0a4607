//! Owen-scrambled Halton pairs, in bases 2 and 3. More samples can be added at any time; the points are spread best at
//! powers of six.
//!
//! # Parameters
//! As for `sobol`.
//!
//! # Example
//! ```toml
//! [sampler]
//! type = "halton"
//! samples = 216
//! ```
//!
//! # Limits
//! Pairs are independent of each other: no dimension above two is stratified jointly. Slower to draw than `sobol`.
//!
//! # References
//! Halton 1960, "On the efficiency of certain quasi-random sequences of points"; Owen 1995, "Randomly Permuted
//! (t,m,s)-Nets and (t,s)-Sequences".

use kirkas_geometry::halton::owen_halton_2d;
use kirkas_scene::{Kind, TypeSpec};

/// The table.
pub const SPEC: TypeSpec =
    TypeSpec { kind: Kind::Sampler, name: "halton", doc: "Owen-scrambled Halton pairs.", params: super::sobol::ROWS };

pub(super) fn pair(index: u32, seed: u64) -> (f32, f32) {
    owen_halton_2d(index, seed)
}
