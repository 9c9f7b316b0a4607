//! Builds the tree: at each node the split of least expected cost among the planes between bins, by the surface-area
//! heuristic.
//!
//! One array of boxes is partitioned in place. Subtrees may be built at once, and large nodes be split by many threads:
//! which, and with what outcome, depends on their size only.

use super::binary::{BinaryTree, Child, MAX_DEPTH, Node};
use super::bins::{Binning, Bins, MAX_BINS};
use super::costs::Costs;
use super::partition::{self, cut, partition, partition_in_chunks};
use super::pieces::Piece;
use super::reference::{Box4, Reference};
use crate::Executor;

/// Subtrees larger than this are handed to the executor in two halves.
const FORK_ABOVE: usize = 1 << 12;

/// The tree over `references`. Nodes stand depth first, the left child after its parent.
pub(crate) fn build(mut references: Vec<Reference>, costs: &Costs, executor: &dyn Executor) -> BinaryTree {
    let builder = Builder { costs, executor };
    let (nodes, root) = builder.nodes(&mut references, 0);
    BinaryTree { nodes, root, references }
}

/// The boxes around some references and around their centers.
#[derive(Clone, Copy)]
struct Around {
    whole: Box4,
    centers: Box4,
}

struct Split {
    left_count: usize,
    boxes: [Box4; 2],
}

pub(super) struct Builder<'a> {
    pub costs: &'a Costs,
    pub executor: &'a dyn Executor,
}

impl Builder<'_> {
    /// The nodes over `references`, which are put into the order of the leaves, and the root, which lies at this depth.
    pub fn nodes(&self, references: &mut [Reference], depth: usize) -> (Vec<Node>, Option<Child>) {
        if references.is_empty() {
            return (Vec::new(), None);
        }
        let around = self.around(references);
        let (nodes, root) = self.fork(references, around, depth).into_nodes(self.executor);
        (nodes, Some(root))
    }

    fn around(&self, references: &[Reference]) -> Around {
        let each = |chunk: &[Reference]| {
            let whole = chunk.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
            Around { whole, centers: partition::centers(chunk) }
        };
        self.sum(references, &each, &|a, b| Around {
            whole: a.whole.union(b.whole),
            centers: a.centers.union(b.centers),
        })
    }

    pub fn bins(&self, references: &[Reference], binning: &Binning) -> Bins {
        let each = |chunk: &[Reference]| {
            let mut bins = Bins::EMPTY;
            bins.fill(chunk, binning);
            bins
        };
        self.sum(references, &each, &|mut a, b| {
            a.merge(&b);
            a
        })
    }

    /// What `each` makes of chunks, added up in an order that depends on their number only.
    pub fn sum<T: Send>(
        &self,
        references: &[Reference],
        each: &(impl Fn(&[Reference]) -> T + Sync),
        add: &(impl Fn(T, T) -> T + Sync),
    ) -> T {
        let Some(middle) = cut(references) else { return each(references) };
        let (a, b) = references.split_at(middle);
        let [a, b] = self.both(|| self.sum(a, each, add), || self.sum(b, each, add));
        add(a, b)
    }

    /// Both results, perhaps computed at once.
    pub fn both<T: Send>(&self, mut a: impl FnMut() -> T + Send, mut b: impl FnMut() -> T + Send) -> [T; 2] {
        let (mut of_a, mut of_b) = (None, None);
        self.executor.join(&mut || of_a = Some(a()), &mut || of_b = Some(b()));
        [of_a, of_b].map(|of| of.expect("executors run both jobs"))
    }

    fn fork(&self, references: &mut [Reference], around: Around, depth: usize) -> Piece {
        if references.len() <= FORK_ABOVE {
            let mut nodes = Vec::with_capacity(references.len() / 3);
            let mut bins = Bins::EMPTY;
            let root = self.subtree(references, 0, around.whole, depth, &mut nodes, &mut bins);
            return Piece::in_place(nodes, root, references.len());
        }
        let binning = Binning::new(&around.centers, MAX_BINS);
        let roomy = has_room(references.len(), depth);
        let plane = if roomy { self.bins(references, &binning).best_plane(&binning, self.costs) } else { None };
        let (left_count, arounds) = match plane {
            Some(plane) => {
                let left = |chunk: &mut [Reference]| partition(chunk, |r| binning.is_left(r, &plane));
                let (left_count, centers) = partition_in_chunks(references, &left, self.executor);
                debug_assert_eq!(left_count, plane.left_count);
                (left_count, [0, 1].map(|s| Around { whole: plane.boxes[s], centers: centers[s] }))
            }
            None => {
                let (left, right) = references.split_at(references.len() / 2);
                (left.len(), [self.around(left), self.around(right)])
            }
        };
        let (left, right) = references.split_at_mut(left_count);
        let halves = self.both(|| self.fork(left, arounds[0], depth + 1), || self.fork(right, arounds[1], depth + 1));
        let [a, b] = arounds.map(|a| a.whole.to_bounds());
        Piece::forked(Node::new([&a, &b], [Child::node(0); 2]), halves)
    }

    pub fn subtree(
        &self,
        references: &mut [Reference],
        first: usize,
        whole: Box4,
        depth: usize,
        nodes: &mut Vec<Node>,
        bins: &mut Bins,
    ) -> Child {
        let Some(split) = self.split(references, &whole, depth, bins) else {
            return Child::leaf(first, references.len());
        };
        let index = nodes.len();
        nodes.push(Node::new([&split.boxes[0].to_bounds(), &split.boxes[1].to_bounds()], [Child::node(0); 2]));
        let (left, right) = references.split_at_mut(split.left_count);
        let left = self.subtree(left, first, split.boxes[0], depth + 1, nodes, bins);
        let right = self.subtree(right, first + split.left_count, split.boxes[1], depth + 1, nodes, bins);
        nodes[index].children = [left, right];
        Child::node(index)
    }

    /// Partition the references by the best split; `None` makes a leaf.
    fn split(&self, references: &mut [Reference], whole: &Box4, depth: usize, bins: &mut Bins) -> Option<Split> {
        let n = references.len();
        if n == 1 {
            return None;
        }
        if !has_room(n, depth) {
            return (n > self.costs.max_leaf).then(|| halve(references));
        }
        // Few references need few planes.
        let count = match n {
            0..16 => 8,
            16..256 => 16,
            _ => MAX_BINS,
        };
        let binning = Binning::new(&partition::centers(references), count);
        bins.fill(references, &binning);
        let plane = bins.best_plane(&binning, self.costs);
        let area = whole.half_area();
        let leaf_cost = self.costs.blocks(n as u32) * self.costs.leaf * area;
        match plane {
            Some(plane)
                if n > self.costs.max_leaf || plane.cost * self.costs.leaf + self.costs.node * area < leaf_cost =>
            {
                let left_count = partition(references, |r| binning.is_left(r, &plane));
                debug_assert_eq!(left_count, plane.left_count);
                Some(Split { left_count, boxes: plane.boxes })
            }
            _ => (n > self.costs.max_leaf).then(|| halve(references)),
        }
    }
}

