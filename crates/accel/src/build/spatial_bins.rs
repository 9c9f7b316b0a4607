//! Bins that cut what they hold: each is a slab of space, and holds of a triangle what lies in that slab (Stich, Friedrich &
//! Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies", section 4). Boxes here serve to choose a plane and lose
//! nothing if they are a rounding too small; the boxes of the tree come from `clip`.

use super::bins::{INTEGER_IN_LOW_BITS, sides, sweep};
use super::costs::Costs;
use super::lanes::Lanes;
use super::reference::{Box4, Reference};
use crate::triangle::Corners;

/// Slabs along each axis, at most.
pub(super) const MAX_SLABS: usize = 16;

#[derive(Clone, Copy)]
pub(super) struct SpatialBins {
    low: Lanes,
    /// Of a slab.
    size: Lanes,
    /// Slabs per length; 0 for an axis without extent.
    scale: Lanes,
    slabs: usize,
    boxes: [[Box4; 3]; MAX_SLABS],
    enter: [[u32; 4]; MAX_SLABS],
    leave: [[u32; 4]; MAX_SLABS],
}

/// A plane between slabs.
pub(super) struct SpatialPlane {
    pub axis: usize,
    pub at: f32,
    /// Blocks to be tested, times area.
    pub cost: f32,
    pub counts: [u32; 2],
    pub boxes: [Box4; 2],
}

impl SpatialBins {
    /// This many slabs, a power of two, over the box of a node.
    pub fn new(whole: &Box4, slabs: usize) -> Self {
        let size = whole.hi.minus(whole.lo).times(Lanes::splat(1.0 / slabs as f32));
        let scale = Lanes(core::array::from_fn(|k| {
            let scale = 1.0 / size.0[k];
            if k < 3 && scale > 0.0 && scale.is_finite() { scale } else { 0.0 }
        }));
        let (boxes, none) = ([[Box4::EMPTY; 3]; MAX_SLABS], [[0; 4]; MAX_SLABS]);
        SpatialBins { low: whole.lo, size, scale, slabs, boxes, enter: none, leave: none }
    }

    /// Add what is in others over the same box.
    pub fn merge(&mut self, other: &Self) {
        for slab in 0..self.slabs {
            for axis in 0..3 {
                self.boxes[slab][axis] = self.boxes[slab][axis].union(other.boxes[slab][axis]);
                self.enter[slab][axis] += other.enter[slab][axis];
                self.leave[slab][axis] += other.leave[slab][axis];
            }
        }
    }

    /// Take in references; those without corners are not cut.
    pub fn fill(&mut self, references: &[Reference], corners: &dyn Fn(&Reference) -> Option<Corners>) {
        for r in references {
            let (first, last) = (self.slabs_of(r.0.lo), self.slabs_of(r.0.hi));
            for axis in 0..3 {
                let slab = first[axis] & (MAX_SLABS - 1);
                if slab == last[axis] & (MAX_SLABS - 1) {
                    self.add(axis, slab, r.0);
                }
            }
            if first != last {
                self.fill_straddling(r, first, last, corners);
            }
        }
    }

    /// On the axes on which it is in several slabs.
    fn fill_straddling(
        &mut self,
        r: &Reference,
        first: [usize; 3],
        last: [usize; 3],
        corners: &dyn Fn(&Reference) -> Option<Corners>,
    ) {
        let corners = corners(r);
        let middle = self.slabs_of(r.center());
        for axis in 0..3 {
            let (first, last, middle) = (first[axis], last[axis], middle[axis]);
            match &corners {
                _ if first == last => {}
                Some(corners) => self.cut(axis, first, last, r, corners),
                None => self.add(axis, middle, r.0),
            }
        }
    }

    /// In which slab a point lies on each axis.
    #[inline(always)]
    fn slabs_of(&self, p: Lanes) -> [usize; 3] {
        let x = p.minus(self.low).times(self.scale).min(Lanes::splat(self.slabs as f32 - 0.02)).max(Lanes::splat(0.0));
        let bits = x.plus(Lanes::splat(0.51)).plus(Lanes::splat(INTEGER_IN_LOW_BITS)).to_bits();
        let slab = |axis: usize| bits[axis].wrapping_sub(1) as usize & (MAX_SLABS - 1);
        [slab(0), slab(1), slab(2)]
    }

    #[inline(always)]
    fn add(&mut self, axis: usize, slab: usize, around: Box4) {
        self.boxes[slab][axis] = self.boxes[slab][axis].union(around);
        self.enter[slab][axis] += 1;
        self.leave[slab][axis] += 1;
    }

    fn plane(&self, axis: usize, after: usize) -> f32 {
        self.low.0[axis] + self.size.0[axis] * (after + 1) as f32
    }

    fn cut(&mut self, axis: usize, first: usize, last: usize, r: &Reference, corners: &Corners) {
        let corners = corners.map(|[x, y, z]| Lanes([x, y, z, 0.0]));
        // One slab more on both sides stands for all that lies beyond.
        let (low, size, scale) = (self.low.0[axis], self.size.0[axis], self.scale.0[axis]);
        let slab = |c: Lanes| ((c.0[axis] - low) * scale + 1.0).clamp(0.0, 1e3) as isize - 1;
        let first_plane = self.plane(axis, 0);
        let slabs = corners.map(slab);
        let mut put = |slab: isize, p: Lanes| {
            if (first as isize..=last as isize).contains(&slab) {
                let part = &mut self.boxes[slab as usize & (MAX_SLABS - 1)][axis];
                *part = part.union(Box4 { lo: p.max(r.0.lo), hi: p.min(r.0.hi) });
            }
        };
        for i in 0..3 {
            let j = (i + 1) % 3;
            put(slabs[i], corners[i]);
            let (low, high) = if slabs[i] < slabs[j] { (i, j) } else { (j, i) };
            let (from, along) = (corners[low], corners[high].minus(corners[low]));
            let begin = slabs[low].max(first as isize - 1);
            for k in begin..slabs[high].min(last as isize + 1) {
                let t = (first_plane + size * k as f32 - from.0[axis]) / along.0[axis];
                let crossing = from.plus(along.times(Lanes::splat(t)));
                put(k, crossing);
                put(k + 1, crossing);
            }
        }
        self.enter[first & (MAX_SLABS - 1)][axis] += 1;
        self.leave[last & (MAX_SLABS - 1)][axis] += 1;
    }

    pub fn best_plane(&self, costs: &Costs) -> Option<SpatialPlane> {
        let n = self.slabs;
        let (cost, axis, last_left) = sweep(&self.boxes[..n], &self.enter[..n], &self.leave[..n], self.scale, costs)?;
        let count = |counts: &[[u32; 4]]| counts.iter().map(|c| c[axis]).sum();
        let counts = [count(&self.enter[..=last_left]), count(&self.leave[last_left + 1..])];
        let boxes = sides(&self.boxes[..n], axis, last_left);
        Some(SpatialPlane { axis, at: self.plane(axis, last_left), cost, counts, boxes })
    }
}
