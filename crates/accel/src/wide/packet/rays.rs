//! The rays of a packet as a structure of arrays, and the frustum around them.

use super::super::box_ray::{SLACK, SOUND};
use super::PACKET;
use kirkas_geometry::Ray;

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
    #[inline(always)]
    pub fn load(&mut self, rays: &[Ray], reach: f32) -> bool {
        self.mask = u32::MAX;
        self.active = 0;
        for (r, ray) in rays.iter().enumerate() {
            let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
            for k in 0..3 {
                (self.origin[k][r], self.direction[k][r]) = (o[k], d[k]);
            }
            (self.t_min[r], self.t_max[r]) = (ray.t_min, ray.t_max);
            self.active |= u64::from(ray.t_min < ray.t_max) << r;
            self.mask &= ray.mask;
        }
        // Where no ray is, one stands in that is never asked.
        for r in rays.len()..PACKET {
            for k in 0..3 {
                (self.origin[k][r], self.direction[k][r]) = (self.origin[k][0], self.direction[k][0]);
            }
            (self.t_min[r], self.t_max[r]) = (f32::INFINITY, f32::NEG_INFINITY);
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
                for r in 0..PACKET {
                    self.shear[k][r] = self.direction[self.axes[k]][r] / self.direction[w][r];
                }
            }
        }
    }
}

#[inline(always)]
fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
