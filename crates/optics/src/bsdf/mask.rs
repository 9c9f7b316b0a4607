//! # mask
//!
//! A material with holes: leaves, lace, grids, worn cloth. Where it is not, light goes straight on, and so do shadow rays.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `material` | name of a material | | required | what is there |
//! | `opacity` | number or texture, 0..1 | | 1 | 1 there, 0 a hole; an image's alpha channel if it has one |
//!
//! ## Example
//!
//! ```toml
//! [materials.veil]
//! type = "mask"
//! material = "silk"
//! opacity = 0.4
//!
//! [materials.silk]
//! type = "velvet"
//! ```
//!
//! ## Limits
//!
//! Opacity between 0 and 1 is a coin, thrown anew for every ray that meets the surface: right on average, with noise. The same as the
//! `alpha` that any material takes, in a material of its own; where both are given they multiply. Bodies with holes are entered only
//! where they are there.
//!
//! ## References
//!
//! T. Porter & T. Duff, "Compositing Digital Images", 1984.

use super::parts::{FIRST, Parts, Shares};
use super::{Bsdf, Compose};
use crate::{Light, Palette};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "mask",
    doc: "A material with holes, by a number or a texture.",
    params: &[
        ParamSpec::new("material", ParamType::Reference(Kind::Material), Fallback::Required, "what is there"),
        ParamSpec::number_texture("opacity", 1.0, UNIT, "1 there, 0 a hole; an image's alpha channel if it has one"),
    ],
};

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

impl Compose for Prepared {
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }

    fn shares(&self, _: &[Light]) -> Shares {
        FIRST
    }

    fn at(&self, _: &[Light], parts: &dyn Parts) -> Bsdf {
        parts.part(0)
    }
}
