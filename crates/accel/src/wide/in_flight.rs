//! Many rays in flight. A lone ray waits: for memory, and for the processor to find out where it goes. So about 16 rays are kept
//! under way in two work lists, "at a node" and "at a leaf"; each round steps every ray of one list once and starts to
//! load what its next step needs. A ray that is through makes room for the next one at once.

use super::Tree;
use super::backend::{Backend, Portable};
use super::node::Place;
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
}

/// Slots, by where their rays are.
struct Lists {
    nodes: [u32; IN_FLIGHT],
    leaves: [u32; IN_FLIGHT],
    ended: [u32; IN_FLIGHT],
}

/// How many are in each of the [`Lists`].
#[derive(Clone, Copy)]
struct Counts {
    nodes: usize,
    leaves: usize,
    ended: usize,
}

impl Lists {
    /// Put a slot where its ray's place says: written into all lists, counted in one, without a branch.
    #[inline(always)]
    fn sort(&mut self, place: Place, slot: u32, n: &mut Counts) {
        let (is_node, is_end) = (usize::from(place.is_node()), usize::from(place.is_end()));
        self.nodes[n.nodes & (IN_FLIGHT - 1)] = slot;
        self.leaves[n.leaves & (IN_FLIGHT - 1)] = slot;
        self.ended[n.ended & (IN_FLIGHT - 1)] = slot;
        n.nodes += is_node;
        n.ended += is_end;
        n.leaves += 1 - is_node - is_end;
    }
}

/// # Safety
/// The CPU has what `B` needs.
#[inline(always)]
unsafe fn fly<'a, B: Backend, const ANY: bool>(
    tree: &Tree,
    batch: &Batch<'a>,
    mut waiting: Range<usize>,
    enter: Enter<ANY>,
    counters: &mut Counters,
    mut done: impl FnMut(usize, Option<Hit>),
) {
    let ground = Ground { tree, lines: tree.lines.as_ptr(), level: batch.level, enter };
    let mut slots: [MaybeUninit<Slot<'a, ANY>>; IN_FLIGHT] = [const { MaybeUninit::uninit() }; IN_FLIGHT];
    let mut lists = Lists { nodes: [0; IN_FLIGHT], leaves: [0; IN_FLIGHT], ended: [0; IN_FLIGHT] };
    // At first no slot has a ray, which is as if all had ended.
    let mut n = Counts { nodes: 0, leaves: 0, ended: IN_FLIGHT };
    lists.ended = core::array::from_fn(|i| i as u32);
    loop {
        // Who is through makes room.
        let ended = lists.ended;
        let count = core::mem::take(&mut n.ended);
        for &number in &ended[..count] {
            let slot = &mut slots[number as usize];
            for index in waiting.by_ref() {
                let ray = &batch.rays[index];
                let s = slot.as_mut_ptr();
                // SAFETY: a place for a ray, still to be written.
                let prepared = unsafe { &mut *(&raw mut (*s).ray).cast::<MaybeUninit<PreparedRay>>() };
                if !PreparedRay::prepare(prepared, ray, (ray.t_min, ray.t_max)) {
                    counters.rays += 1;
                    done(index, None);
                    continue;
                }
                // SAFETY: the ray was written, and the other parts of the slot are before any is read.
                let slot = unsafe {
                    (&raw mut (*s).search).write(Search::new(ray, index, batch.query));
                    let walker = &mut *(&raw mut (*s).walker).cast::<MaybeUninit<Walker>>();
                    Walker::start(walker, &(*s).ray, &mut (*s).search, &ground);
                    &mut *s
                };
                if slot.walker.place.is_end() {
                    *counters += slot.search.counters;
                    done(index, slot.search.best);
                    continue;
                }
                lists.sort(slot.walker.place, number, &mut n);
                break;
            }
        }
        if n.nodes + n.leaves == 0 {
            return;
        }
        // What stays in a list is written over what was already read.
        if n.nodes >= n.leaves {
            let count = core::mem::take(&mut n.nodes);
            counters.nodes_visited += count as u64;
            for i in 0..count {
                let number = lists.nodes[i];
                // SAFETY: slots in the lists were filled.
                let walker = unsafe { &mut slots.get_unchecked_mut(number as usize).assume_init_mut().walker };
                // SAFETY: this list holds rays at nodes; the caller promises the CPU.
                unsafe { walker.step_node::<B, ANY>(&ground) };
                prefetch(&ground, walker.place);
                lists.sort(walker.place, number, &mut n);
            }
        } else {
            let count = core::mem::take(&mut n.leaves);
            for i in 0..count {
                let number = lists.leaves[i];
                // SAFETY: slots in the lists were filled.
                let slot = unsafe { slots.get_unchecked_mut(number as usize).assume_init_mut() };
                // SAFETY: this list holds rays at leaves and nodes of what moves; the caller promises the CPU.
                unsafe { slot.walker.step_leaf::<B, ANY>(&slot.ray, &mut slot.search, &ground) };
                prefetch(&ground, slot.walker.place);
                lists.sort(slot.walker.place, number, &mut n);
            }
        }
        for &number in &lists.ended[..n.ended] {
            // SAFETY: slots in the lists were filled.
            let search = unsafe { &slots[number as usize].assume_init_ref().search };
            *counters += search.counters;
            done(search.ray_index, search.best);
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
