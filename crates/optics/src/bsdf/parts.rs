//! Materials that are made of others: what they ask about their parts.

use super::Bsdf;
use kirkas_scene::{Kind, Node, ParamType, Params, Span};

/// The parts of a composed material at a point, numbered as [`part_names`] has them.
pub trait Parts {
    /// The part's scattering.
    fn part(&self, number: usize) -> Bsdf;

    /// How much of it is there, 0..1.
    fn opacity(&self, _number: usize) -> f32 {
        1.0
    }

    /// How steeply texture row number `slot` rises along the x and the y of the frame, per scene unit.
    fn slopes(&self, _slot: usize) -> (f32, f32) {
        (0.0, 0.0)
    }
}

/// For models that have no parts.
pub struct NoParts;

impl Parts for NoParts {
    fn part(&self, _: usize) -> Bsdf {
        Bsdf::Mixture(super::mixture::Mixture::EMPTY)
    }
}

/// The materials that `params` name, in the order of the table, each with the place where it is named.
pub fn part_names<'a>(params: &Params<'a>) -> Vec<(&'a str, Span)> {
    let written = |name: &str| params.entity.params.get(name);
    let named = |node: &'a Node| node.text().map(|text| (text, node.span));
    let mut all = Vec::new();
    for row in params.spec().params {
        match row.ty {
            ParamType::Reference(Kind::Material) => all.extend(written(row.name).and_then(named)),
            ParamType::References(Kind::Material) => {
                all.extend(written(row.name).and_then(Node::list).into_iter().flatten().filter_map(named));
            }
            _ => {}
        }
    }
    all
}

/// Relative shares of the parts at a point.
pub type Shares = [f32; MOST_PARTS];

/// The most parts that a material names.
pub const MOST_PARTS: usize = 16;

/// The first share is 1.
pub(super) const FIRST: Shares = {
    let mut first = [0.0; MOST_PARTS];
    first[0] = 1.0;
    first
};
