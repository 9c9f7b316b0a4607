//! Bins along the three axes, and the plane between bins that the surface-area heuristic likes best (Wald 2007, "On fast
//! Construction of SAH-based Bounding Volume Hierarchies").

use super::costs::Costs;
use super::lanes::Lanes;
use super::reference::{Box4, MAX_SIZE, Reference};

/// Bins of an axis, at most.
pub(crate) const MAX_BINS: usize = 32;

/// The map from centers to bins.
#[derive(Clone, Copy)]
pub(crate) struct Binning {
    low: Lanes,
    /// Bins per length; 0 where the centers do not differ.
    scale: Lanes,
    bins: usize,
}

/// A plane between bins.
pub(crate) struct Plane {
    pub axis: usize,
    pub last_left: u32,
    /// Blocks to be tested, times area.
    pub cost: f32,
    pub left_count: usize,
    pub boxes: [Box4; 2],
}

/// Adding it to a small positive f32 leaves the nearest integer in the low bits.
pub(super) const INTEGER_IN_LOW_BITS: f32 = 8_388_608.0;

impl Binning {
    /// Over the box of the centers; `bins` is a power of two up to [`MAX_BINS`].
    pub fn new(centers: &Box4, bins: usize) -> Self {
        debug_assert!(bins.is_power_of_two() && bins <= MAX_BINS);
        let scale = core::array::from_fn(|k| {
            let scale = (bins as f32 - 0.02) / (centers.hi.0[k] - centers.lo.0[k]);
            if scale > 0.0 && scale.is_finite() { scale } else { 0.0 }
        });
        Binning { low: centers.lo, scale: Lanes(scale), bins }
    }

    /// The bin on each axis, monotone in the center.
    #[inline(always)]
    pub fn bins(&self, r: &Reference) -> [u32; 3] {
        let x = r.center().minus(self.low).times(self.scale);
        // Half a bin is added, lest 0 be rounded to a bin of its own, and one bin taken off again.
        let bits = x.plus(Lanes::splat(0.51)).plus(Lanes::splat(INTEGER_IN_LOW_BITS)).to_bits();
        let bin = |axis: usize| bits[axis].wrapping_sub(1) & (MAX_BINS as u32 - 1);
        [bin(0), bin(1), bin(2)]
    }

    /// True for what lies to the left of the plane.
    #[inline(always)]
    pub fn is_left(&self, r: &Reference, plane: &Plane) -> bool {
        self.bins(r)[plane.axis] <= plane.last_left
    }
}

/// What fell into each bin of each axis.
pub(crate) struct Bins {
    boxes: [[Box4; 3]; MAX_BINS],
    counts: [[u32; 4]; MAX_BINS],
}

impl Bins {
    pub const EMPTY: Bins = Bins { boxes: [[Box4::EMPTY; 3]; MAX_BINS], counts: [[0; 4]; MAX_BINS] };

    /// Forget what they hold and take in `references`.
    pub fn fill(&mut self, references: &[Reference], binning: &Binning) {
        for i in 0..binning.bins {
            self.boxes[i] = [Box4::EMPTY; 3];
            self.counts[i] = [0; 4];
        }
        // Neighbours often share a bin, and each would wait for the one before: two that are far apart seldom do.
        let (near, far) = references.split_at(references.len() / 2);
        for (a, b) in near.iter().zip(far) {
            self.take_in(a, binning);
            self.take_in(b, binning);
        }
        if near.len() < far.len() {
            self.take_in(&far[near.len()], binning);
        }
    }

    #[inline(always)]
    fn take_in(&mut self, r: &Reference, binning: &Binning) {
        for (axis, bin) in binning.bins(r).into_iter().enumerate() {
            let i = bin as usize & (MAX_BINS - 1);
            self.boxes[i][axis] = self.boxes[i][axis].union(r.0);
            self.counts[i][axis] += 1;
        }
    }

    /// Add what fell into the bins of others.
    pub fn merge(&mut self, other: &Self) {
        for i in 0..MAX_BINS {
            for axis in 0..3 {
                self.boxes[i][axis] = self.boxes[i][axis].union(other.boxes[i][axis]);
                self.counts[i][axis] += other.counts[i][axis];
            }
        }
    }

