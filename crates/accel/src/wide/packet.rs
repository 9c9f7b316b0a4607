//! Packets of rays that run close together, as camera rays do: 64 rays go down the tree as one. A node is tested against the
//! packet as a whole, by interval arithmetic (Boulos, Wald & Shirley 2006, "Geometric and Arithmetic Culling Methods for
//! Entire Ray Packets"), all eight children at once; the box of a leaf then tells which rays test what is in it. The interval test
//! only culls what no ray of the packet enters, since rounding is monotone; so each ray gets the same answer as alone.

use super::Tree;
use super::arena;
use super::backend::{Backend, Portable};
use super::in_flight::Batch;
use super::node::{Node, Place};
use super::walker::{Ground, test_leaf};
use crate::hit::{Counters, Hit};
use crate::prepared_ray::PreparedRay;
use crate::search::{Enter, Search};
use core::mem::MaybeUninit;
use core::ops::Range;

/// Rays in a packet.
pub(super) const PACKET: usize = 64;

/// What is common to the rays of a packet. All their directions have the same signs, and no component is 0.
pub(super) struct Frustum {
    /// Least and greatest, by axis.
    pub origin: [(f32, f32); 3],
    /// Least and greatest, by axis.
    pub inverse: [(f32, f32); 3],
    pub t_min: f32,
    /// 1 where the directions are negative.
    pub is_negative: [u32; 3],
}

impl Frustum {
    /// The least and the greatest distance to a plane.
    #[inline(always)]
    pub fn distances(&self, axis: usize, plane: f32) -> (f32, f32) {
        let (o, i) = (self.origin[axis], self.inverse[axis]);
        let (a, b) = (plane - o.0, plane - o.1);
        [a * i.0, a * i.1, b * i.0, b * i.1].into_iter().fold((f32::INFINITY, f32::NEG_INFINITY), |m, p| {
            (if p < m.0 { p } else { m.0 }, if p > m.1 { p } else { m.1 })
        })
    }
}

/// The rays of a packet as a structure of arrays, for tests of one box.
#[repr(C, align(32))]
pub(super) struct PacketRays {
    pub origin: [[f32; PACKET]; 3],
    pub inverse: [[f32; PACKET]; 3],
    pub t_min: [f32; PACKET],
    /// Negative infinity for what is not a ray, or has been answered.
    pub limit: [f32; PACKET],
    pub is_negative: [u32; 3],
}

/// A ray of the packet.
struct Member<'a> {
    ray: PreparedRay,
    search: Search<'a, false>,
}

/// A place that the packet has yet to look at.
#[derive(Clone, Copy)]
struct Waiting {
    place: Place,
    /// The node that holds its box, and where.
    parent: Place,
    child: u8,
    /// No ray enters it earlier.
    key: u16,
}

/// Levels times the children that wait on each.
const MOST_WAITING: usize = super::MAX_LEVELS * 7 + 8;

impl Tree {
    /// Search for each ray as [`Tree::search_batch`] does, in packets of what stands together in the batch. Packets whose
    /// rays go different ways are searched as batches.
    pub fn search_packets(
        &self,
        batch: &Batch,
        enter: Enter<false>,
        counters: &mut Counters,
        mut done: impl FnMut(usize, Option<Hit>),
    ) {
        for first in (0..batch.rays.len()).step_by(PACKET) {
            let range = first..batch.rays.len().min(first + PACKET);
            if !self.search_packet(batch, range.clone(), enter, counters, &mut done) {
                self.search_slice(batch, range, enter, counters, &mut done);
            }
        }
    }

