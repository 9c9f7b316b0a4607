//! What a packet does at a leaf: triangles are tested with eight rays at once where many come, else eight triangles with each ray; all
//! else is tested one by one.

use super::super::arena;
use super::super::backend::Weights;
use super::super::in_flight::Batch;
use super::super::node::{Block, Place};
use super::super::walker::{Ground, test_leaf};
use super::Packet;
use super::backend::PacketBackend;
use super::found::Found;
use super::rays::Rays;
use crate::prepared_ray::PreparedRay;
use crate::search::Search;
use core::mem::MaybeUninit;

impl Packet<'_> {
    /// Test what is in a leaf; true if something was found.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a leaf of the ground's tree.
    #[inline(always)]
    pub unsafe fn test_leaf<B: PacketBackend>(&mut self, place: Place, inside: u64, ground: &Ground<false>) -> bool {
        if !place.is_block() {
            // SAFETY: the caller promises as much.
            self.each(inside, ground, |ray, search| unsafe { test_leaf::<B, false>(place, ray, search, ground) });
            return true;
        }
        // SAFETY: the caller promises that there is a block.
        let block: *const Block = unsafe { arena::get(ground.lines, place.line()) };
        let (count, rays) = (place.count(), inside.count_ones() as usize);
        self.counters.primitives_tested += (count * rays) as u64;
        if self.rays.has_one_axis && count * eights(inside) * EIGHT_RAYS < rays * EIGHT_TRIANGLES {
            // SAFETY: the caller promises the CPU and a block.
            unsafe { self.test_by_eights::<B>(block, count, inside, ground) }
        } else {
            // SAFETY: as above.
            unsafe { self.test_one_by_one::<B>(block, count, inside, ground) }
        }
    }

    /// Test a block's triangles, eight rays at a time.
    ///
    /// # Safety
    /// As for [`Packet::test_leaf`].
    #[inline(always)]
    unsafe fn test_by_eights<B: PacketBackend>(
        &mut self,
        block: *const Block,
        count: usize,
        inside: u64,
        ground: &Ground<false>,
    ) -> bool {
        let Packet { rays, found, batch, first, .. } = self;
        let mut any = false;
        // SAFETY: the caller promises the CPU and a block.
        unsafe {
            B::cross_block(block, count, rays, inside, |lane, eight, bits, crossings| {
                let number = (&(*block).numbers)[lane & 7];
                if is_plain(rays, batch, ground, number) {
                    any |= B::keep(found, eight, bits, crossings, number);
                    return;
                }
                for l in (0..8).filter(|l| bits >> l & 1 != 0) {
                    let crossing = (crossings.t[l], crossings.u[l], crossings.v[l]);
                    any |= offer(found, batch, *first, 8 * eight + l, number, crossing, ground);
                }
            });
        }
        any
    }

    /// Test a block's triangles, eight at once with each ray.
    ///
    /// # Safety
    /// As for [`Packet::test_leaf`].
    #[inline(always)]
    unsafe fn test_one_by_one<B: PacketBackend>(
        &mut self,
        block: *const Block,
        count: usize,
        mut inside: u64,
        ground: &Ground<false>,
    ) -> bool {
        let mut any = false;
        while inside != 0 {
            let r = inside.trailing_zeros() as usize;
            inside &= inside - 1;
            self.prepare(r);
            // SAFETY: prepared above.
            let ray = unsafe { self.single[r].assume_init_ref() };
            let mut weights = MaybeUninit::<Weights>::uninit();
            // SAFETY: the caller promises the CPU and a block.
            let mut passing = unsafe { B::edges(block, ray, &mut weights) } & ((1 << count) - 1);
            while passing != 0 {
                let lane = passing.trailing_zeros() as usize & 7;
                passing &= passing - 1;
                // SAFETY: the caller promises the CPU and a block; the weights were written by the edge test.
                let crossing = unsafe { B::crossing(block, lane, ray, weights.assume_init_ref()) };
                let Some(crossing) = crossing else { continue };
                // SAFETY: as above.
                let number = unsafe { (&(*block).numbers)[lane] };
                if is_plain(&self.rays, self.batch, ground, number) {
                    if self.found.would_keep(r, crossing.0, number) {
                        self.found.keep(r, crossing, number);
                        any = true;
                    }
                } else {
                    any |= offer(&mut self.found, self.batch, self.first, r, number, crossing, ground);
                }
            }
        }
        any
    }

    /// Make a ray ready to be tested alone.
    #[inline(always)]
    fn prepare(&mut self, r: usize) {
        if self.prepared >> r & 1 == 0 {
            self.prepared |= 1 << r;
            let ray = &self.batch.rays[self.first + r];
            let is_usable = PreparedRay::prepare(&mut self.single[r], ray, (ray.t_min, ray.t_max));
            assert!(is_usable, "rays that can hit nothing are not active");
        }
    }

    /// Search on with some rays, one by one.
    pub fn each(&mut self, mut some: u64, ground: &Ground<false>, test: impl Fn(&PreparedRay, &mut Search<false>)) {
        while some != 0 {
            let r = some.trailing_zeros() as usize;
            some &= some - 1;
            self.prepare(r);
            let mut search = resume(&self.found, self.batch, self.first, r, ground);
            // SAFETY: prepared above.
            test(unsafe { self.single[r].assume_init_ref() }, &mut search);
            search.counters.rays = 0;
            self.counters += search.counters;
            if let Some(best) = search.best {
                self.found.keep_hit(r, &best, &ground.tree.numbers);
            }
        }
    }
}

/// What it costs, about, to test 8 rays with a triangle, and a ray with 8 triangles.
const EIGHT_RAYS: usize = 1;
const EIGHT_TRIANGLES: usize = 3;

/// Eights of which some ray is in a mask.
#[inline(always)]
fn eights(mask: u64) -> usize {
    let mask = mask | mask >> 4;
    let mask = mask | mask >> 2;
    let mask = mask | mask >> 1;
    (mask & 0x0101_0101_0101_0101).count_ones() as usize
}

/// Whether any hit on this primitive counts, whichever ray of the packet hits it.
#[inline(always)]
fn is_plain(rays: &Rays, batch: &Batch, ground: &Ground<false>, number: u32) -> bool {
    let geometry = &ground.level.geometries[ground.tree.numbers.ids(number).0 as usize];
    geometry.mask & rays.mask != 0
        && (geometry.opaque || batch.query.filter.is_none())
        && batch.query.excluded.is_empty()
}

/// The search of one ray, as far as it has come.
fn resume<'a>(found: &Found, batch: &Batch<'a>, first: usize, r: usize, ground: &Ground<false>) -> Search<'a, false> {
    let mut search = Search::new(&batch.rays[first + r], first + r, batch.query);
    (search.best, search.limit) = (found.hit(r, &ground.tree.numbers), found.t[r]);
    search
}

/// Consider a crossing as single searches do; true if it was taken.
#[cold]
fn offer(
    found: &mut Found,
    batch: &Batch,
    first: usize,
    r: usize,
    number: u32,
    crossing: (f32, f32, f32),
    ground: &Ground<false>,
) -> bool {
    let mut search = resume(found, batch, first, r, ground);
    let (geometry, index) = ground.tree.numbers.ids(number);
    let before = search.best;
    search.offer(ground.level, geometry, index, crossing);
    if search.best == before {
        return false;
    }
    search.best.is_some_and(|best| {
        found.keep_hit(r, &best, &ground.tree.numbers);
        true
    })
}