    /// The plane of the least cost; `None` when the centers do not differ, or areas overflow.
    pub fn best_plane(&self, binning: &Binning, costs: &Costs) -> Option<Plane> {
        let bins = binning.bins;
        let counts = &self.counts[..bins];
        let (cost, axis, last_left) = sweep(&self.boxes[..bins], counts, counts, binning.scale, costs)?;
        let left_count = counts[..=last_left].iter().map(|c| c[axis]).sum::<u32>() as usize;
        let boxes = sides(&self.boxes[..bins], axis, last_left);
        Some(Plane { axis, last_left: last_left as u32, cost, left_count, boxes })
    }
}

/// The plane of the least cost, as `(cost, axis, last bin on the left)`, on the axes whose `scale` is not 0. What lies in
/// several bins is counted where it begins, in `enter`, and where it ends, in `leave`.
pub(super) fn sweep(
    boxes: &[[Box4; 3]],
    enter: &[[u32; 4]],
    leave: &[[u32; 4]],
    scale: Lanes,
    costs: &Costs,
) -> Option<(f32, usize, usize)> {
    // All axes at once: what the right sides cost, then the sums.
    let planes = boxes.len() - 1;
    let mut right_cost = [Lanes::splat(0.0); MAX_BINS];
    let mut side = Side { boxes: [Box4::EMPTY; 3], counts: [0; 4] };
    for i in (0..planes).rev() {
        side = side.and(&boxes[i + 1], &leave[i + 1]);
        right_cost[i] = side.cost(costs);
    }
    let mut side = Side { boxes: [Box4::EMPTY; 3], counts: [0; 4] };
    let (mut least, mut last_left) = (Lanes::splat(f32::INFINITY), Lanes::splat(0.0));
    for (i, right) in right_cost.iter().enumerate().take(planes) {
        side = side.and(&boxes[i], &enter[i]);
        let sum = side.cost(costs).plus(*right);
        let better = sum.less(least);
        least = sum.where_or(better, least);
        last_left = Lanes::splat(i as f32).where_or(better, last_left);
    }
    let mut best = (f32::INFINITY, 0);
    for axis in 0..3 {
        if scale.0[axis] > 0.0 && least.0[axis] < best.0 {
            best = (least.0[axis], axis);
        }
    }
    let (cost, axis) = best;
    (cost < f32::INFINITY).then(|| (cost, axis, last_left.0[axis] as usize))
}

/// The boxes around both sides of a plane.
pub(super) fn sides(boxes: &[[Box4; 3]], axis: usize, last_left: usize) -> [Box4; 2] {
    let (left, right) = boxes.split_at(last_left + 1);
    [left, right].map(|side| side.iter().fold(Box4::EMPTY, |all, b| all.union(b[axis])))
}

/// What lies to one side of a plane, on each axis.
#[derive(Clone, Copy)]
struct Side {
    boxes: [Box4; 3],
    counts: [u32; 4],
}

impl Side {
    /// With one more bin.
    #[inline(always)]
    fn and(self, boxes: &[Box4; 3], counts: &[u32; 4]) -> Side {
        let around = |axis: usize| self.boxes[axis].union(boxes[axis]);
        let count = |axis: usize| self.counts[axis] + counts[axis];
        Side { boxes: [around(0), around(1), around(2)], counts: [count(0), count(1), count(2), count(3)] }
    }

    /// Blocks times area on each axis; NaN, so that no comparison favours it, for an empty side.
    #[inline(always)]
    fn cost(&self, costs: &Costs) -> Lanes {
        let size = |axis: usize| self.boxes[axis].hi.minus(self.boxes[axis].lo).min(Lanes::splat(MAX_SIZE));
        let [x, y, z] = Lanes::transpose([size(0), size(1), size(2)]);
        let area = x.times(y).plus(y.plus(x).times(z));
        let blocks = |axis: usize| costs.blocks(self.counts[axis]);
        area.times(Lanes([blocks(0), blocks(1), blocks(2), blocks(3)]))
    }
}
