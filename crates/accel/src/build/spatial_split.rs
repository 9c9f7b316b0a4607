//! Builds the tree with spatial splits: a plane may cut triangles in two, so that both sides' boxes end at the plane (Stich,
//! Friedrich & Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies"). Each node takes the cheaper of the best split
//! between references and the best cut. Slow, and best where triangles are long and thin.
//!
//! The cuts are limited: each node owns some room for further references, which it hands down in proportion to the areas
//! below. Where there is no room, or no box large enough to be worth it, `binned_sah` goes on.

use super::binary::{BinaryTree, Child, MAX_LEAF, Node};
use super::binned_sah::{Builder, has_room};
use super::bins::{Binning, Bins, MAX_BINS, Plane};
use super::clip;
use super::costs::Costs;
use super::partition::{centers, partition, partition_in_chunks};
use super::pieces::Piece;
use super::reference::{Box4, MAX_ID, Reference};
use super::spatial_bins::{MAX_SLABS, SpatialBins, SpatialPlane};
use crate::Executor;
use crate::triangle::Corners;

/// Room for further references, as a part of the references.
const ROOM: f32 = 0.4;
/// Cuts are tried where the sides overlap by more than this part of the whole area (section 4.5 of the paper).
const OVERLAP: f32 = 1e-5;
/// ... and where a cut between the sides would take more than this part of the whole area off theirs.
const LEAST_GAIN: f32 = 0.07;
/// Subtrees larger than this are handed to the executor in two halves.
const FORK_ABOVE: usize = 1 << 12;

/// The corners of a reference's triangle; `None` for what shall not be cut.
pub(crate) type CornersOf<'a> = &'a (dyn Fn(&Reference) -> Option<Corners> + Sync);

/// The tree over `references`, of which some may occur in several leaves, each time with another part's box. Nodes stand
/// depth first, the left child after its parent.
pub(crate) fn build(
    mut references: Vec<Reference>,
    corners: CornersOf,
    costs: &Costs,
    executor: &dyn Executor,
) -> BinaryTree {
    let count = references.len();
    if count == 0 {
        return BinaryTree { nodes: Vec::new(), root: None, references };
    }
    let whole = references.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
    let blank = references[0];
    let room = ((count as f32 * ROOM) as usize).min((MAX_ID as usize).saturating_sub(count));
    references.resize(count + room, blank);
    let splitter =
        Splitter { corners, builder: Builder { costs, executor }, least_overlap: whole.half_area() * OVERLAP };
    let piece = splitter.piece(&mut references, count, whole, 0);
    drop(references);
    piece.into_tree(executor)
}

/// What is being built of a subtree.
struct Grown {
    nodes: Vec<Node>,
    references: Vec<Reference>,
}

struct Splitter<'a> {
    corners: CornersOf<'a>,
    builder: Builder<'a>,
    /// Half area.
    least_overlap: f32,
}

/// How references were parted: the low ones come first, then the high ones.
struct Parted {
    counts: [usize; 2],
    boxes: [Box4; 2],
}

impl Parted {
    /// The high ones are the first child.
    fn node(&self) -> Node {
        Node::new([&self.boxes[1].to_bounds(), &self.boxes[0].to_bounds()], [Child::node(0); 2])
    }
}

