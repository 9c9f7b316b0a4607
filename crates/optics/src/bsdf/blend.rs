//! # blend
//!
//! One material where a texture is black, another where it is white, and both in parts between: rust on steel, paint that is worn off.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `first` | name of a material | | required | seen where `amount` is 0 |
//! | `second` | name of a material | | required | seen where `amount` is 1 |
//! | `amount` | number or texture, 0..1 | | 0.5 | how much of the second |
//!
//! ## Example
//!
//! ```toml
//! [materials.rusty]
//! type = "blend"
//! first = "steel"
//! second = "rust"
//! amount = 0.3
//!
//! [materials.steel]
//! type = "rough_conductor"
//! ior = { material = "iron" }
//!
//! [materials.rust]
//! type = "oren_nayar"
//! reflectance = [0.3, 0.1, 0.04]
//! ```
//!
//! ## Limits
//!
//! Both lie side by side, finer than can be seen, and do not shade each other. Parts that bound bodies must agree on what fills them.
//! Lamps and hulls cannot be parts.
//!
//! ## References
//!
//! T. Porter & T. Duff, "Compositing Digital Images", 1984 (the weighted mean of what covers a pixel in parts).

use super::mixture::Mixture;
use super::parts::{MOST_PARTS, Parts, Shares};
use super::{Bsdf, Compose, slot};
use crate::{Light, Palette};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

const fn part(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Reference(Kind::Material), Fallback::Required, doc)
}

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "blend",
    doc: "Two materials, mixed by a number or a texture.",
    params: &[
        part("first", "material where `amount` is 0"),
        part("second", "material where `amount` is 1"),
        ParamSpec::number_texture("amount", 0.5, UNIT, "how much of the second"),
    ],
};
const AMOUNT: usize = slot(SPEC.params, "amount");

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

impl Compose for Prepared {
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }

    fn shares(&self, slots: &[Light]) -> Shares {
        let mut shares = [0.0; MOST_PARTS];
        shares[0] = 1.0 - slots[AMOUNT][0];
        shares[1] = slots[AMOUNT][0];
        shares
    }

    fn at(&self, slots: &[Light], parts: &dyn Parts) -> Bsdf {
        let shares = self.shares(slots);
        // One alone needs no company.
        match (shares[0], shares[1]) {
            (_, 0.0) => parts.part(0),
            (0.0, _) => parts.part(1),
            _ => Bsdf::Mixture(Mixture::of(&shares, parts)),
        }
    }
}
