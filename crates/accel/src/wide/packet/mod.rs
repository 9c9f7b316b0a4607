//! Packets of rays that run close together, as camera rays do: 64 rays go down the tree as one. The boxes of a node are tested
//! against the packet as a whole, by interval arithmetic (Boulos, Wald & Shirley 2006, "Geometric and Arithmetic Culling Methods
//! for Entire Ray Packets"), all eight children at once; then a mask of the rays that enter a child goes down with it (Wald,
//! Slusallek, Benthin & Wagner 2001, "Interactive Rendering with Coherent Ray Tracing"). Leaves test eight rays at once where
//! many come, else eight triangles at once. Boxes only cull what no ray enters; so each ray gets the same answer as alone.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod backend;
mod found;
mod rays;

use super::Tree;
use super::arena;
use super::backend::{NO_KEY, Portable, Weights, key};
use super::in_flight::Batch;
use super::node::{Block, Node, Place};
use super::walker::{Ground, test_leaf};
use crate::hit::{Counters, Hit};
use crate::prepared_ray::PreparedRay;
use crate::search::{Enter, Search};
use backend::PacketBackend;
use core::mem::MaybeUninit;
use found::Found;
use kirkas_geometry::Ray;
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

/// What the next packet will touch, to be loaded little by little while this one is under way.
struct Ahead {
    next: [*const i8; 2],
    lines: usize,
}

impl Ahead {
    const NOTHING: Ahead = Ahead { next: [core::ptr::null(); 2], lines: 0 };

    fn of(rays: &[Ray], hits: &[Option<Hit>]) -> Self {
        let bytes = size_of_val(rays).min(size_of_val(hits)).min(PACKET * size_of::<Ray>());
        Ahead { next: [rays.as_ptr().cast(), hits.as_ptr().cast()], lines: bytes / 64 }
    }

    /// Start to load a little more.
    #[inline(always)]
    fn load(&mut self) {
        for _ in 0..self.lines.min(3) {
            self.lines -= 1;
            for next in &mut self.next {
                #[cfg(target_arch = "x86_64")]
                // SAFETY: prefetching has no effect on memory.
                unsafe {
                    use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
                    _mm_prefetch::<_MM_HINT_T0>(*next);
                }
                *next = next.wrapping_add(64);
            }
        }
    }
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
            loop {
                // SAFETY: the caller promises the CPU.
                let (key, child) = unsafe { B::least(&keys) };
                if key == NO_KEY {
                    break;
                }
                // SAFETY: the caller promises the CPU.
                keys = unsafe { B::without(&keys, child) }.0;
                // SAFETY: the node is valid.
                let inner = unsafe { (&(*node).children)[child & 7] };
                waiting[count].write(Waiting { among: inside, place: inner, parent: place, child: child as u8, key });
                count += 1;
            }
            waiting[from..count].reverse();

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

    /// Test what is in a leaf; true if something was found.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a leaf of the ground's tree.
    #[inline(always)]
    unsafe fn test_leaf<B: PacketBackend>(&mut self, place: Place, inside: u64, ground: &Ground<false>) -> bool {
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
    fn each(&mut self, mut some: u64, ground: &Ground<false>, test: impl Fn(&PreparedRay, &mut Search<false>)) {
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

/// What it costs to test 8 rays with a triangle, and a ray with 8 triangles.
const EIGHT_RAYS: usize = 1;
const EIGHT_TRIANGLES: usize = 2;

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
