//! Many rays in flight. A lone ray waits: for memory, and for the processor to find out where it goes. So about 16 rays are kept
//! under way in two work lists, "at a node" and "at a leaf"; each round steps every ray of one list once and starts to
//! load what its next step needs. A ray that is through makes room for the next one at once.

use super::Tree;
use super::arena;
use super::backend::{Backend, Portable, Weights};
use super::node::{Block, Place};
use super::walker::{Ground, Walker};
use crate::hit::{Counters, Hit};
use crate::prepared_ray::PreparedRay;
use crate::query::Query;
use crate::search::{Enter, Level, Search};
use core::mem::MaybeUninit;
use core::ops::Range;
use kirkas_geometry::Ray;

/// Rays under way at once.
const IN_FLIGHT: usize = 16;

/// A batch of rays and what is asked of them.
pub(crate) struct Batch<'a> {
    pub rays: &'a [Ray],
    pub query: Query<'a>,
    pub level: Level<'a>,
}

impl Tree {
    /// Search for each ray; `done` is told the hit of each, in any order.
    pub fn search_batch<const ANY: bool>(
        &self,
        batch: &Batch,
        enter: Enter<ANY>,
        counters: &mut Counters,
        done: impl FnMut(usize, Option<Hit>),
    ) {
        self.search_slice(batch, 0..batch.rays.len(), enter, counters, done);
    }

    /// Search for some rays of the batch.
    pub(super) fn search_slice<const ANY: bool>(
        &self,
        batch: &Batch,
        range: Range<usize>,
        enter: Enter<ANY>,
        counters: &mut Counters,
        done: impl FnMut(usize, Option<Hit>),
    ) {
        #[cfg(target_arch = "x86_64")]
        if self.has_avx2 {
            // SAFETY: `has_avx2` is only set where it was detected.
            return unsafe { fly_avx2::<ANY>(self, batch, range, enter, counters, done) };
        }
        // SAFETY: portable code needs nothing.
        unsafe { fly::<Portable, ANY>(self, batch, range, enter, counters, done) }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn fly_avx2<const ANY: bool>(
    tree: &Tree,
    batch: &Batch,
    waiting: Range<usize>,
    enter: Enter<ANY>,
    counters: &mut Counters,
    done: impl FnMut(usize, Option<Hit>),
) {
    // SAFETY: AVX2 and FMA are enabled here.
    unsafe { fly::<super::avx2::Avx2, ANY>(tree, batch, waiting, enter, counters, done) }
}

/// A ray under way.
struct Slot<'a, const ANY: bool> {
    walker: Walker,
    ray: PreparedRay,
    search: Search<'a, ANY>,
    /// Of the block where the ray is: the triangles whose edges it passes, and what weighs their corners.
    passing: u32,
    weights: MaybeUninit<Weights>,
}

/// Slots, by where their rays are: each as its distance in bytes from the first.
struct Lists {
    nodes: [u32; IN_FLIGHT],
    leaves: [u32; IN_FLIGHT],
}

/// How many are in each of the [`Lists`].
#[derive(Clone, Copy)]
struct Counts {
    nodes: usize,
    leaves: usize,
}

impl Lists {
    /// Put a slot where its ray's place says: written into both lists, counted in one, without a branch.
    #[inline(always)]
    fn sort(&mut self, place: Place, slot: u32, n: &mut Counts) {
        let is_node = usize::from(place.is_node());
        self.nodes[n.nodes & (IN_FLIGHT - 1)] = slot;
        self.leaves[n.leaves & (IN_FLIGHT - 1)] = slot;
        n.nodes += is_node;
        n.leaves += 1 - is_node;
    }
}

/// The rays that wait, and who is told of each.
struct Queue<'q, 'a, F> {
    batch: &'q Batch<'a>,
    waiting: Range<usize>,
    counters: &'q mut Counters,
    done: F,
}

impl<'a, F: FnMut(usize, Option<Hit>)> Queue<'_, 'a, F> {
    /// Let the next ray start in a slot; false when none waits.
    #[inline(always)]
    fn launch<const ANY: bool>(&mut self, s: *mut Slot<'a, ANY>, ground: &Ground<ANY>) -> bool {
        while let Some(index) = self.waiting.next() {
            let ray = &self.batch.rays[index];
            // SAFETY: a place for a ray, still to be written.
            let prepared = unsafe { &mut *(&raw mut (*s).ray).cast::<MaybeUninit<PreparedRay>>() };
            if !PreparedRay::prepare(prepared, ray, (ray.t_min, ray.t_max)) {
                self.counters.rays += 1;
                (self.done)(index, None);
                continue;
            }
            // SAFETY: the ray was written, and the other parts of the slot are before any is read.
            let slot = unsafe {
                (&raw mut (*s).search).write(Search::new(ray, index, self.batch.query));
                let walker = &mut *(&raw mut (*s).walker).cast::<MaybeUninit<Walker>>();
                Walker::start(walker, &(*s).ray, &mut (*s).search, ground);
                &mut *s
            };
            if !slot.walker.place.is_end() {
                return true;
            }
            self.finish(slot);
        }
        false
    }

    /// Tell what was found.
    #[inline(always)]
    fn finish<const ANY: bool>(&mut self, slot: &Slot<ANY>) {
        *self.counters += slot.search.counters;
        (self.done)(slot.search.ray_index, slot.search.best);
    }
}

