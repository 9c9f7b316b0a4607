//! Builds the tree: at each node the split of least expected cost among 15 planes per axis, by the surface-area heuristic
//! (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
//!
//! One array of boxes is partitioned in place. Subtrees may be built at once: which, and with what outcome, depends on
//! their size only.

use super::binary::{BinaryTree, Child, MAX_DEPTH, MAX_LEAF, Node};
use super::reference::{Box4, Lanes, Reference};
use crate::Executor;

/// Cost of visiting a node; testing a primitive costs 1.
pub(crate) const NODE_COST: f32 = 2.0;
const BINS: usize = 16;
/// Subtrees larger than this are handed to the executor in two halves.
const FORK_ABOVE: usize = 1 << 15;

/// The tree over `references`.
pub(crate) fn build(mut references: Vec<Reference>, executor: &dyn Executor) -> BinaryTree {
    let (nodes, root) = nodes(&mut references, executor);
    BinaryTree { nodes, root, references }
}

/// The nodes over `references`, which are put into the order of the leaves, and the root.
fn nodes(references: &mut [Reference], executor: &dyn Executor) -> (Vec<Node>, Option<Child>) {
    if references.is_empty() {
        return (Vec::new(), None);
    }
    let whole = references.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
    let mut nodes = Vec::new();
    let root = if references.len() > FORK_ABOVE {
        let piece = fork(references, 0, whole, 0, executor);
        nodes.reserve_exact(piece.len());
        piece.append_to(&mut nodes)
    } else {
        subtree(references, 0, whole, 0, &mut nodes)
    };
    (nodes, Some(root))
}

/// A tree in pieces, each built on its own.
enum Piece {
    Whole(Vec<Node>, Child),
    Forked { boxes: [Box4; 2], halves: Box<[Piece; 2]> },
}

impl Piece {
    fn len(&self) -> usize {
        match self {
            Piece::Whole(nodes, _) => nodes.len(),
            Piece::Forked { halves, .. } => 1 + halves[0].len() + halves[1].len(),
        }
    }

    fn append_to(self, nodes: &mut Vec<Node>) -> Child {
        let base = nodes.len();
        match self {
            Piece::Whole(own, root) => {
                nodes.extend(own.iter().map(|n| Node { children: n.children.map(|c| c.moved(base)), ..*n }));
                root.moved(base)
            }
            Piece::Forked { boxes, halves } => {
                nodes.push(Node::new([&boxes[0].to_bounds(), &boxes[1].to_bounds()], [Child::node(0); 2]));
                let children = halves.map(|half| half.append_to(nodes));
                nodes[base].children = children;
                Child::node(base)
            }
        }
    }
}

fn fork(references: &mut [Reference], first: usize, whole: Box4, depth: usize, executor: &dyn Executor) -> Piece {
    if references.len() <= FORK_ABOVE {
        let mut nodes = Vec::with_capacity(references.len() / 2);
        let root = subtree(references, first, whole, depth, &mut nodes);
        return Piece::Whole(nodes, root);
    }
    let split = split(references, &whole, depth).expect("more references than a leaf holds");
    let (left, right) = references.split_at_mut(split.left_count);
    let (mut a, mut b) = (None, None);
    executor.join(&mut || a = Some(fork(left, first, split.boxes[0], depth + 1, executor)), &mut || {
        b = Some(fork(right, first + split.left_count, split.boxes[1], depth + 1, executor))
    });
    let halves = Box::new([a.expect("executors run both jobs"), b.expect("executors run both jobs")]);
    Piece::Forked { boxes: split.boxes, halves }
}

fn subtree(references: &mut [Reference], first: usize, whole: Box4, depth: usize, nodes: &mut Vec<Node>) -> Child {
    let Some(split) = split(references, &whole, depth) else {
        return Child::leaf(first, references.len());
    };
    let index = nodes.len();
    nodes.push(Node::new([&split.boxes[0].to_bounds(), &split.boxes[1].to_bounds()], [Child::node(0); 2]));
    let (left, right) = references.split_at_mut(split.left_count);
    let left = subtree(left, first, split.boxes[0], depth + 1, nodes);
    let right = subtree(right, first + split.left_count, split.boxes[1], depth + 1, nodes);
    nodes[index].children = [left, right];
    Child::node(index)
}

struct Split {
    left_count: usize,
    boxes: [Box4; 2],
}

/// Partition the references by the best split; `None` makes a leaf.
fn split(references: &mut [Reference], whole: &Box4, depth: usize) -> Option<Split> {
    let n = references.len();
    if n == 1 {
        return None;
    }
    // Near the depth that traversal has room for, halve: each level then takes one from the logarithm.
    let levels_needed = usize::BITS - (n - 1).leading_zeros();
    if depth + levels_needed as usize >= MAX_DEPTH {
        return (n > MAX_LEAF).then(|| halve(references));
    }
    let centers = references.iter().fold(Box4::EMPTY, |b, r| {
        let c = r.center();
        Box4 { lo: b.lo.min(c), hi: b.hi.max(c) }
    });
    let binning = Binning::new(&centers);
    // Few references need few planes.
    let best = if n <= MAX_LEAF { binning.best_plane::<8>(references) } else { binning.best_plane::<BINS>(references) };
    let leaf_cost = n as f32 * whole.half_area();
    match best {
        Some(plane) if n > MAX_LEAF || plane.cost + NODE_COST * whole.half_area() < leaf_cost => {
            let left_count = partition(references, |r| binning.bin(r, plane.axis, plane.bins) <= plane.last_left);
            debug_assert_eq!(left_count, plane.left_count);
            Some(Split { left_count, boxes: plane.boxes })
        }
        _ => (n > MAX_LEAF).then(|| halve(references)),
    }
}