/// Near the depth that traversal has room for, references are halved: each level then takes one from the logarithm.
pub(super) fn has_room(count: usize, depth: usize) -> bool {
    let levels_needed = usize::BITS - (count - 1).leading_zeros();
    depth + (levels_needed as usize) < MAX_DEPTH
}

/// Cut in the middle of the order they are in.
fn halve(references: &mut [Reference]) -> Split {
    let left_count = references.len() / 2;
    let around = |r: &[Reference]| r.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
    Split { left_count, boxes: [around(&references[..left_count]), around(&references[left_count..])] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::partition::CHUNK;
    use crate::build::testing::{Backwards, random_boxes};
    use kirkas_geometry::{Bounds3, Vec3};

    /// Boxes of which every split peels off a few, begun so deep that the room for it runs out.
    #[test]
    fn near_the_limit_subtrees_are_halved_into_the_room_that_is_left() {
        let cube = |i: i32| Bounds3 { min: Vec3::splat(2_f32.powi(i)), max: Vec3::splat(2_f32.powi(i) * 1.1) };
        let peels = |depth: usize| {
            let mut references: Vec<_> = (-50..50).map(|i| Reference::new(&cube(i), 0, (i + 50) as u32)).collect();
            let whole = references.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
            let mut nodes = Vec::new();
            let builder = Builder { costs: &Costs::BVH2, executor: &Serial };
            let root = builder.subtree(&mut references, 0, whole, depth, &mut nodes, &mut { Bins::EMPTY });
            levels(&nodes, root)
        };
        assert!(peels(0) > 10);
        assert!(peels(MAX_DEPTH - 10) <= 10);
        assert!(peels(MAX_DEPTH - 7) <= 7);
    }

    #[test]
    fn the_tree_is_the_same_whatever_the_executor() {
        for costs in [Costs::BVH2, Costs::WIDE, Costs::INSTANCES] {
            let [a, b]: [&dyn Executor; 2] = [&Serial, &Backwards];
            let [a, b] = [a, b].map(|e| build(random_boxes(5 * CHUNK + 77, 1), &costs, e));
            let node = |n: &Node| (n.planes.map(|p| p.map(|s| s.map(f32::to_bits))), n.children);
            assert!(a.nodes.iter().map(node).eq(b.nodes.iter().map(node)) && a.root == b.root);
            assert!(a.references.iter().map(Reference::ids).eq(b.references.iter().map(Reference::ids)));
            let mut ids: Vec<_> = a.references.iter().map(Reference::ids).collect();
            ids.sort_unstable();
            assert!(ids.into_iter().eq((0..a.references.len() as u32).map(|i| (0, i))));
        }
    }

    #[test]
    fn what_coincides_is_halved() {
        let one = random_boxes(1, 1)[0];
        for count in [9, 1000, 3 * CHUNK] {
            let tree = build(vec![one; count], &Costs::WIDE, &Serial);
            let depth = levels(&tree.nodes, tree.root.unwrap());
            assert!(depth <= count.ilog2() as usize, "{count} in {depth} levels");
        }
    }

    #[test]
    fn leaves_are_as_small_as_asked_and_full_blocks_are_liked() {
        let leaves = |costs: &Costs| {
            let tree = build(random_boxes(20_000, 3), costs, &Serial);
            let children = tree.nodes.iter().flat_map(|n| n.children).filter(|c| c.is_leaf());
            children.map(|c| c.run().1).collect::<Vec<_>>()
        };
        assert!(leaves(&Costs::INSTANCES).iter().all(|n| *n == 1));
        let (full, small) = (leaves(&Costs::WIDE).len(), leaves(&Costs::BVH2).len());
        assert!(full * 4 < small * 3, "{full} leaves, {small} without blocks");
    }

    fn levels(nodes: &[Node], child: Child) -> usize {
        let below = |c: &Child| 1 + levels(nodes, *c);
        if child.is_leaf() { 0 } else { nodes[child.index()].children.iter().map(below).max().unwrap_or(0) }
    }
}
