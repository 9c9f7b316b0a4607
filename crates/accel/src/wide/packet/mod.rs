//! Packets of rays that run close together, as camera rays do: 64 rays go down the tree as one. The boxes of a node are tested
//! against the packet as a whole, by interval arithmetic (Boulos, Wald & Shirley 2006, "Geometric and Arithmetic Culling Methods
//! for Entire Ray Packets"), all eight children at once; then a mask of the rays that enter a child goes down with it (Wald,
//! Slusallek, Benthin & Wagner 2001, "Interactive Rendering with Coherent Ray Tracing"). Leaves test eight rays at once where
//! many come, else eight triangles at once. Boxes only cull what no ray enters; so each ray gets the same answer as alone.

mod ahead;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx2_block;
mod backend;
mod found;
mod leaf;
mod rays;

use super::Tree;
use super::arena;
use super::backend::{NO_KEY, Portable, key};
use super::in_flight::Batch;
use super::node::{Node, Place};
use super::walker::Ground;
use crate::hit::{Counters, Hit};
use crate::prepared_ray::PreparedRay;
use crate::search::Enter;
use ahead::Ahead;
use backend::PacketBackend;
use core::mem::MaybeUninit;
use found::Found;
use rays::Rays;

/// Rays in a packet.
const PACKET: usize = 64;

/// A place that the packet has yet to look at.
#[derive(Clone, Copy)]
struct Waiting {
    /// The rays that entered its parent.
    among: u64,
    place: Place,
    /// The node that holds its box, and where.
    parent: Place,
    child: u8,
    /// No ray enters it earlier.
    key: u16,
}

/// Levels times the children that wait on each.
const MOST_WAITING: usize = super::MAX_LEVELS * 7 + 8;

/// A packet on its way.
struct Packet<'a> {
    rays: Rays,
    found: Found,
    /// Rays for tests of one at a time, prepared when they are first needed.
    single: [MaybeUninit<PreparedRay>; PACKET],
    /// A bit for each ray that is prepared.
    prepared: u64,
    batch: &'a Batch<'a>,
    /// Where in the batch they begin.
    first: usize,
    counters: Counters,
    ahead: Ahead,
}

