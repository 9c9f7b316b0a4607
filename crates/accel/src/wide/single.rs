//! One ray at a time.

use super::Tree;
use super::backend::{Backend, Portable};
use super::walker::{Ground, Walker};
use crate::prepared_ray::PreparedRay;
use crate::search::{Enter, Level, Search};
use core::mem::MaybeUninit;

impl Tree {
    /// Search all that the tree holds; `enter` searches an instance.
    #[inline]
    pub fn search<const ANY: bool>(
        &self,
        level: Level,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        enter: Enter<ANY>,
    ) {
        let ground = Ground { tree: self, lines: self.lines.as_ptr(), level, enter };
        #[cfg(target_arch = "x86_64")]
        if self.has_avx2 {
            // SAFETY: `has_avx2` is only set where it was detected.
            return unsafe { walk_avx2(&ground, ray, search) };
        }
        // SAFETY: portable code needs nothing.
        unsafe { walk::<Portable, ANY>(&ground, ray, search) }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn walk_avx2<const ANY: bool>(ground: &Ground<ANY>, ray: &PreparedRay, search: &mut Search<ANY>) {
    // SAFETY: AVX2 and FMA are enabled here.
    unsafe { walk::<super::avx2::Avx2, ANY>(ground, ray, search) }
}

/// # Safety
/// The CPU has what `B` needs.
#[inline(always)]
unsafe fn walk<B: Backend, const ANY: bool>(ground: &Ground<ANY>, ray: &PreparedRay, search: &mut Search<ANY>) {
    let mut slot = MaybeUninit::uninit();
    let walker = Walker::start(&mut slot, ray, search, ground);
    let mut nodes_visited = 0;
    while !walker.place.is_end() {
        // SAFETY: the caller promises the CPU; places are tested before they are stepped on.
        unsafe {
            if walker.place.is_node() {
                walker.step_node::<B, ANY>(ground);
                nodes_visited += 1;
            } else {
                walker.step_leaf::<B, ANY>(ray, search, ground);
            }
        }
    }
    search.counters.nodes_visited += nodes_visited;
}
