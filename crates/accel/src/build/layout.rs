//! Puts nodes and references where a [`BinaryTree`] has them: depth first.

use super::binary::{BinaryTree, Child, Node};
use super::reference::{Box4, Reference};
use crate::{Executor, memory};
use std::mem::MaybeUninit;

/// Subtrees of more references than this are handed to the executor in two halves.
const FORK_ABOVE: usize = 1 << 12;

/// A leaf, or two clusters made one.
#[derive(Clone, Copy)]
pub(super) struct Cluster {
    pub around: Box4,
    /// The leaf's run in the order of its grove, begin and end; or the two clusters.
    pub parts: [u32; 2],
    /// References below.
    pub references: u32,
    /// Leaves below; one for a leaf.
    pub leaves: u32,
}

/// Clusters, each in one other at most.
pub(super) struct Grove {
    /// Indices of references.
    pub order: Vec<u32>,
    pub clusters: Vec<Cluster>,
}

/// A tree over clusters of several groves.
pub(super) struct Part {
    pub what: What,
    pub around: Box4,
    /// References below.
    pub references: usize,
    /// Leaves below.
    pub leaves: usize,
    /// Levels above the clusters.
    pub levels: usize,
}

pub(super) enum What {
    /// Grove and cluster.
    Cluster(usize, u32),
    Pair(Box<[Part; 2]>),
}

impl Part {
    pub fn cluster(groves: &[Grove], grove: usize, cluster: u32) -> Self {
        let c = &groves[grove].clusters[cluster as usize];
        let (references, leaves) = (c.references as usize, c.leaves as usize);
        Part { what: What::Cluster(grove, cluster), around: c.around, references, leaves, levels: 0 }
    }

    pub fn pair(a: Part, b: Part) -> Self {
        let around = a.around.union(b.around);
        let (references, leaves) = (a.references + b.references, a.leaves + b.leaves);
        let levels = 1 + a.levels.max(b.levels);
        Part { what: What::Pair(Box::new([a, b])), around, references, leaves, levels }
    }
}

/// The tree that `top` and the groves below describe.
pub(super) fn lay_out(source: &[Reference], groves: &[Grove], top: &Part, executor: &dyn Executor) -> BinaryTree {
    let mut nodes: Vec<Node> = memory::with_capacity(top.leaves - 1);
    let mut references: Vec<Reference> = memory::with_capacity(top.references);
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
        let [a, b] = match &part.what {
            What::Cluster(grove, cluster) => return self.cluster(&self.groves[*grove], *cluster, room),
            What::Pair(parts) => &**parts,
        };
        let boxes = [&a.around, &b.around];
        self.inner(boxes, a.leaves, a.references, room, &|room| self.part(a, room), &|room| self.part(b, room))
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
        let boxes = [&a.around, &b.around];
        let [on_left, on_right] = c.parts.map(|part| move |room: Room| self.cluster(grove, part, room));
        self.inner(boxes, a.leaves as usize, a.references as usize, room, &on_left, &on_right)
    }

    /// A node; the first of its subtrees has so many leaves and references.
    #[inline(always)]
    fn inner(
        &self,
        boxes: [&Box4; 2],
        leaves: usize,
        references: usize,
        room: Room,
        on_left: &(impl Fn(Room) -> Child + Sync),
        on_right: &(impl Fn(Room) -> Child + Sync),
    ) -> Child {
        let index = Child::node(room.first_node);
        let is_large = room.references.len() > FORK_ABOVE;
        let (own, [left, right]) = room.halves(leaves, references);
        let children =
            if is_large { self.fork(left, right, on_left, on_right) } else { [on_left(left), on_right(right)] };
        let [a, b] = boxes.map(|b| b.to_bounds());
        own.write(Node::new([&a, &b], children));
        index
    }

    fn fork(
        &self,
        left: Room,
        right: Room,
        on_left: &(dyn Fn(Room) -> Child + Sync),
        on_right: &(dyn Fn(Room) -> Child + Sync),
    ) -> [Child; 2] {
        let (mut left, mut right) = (Some(left), Some(right));
        let (mut a, mut b) = (None, None);
        self.executor.join(&mut || a = left.take().map(on_left), &mut || b = right.take().map(on_right));
        [a, b].map(|child| child.expect("executors run both jobs"))
    }
}