/// # Safety
/// The CPU has what `B` needs.
#[inline(always)]
unsafe fn fly<'a, B: Backend, const ANY: bool>(
    tree: &Tree,
    batch: &Batch<'a>,
    waiting: Range<usize>,
    enter: Enter<ANY>,
    counters: &mut Counters,
    done: impl FnMut(usize, Option<Hit>),
) {
    let ground = Ground { tree, lines: tree.lines.as_ptr(), level: batch.level, enter };
    let mut slots: [MaybeUninit<Slot<'a, ANY>>; IN_FLIGHT] = [const { MaybeUninit::uninit() }; IN_FLIGHT];
    let first = slots.as_mut_ptr().cast::<Slot<'a, ANY>>();
    let mut queue = Queue { batch, waiting, counters, done };
    let mut lists = Lists { nodes: [0; IN_FLIGHT], leaves: [0; IN_FLIGHT] };
    let mut n = Counts { nodes: 0, leaves: 0 };
    for number in 0..IN_FLIGHT {
        let offset = number * size_of::<Slot<ANY>>();
        // SAFETY: within the slots.
        let slot = unsafe { first.byte_add(offset) };
        if !queue.launch(slot, &ground) {
            break;
        }
        // SAFETY: launched.
        lists.sort(unsafe { (*slot).walker.place }, offset as u32, &mut n);
    }
    // What stays in a list is written over what was already read.
    while n.nodes + n.leaves > 0 {
        if n.nodes >= n.leaves {
            let count = core::mem::take(&mut n.nodes);
            queue.counters.nodes_visited += count as u64;
            for i in 0..count {
                let offset = lists.nodes[i];
                // SAFETY: slots in the lists hold rays.
                let walker = unsafe { &mut (*first.byte_add(offset as usize)).walker };
                // SAFETY: this list holds rays at nodes; the caller promises the CPU.
                unsafe { walker.step_node_in_flight::<B, ANY>(&ground) };
                prefetch(&ground, walker.place);
                lists.sort(walker.place, offset, &mut n);
            }
        } else {
            // The edges of the triangles in each block,
            let count = core::mem::take(&mut n.leaves);
            let (mut passed, mut through) = ([0; IN_FLIGHT], [0; IN_FLIGHT]);
            let (mut n_passed, mut n_through) = (0, 0);
            for &offset in &lists.leaves[..count] {
                // SAFETY: slots in the lists hold rays.
                let slot = unsafe { &mut *first.byte_add(offset as usize) };
                let place = slot.walker.place;
                slot.passing = 0;
                if place.is_block() {
                    // SAFETY: the tree's places lead to what they say; the caller promises the CPU.
                    unsafe {
                        let block: *const Block = arena::get(ground.lines, place.line());
                        slot.search.counters.primitives_tested += place.count() as u64;
                        slot.passing = B::edges(block, &slot.ray, &mut slot.weights) & ((1 << place.count()) - 1);
                    }
                }
                passed[n_passed & (IN_FLIGHT - 1)] = offset;
                through[n_through & (IN_FLIGHT - 1)] = offset;
                n_passed += usize::from(slot.passing != 0);
                n_through += usize::from(slot.passing == 0);
            }
            // then the planes of those that are passed,
            for &offset in &passed[..n_passed] {
                // SAFETY: slots in the lists hold rays.
                let slot = unsafe { &mut *first.byte_add(offset as usize) };
                // SAFETY: the block that was looked at above.
                unsafe { cross::<B, ANY>(slot, &ground) };
                through[n_through & (IN_FLIGHT - 1)] = offset;
                n_through += 1;
            }
            // and on to what is left.
            for &offset in &through[..n_through] {
                // SAFETY: slots in the lists hold rays.
                let slot = unsafe { &mut *first.byte_add(offset as usize) };
                // SAFETY: the caller promises the CPU.
                unsafe { slot.walker.after_leaf::<B, ANY>(&slot.ray, &mut slot.search, &ground) };
                // Who is through makes room.
                if slot.walker.place.is_end() {
                    queue.finish(slot);
                    if !queue.launch(slot, &ground) {
                        continue;
                    }
                }
                prefetch(&ground, slot.walker.place);
                lists.sort(slot.walker.place, offset, &mut n);
            }
        }
    }
}

/// Offer the crossings with the triangles whose edges are passed.
///
/// # Safety
/// The ray is at a block, of which `passing` and `weights` speak; the CPU has what `B` needs.
#[inline(always)]
unsafe fn cross<B: Backend, const ANY: bool>(slot: &mut Slot<ANY>, ground: &Ground<ANY>) {
    // SAFETY: the caller promises as much.
    unsafe {
        let block: *const Block = arena::get(ground.lines, slot.walker.place.line());
        let mut passing = slot.passing;
        loop {
            let lane = passing.trailing_zeros() as usize & 7;
            passing &= passing - 1;
            if let Some(crossing) = B::crossing(block, lane, &slot.ray, slot.weights.assume_init_ref()) {
                let (geometry, index) = ground.tree.numbers.ids((&(*block).numbers)[lane]);
                slot.search.offer(ground.level, geometry, index, crossing);
            }
            if passing == 0 {
                return;
            }
        }
    }
}

/// Start to load what the next step needs.
#[inline(always)]
fn prefetch<const ANY: bool>(ground: &Ground<ANY>, place: Place) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: prefetching has no effect on memory, and the address is within the arena or its first line.
    unsafe {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let first = ground.lines.add(place.line()).cast::<i8>();
        _mm_prefetch::<_MM_HINT_T0>(first);
        _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(64));
        _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(128));
        _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(192));
        _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(256));
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (ground, place);
}
