//! What every builder of boxes makes: a binary tree whose leaves are runs of references. It is traversed as it is by `bvh2`,
//! and collapsed into wider trees by others.

use super::reference::Reference;
use kirkas_geometry::Bounds3;

/// No inner node lies deeper than this many levels. Room for 2^28 primitives by halving, and 36 levels of freedom for the
/// heuristic.
pub(crate) const MAX_DEPTH: usize = 64;

/// A binary tree over references.
pub(crate) struct BinaryTree {
    /// Depth first: a node, all below its first child, all below its second.
    pub nodes: Vec<Node>,
    /// `None` when there are no references.
    pub root: Option<Child>,
    /// In the order of the leaves.
    pub references: Vec<Reference>,
}

/// An inner node.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// `planes[axis][0 = low, 1 = high][child]`.
    pub planes: [[[f32; 2]; 2]; 3],
    pub children: [Child; 2],
}

/// Where a child is: an inner node's index, or a leaf's run of records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(u32);

/// A leaf's run.
pub(crate) const MAX_LEAF: usize = 8;
const LEAF: u32 = 1 << 31;
const FIRST: u32 = (1 << 28) - 1;

impl Child {
    pub fn node(index: usize) -> Self {
        debug_assert!(index < LEAF as usize);
        Child(index as u32)
    }

    pub fn leaf(first: usize, count: usize) -> Self {
        debug_assert!((1..=MAX_LEAF).contains(&count) && first <= FIRST as usize);
        Child(LEAF | ((count - 1) as u32) << 28 | first as u32)
    }

    #[inline]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    /// Index of an inner node.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// First record and number of records of a leaf.
    #[inline]
    pub fn run(self) -> (usize, usize) {
        ((self.0 & FIRST) as usize, (self.0 >> 28 & 7) as usize + 1)
    }

    /// As a number.
    #[inline]
    pub fn bits(self) -> u32 {
        self.0
    }

    /// The child that [`Child::bits`] gave.
    #[inline]
    pub fn from_bits(bits: u32) -> Self {
        Child(bits)
    }

    /// The same child in an array where the nodes start `by` later.
    pub fn moved(self, by: usize) -> Self {
        if self.is_leaf() { self } else { Child::node(self.index() + by) }
    }
}

impl Node {
    pub fn new(boxes: [&Bounds3; 2], children: [Child; 2]) -> Self {
        let plane = |k: usize| [boxes.map(|b| b.min[k]), boxes.map(|b| b.max[k])];
        Node { planes: [plane(0), plane(1), plane(2)], children }
    }

    /// The box of one child.
    pub fn child_bounds(&self, child: usize) -> Bounds3 {
        let corner = |side: usize| [0, 1, 2].map(|k| self.planes[k][side][child]).into();
        Bounds3 { min: corner(0), max: corner(1) }
    }
}