/// Cut in the middle of the order they are in.
fn halve(references: &mut [Reference]) -> Split {
    let left_count = references.len() / 2;
    let around = |r: &[Reference]| r.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
    Split { left_count, boxes: [around(&references[..left_count]), around(&references[left_count..])] }
}

/// Put those for which `left` holds first; returns how many they are. Without a branch on the data.
fn partition(references: &mut [Reference], left: impl Fn(&Reference) -> bool) -> usize {
    let mut count = 0;
    for i in 0..references.len() {
        let goes_left = left(&references[i]);
        references.swap(i, count);
        count += usize::from(goes_left);
    }
    count
}

/// The map from centers to bins.
struct Binning {
    low: Lanes,
    /// One over the size; 0 where the centers do not differ.
    scale: Lanes,
}

/// A plane between bins.
struct Plane {
    axis: usize,
    bins: u32,
    last_left: u32,
    cost: f32,
    left_count: usize,
    boxes: [Box4; 2],
}

/// Adding it to a small positive f32 leaves the nearest integer in the low bits.
const INTEGER_IN_LOW_BITS: f32 = 8_388_608.0;

impl Binning {
    fn new(centers: &Box4) -> Self {
        let scale = core::array::from_fn(|k| {
            let scale = 1.0 / (centers.hi.0[k] - centers.lo.0[k]);
            if scale > 0.0 && scale.is_finite() { scale } else { 0.0 }
        });
        Binning { low: centers.lo, scale: Lanes(scale) }
    }

    /// Monotone in the center: `(0, bins)` to `0..bins`.
    #[inline(always)]
    fn bin(&self, r: &Reference, axis: usize, bins: u32) -> u32 {
        let k = axis & 3;
        let c = r.0.lo.0[k] * 0.5 + r.0.hi.0[k] * 0.5;
        let x = (c - self.low.0[k]) * self.scale.0[k] * (bins as f32 - 0.02);
        // Half a bin is added, lest 0 be rounded to a bin of its own, and one bin taken off again.
        ((x + 0.51) + INTEGER_IN_LOW_BITS).to_bits().wrapping_sub(1) & (bins - 1)
    }

    fn best_plane<const N: usize>(&self, references: &[Reference]) -> Option<Plane> {
        let mut boxes = [[Box4::EMPTY; N]; 3];
        let mut counts = [[0_u32; N]; 3];
        for r in references {
            let at: [u32; 4] = core::array::from_fn(|axis| self.bin(r, axis, N as u32));
            for axis in 0..3 {
                let i = at[axis] as usize & (N - 1);
                boxes[axis][i] = boxes[axis][i].union(r.0);
                counts[axis][i] += 1;
            }
        }
        let mut best = (f32::INFINITY, 0, 0);
        for axis in 0..3 {
            if self.scale.0[axis] > 0.0 {
                let (cost, last_left) = sweep(&boxes[axis], &counts[axis]);
                if cost < best.0 {
                    best = (cost, axis, last_left);
                }
            }
        }
        let (cost, axis, last_left) = best;
        let around = |b: &[Box4]| b.iter().fold(Box4::EMPTY, |all, b| all.union(*b));
        let (left, right) = boxes[axis].split_at(last_left + 1);
        let left_count = counts[axis][..=last_left].iter().sum::<u32>() as usize;
        let boxes = [around(left), around(right)];
        let plane = Plane { axis, bins: N as u32, last_left: last_left as u32, cost, left_count, boxes };
        (cost < f32::INFINITY).then_some(plane)
    }
}

/// The least cost among one axis' planes, and the last bin to the left of that plane.
#[inline(always)]
fn sweep<const N: usize>(boxes: &[Box4; N], counts: &[u32; N]) -> (f32, usize) {
    let mut right_cost = [0.0_f32; N];
    let (mut right, mut right_count) = (Box4::EMPTY, 0);
    for i in (1..N).rev() {
        right = right.union(boxes[i]);
        right_count += counts[i];
        right_cost[i - 1] = cost(right_count, &right);
    }
    let (mut left, mut left_count) = (Box4::EMPTY, 0);
    let mut best = (f32::INFINITY, 0);
    for i in 0..N - 1 {
        left = left.union(boxes[i]);
        left_count += counts[i];
        let sum = cost(left_count, &left) + right_cost[i];
        if sum < best.0 {
            best = (sum, i);
        }
    }
    best
}

/// Tests expected in a side of a split; an empty side makes the plane worthless.
#[inline(always)]
fn cost(count: u32, around: &Box4) -> f32 {
    if count == 0 { f32::INFINITY } else { count as f32 * around.half_area() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::{Bounds3, Vec3};

    /// Boxes of which every split peels off a few, begun so deep that the room for it runs out.
    #[test]
    fn near_the_limit_subtrees_are_halved_into_the_room_that_is_left() {
        let cube = |i: i32| Bounds3 { min: Vec3::splat(2_f32.powi(i)), max: Vec3::splat(2_f32.powi(i) * 1.1) };
        let peels = |depth: usize| {
            let mut references: Vec<_> = (-50..50).map(|i| Reference::new(&cube(i), 0, (i + 50) as u32)).collect();
            let whole = references.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
            let mut nodes = Vec::new();
            let root = subtree(&mut references, 0, whole, depth, &mut nodes);
            levels(&nodes, root)
        };
        assert!(peels(0) > 10);
        assert!(peels(MAX_DEPTH - 10) <= 10);
        assert!(peels(MAX_DEPTH - 7) <= 7);
    }

    fn levels(nodes: &[Node], child: Child) -> usize {
        let below = |c: &Child| 1 + levels(nodes, *c);
        if child.is_leaf() { 0 } else { nodes[child.index()].children.iter().map(below).max().unwrap_or(0) }
    }
}
