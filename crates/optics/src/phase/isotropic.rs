//! # isotropic
//!
//! Scatters evenly into all directions, `p = 1 / (4 pi)`: the default, and the case with closed forms.
//!
//! ## Parameters
//!
//! None.
//!
//! ## Example
//!
//! ```toml
//! [phases.even]
//! type = "isotropic"
//! ```
//!
//! ## Limits
//!
//! Nothing real does this; milk comes near after many bounces.
//!
//! ## References
//!
//! S. Chandrasekhar, "Radiative Transfer", 1950, section 3.

use super::{Scatter, Turn};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec =
    TypeSpec { kind: Kind::Phase, name: "isotropic", doc: "Scatters evenly into all directions.", params: &[] };

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Isotropic;

impl Scatter for Isotropic {
    fn prepare(_: &Params, _: &Palette) -> Self {
        Isotropic
    }

    fn value(&self, lanes: &Lanes, _: Vec3, _: Vec3) -> Light {
        lanes.one() * (0.25 / PI)
    }

    fn turn(&self, _: &Lanes, _: usize, u: f32) -> Turn {
        Turn::from_cos(1.0 - 2.0 * u)
    }
}
