//! Memory for large arrays. Where the system has pages of 2 MB and asks to be told where they pay, it is told: a build then
//! spends less on first touches, and rays find their way to an address sooner.

/// Arrays of fewer bytes than this are left alone.
#[cfg(target_os = "linux")]
const LARGE: usize = 1 << 21;

/// An empty vector with room for `count`, in large pages if that is much.
pub(crate) fn with_capacity<T>(count: usize) -> Vec<T> {
    let mut items = Vec::with_capacity(count);
    prefer_large_pages(items.spare_capacity_mut());
    items
}

/// A vector of `count` times the same, in large pages if that is much.
pub(crate) fn filled<T: Clone>(item: T, count: usize) -> Vec<T> {
    let mut items = with_capacity(count);
    items.resize(count, item);
    items
}

#[cfg(target_os = "linux")]
fn prefer_large_pages<T>(items: &mut [T]) {
    use core::ffi::{c_int, c_void};
    unsafe extern "C" {
        fn madvise(start: *mut c_void, bytes: usize, advice: c_int) -> c_int;
    }
    const MADV_HUGEPAGE: c_int = 14;
    const PAGE: usize = 1 << 12;
    let bytes = size_of_val(items);
    if bytes < LARGE {
        return;
    }
    let start = items.as_mut_ptr().cast::<u8>();
    let before = start.addr() % PAGE;
    // SAFETY: the advice changes nothing but the size of the pages around memory that is ours. Where it is refused, because
    // the system has no such pages or larger small ones, nothing happens.
    unsafe { madvise(start.wrapping_sub(before).cast(), before + bytes, MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn prefer_large_pages<T>(_: &mut [T]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_and_small_arrays_hold_what_is_put_in() {
        for count in [0, 1, 1000, 1 << 20] {
            let room = with_capacity::<u64>(count);
            assert!(room.is_empty() && room.capacity() >= count);
            let mut items = filled(7_u64, count);
            items.iter_mut().enumerate().for_each(|(i, item)| *item += i as u64);
            assert!(items.into_iter().eq(7..7 + count as u64));
        }
    }
}
