//! What the rays of a packet have found, as a structure of arrays.

use super::super::numbers::Numbers;
use super::PACKET;
use super::rays::{Rays, Row};
use crate::hit::Hit;
use crate::path::InstancePath;
use core::mem::MaybeUninit;
use kirkas_geometry::bounds::FAR_PAD;

/// The closest hit of each ray.
#[repr(C, align(64))]
pub(super) struct Found {
    /// Where it is; `t_max` where there is none.
    pub t: Row,
    pub u: Row,
    pub v: Row,
    /// 1 more than the primitive's number; less wins where `t` is equal.
    pub rank: [u32; PACKET],
    /// Boxes that are entered after this are culled.
    pub limit: Row,
    /// Two factors of `t`, of which the larger product is the limit.
    pub pads: [f32; 2],
    /// The whole hit, where `rank` is [`Found::PLACED`].
    placed: [MaybeUninit<Hit>; PACKET],
}

impl Found {
    /// The rank of what is in an instance, which wins over what is in the world.
    const PLACED: u32 = 0;
    /// The rank of nothing.
    const NOTHING: u32 = u32::MAX;

    pub const EMPTY: Found = Found {
        t: [0.0; PACKET],
        u: [0.0; PACKET],
        v: [0.0; PACKET],
        rank: [Self::NOTHING; PACKET],
        limit: [0.0; PACKET],
        pads: [1.0; 2],
        placed: [const { MaybeUninit::uninit() }; PACKET],
    };

    /// Nothing yet. Where primitives may be in several boxes, in parts, limits lie a little after the hits.
    #[inline(always)]
    pub fn clear(&mut self, rays: &Rays, is_split: bool) {
        self.pads = if is_split { [FAR_PAD, 2.0 - FAR_PAD] } else { [1.0; 2] };
        for r in 0..PACKET {
            self.t[r] = rays.t_max[r];
            self.limit[r] = self.limit_at(rays.t_max[r]);
            self.rank[r] = Self::NOTHING;
        }
    }

    #[inline(always)]
    fn limit_at(&self, t: f32) -> f32 {
        let (after, before) = (t * self.pads[0], t * self.pads[1]);
        if after > before { after } else { before }
    }

    /// Whether a hit of the world would win.
    #[inline(always)]
    pub fn would_keep(&self, r: usize, t: f32, number: u32) -> bool {
        t < self.t[r] || (t == self.t[r] && number < self.rank[r])
    }

    /// Keep a hit of the world.
    #[inline(always)]
    pub fn keep(&mut self, r: usize, (t, u, v): (f32, f32, f32), number: u32) {
        (self.t[r], self.u[r], self.v[r]) = (t, u, v);
        self.rank[r] = number + 1;
        self.limit[r] = self.limit_at(t);
    }

    /// Keep any hit.
    pub fn keep_hit(&mut self, r: usize, hit: &Hit, numbers: &Numbers) {
        if hit.instance.is_world() {
            self.keep(r, (hit.t, hit.u, hit.v), numbers.of(hit.geometry, hit.primitive));
        } else {
            self.placed[r].write(*hit);
            self.t[r] = hit.t;
            self.rank[r] = Self::PLACED;
            self.limit[r] = self.limit_at(hit.t);
        }
    }

    /// The hit of a ray.
    #[inline(always)]
    pub fn hit(&self, r: usize, numbers: &Numbers) -> Option<Hit> {
        match self.rank[r] {
            Self::NOTHING => None,
            // SAFETY: written when the rank was.
            Self::PLACED => Some(unsafe { self.placed[r].assume_init() }),
            rank => {
                let (geometry, primitive) = numbers.ids(rank - 1);
                let (t, u, v) = (self.t[r], self.u[r], self.v[r]);
                Some(Hit { t, u, v, instance: InstancePath::WORLD, geometry, primitive })
            }
        }
    }
}
