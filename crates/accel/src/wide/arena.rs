//! The memory of a tree: 64-byte lines that hold nodes and leaves side by side, without pointers.

use super::node::{BLOCK_LINES, Block, LIST_LINES, List, MOTION_LINES, MotionNode, NODE_LINES, Node};
use std::mem::MaybeUninit;

/// One cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Line(pub [u32; 16]);

/// What may lie in an arena.
///
/// # Safety
/// Plain numbers only without padding, every bit pattern valid, a whole number of lines, aligned like a line.
pub(super) unsafe trait Item: Copy {
    const LINES: usize;
}

// SAFETY: `repr(C, align(64))`, of f32, u32 and u16 without padding (the sizes are checked below).
unsafe impl Item for Node {
    const LINES: usize = NODE_LINES;
}
// SAFETY: as above.
unsafe impl Item for MotionNode {
    const LINES: usize = MOTION_LINES;
}
// SAFETY: as above.
unsafe impl Item for Block {
    const LINES: usize = BLOCK_LINES;
}
// SAFETY: as above.
unsafe impl Item for List {
    const LINES: usize = LIST_LINES;
}
const _: () = assert!(
    size_of::<Node>() == 256 && size_of::<MotionNode>() == 448 && size_of::<Block>() == 320 && size_of::<List>() == 64
);

/// Write an item to its lines.
pub(super) fn put<T: Item>(lines: &mut [Line], item: &T) {
    assert!(lines.len() >= T::LINES, "room for the item");
    // SAFETY: there is room, lines are aligned for items, and items are plain numbers without padding.
    unsafe { lines.as_mut_ptr().cast::<T>().write(*item) };
}

/// Write an item to new lines, all of them.
pub(super) fn fill<T: Item>(lines: &mut [MaybeUninit<Line>], item: &T) {
    assert!(lines.len() == T::LINES, "room for the item and no more");
    // SAFETY: as above.
    unsafe { lines.as_mut_ptr().cast::<T>().write(*item) };
}

/// The item at a line.
///
/// # Safety
/// `line .. line + T::LINES` lies within the arena and holds a `T`.
#[inline(always)]
pub(super) unsafe fn get<T: Item>(lines: *const Line, line: usize) -> *const T {
    // SAFETY: the caller promises that the lines are there.
    unsafe { lines.add(line).cast::<T>() }
}

/// The item at a line, checked.
pub(super) fn read<T: Item>(lines: &[Line], line: usize) -> Option<&T> {
    let own = lines.get(line..line.checked_add(T::LINES)?)?;
    // SAFETY: the lines are there, aligned for items, and every bit pattern is one.
    Some(unsafe { &*own.as_ptr().cast::<T>() })
}
