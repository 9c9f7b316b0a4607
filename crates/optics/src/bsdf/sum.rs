//! # sum
//!
//! Several materials at once: their lobes, each times its weight, added up.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `materials` | names of materials | | required | up to 16 of them |
//! | `weights` | numbers, at least 0 | | 1 each | how much of each |
//! | `form` | `bounded`, `classic` | | `bounded` | weights that add up to more than 1 are divided by their sum, or taken as written |
//!
//! ## Example
//!
//! ```toml
//! [materials.lacquer]
//! type = "sum"
//! materials = ["wood", "gloss"]
//! weights = [0.9, 0.1]
//!
//! [materials.wood]
//! type = "lambert"
//! reflectance = [0.4, 0.2, 0.1]
//!
//! [materials.gloss]
//! type = "rough_mirror"
//! ```
//!
//! ## Limits
//!
//! With `form = "bounded"` the sum gives back no more light than the best of its parts. With `classic` it gives back up to the sum of the
//! weights times as much, as classics' k_d + k_s do: keep the parts' albedos, each times its weight, at 1 together. One part does not
//! shade another; layers do: `plastic`, `principled`.
//!
//! Parts that bound bodies must agree on what fills them. Lamps and hulls cannot be parts.
//!
//! ## References
//!
//! R. L. Cook & K. E. Torrance, "A Reflectance Model for Computer Graphics", 1982, equation 1 (a sum of weighted lobes).

use super::mixture::Mixture;
use super::parts::{MOST_PARTS, Parts, Shares};
use super::{Bsdf, Compose};
use crate::{Light, Palette};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Fallback, Kind, Node, ParamSpec, ParamType, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "sum",
    doc: "Several materials added up, each with a weight.",
    params: &[
        ParamSpec::new("materials", ParamType::References(Kind::Material), Fallback::Required, "what is added up"),
        ParamSpec::new("weights", ParamType::Numbers, Fallback::Absent, "how much of each; absent: 1 of each")
            .range(NOT_NEGATIVE),
        ParamSpec::choice("form", &["bounded", "classic"], "weights add up to 1 at most, or are taken as written"),
    ],
};

/// The weights.
#[derive(Clone, Debug)]
pub struct Prepared {
    shares: Shares,
}

impl Compose for Prepared {
    fn prepare(params: &Params, _: &Palette) -> Self {
        let list = |name: &str| params.entity.params.get(name).and_then(Node::list).unwrap_or_default();
        let weights = list("weights");
        let weight = |i: usize| weights.get(i).and_then(Node::number).unwrap_or(1.0) as f32;
        let count = list("materials").len().min(MOST_PARTS);
        let sum: f32 = (0..count).map(weight).sum();
        let over = if params.text("form") == Some("classic") { 1.0 } else { sum.max(1.0) };
        Prepared { shares: core::array::from_fn(|i| if i < count { weight(i) / over } else { 0.0 }) }
    }

    fn shares(&self, _: &[Light]) -> Shares {
        self.shares
    }

    fn at(&self, _: &[Light], parts: &dyn Parts) -> Bsdf {
        Bsdf::Mixture(Mixture::of(&self.shares, parts))
    }
}
