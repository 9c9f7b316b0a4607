//! Cuts the sorted order into leaves: the blocks of the curve that hold no more than a leaf does, as large as they go.

use super::codes::{self, Key, code, index};
use crate::build::binary::MAX_LEAF;
use crate::build::reference::Reference;
use std::ops::Range;

/// What still lies in one cell after so many finer grids is cut without regard for place.
const MAX_GRIDS: usize = 6;

/// Ranges of about `size` keys that begin and end where leaves do.
pub(super) fn cuts(keys: &[Key], size: usize) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut first = 0;
    while first < keys.len() {
        let end = (first + size..keys.len()).find(|&at| is_cut(keys, at)).unwrap_or(keys.len());
        ranges.push(first..end);
        first = end;
    }
    ranges
}

/// True when no leaf holds both the key at `at` and the one before.
fn is_cut(keys: &[Key], at: usize) -> bool {
    let Some(bit) = (code(keys[at - 1]) ^ code(keys[at])).checked_ilog2() else { return false };
    let in_block = |key: &&Key| (code(**key) ^ code(keys[at])) >> bit >> 1 == 0;
    let before = keys[..at].iter().rev().take(MAX_LEAF).take_while(in_block).count();
    let after = keys[at..].iter().take(MAX_LEAF).take_while(in_block).count();
    before + after > MAX_LEAF
}

/// Append the order of the references in `range`, which begins and ends where leaves do, and call `leaf` with each leaf's
/// run in that order.
pub(super) fn scan(
    keys: &[Key],
    range: Range<usize>,
    references: &[Reference],
    order: &mut Vec<u32>,
    leaf: &mut dyn FnMut(&[u32], Range<usize>),
) {
    scan_grid(keys, range, references, order, leaf, 1);
}

fn scan_grid(
    keys: &[Key],
    range: Range<usize>,
    references: &[Reference],
    order: &mut Vec<u32>,
    leaf: &mut dyn FnMut(&[u32], Range<usize>),
    grid: usize,
) {
    let mut at = range.start;
    while at < range.end {
        let own = code(keys[at]);
        let differs = |other: Option<&Key>| other.map_or(u64::MAX, |key| code(*key) ^ own);
        // The largest block that begins here and holds no more than a leaf does.
        let nearest = differs(keys.get(at + MAX_LEAF)).min(differs(at.checked_sub(1).and_then(|i| keys.get(i))));
        let Some(bit) = nearest.checked_ilog2() else {
            at = scan_cell(keys, at..range.end, references, order, leaf, grid);
            continue;
        };
        let begin = order.len();
        while at < range.end && (code(keys[at]) ^ own) >> bit == 0 {
            order.push(index(keys[at]) as u32);
            at += 1;
        }
        leaf(order, begin..order.len());
    }
}

/// More references share the first key's cell than a leaf holds. Returns where the cell ends.
#[cold]
fn scan_cell(
    keys: &[Key],
    range: Range<usize>,
    references: &[Reference],
    order: &mut Vec<u32>,
    leaf: &mut dyn FnMut(&[u32], Range<usize>),
    grid: usize,
) -> usize {
    let keys = &keys[range.clone()];
    let cell = &keys[..keys.iter().take_while(|key| code(**key) == code(keys[0])).count()];
    let finer = || codes::sorted_again(references, cell.iter().map(|key| index(*key)));
    match if grid < MAX_GRIDS { finer() } else { None } {
        Some(finer) => scan_grid(&finer, 0..finer.len(), references, order, leaf, grid + 1),
        None => {
            for run in cell.chunks(MAX_LEAF) {
                let begin = order.len();
                order.extend(run.iter().map(|key| index(*key) as u32));
                leaf(order, begin..order.len());
            }
        }
    }
    range.start + cell.len()
}
