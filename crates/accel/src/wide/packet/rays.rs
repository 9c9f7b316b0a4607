//! The rays of a packet as a structure of arrays, and the frustum around them.

use super::super::box_ray::{SLACK, SOUND};
use super::PACKET;
use super::backend::PacketBackend;
use kirkas_geometry::Ray;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// A number of each ray.
pub(super) type Row = [f32; PACKET];

/// What the tests need of the rays. Their directions have the same signs, and neither a component of them nor its inverse is 0.
#[repr(C, align(64))]
pub(super) struct Rays {
    pub origin: [Row; 3],
    pub direction: [Row; 3],
    pub inverse: [Row; 3],
    /// As in [`BoxRay`](super::super::box_ray::BoxRay): added to the distances of planes.
    pub enter: [Row; 3],
    pub leave: [Row; 3],
    /// As in [`PreparedRay`](crate::prepared_ray::PreparedRay), where all have the same axes.
    pub shear: [Row; 2],
    pub t_min: Row,
    pub t_max: Row,
    /// The middle of all shears along each axis, and how far they are from it at most.
    pub shears: [(f32, f32); 2],
    /// The axes in cyclic order, the one along which they run fastest last; of the first ray, unless `has_one_axis`.
    pub axes: [usize; 3],
    /// All run fastest along the same axis.
    pub has_one_axis: bool,
    /// All start at the same point.
    pub has_one_origin: bool,
    /// 1 where the directions are negative.
    pub is_negative: [usize; 3],
    /// A bit for each ray that may hit something.
    pub active: u64,
    /// What all see.
    pub mask: u32,
    pub frustum: Frustum,
}

/// What no ray of the packet leaves: as for one ray, but with the two inverse directions that are least and greatest.
#[derive(Clone, Copy)]
pub(super) struct Frustum {
    /// By axis.
    pub inverse: [[f32; 2]; 3],
    pub enter: [[f32; 2]; 3],
    pub leave: [[f32; 2]; 3],
    /// The rows of a node's planes through which the rays enter.
    pub enter_row: [usize; 3],
    pub t_min: f32,
}

/// Numbers that fill a register.
const LANES: usize = 8;

/// Least and greatest, 8 at a time.
#[inline(always)]
fn extremes(row: &Row) -> (f32, f32) {
    let (mut low, mut high) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
    for eight in row.as_chunks::<LANES>().0 {
        for (l, x) in eight.iter().enumerate() {
            low[l] = if *x < low[l] { *x } else { low[l] };
            high[l] = if *x > high[l] { *x } else { high[l] };
        }
    }
    let (mut least, mut most) = (low[0], high[0]);
    for l in 1..LANES {
        least = if low[l] < least { low[l] } else { least };
        most = if high[l] > most { high[l] } else { most };
    }
    (least, most)
}

impl Rays {
    pub const EMPTY: Rays = Rays {
        origin: [[0.0; PACKET]; 3],
        direction: [[0.0; PACKET]; 3],
        inverse: [[0.0; PACKET]; 3],
        enter: [[0.0; PACKET]; 3],
        leave: [[0.0; PACKET]; 3],
        shear: [[0.0; PACKET]; 2],
        t_min: [0.0; PACKET],
        t_max: [0.0; PACKET],
        shears: [(0.0, 0.0); 2],
        axes: [0; 3],
        has_one_axis: false,
        has_one_origin: false,
        is_negative: [0; 3],
        active: 0,
        mask: 0,
        frustum: Frustum {
            inverse: [[0.0; 2]; 3],
            enter: [[0.0; 2]; 3],
            leave: [[0.0; 2]; 3],
            enter_row: [0; 3],
            t_min: 0.0,
        },
    };

