//! What builders weigh splits by.

use super::binary::MAX_LEAF;

/// The prices of the surface-area heuristic, and the largest leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Costs {
    /// References tested at once, a power of two: `n` of them cost `ceil(n / block)` blocks.
    pub block: u32,
    /// Testing a block.
    pub leaf: f32,
    /// Visiting a binary node.
    pub node: f32,
    /// References in a leaf, at most: from 1 to [`MAX_LEAF`].
    pub max_leaf: usize,
}

impl Costs {
    /// For a tree that tests one primitive after the other.
    pub const BVH2: Costs = Costs { block: 1, leaf: 1.0, node: 2.0, max_leaf: MAX_LEAF };
    /// For a tree of wide nodes, each of which takes the place of several binary ones, with leaves of one block.
    pub const WIDE: Costs = Costs { block: 8, leaf: 1.0, node: 0.3, max_leaf: MAX_LEAF };
    /// For a level made of instances, each of which is a tree to be entered.
    pub const INSTANCES: Costs = Costs { block: 1, leaf: 4.0, node: 1.0, max_leaf: 1 };

    /// Blocks that hold `count` references.
    #[inline(always)]
    pub fn blocks(&self, count: u32) -> f32 {
        debug_assert!(self.block.is_power_of_two());
        ((count + (self.block - 1)) >> self.block.trailing_zeros()) as f32
    }
}
