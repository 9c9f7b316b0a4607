//! # two_sided
//!
//! A sheet that looks one way in front and another way behind, or the same from both sides; nothing goes through. Playing cards, book
//! pages, lined cloth.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `front` | name of a material | | required | on the side that the surface faces |
//! | `back` | name of a material | | as `front` | on the other side |
//!
//! ## Example
//!
//! ```toml
//! [materials.card]
//! type = "two_sided"
//! front = "face"
//! back = "pattern"
//!
//! [materials.face]
//! type = "plastic"
//! reflectance = 0.8
//!
//! [materials.pattern]
//! type = "lambert"
//! reflectance = [0.5, 0.05, 0.05]
//! ```
//!
//! ## Limits
//!
//! Only what its parts reflect is kept: glass becomes a sheet that swallows what it would let through. Each side acts as in vacuum.
//! Where the parts have holes the sheet has as many as both on average.
//!
//! ## References
//!
//! W. Jakob et al., "Mitsuba 3", 2022 (`twosided`).

use super::parts::{MOST_PARTS, Parts, Shares};
use super::sides::Sides;
use super::{Bsdf, Compose};
use crate::{Light, Palette};
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "two_sided",
    doc: "One material in front, another behind, and nothing goes through.",
    params: &[
        ParamSpec::new("front", ParamType::Reference(Kind::Material), Fallback::Required, "material of the front"),
        ParamSpec::new("back", ParamType::Reference(Kind::Material), Fallback::Absent, "of the back; as the front"),
    ],
};

/// Number of the part behind.
#[derive(Clone, Debug)]
pub struct Prepared {
    back: usize,
}

impl Compose for Prepared {
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { back: usize::from(params.has("back")) }
    }

    fn shares(&self, _: &[Light]) -> Shares {
        let mut shares = [0.0; MOST_PARTS];
        shares[0] = 0.5;
        shares[self.back] += 0.5;
        shares
    }

    fn at(&self, _: &[Light], parts: &dyn Parts) -> Bsdf {
        let front = parts.part(0);
        let back = if self.back == 0 { front.clone() } else { parts.part(self.back) };
        Bsdf::Sides(Sides(Box::new([front, back])))
    }

    fn is_opaque(&self) -> bool {
        true
    }
}