    /// Take these rays, 1 to 64, for boxes of which no coordinate is larger than `reach`; false when they cannot go together.
    ///
    /// # Safety
    /// The CPU has what `B` needs.
    #[inline(always)]
    pub unsafe fn load<B: PacketBackend>(&mut self, rays: &[Ray], reach: f32) -> bool {
        if let Ok(all) = rays.try_into() {
            // SAFETY: the caller promises the CPU.
            unsafe { B::load_rows(self, all) };
            self.active = u64::MAX;
        } else {
            // SAFETY: as above.
            unsafe { B::load_rows(self, &filled(rays)) };
            self.active = (1 << rays.len()) - 1;
        }
        let mut masks = [u32::MAX; LANES];
        let (eights, rest) = rays.as_chunks::<LANES>();
        for eight in eights {
            for (mask, ray) in masks.iter_mut().zip(eight) {
                *mask &= ray.mask;
            }
        }
        self.mask = masks.iter().chain(rest.iter().map(|ray| &ray.mask)).fold(u32::MAX, |all, mask| all & mask);
        for r in 0..PACKET {
            let can_hit = self.t_min[r] < self.t_max[r];
            self.active &= !(u64::from(!can_hit) << r);
        }
        self.has_one_origin = true;
        let mut slack = [0.0; 3];
        for k in 0..3 {
            let (mut differ, mut same, mut bad) = (0, u32::MAX, 0);
            for r in 0..PACKET {
                let (o, d) = (self.origin[k][r], self.direction[k][r]);
                let i = 1.0 / d;
                self.inverse[k][r] = i;
                (differ, same) = (differ | i.to_bits(), same & i.to_bits());
                let is_sound = (o.abs() < f32::INFINITY) & (d.abs() < f32::INFINITY) & (i.abs() < f32::INFINITY);
                bad |= u32::from(!is_sound);
            }
            if bad != 0 || differ >> 31 != same >> 31 {
                return false;
            }
            self.is_negative[k] = (differ >> 31) as usize;
            let (o, i) = (extremes(&self.origin[k]), extremes(&self.inverse[k]));
            self.has_one_origin &= o.0 == o.1;
            let farthest = (reach + most(o.0.abs(), o.1.abs())) * most(i.0.abs(), i.1.abs());
            if !(farthest < SOUND) {
                return false;
            }
            slack[k] = SLACK * farthest;
            // Who starts last in the direction of travel enters first.
            let (first, last) = if self.is_negative[k] != 0 { (o.0, o.1) } else { (o.1, o.0) };
            let f = &mut self.frustum;
            f.inverse[k] = [i.0, i.1];
            f.enter[k] = [i.0, i.1].map(|i| -(first * i) - slack[k]);
            f.leave[k] = [i.0, i.1].map(|i| -(last * i) + slack[k]);
            f.enter_row[k] = 2 * k + self.is_negative[k];
        }
        self.frustum.t_min = extremes(&self.t_min).0;
        for k in 0..3 {
            for r in 0..PACKET {
                let at = -(self.origin[k][r] * self.inverse[k][r]);
                (self.enter[k][r], self.leave[k][r]) = (at - slack[k], at + slack[k]);
            }
        }
        self.shear();
        true
    }

    /// Find the axes and the shears along them.
    #[inline(always)]
    fn shear(&mut self) {
        let (mut any, mut all) = (0u32, u32::MAX);
        for r in 0..PACKET {
            let [x, y, z] = [0, 1, 2].map(|k: usize| self.direction[k][r].abs());
            let last = if y > z { 2u32 } else { 4 };
            let last = if (x > y) & (x > z) { 1 } else { last };
            (any, all) = (any | last, all & last);
        }
        self.has_one_axis = any == all;
        let w = any.trailing_zeros() as usize % 3;
        self.axes = [(w + 1) % 3, (w + 2) % 3, w];
        if self.has_one_axis {
            for k in 0..2 {
                let (along, last) = (&self.direction[self.axes[k]], &self.direction[w]);
                for ((s, d), w) in self.shear[k].iter_mut().zip(along).zip(last) {
                    *s = d / w;
                }
                let (low, high) = extremes(&self.shear[k]);
                let middle = 0.5 * (low + high);
                // A little more than half of the span, for the roundings of these two lines.
                self.shears[k] = (middle, 0.5 * (high - low) + 4.0 * UNIT_ROUNDOFF * most(low.abs(), high.abs()));
            }
        }
    }
}

/// Rays of which the last stand in where there are none, and are never asked.
#[cold]
fn filled(rays: &[Ray]) -> [Ray; PACKET] {
    let mut all = [rays[0]; PACKET];
    all[..rays.len()].copy_from_slice(rays);
    all
}

#[inline(always)]
fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