impl Tree {
    /// Search for each ray as [`Tree::search_batch`] does, in packets of what stands together in the batch. Packets whose
    /// rays go different ways are searched as batches.
    pub fn search_packets(
        &self,
        batch: &Batch,
        enter: Enter<false>,
        counters: &mut Counters,
        hits: &mut [Option<Hit>],
    ) {
        if !self.root.is_node() || self.is_moving {
            return self.search_batch(batch, enter, counters, |i, hit| hits[i] = hit);
        }
        #[cfg(target_arch = "x86_64")]
        if self.has_avx2 {
            // SAFETY: `has_avx2` is only set where it was detected.
            return unsafe { pack_avx2(self, batch, enter, counters, hits) };
        }
        // SAFETY: portable code needs nothing.
        unsafe { pack::<Portable>(self, batch, enter, counters, hits) }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn pack_avx2(
    tree: &Tree,
    batch: &Batch,
    enter: Enter<false>,
    counters: &mut Counters,
    hits: &mut [Option<Hit>],
) {
    // SAFETY: AVX2 and FMA are enabled here.
    unsafe { pack::<super::avx2::Avx2>(tree, batch, enter, counters, hits) }
}

/// # Safety
/// The CPU has what `B` needs.
#[inline(always)]
unsafe fn pack<B: PacketBackend>(
    tree: &Tree,
    batch: &Batch,
    enter: Enter<false>,
    counters: &mut Counters,
    hits: &mut [Option<Hit>],
) {
    let ground = Ground { tree, lines: tree.lines.as_ptr(), level: batch.level, enter };
    let mut packet = Packet {
        rays: Rays::EMPTY,
        found: Found::EMPTY,
        single: [const { MaybeUninit::uninit() }; PACKET],
        prepared: 0,
        batch,
        first: 0,
        counters: Counters::default(),
        ahead: Ahead::NOTHING,
    };
    for first in (0..batch.rays.len()).step_by(PACKET) {
        let end = batch.rays.len().min(first + PACKET);
        // SAFETY: the caller promises the CPU.
        if !unsafe { packet.rays.load::<B>(&batch.rays[first..end], tree.reach) } {
            tree.search_slice(batch, first..end, enter, counters, |i, hit| hits[i] = hit);
            continue;
        }
        packet.found.clear(&packet.rays, tree.is_split);
        (packet.prepared, packet.first) = (0, first);
        packet.ahead = Ahead::of(batch.rays.get(end..).unwrap_or_default(), hits.get(end..).unwrap_or_default());
        // SAFETY: the caller promises the CPU, and the root is a node of a tree where nothing moves.
        unsafe { packet.walk::<B>(&ground) };
        for (r, hit) in hits[first..end].iter_mut().enumerate() {
            *hit = packet.found.hit(r, &tree.numbers);
        }
        packet.counters.rays += (end - first) as u64;
    }
    *counters += packet.counters;
}

impl Packet<'_> {
    /// Search for all rays of the packet.
    ///
    /// # Safety
    /// The CPU has what `B` needs; nothing moves in the tree, of which the root is a node.
    #[inline(always)]
    unsafe fn walk<B: PacketBackend>(&mut self, ground: &Ground<false>) {
        for record in &ground.tree.unbounded {
            self.each(self.rays.active, ground, |ray, search| record.test(ground.level, ray, search, ground.enter));
        }
        let mut waiting: [MaybeUninit<Waiting>; MOST_WAITING] = [const { MaybeUninit::uninit() }; MOST_WAITING];
        let mut count = 0;
        let (mut place, mut inside) = (ground.tree.root, self.rays.active);
        let mut limit = self.farthest();
        loop {
            // Put the children that rays enter away, the farthest first.
            self.counters.nodes_visited += 1;
            self.ahead.load();
            // SAFETY: the place is that of a node of this tree.
            let node: *const Node = unsafe { arena::get(ground.lines, place.line()) };
            // SAFETY: the node is valid, and the caller promises the CPU.
            let mut keys = unsafe { B::packet_boxes(node, &self.rays.frustum, limit) };
            let from = count;
            count += keys.0.iter().filter(|key| **key != NO_KEY).count();
            for entry in waiting[from..count].iter_mut().rev() {
                // SAFETY: the caller promises the CPU.
                let (key, child) = unsafe { B::least(&keys) };
                // SAFETY: the caller promises the CPU.
                keys = unsafe { B::without(&keys, child) }.0;
                // SAFETY: the node is valid.
                let inner = unsafe { (&(*node).children)[child & 7] };
                entry.write(Waiting { among: inside, place: inner, parent: place, child: child as u8, key });
            }

            // Take up the nearest that some ray enters.
            loop {
                if count == 0 {
                    return;
                }
                count -= 1;
                // SAFETY: those below the count were written.
                let next = unsafe { waiting[count].assume_init() };
                if next.key > key(limit) {
                    continue;
                }
                // SAFETY: what waits has the node that it was found in as its parent.
                let parent: *const Node = unsafe { arena::get(ground.lines, next.parent.line()) };
                let (child, limits) = (next.child as usize, &self.found.limit);
                // SAFETY: the node is valid, and the caller promises the CPU.
                inside = unsafe { B::rays_in_box(parent, child, &self.rays, limits, next.among) };
                if inside == 0 {
                    continue;
                }
                if next.place.is_node() {
                    place = next.place;
                    break;
                }
                self.ahead.load();
                // SAFETY: what is no node is a leaf of this tree, and the caller promises the CPU.
                if unsafe { self.test_leaf::<B>(next.place, inside, ground) } {
                    limit = self.farthest();
                }
            }
        }
    }

    /// No ray has a limit beyond this.
    #[inline(always)]
    fn farthest(&self) -> f32 {
        let mut most = [f32::NEG_INFINITY; 8];
        for eight in self.found.limit.as_chunks::<8>().0 {
            for (m, l) in most.iter_mut().zip(eight) {
                *m = if *l > *m { *l } else { *m };
            }
        }
        most.into_iter().fold(f32::NEG_INFINITY, |m, l| if l > m { l } else { m })
    }
}