    /// Search for one packet; false (and nothing done) when its rays are not of one mind.
    fn search_packet(
        &self,
        batch: &Batch,
        range: Range<usize>,
        enter: Enter<false>,
        counters: &mut Counters,
        done: &mut dyn FnMut(usize, Option<Hit>),
    ) -> bool {
        #[cfg(target_arch = "x86_64")]
        if self.has_avx2 {
            // SAFETY: `has_avx2` is only set where it was detected.
            return unsafe { pack_avx2(self, batch, range, enter, counters, done) };
        }
        // SAFETY: portable code needs nothing.
        unsafe { pack::<Portable>(self, batch, range, enter, counters, done) }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn pack_avx2(
    tree: &Tree,
    batch: &Batch,
    range: Range<usize>,
    enter: Enter<false>,
    counters: &mut Counters,
    done: &mut dyn FnMut(usize, Option<Hit>),
) -> bool {
    // SAFETY: AVX2 and FMA are enabled here.
    unsafe { pack::<super::avx2::Avx2>(tree, batch, range, enter, counters, done) }
}

/// Search for a packet; false (and nothing done) when its rays are not of one mind.
///
/// # Safety
/// The CPU has what `B` needs.
#[inline(always)]
unsafe fn pack<B: Backend>(
    tree: &Tree,
    batch: &Batch,
    range: Range<usize>,
    enter: Enter<false>,
    counters: &mut Counters,
    done: &mut dyn FnMut(usize, Option<Hit>),
) -> bool {
    let rays = &batch.rays[range.clone()];
    let ground = Ground { tree, lines: tree.lines.as_ptr(), level: batch.level, enter };
    if !tree.root.is_node() || tree.is_moving {
        return false;
    }
    let mut members: [MaybeUninit<Member>; PACKET] = [const { MaybeUninit::uninit() }; PACKET];
    let mut soa = PacketRays {
        origin: [[0.0; PACKET]; 3],
        inverse: [[1.0; PACKET]; 3],
        t_min: [0.0; PACKET],
        limit: [f32::NEG_INFINITY; PACKET],
        is_negative: [0; 3],
    };
    let mut frustum = Frustum {
        origin: [(f32::INFINITY, f32::NEG_INFINITY); 3],
        inverse: [(f32::INFINITY, f32::NEG_INFINITY); 3],
        t_min: f32::INFINITY,
        is_negative: [0; 3],
    };
    for (r, ray) in rays.iter().enumerate() {
        let Some(prepared) = PreparedRay::new(ray) else { return false };
        let is_negative = prepared.is_negative;
        if r == 0 {
            (soa.is_negative, frustum.is_negative) = (is_negative, is_negative);
        } else if is_negative != soa.is_negative {
            return false;
        }
        // Then no product of the interval test is NaN.
        if !prepared.inverse().is_finite() {
            return false;
        }
        let (o, i) = (prepared.clipped.origin.to_array(), prepared.inverse);
        for k in 0..3 {
            (soa.origin[k][r], soa.inverse[k][r]) = (o[k], i[k]);
            frustum.origin[k] = (frustum.origin[k].0.min(o[k]), frustum.origin[k].1.max(o[k]));
            frustum.inverse[k] = (frustum.inverse[k].0.min(i[k]), frustum.inverse[k].1.max(i[k]));
        }
        soa.t_min[r] = prepared.clipped.t_min;
        soa.limit[r] = prepared.clipped.t_max;
        frustum.t_min = frustum.t_min.min(prepared.clipped.t_min);
        let mut search = Search::new(ray, range.start + r, batch.query);
        for record in &tree.unbounded {
            record.test(batch.level, &prepared, &mut search, enter);
        }
        soa.limit[r] = ground.limit(&prepared, &search);
        members[r].write(Member { ray: prepared, search });
    }
    // SAFETY: all were written.
    let members = unsafe { &mut *(&raw mut members[..rays.len()] as *mut [Member]) };

    let mut waiting = [Waiting { place: Place::END, parent: Place::END, child: 0, key: 0 }; MOST_WAITING];
    let mut count = 0;
    let mut limit = soa.limit.iter().fold(f32::NEG_INFINITY, |m, l| if *l > m { *l } else { m });
    let mut place = tree.root;
    loop {
        if place.is_node() {
            counters.nodes_visited += 1;
            // SAFETY: the place is that of a node of this tree.
            let node: *const Node = unsafe { arena::get(ground.lines, place.line()) };
            // SAFETY: the node is valid, and the caller promises the CPU.
            let mut keys = unsafe { B::packet_boxes(node, &frustum, limit) };
            // The farthest is put away first.
            let from = count;
            loop {
                // SAFETY: the caller promises the CPU.
                let (key, child) = unsafe { B::least(&keys) };
                if key == super::backend::NO_KEY {
                    break;
                }
                // SAFETY: the caller promises the CPU.
                keys = unsafe { B::without(&keys, child) }.0;
                // SAFETY: the node is valid.
                let inner = unsafe { (&(*node).children)[child & 7] };
                waiting[count] = Waiting { place: inner, parent: place, child: child as u8, key };
                count += 1;
            }
            waiting[from..count].reverse();
        }
        // Take up the nearest that some ray may enter.
        loop {
            if count == 0 {
                for m in members.iter() {
                    *counters += m.search.counters;
                    done(m.search.ray_index, m.search.best);
                }
                return true;
            }
            count -= 1;
            let next = waiting[count];
            if next.key > super::backend::key(limit) {
                continue;
            }
            // SAFETY: what waits has the node that it was found in as its parent.
            let parent: *const Node = unsafe { arena::get(ground.lines, next.parent.line()) };
            // SAFETY: the node is valid, and the caller promises the CPU.
            let mut inside = unsafe { B::rays_in_box(parent, next.child as usize, &soa) };
            if inside == 0 {
                continue;
            }
            if next.place.is_node() {
                place = next.place;
                break;
            }
            while inside != 0 {
                let r = inside.trailing_zeros() as usize;
                inside &= inside - 1;
                let Member { ray, search } = &mut members[r];
                // SAFETY: what is no node is a leaf of this tree (it has no nodes of what moves), and the caller promises the CPU.
                unsafe { test_leaf::<B, false>(next.place, ray, search, &ground) };
                soa.limit[r] = ground.limit(ray, search);
            }
            limit = soa.limit.iter().fold(f32::NEG_INFINITY, |m, l| if *l > m { *l } else { m });
        }
    }
}
