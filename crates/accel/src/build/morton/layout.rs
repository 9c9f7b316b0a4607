//! Puts nodes and references where a [`BinaryTree`] has them: depth first.

use super::clusters::Grove;
use super::top::{Part, What};
use crate::Executor;
use crate::build::binary::{BinaryTree, Child, Node};
use crate::build::reference::{Box4, Reference};
use std::mem::MaybeUninit;

/// Subtrees of more references than this are handed to the executor in two halves.
const FORK_ABOVE: usize = 1 << 15;

/// The tree that `top` and the groves below describe.
pub(super) fn lay_out(source: &[Reference], groves: &[Grove], top: &Part, executor: &dyn Executor) -> BinaryTree {
    let mut nodes: Vec<Node> = Vec::with_capacity(top.leaves - 1);
    let mut references: Vec<Reference> = Vec::with_capacity(top.references);
    let room = Room {
        nodes: &mut nodes.spare_capacity_mut()[..top.leaves - 1],
        references: &mut references.spare_capacity_mut()[..top.references],
        first_node: 0,
        first_reference: 0,
    };
    let root = Layout { source, groves, executor }.part(top, room);
    // SAFETY: each call of `part` and `cluster` fills the whole room it is given: an inner one its first node and, through
    // the calls for its halves, the rest; a leaf has no node, and as many references as its run is long. `Room::halves` and
    // `leaf` assert that the room is exactly as large as that.
    unsafe {
        nodes.set_len(top.leaves - 1);
        references.set_len(top.references);
    }
    BinaryTree { nodes, root: Some(root), references }
}

/// Where a subtree goes.
struct Room<'a> {
    nodes: &'a mut [MaybeUninit<Node>],
    references: &'a mut [MaybeUninit<Reference>],
    /// Places of the above in the whole tree.
    first_node: usize,
    first_reference: usize,
}

impl<'a> Room<'a> {
    /// A place for a node, and rooms for its two subtrees, the first with so many leaves and references.
    #[inline(always)]
    fn halves(self, leaves: usize, references: usize) -> (&'a mut MaybeUninit<Node>, [Room<'a>; 2]) {
        let (own, below) = self.nodes.split_first_mut().expect("room for a node");
        let nodes = below.split_at_mut(leaves - 1);
        let references_of = self.references.split_at_mut(references);
        let left = Room {
            nodes: nodes.0,
            references: references_of.0,
            first_node: self.first_node + 1,
            first_reference: self.first_reference,
        };
        let right = Room {
            nodes: nodes.1,
            references: references_of.1,
            first_node: self.first_node + leaves,
            first_reference: self.first_reference + references,
        };
        (own, [left, right])
    }
}

struct Layout<'a> {
    source: &'a [Reference],
    groves: &'a [Grove],
    executor: &'a dyn Executor,
}

impl Layout<'_> {
    fn part(&self, part: &Part, room: Room) -> Child {
        let parts = match &part.what {
            What::Root(grove, root) => return self.cluster(&self.groves[*grove], *root, room),
            What::Pair(parts) => parts,
        };
        let index = Child::node(room.first_node);
        let (own, rooms) = room.halves(parts[0].leaves, parts[0].references);
        let [mut left, mut right] = rooms.map(Some);
        let mut children = [index; 2];
        let [first, second] = &mut children;
        let mut a = || left.take().into_iter().for_each(|room| *first = self.part(&parts[0], room));
        let mut b = || right.take().into_iter().for_each(|room| *second = self.part(&parts[1], room));
        if part.references > FORK_ABOVE {
            self.executor.join(&mut a, &mut b);
        } else {
            a();
            b();
        }
        assert!(left.is_none() && right.is_none(), "executors run both jobs");
        own.write(node([&parts[0].around, &parts[1].around], children));
        index
    }

    fn cluster(&self, grove: &Grove, cluster: u32, room: Room) -> Child {
        let c = &grove.clusters[cluster as usize];
        if c.leaves == 1 {
            let run = &grove.order[c.parts[0] as usize..c.parts[1] as usize];
            assert!(run.len() == room.references.len() && room.nodes.is_empty());
            for (to, i) in room.references.iter_mut().zip(run) {
                to.write(self.source[*i as usize]);
            }
            return Child::leaf(room.first_reference, run.len());
        }
        let [a, b] = c.parts.map(|p| &grove.clusters[p as usize]);
        let index = Child::node(room.first_node);
        let (own, [left, right]) = room.halves(a.leaves as usize, a.references as usize);
        let children = [self.cluster(grove, c.parts[0], left), self.cluster(grove, c.parts[1], right)];
        own.write(node([&a.around, &b.around], children));
        index
    }
}

fn node(around: [&Box4; 2], children: [Child; 2]) -> Node {
    let [a, b] = around.map(|b| b.to_bounds());
    Node::new([&a, &b], children)
}
