//! Where primitives lie along a Morton curve, and the sort by that.

use crate::build::parallel::for_each;
use crate::build::reference::{Box4, Reference};
use crate::{Executor, memory};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A place on the curve in the upper 33 bits, the index of the reference in the lower 28.
pub(super) type Key = u64;
const INDEX_BITS: u32 = 28;
const BITS_PER_AXIS: u32 = 11;
/// Keys are sorted digit by digit.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;

/// The place on the curve.
#[inline(always)]
pub(super) fn code(key: Key) -> u64 {
    key >> INDEX_BITS
}

/// The index of the reference.
#[inline(always)]
pub(super) fn index(key: Key) -> usize {
    (key & ((1 << INDEX_BITS) - 1)) as usize
}

/// How many of so many references a job takes at once.
fn chunk_of(count: usize) -> usize {
    (count / 32).clamp(1 << 12, 1 << 16)
}

/// The keys of all references, ascending.
pub(super) fn sorted(references: &[Reference], executor: &dyn Executor) -> Vec<Key> {
    let grid = Grid::new(&center_bounds(references, executor));
    let mut keys: Vec<Key> = memory::filled(0, references.len());
    let size = chunk_of(references.len());
    let mut chunks: Vec<(usize, &mut [Key])> = keys.chunks_mut(size).enumerate().collect();
    for_each(&mut chunks, executor, &|(i, chunk)| {
        let first = *i * size;
        for (k, (key, r)) in chunk.iter_mut().zip(&references[first..]).enumerate() {
            *key = grid.key(r, first + k);
        }
    });
    radix_sort(keys, executor)
}

/// The keys of those references that `indices` names, ascending; `None` when all centers coincide.
pub(super) fn sorted_again(references: &[Reference], indices: impl Iterator<Item = usize> + Clone) -> Option<Vec<Key>> {
    let centers = indices.clone().fold(Box4::EMPTY, |b, i| with_center(b, &references[i]));
    let grid = Grid::new(&centers);
    let mut keys: Vec<Key> = (grid.scale > 0.0).then(|| indices.map(|i| grid.key(&references[i], i)).collect())?;
    keys.sort_unstable();
    Some(keys)
}

#[inline(always)]
fn with_center(b: Box4, r: &Reference) -> Box4 {
    let c = r.center();
    b.union(Box4 { lo: c, hi: c })
}

fn center_bounds(references: &[Reference], executor: &dyn Executor) -> Box4 {
    let mut parts: Vec<(&[Reference], Box4)> =
        references.chunks(chunk_of(references.len())).map(|c| (c, Box4::EMPTY)).collect();
    for_each(&mut parts, executor, &|(chunk, b)| *b = chunk.iter().fold(Box4::EMPTY, with_center));
    parts.iter().fold(Box4::EMPTY, |b, part| b.union(part.1))
}

/// Cubes over the box of the centers.
struct Grid {
    low: [f32; 3],
    /// Cubes per half a unit of length; 0 where the centers do not differ.
    scale: f32,
}

impl Grid {
    fn new(centers: &Box4) -> Self {
        let low = [0, 1, 2].map(|k| centers.lo.0[k] * 0.5);
        let sizes = [0, 1, 2].map(|k| centers.hi.0[k] * 0.5 - low[k]);
        let scale = ((1 << BITS_PER_AXIS) - 1) as f32 / sizes.into_iter().fold(0.0, f32::max);
        Grid { low, scale: if scale.is_finite() { scale } else { 0.0 } }
    }

    #[inline(always)]
    fn key(&self, r: &Reference, index: usize) -> Key {
        let c = r.center();
        let [x, y, z] = [0, 1, 2].map(|k| {
            let x = (c.0[k] * 0.5 - self.low[k]) * self.scale;
            // Adding 2^23 leaves the nearest integer in the low bits.
            u64::from((x + 8_388_608.0).to_bits() & ((1 << BITS_PER_AXIS) - 1))
        });
        (spread(x) << 2 | spread(y) << 1 | spread(z)) << INDEX_BITS | index as u64
    }
}

/// Two zeros after each of eleven bits.
#[inline(always)]
fn spread(x: u64) -> u64 {
    let x = (x | x << 16) & 0x0F00_00FF;
    let x = (x | x << 8) & 0x0F00_F00F;
    let x = (x | x << 4) & 0xC30C_30C3;
    (x | x << 2) & 0x2_4924_9249
}

/// Sort by the codes, the order of equal ones kept.
fn radix_sort(mut keys: Vec<Key>, executor: &dyn Executor) -> Vec<Key> {
    let mut sorted: Vec<Key> = memory::filled(0, keys.len());
    let size = chunk_of(keys.len());
    let mut parts: Vec<(usize, [u32; DIGITS])> = (0..keys.len()).step_by(size).map(|i| (i, [0; DIGITS])).collect();
    for shift in (INDEX_BITS..INDEX_BITS + 3 * BITS_PER_AXIS).step_by(DIGIT_BITS as usize) {
        let digit = |key: &Key| (key >> shift) as usize & (DIGITS - 1);
        let chunk = |first: usize| &keys[first..(first + size).min(keys.len())];
        for_each(&mut parts, executor, &|(first, counts)| {
            *counts = [0; DIGITS];
            chunk(*first).iter().for_each(|key| counts[digit(key)] += 1);
        });
        // From counts to the places where each chunk's keys of each digit go.
        let mut place = 0;
        for d in 0..DIGITS {
            for (_, counts) in &mut parts {
                place += core::mem::replace(&mut counts[d], place);
            }
        }
        let places = as_atomics(&mut sorted);
        for_each(&mut parts, executor, &|(first, next)| {
            for key in chunk(*first) {
                let next = &mut next[digit(key)];
                places[*next as usize].store(*key, Relaxed);
                *next += 1;
            }
        });
        core::mem::swap(&mut keys, &mut sorted);
    }
    keys
}

/// The same numbers for several threads to write, each its own.
fn as_atomics(keys: &mut [Key]) -> &[AtomicU64] {
    // SAFETY: an `AtomicU64` has the size and the valid bits of a `u64`, and while the result lives nothing else reaches
    // the keys.
    let (before, atomics, after) = unsafe { keys.align_to_mut::<AtomicU64>() };
    assert!(before.is_empty() && after.is_empty(), "allocations are aligned to 8 bytes");
    atomics
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::testing::{Backwards, random_boxes};

    #[test]
    fn spreading_puts_bit_i_at_3i() {
        for i in 0..BITS_PER_AXIS {
            assert_eq!(spread(1 << i), 1 << (3 * i));
        }
    }

    #[test]
    fn keys_are_sorted_and_each_is_there_once() {
        let references = random_boxes(100_000, 1);
        let keys = sorted(&references, &Serial);
        assert!(keys.is_sorted());
        let mut indices: Vec<usize> = keys.iter().map(|k| index(*k)).collect();
        indices.sort_unstable();
        assert!(indices.into_iter().eq(0..references.len()));
        assert_eq!(sorted(&references, &Backwards), keys);
        assert_eq!(sorted_again(&references, 0..references.len()), Some(keys));
    }
}