impl Splitter<'_> {
    /// `references` is `count` of them, and room.
    fn piece(&self, references: &mut [Reference], count: usize, whole: Box4, depth: usize) -> Piece {
        let room = references.len() - count;
        let mut bins = Bins::EMPTY;
        if count <= FORK_ABOVE {
            let mut out = Grown { nodes: Vec::with_capacity(count / 3), references: Vec::with_capacity(count) };
            let (root, _) = self.subtree(references, count, room, whole, depth, &mut out, &mut bins);
            return Piece::with_references(out.nodes, root, out.references);
        }
        let Some(parted) = self.split(references, count, room, &whole, depth, &mut bins) else {
            let references = &mut references[..count];
            let (nodes, root) = self.builder.nodes(references, depth);
            return Piece::with_references(nodes, root.expect("a root over references"), references.to_vec());
        };
        let room = references.len() - parted.counts[0] - parted.counts[1];
        let (room_of_low, upper) = self.deal(references, &parted, room);
        let (low, high) = references.split_at_mut(upper);
        debug_assert_eq!(low.len(), parted.counts[0] + room_of_low);
        let halves = self.builder.both(
            || self.piece(high, parted.counts[1], parted.boxes[1], depth + 1),
            || self.piece(low, parted.counts[0], parted.boxes[0], depth + 1),
        );
        Piece::forked(parted.node(), halves)
    }

    /// The first `count` of `references` are to be built over, and up to `room` more may come to be; returns also what of the
    /// room is left.
    fn subtree(
        &self,
        references: &mut [Reference],
        count: usize,
        room: usize,
        whole: Box4,
        depth: usize,
        out: &mut Grown,
        bins: &mut Bins,
    ) -> (Child, usize) {
        let Some(parted) = self.split(references, count, room, &whole, depth, bins) else {
            return (self.finish(&mut references[..count], whole, depth, out, bins), room);
        };
        let index = out.nodes.len();
        out.nodes.push(parted.node());
        let [low, high] = parted.counts;
        let room = room + count - (low + high);
        let (room_of_low, upper) = self.deal(references, &parted, room);
        let rest = &mut references[upper..];
        let (a, left) = self.subtree(rest, high, room - room_of_low, parted.boxes[1], depth + 1, out, bins);
        // Done with those, their places are free.
        let (b, left) = self.subtree(references, low, room_of_low + left, parted.boxes[0], depth + 1, out, bins);
        out.nodes[index].children = [a, b];
        (Child::node(index), left)
    }

    /// Without cuts.
    fn finish(
        &self,
        references: &mut [Reference],
        whole: Box4,
        depth: usize,
        out: &mut Grown,
        bins: &mut Bins,
    ) -> Child {
        let root = self.builder.subtree(references, out.references.len(), whole, depth, &mut out.nodes, bins);
        out.references.extend_from_slice(references);
        root
    }

    /// Part the references by the better of a split and a cut; `None` where cuts are out of question.
    fn split(
        &self,
        references: &mut [Reference],
        count: usize,
        room: usize,
        whole: &Box4,
        depth: usize,
        bins: &mut Bins,
    ) -> Option<Parted> {
        let worth = room > 0 && whole.half_area() > self.least_overlap;
        if count <= 2 * MAX_LEAF || !worth || !has_room(count, depth) {
            return None;
        }
        let costs = self.builder.costs;
        let own = &mut references[..count];
        let is_large = count > FORK_ABOVE;
        let middle = self.builder.sum(own, &centers, &Box4::union);
        let binning = Binning::new(&middle, if count < 256 { 16 } else { MAX_BINS });
        if is_large {
            *bins = self.builder.bins(own, &binning);
        } else {
            bins.fill(own, &binning);
        }
        let plane = bins.best_plane(&binning, costs);
        // Cut where the sides overlap, if it is cheaper.
        if plane.as_ref().is_none_or(|p| self.is_worth_a_cut(p, whole)) {
            let blank = SpatialBins::new(whole, if count < 64 { 8 } else { MAX_SLABS });
            let each = |chunk: &[Reference]| {
                let mut slabs = blank;
                slabs.fill(chunk, self.corners);
                slabs
            };
            let slabs = self.builder.sum(own, &each, &|mut a, b| {
                a.merge(&b);
                a
            });
            let split_cost = plane.as_ref().map_or(f32::INFINITY, |p| p.cost);
            let cut = slabs.best_plane(costs).filter(|cut| cut.cost < split_cost);
            if let Some(parted) = cut.and_then(|cut| self.cut(references, count, room, &cut)) {
                return Some(parted);
            }
        }
        let plane = plane?;
        let own = &mut references[..count];
        let is_left = |r: &Reference| binning.is_left(r, &plane);
        let left = match is_large {
            true => partition_in_chunks(own, &|chunk| partition(chunk, is_left), self.builder.executor).0,
            false => partition(own, is_left),
        };
        Some(Parted { counts: [left, count - left], boxes: plane.boxes })
    }

    /// True when the sides overlap by much: in area, and in what a cut between them would take off the sides' areas.
    fn is_worth_a_cut(&self, plane: &Plane, whole: &Box4) -> bool {
        let [a, b] = plane.boxes;
        let shared = Box4 { lo: a.lo.max(b.lo), hi: a.hi.min(b.hi) };
        let size = [0, 1, 2].map(|k| shared.hi.0[k] - shared.lo.0[k]);
        if size.iter().any(|s| *s < 0.0) {
            return false;
        }
        let across = size[plane.axis] * (size[(plane.axis + 1) % 3] + size[(plane.axis + 2) % 3]);
        shared.half_area() > self.least_overlap && across > LEAST_GAIN * whole.half_area()
    }

    /// Part the references by a plane; `None`, and nothing but the order changed, where that takes more room than there is or
    /// leaves a side empty.
    fn cut(&self, references: &mut [Reference], count: usize, room: usize, plane: &SpatialPlane) -> Option<Parted> {
        if (plane.counts[0] + plane.counts[1]) as usize > count + room {
            return None;
        }
        let mut boxes = [Box4::EMPTY; 2];
        let (mut on_left, mut end) = (0, count);
        for i in 0..count {
            let r = references[i];
            match self.side(&r, plane) {
                Goes::Both(corners) if end < count + room => {
                    let (geometry, primitive) = r.ids();
                    let parts = clip::split(&corners, &r.bounds(), plane.axis, plane.at);
                    let [a, b] = parts.map(|part| Reference::new(&part, geometry, primitive));
                    boxes = [boxes[0].union(a.0), boxes[1].union(b.0)];
                    references[i] = a;
                    references.swap(i, on_left);
                    on_left += 1;
                    references[end] = b;
                    end += 1;
                }
                Goes::Left | Goes::Both(_) => {
                    boxes[0] = boxes[0].union(r.0);
                    references.swap(i, on_left);
                    on_left += 1;
                }
                Goes::Right => boxes[1] = boxes[1].union(r.0),
            }
        }
        let counts = [on_left, end - on_left];
        (!counts.contains(&0)).then_some(Parted { counts, boxes })
    }

    /// Where a reference goes; what straddles is not cut where it is cheaper on one side ("reference unsplitting").
    fn side(&self, r: &Reference, plane: &SpatialPlane) -> Goes {
        let (low, high) = (r.0.lo.0[plane.axis], r.0.hi.0[plane.axis]);
        if high <= plane.at {
            return Goes::Left;
        }
        if low >= plane.at {
            return Goes::Right;
        }
        let area = |b: Box4| b.half_area();
        let (counts, [left, right]) = (plane.counts.map(|n| n as f32), plane.boxes);
        let both = area(left) * counts[0] + area(right) * counts[1];
        let only_left = area(left.union(r.0)) * counts[0] + area(right) * (counts[1] - 1.0);
        let only_right = area(left) * (counts[0] - 1.0) + area(right.union(r.0)) * counts[1];
        let corners = if both < only_left.min(only_right) { (self.corners)(r) } else { None };
        match corners {
            Some(corners) => Goes::Both(corners),
            None if only_left <= only_right => Goes::Left,
            None => Goes::Right,
        }
    }

    /// Move the high ones up, so that both sides have their share of the room after them; returns the low ones' share and where
    /// the high ones begin.
    fn deal(&self, references: &mut [Reference], parted: &Parted, room: usize) -> (usize, usize) {
        let [low, high] = parted.counts;
        let count = low + high;
        let each = |r: &[Reference]| r.iter().map(|r| f64::from(r.0.half_area())).sum::<f64>();
        let areas = |r: &[Reference]| self.builder.sum(r, &each, &|a, b| a + b);
        let (of_low, of_high) = (areas(&references[..low]), areas(&references[low..count]));
        let share = if of_low + of_high > 0.0 { of_low / (of_low + of_high) } else { 0.5 };
        let room_of_low = ((room as f64 * share) as usize).min(room);
        // Their order does not matter.
        if room_of_low <= high {
            references.copy_within(low..low + room_of_low, count);
        } else {
            references.copy_within(low..count, low + room_of_low);
        }
        (room_of_low, low + room_of_low)
    }
}

enum Goes {
    Left,
    Right,
    Both(Corners),
}

#[cfg(test)]
#[path = "spatial_split_tests.rs"]
mod tests;
