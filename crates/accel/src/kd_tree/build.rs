//! What both builders share: cost, end of the recursion, and order of the nodes.
//!
//! `cost = NODE_COST + P(left) n_left + P(right) n_right`, the chances being ratios of areas, less a bonus for planes that
//! cut off empty space. A cell stays a leaf where that is no less than its number of primitives, at a depth of
//! `8 + 1.3 log2 n`, or where the copies outgrow what is allowed: so memory is bounded whatever the scene.

use super::node::{MAX_LINK, Node};
use crate::Executor;
use kirkas_geometry::Bounds3;

/// Cost of visiting a node; testing a primitive costs 1.
pub(super) const NODE_COST: f64 = 0.75;
/// What the cost of a plane with an empty side is multiplied by.
const EMPTY_BONUS: f64 = 0.8;
/// All leaves together hold at most this many entries for each primitive.
const MAX_COPIES: usize = 8;
/// No node lies deeper: `8 + 1.3 log2` of the largest number of primitives.
pub(super) const MAX_DEPTH: usize = 45;
/// Cells with more primitives are handed to the executor in two halves, in the first levels.
const FORK_ABOVE: usize = 1 << 14;
const FORK_LEVELS: usize = 4;

/// A way to choose planes, and to divide what they cut.
pub(super) trait Splitter: Sync {
    /// The primitives in a cell.
    type Pieces: Send;
    /// Memory for [`Splitter::divide`].
    type Scratch: Send;

    fn all(&self) -> Self::Pieces;
    fn scratch(&self) -> Self::Scratch;
    fn count(&self, pieces: &Self::Pieces) -> usize;
    /// The plane of least cost strictly within the cell, if there is any.
    fn best_plane(&self, cell: &Bounds3, pieces: &Self::Pieces) -> Option<Plane>;
    /// What lies in the two cells that a plane makes. What touches the plane from one side only is on that side.
    fn divide(
        &self,
        pieces: &Self::Pieces,
        plane: &Plane,
        cells: &[Bounds3; 2],
        scratch: &mut Self::Scratch,
    ) -> [Self::Pieces; 2];
    /// Append the indices of the primitives.
    fn list(&self, pieces: &Self::Pieces, out: &mut Vec<u32>);
}

/// A plane that may divide a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub axis: usize,
    pub position: f32,
    pub cost: f64,
    /// Whether what lies within the plane goes to the left.
    pub flat_left: bool,
}

/// Computes the cost of planes through one cell.
pub(super) struct PlaneCosts {
    extent: [f64; 3],
    min: [f32; 3],
    max: [f32; 3],
    per_area: f64,
}

impl PlaneCosts {
    pub fn new(cell: &Bounds3) -> Self {
        let extent = (cell.max.as_dvec3() - cell.min.as_dvec3()).to_array();
        let [x, y, z] = extent;
        let (min, max) = (cell.min.to_array(), cell.max.to_array());
        PlaneCosts { extent, min, max, per_area: 1.0 / (x * y + (x + y) * z) }
    }

    /// Keep the better of `best` and the plane at `position` with `flat` primitives within it.
    #[inline]
    pub fn offer(&self, best: &mut Option<Plane>, axis: usize, position: f32, [left, flat, right]: [usize; 3]) {
        if !(position > self.min[axis] && position < self.max[axis]) {
            return;
        }
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (across, around) = (self.extent[i] * self.extent[j], self.extent[i] + self.extent[j]);
        let area = |from: f32, to: f32| across + around * (f64::from(to) - f64::from(from));
        let left_chance = area(self.min[axis], position) * self.per_area;
        let right_chance = area(position, self.max[axis]) * self.per_area;
        for flat_left in [true, false] {
            let (l, r) = if flat_left { (left + flat, right) } else { (left, right + flat) };
            let bonus = if l == 0 || r == 0 { EMPTY_BONUS } else { 1.0 };
            let cost = bonus * (NODE_COST + left_chance * l as f64 + right_chance * r as f64);
            if best.is_none_or(|b| cost < b.cost) {
                *best = Some(Plane { axis, position, cost, flat_left });
            }
            if flat == 0 {
                return;
            }
        }
    }
}

/// Nodes and lists of a tree or a subtree.
#[derive(Default)]
pub(super) struct Part {
    pub nodes: Vec<Node>,
    pub lists: Vec<u32>,
}

