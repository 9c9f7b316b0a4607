//! Chooses the resolution and fills the lists.

use crate::build::reference::Reference;
use crate::cells::{Clip, growth};
use crate::record::Record;
use core::ops::RangeInclusive;
use kirkas_geometry::elementary::cbrt;
use kirkas_geometry::{Bounds3, DVec3, Vec3};

/// Cells for each primitive, were the grid a cube: the number of cells along an edge is the cube root of the total.
const DENSITY: f64 = 4.0;
/// No more cells along an axis.
const MAX_RESOLUTION: f64 = 512.0;
/// Bounds of primitives may meet this many cells on average; otherwise the cells are made larger.
const MAX_COPIES: u64 = 32;

/// The planes between cells, along each axis from the lowest to the highest face.
pub(super) struct Planes([Vec<f32>; 3]);

/// For each cell a run of indices of primitives, in ascending order.
pub(super) struct Lists {
    /// Where each cell's run begins, and the end of the last.
    firsts: Vec<u32>,
    primitives: Vec<u32>,
}

impl Planes {
    fn new(bounds: &Bounds3, resolution: [usize; 3]) -> Self {
        Planes([0, 1, 2].map(|k| {
            let (low, high, n) = (f64::from(bounds.min[k]), f64::from(bounds.max[k]), resolution[k]);
            let at = |i: usize| (low + (high - low) * (i as f64 / n as f64)).min(high) as f32;
            (0..n).map(at).chain([bounds.max[k]]).collect()
        }))
    }

    pub fn bytes(&self) -> usize {
        self.0.iter().map(|p| size_of_val(&**p)).sum()
    }

    /// All planes along an axis, the faces of the grid included.
    pub fn along(&self, axis: usize) -> &[f32] {
        &self.0[axis]
    }

    /// Those between cells.
    pub fn inner(&self, axis: usize) -> &[f32] {
        &self.0[axis][1..self.resolution(axis)]
    }

    pub fn resolution(&self, axis: usize) -> usize {
        self.0[axis].len() - 1
    }

    pub fn cell_count(&self) -> usize {
        (0..3).map(|k| self.resolution(k)).product()
    }

    /// The index of a cell's list.
    #[inline(always)]
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.resolution(1) + y) * self.resolution(0) + x
    }

    /// The cells that touch an interval of an axis, were the outermost ones without end.
    pub fn touched(&self, axis: usize, from: f64, to: f64) -> RangeInclusive<usize> {
        let inner = self.inner(axis);
        inner.partition_point(|&p| f64::from(p) < from)..=inner.partition_point(|&p| f64::from(p) <= to)
    }

    pub fn cell(&self, at: [usize; 3]) -> Bounds3 {
        let corner = |d: usize| Vec3::from_array([0, 1, 2].map(|k| self.0[k][at[k] + d]));
        Bounds3 { min: corner(0), max: corner(1) }
    }
}

impl Lists {
    #[inline(always)]
    pub fn of(&self, cell: usize) -> &[u32] {
        &self.primitives[self.firsts[cell] as usize..self.firsts[cell + 1] as usize]
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.firsts) + size_of_val(&*self.primitives)
    }
}

/// Planes and lists over primitives within these bounds.
pub(super) fn cells(bounds: &Bounds3, references: &[Reference], records: &[Record]) -> (Planes, Lists) {
    let grow = growth(bounds);
    let mut wanted = resolution(bounds, references.len());
    let planes = loop {
        let planes = Planes::new(bounds, wanted);
        let met = |r: &Reference| ranges(&planes, &grown(&r.bounds(), grow)).map(|r| r.count() as u64).iter().product();
        let entries: u64 = references.iter().map(met).map(|n: u64| n).sum();
        let room = (MAX_COPIES * references.len() as u64).min(u32::MAX.into());
        if wanted == [1; 3] || entries <= room {
            break planes;
        }
        wanted = wanted.map(|n| n.div_ceil(2));
    };

    let mut entries: Vec<(u32, u32)> = Vec::with_capacity(2 * references.len());
    for (i, (reference, record)) in references.iter().zip(records).enumerate() {
        let region = region(reference, record, grow);
        for_each_cell(ranges(&planes, &grown(&reference.bounds(), grow)), |at| {
            if !region.within(&planes.cell(at)).is_empty() {
                entries.push((planes.index(at) as u32, i as u32));
            }
        });
    }

    // Sort by cell, keeping the order of primitives.
    let mut firsts = vec![0_u32; planes.cell_count() + 1];
    entries.iter().for_each(|e| firsts[e.0 as usize + 1] += 1);
    for cell in 1..firsts.len() {
        firsts[cell] += firsts[cell - 1];
    }
    let (mut next, mut primitives) = (firsts.clone(), vec![0; entries.len()]);
    for (cell, primitive) in entries {
        let slot = &mut next[cell as usize];
        primitives[*slot as usize] = primitive;
        *slot += 1;
    }
    (planes, Lists { firsts, primitives })
}

/// Where a primitive is to be listed.
pub(super) fn region(reference: &Reference, record: &Record, grow: f64) -> Clip {
    Clip::new(record, grown(&reference.bounds(), grow), grow)
}

pub(super) fn grown(b: &Bounds3, by: f64) -> Bounds3 {
    Bounds3::around_f64(b.min.as_dvec3() - DVec3::splat(by), b.max.as_dvec3() + DVec3::splat(by))
}

fn ranges(planes: &Planes, b: &Bounds3) -> [RangeInclusive<usize>; 3] {
    [0, 1, 2].map(|k| planes.touched(k, b.min[k].into(), b.max[k].into()))
}

pub(super) fn for_each_cell([x, y, z]: [RangeInclusive<usize>; 3], mut visit: impl FnMut([usize; 3])) {
    for k in z {
        for j in y.clone() {
            for i in x.clone() {
                visit([i, j, k]);
            }
        }
    }
}

/// Cells along each axis: as near to cubes as can be. Flat grids count as a hundredth as high as wide.
fn resolution(bounds: &Bounds3, primitives: usize) -> [usize; 3] {
    let extent = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    let filled = extent.max(DVec3::splat(extent.max_element() * 0.01));
    let size = extent.max_element();
    let volume = (filled / size).element_product();
    let edge = cbrt(volume / (DENSITY * primitives as f64)) * size;
    extent.to_array().map(|e| if edge > 0.0 { (e / edge).ceil().clamp(1.0, MAX_RESOLUTION) as usize } else { 1 })
}
