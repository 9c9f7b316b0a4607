//! A tree in pieces, each built on its own, to be put together: depth first, wherever the pieces come from.

use super::binary::{BinaryTree, Child, Node};
use super::reference::Reference;
use crate::{Executor, memory};
use std::mem::MaybeUninit;

/// A subtree. Places in a piece are counted from its own beginning.
pub(super) enum Piece {
    /// Nodes and root over so many references.
    Whole { nodes: Vec<Node>, root: Child, count: usize, references: Vec<Reference> },
    /// A node, of which the children are still to be put in, and its subtrees.
    Forked { node: Node, halves: Box<[Piece; 2]>, sizes: Sizes },
}

/// Nodes and references of a subtree.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    nodes: usize,
    references: usize,
    /// Of these, such as it brings along.
    own: usize,
}

impl Piece {
    /// A piece over references that are in place already.
    pub fn in_place(nodes: Vec<Node>, root: Child, count: usize) -> Self {
        Piece::Whole { nodes, root, count, references: Vec::new() }
    }

    /// A piece that brings its references along.
    pub fn with_references(nodes: Vec<Node>, root: Child, references: Vec<Reference>) -> Self {
        Piece::Whole { nodes, root, count: references.len(), references }
    }

    pub fn forked(node: Node, halves: [Piece; 2]) -> Self {
        let [a, b] = [halves[0].sizes(), halves[1].sizes()];
        let sizes = Sizes { nodes: 1 + a.nodes + b.nodes, references: a.references + b.references, own: a.own + b.own };
        Piece::Forked { node, halves: Box::new(halves), sizes }
    }

    fn sizes(&self) -> Sizes {
        match self {
            Piece::Whole { nodes, count, references, .. } => {
                Sizes { nodes: nodes.len(), references: *count, own: references.len() }
            }
            Piece::Forked { sizes, .. } => *sizes,
        }
    }

    /// Put the pieces together over references that are in place.
    pub fn into_nodes(self, executor: &dyn Executor) -> (Vec<Node>, Child) {
        match self {
            Piece::Whole { nodes, root, .. } => (nodes, root),
            forked => {
                let tree = forked.copied(executor);
                (tree.nodes, tree.root.expect("a piece has a root"))
            }
        }
    }

    /// Put the pieces and the references that they bring along together.
    pub fn into_tree(self, executor: &dyn Executor) -> BinaryTree {
        match self {
            Piece::Whole { nodes, root, references, .. } => BinaryTree { nodes, root: Some(root), references },
            forked => forked.copied(executor),
        }
    }

    fn copied(self, executor: &dyn Executor) -> BinaryTree {
        let sizes = self.sizes();
        let mut nodes = memory::with_capacity(sizes.nodes);
        let mut references = memory::with_capacity(sizes.own);
        let room = Room {
            nodes: &mut nodes.spare_capacity_mut()[..sizes.nodes],
            references: &mut references.spare_capacity_mut()[..sizes.own],
            first_node: 0,
            first_reference: 0,
        };
        let root = self.copy(room, executor);
        // SAFETY: `copy` fills the whole room: a whole piece from slices of its length (asserted), a forked one its first node and, through its halves, which share the rest, all other.
        unsafe {
            nodes.set_len(sizes.nodes);
            references.set_len(sizes.own);
        }
        BinaryTree { nodes, root: Some(root), references }
    }

    fn copy(self, room: Room, executor: &dyn Executor) -> Child {
        match self {
            Piece::Whole { nodes, root, references, .. } => {
                let moved = |c: Child| match c.is_leaf() {
                    true => Child::leaf(c.run().0 + room.first_reference, c.run().1),
                    false => c.moved(room.first_node),
                };
                assert!(nodes.len() == room.nodes.len() && references.len() == room.references.len());
                for (to, n) in room.nodes.iter_mut().zip(&nodes) {
                    to.write(Node { children: n.children.map(moved), ..*n });
                }
                for (to, r) in room.references.iter_mut().zip(&references) {
                    to.write(*r);
                }
                moved(root)
            }
            Piece::Forked { node, halves, .. } => {
                let index = Child::node(room.first_node);
                let (own, [left, right]) = room.halves(&halves[0].sizes());
                let [a, b] = *halves;
                let (mut a, mut b) = (Some((a, left)), Some((b, right)));
                let (mut of_a, mut of_b) = (None, None);
                let copy = |piece: Option<(Piece, Room)>| piece.map(|(piece, room)| piece.copy(room, executor));
                executor.join(&mut || of_a = copy(a.take()), &mut || of_b = copy(b.take()));
                let children = [of_a, of_b].map(|of| of.expect("executors run both jobs"));
                own.write(Node { children, ..node });
                index
            }
        }
    }
}

/// Where a piece goes.
struct Room<'a> {
    nodes: &'a mut [MaybeUninit<Node>],
    references: &'a mut [MaybeUninit<Reference>],
    /// Places of the above in the whole tree.
    first_node: usize,
    first_reference: usize,
}

impl<'a> Room<'a> {
    /// A place for a node, and rooms for its two subtrees, the first of these sizes.
    fn halves(self, of_left: &Sizes) -> (&'a mut MaybeUninit<Node>, [Room<'a>; 2]) {
        let (own, below) = self.nodes.split_first_mut().expect("room for a node");
        let nodes = below.split_at_mut(of_left.nodes);
        let references = self.references.split_at_mut(of_left.own);
        let (first_node, first_reference) = (self.first_node + 1, self.first_reference);
        let left = Room { nodes: nodes.0, references: references.0, first_node, first_reference };
        let right = Room {
            nodes: nodes.1,
            references: references.1,
            first_node: first_node + of_left.nodes,
            first_reference: first_reference + of_left.references,
        };
        (own, [left, right])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::binned_sah;
    use crate::build::costs::Costs;
    use crate::build::testing::{Backwards, assert_sound, random_boxes};
    use kirkas_geometry::Bounds3;

    /// A tree over each part, and nodes above: `((0 1) 2)`.
    fn forked(parts: [&[Reference]; 3]) -> Piece {
        let around = |r: &[Reference]| r.iter().fold(Bounds3::EMPTY, |b, r| b.union(r.bounds()));
        let [a, b, c] = parts.map(|part| {
            let tree = binned_sah::build(part.to_vec(), &Costs::WIDE, &Serial);
            Piece::with_references(tree.nodes, tree.root.expect("a root"), tree.references)
        });
        let boxes = parts.map(around);
        let node = |a: Bounds3, b: Bounds3| Node::new([&a, &b], [Child::node(0); 2]);
        let low = Piece::forked(node(boxes[0], boxes[1]), [a, b]);
        Piece::forked(node(boxes[0].union(boxes[1]), boxes[2]), [low, c])
    }

    #[test]
    fn pieces_make_one_sound_tree() {
        let references = random_boxes(500, 4);
        for (first, second) in [(100, 300), (1, 2), (7, 499)] {
            let parts = || [&references[..first], &references[first..second], &references[second..]];
            assert_sound(&forked(parts()).into_tree(&Serial), &references);
            assert_sound(&forked(parts()).into_tree(&Backwards), &references);
        }
    }
}