impl Part {
    fn append(&mut self, part: Part) {
        let (nodes, lists) = (self.nodes.len(), self.lists.len());
        self.nodes.extend(part.nodes.iter().map(|n| n.moved(nodes, lists)));
        self.lists.extend(part.lists);
    }
}

/// The tree over all primitives. It does not depend on the executor.
pub(super) fn tree<S: Splitter>(splitter: &S, bounds: Bounds3, executor: &dyn Executor) -> Part {
    let pieces = splitter.all();
    let n = splitter.count(&pieces);
    let max_depth = 8 + 13 * (n.max(1).ilog2() as usize + 1) / 10;
    debug_assert!(max_depth <= MAX_DEPTH);
    let builder = Builder { splitter, executor, max_depth };
    let room = (MAX_COPIES * n).min(MAX_LINK - 1);
    let mut part = Part::default();
    builder.subtree(Cell { bounds, pieces, depth: 0, room }, &mut splitter.scratch(), &mut part);
    part
}

struct Builder<'a, S> {
    splitter: &'a S,
    executor: &'a dyn Executor,
    max_depth: usize,
}

struct Cell<P> {
    bounds: Bounds3,
    pieces: P,
    depth: usize,
    /// Entries that its leaves may have.
    room: usize,
}

impl<S: Splitter> Builder<'_, S> {
    fn subtree(&self, cell: Cell<S::Pieces>, scratch: &mut S::Scratch, out: &mut Part) {
        let forks = cell.depth < FORK_LEVELS && self.splitter.count(&cell.pieces) > FORK_ABOVE;
        let (plane, [left, right]) = match self.split(cell, scratch) {
            Ok(split) => split,
            Err(pieces) => {
                let first = out.lists.len();
                self.splitter.list(&pieces, &mut out.lists);
                return out.nodes.push(Node::leaf(first, out.lists.len() - first));
            }
        };
        let index = out.nodes.len();
        out.nodes.push(Node::inner(plane.axis, plane.position));
        if forks {
            let (mut left, mut right) = ((Some(left), Part::default()), (Some(right), Part::default()));
            let mut own = self.splitter.scratch();
            let (scratch, own) = (&mut *scratch, &mut own);
            let run = |(cell, part): &mut (Option<_>, Part), scratch: &mut S::Scratch| {
                cell.take().into_iter().for_each(|cell| self.subtree(cell, scratch, part))
            };
            self.executor.join(&mut || run(&mut left, scratch), &mut || run(&mut right, own));
            out.append(left.1);
            let right_index = out.nodes.len();
            out.nodes[index].set_right(right_index);
            out.append(right.1);
        } else {
            self.subtree(left, scratch, out);
            let right_index = out.nodes.len();
            out.nodes[index].set_right(right_index);
            self.subtree(right, scratch, out);
        }
    }

    /// The two halves of a cell, or its pieces when it is to be a leaf.
    #[allow(clippy::type_complexity)]
    fn split(
        &self,
        cell: Cell<S::Pieces>,
        scratch: &mut S::Scratch,
    ) -> Result<(Plane, [Cell<S::Pieces>; 2]), S::Pieces> {
        let Cell { bounds, pieces, depth, room } = cell;
        let n = self.splitter.count(&pieces);
        if depth >= self.max_depth || n == 0 {
            return Err(pieces);
        }
        let plane = match self.splitter.best_plane(&bounds, &pieces) {
            Some(plane) if plane.cost < n as f64 => plane,
            _ => return Err(pieces),
        };
        let mut cells = [bounds; 2];
        (cells[0].max[plane.axis], cells[1].min[plane.axis]) = (plane.position, plane.position);
        let halves = self.splitter.divide(&pieces, &plane, &cells, scratch);
        let counts = halves.each_ref().map(|h| self.splitter.count(h));
        let needed = counts[0] + counts[1];
        if needed > room {
            return Err(pieces);
        }
        // What is left over goes to the halves by their numbers.
        let spare = (room - needed) as u64;
        let extra = (spare * counts[0] as u64 / needed.max(1) as u64) as usize;
        let rooms = [counts[0] + extra, room - counts[0] - extra];
        let [left, right] = halves;
        let half = |i: usize, pieces| Cell { bounds: cells[i], pieces, depth: depth + 1, room: rooms[i] };
        Ok((plane, [half(0, left), half(1, right)]))
    }
}
