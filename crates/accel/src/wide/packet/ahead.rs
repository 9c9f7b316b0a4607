//! Loading in time what the next packet needs: a packet of rays ends a page every now and then, and there the processor's own foresight
//! ends, too.

use super::PACKET;
use crate::hit::Hit;
use kirkas_geometry::Ray;

/// Lines of each kind that are loaded at a time; fewer than a processor can wait for at once.
const LINES: usize = 6;

/// What the next packet will touch, to be loaded little by little while this one is under way.
pub(super) struct Ahead {
    next: [*const i8; 2],
    lines: usize,
}

impl Ahead {
    /// Nothing is to come.
    pub const NOTHING: Ahead = Ahead { next: [core::ptr::null(); 2], lines: 0 };

    /// For these rays and the places of their hits.
    pub fn of(rays: &[Ray], hits: &[Option<Hit>]) -> Self {
        let bytes = size_of_val(rays).min(size_of_val(hits)).min(PACKET * size_of::<Ray>());
        Ahead { next: [rays.as_ptr().cast(), hits.as_ptr().cast()], lines: bytes / 64 }
    }

    /// Start to load a little more.
    #[inline(always)]
    pub fn load(&mut self) {
        for _ in 0..self.lines.min(LINES) {
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
