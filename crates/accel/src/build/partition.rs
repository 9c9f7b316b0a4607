//! Puts the references of one side first. What is large is taken chunk by chunk, so that threads can share it; the order
//! that results depends on the size of the chunks, not on the threads.

use super::parallel::for_each;
use super::reference::{Box4, Reference};
use crate::Executor;

/// References that one thread handles at a time: 128 kilobytes.
pub(crate) const CHUNK: usize = 1 << 12;

/// Put those for which `left` holds first; returns how many they are. Without a branch on the data.
#[inline(always)]
pub(crate) fn partition(references: &mut [Reference], left: impl Fn(&Reference) -> bool) -> usize {
    let mut count = 0;
    for i in 0..references.len() {
        let goes_left = left(&references[i]);
        references.swap(i, count);
        count += usize::from(goes_left);
    }
    count
}

/// The box around the centers.
#[inline(always)]
pub(crate) fn centers(references: &[Reference]) -> Box4 {
    let with = |b: Box4, r: &Reference| {
        let c = r.center();
        Box4 { lo: b.lo.min(c), hi: b.hi.max(c) }
    };
    // Two at a time, lest each wait for the one before.
    let (pairs, rest) = references.as_chunks::<2>();
    let [even, odd] = pairs.iter().fold([Box4::EMPTY; 2], |[even, odd], [a, b]| [with(even, a), with(odd, b)]);
    rest.iter().fold(even.union(odd), with)
}

/// Cut in two, a whole number of chunks first; `None` when it is one chunk.
pub(crate) fn cut<T>(items: &[T]) -> Option<usize> {
    (items.len() > CHUNK).then(|| items.len().div_ceil(CHUNK) / 2 * CHUNK)
}

/// One chunk after its partition.
#[derive(Clone, Copy)]
struct Chunk {
    left_count: usize,
    centers: [Box4; 2],
}

/// [`partition`] with any number of threads; returns also the boxes around both sides' centers.
pub(crate) fn partition_in_chunks(
    references: &mut [Reference],
    left: &(dyn Fn(&mut [Reference]) -> usize + Sync),
    executor: &dyn Executor,
) -> (usize, [Box4; 2]) {
    let mut chunks = vec![Chunk { left_count: 0, centers: [Box4::EMPTY; 2] }; references.len().div_ceil(CHUNK)];
    partition_each(references, &mut chunks, left, executor);
    let left_count = chunks.iter().map(|c| c.left_count).sum();
    for_each(&mut misplaced(references, &chunks, left_count), executor, &|(a, b)| a.swap_with_slice(b));
    let side = |s: usize| chunks.iter().fold(Box4::EMPTY, |all, c| all.union(c.centers[s]));
    (left_count, [side(0), side(1)])
}

fn partition_each(
    references: &mut [Reference],
    chunks: &mut [Chunk],
    left: &(dyn Fn(&mut [Reference]) -> usize + Sync),
    executor: &dyn Executor,
) {
    if let Some(middle) = cut(references) {
        let (a, b) = references.split_at_mut(middle);
        let (chunks_a, chunks_b) = chunks.split_at_mut(middle / CHUNK);
        executor.join(&mut || partition_each(a, chunks_a, left, executor), &mut || {
            partition_each(b, chunks_b, left, executor)
        });
    } else {
        let left_count = left(references);
        let (a, b) = references.split_at(left_count);
        chunks[0] = Chunk { left_count, centers: [centers(a), centers(b)] };
    }
}

type Pair<'a> = (&'a mut [Reference], &'a mut [Reference]);

/// Runs of equal length to be exchanged: such as belong right before `left_count`, such as belong left after it.
fn misplaced<'a>(references: &'a mut [Reference], chunks: &[Chunk], left_count: usize) -> Vec<Pair<'a>> {
    let total = references.len();
    let (mut low, mut high) = references.split_at_mut(left_count);
    let (mut low_at, mut high_at) = (0, left_count);
    let (mut to_right, mut to_left) = (Vec::new(), Vec::new());
    for (i, chunk) in chunks.iter().enumerate() {
        let (begin, end) = (i * CHUNK, total.min((i + 1) * CHUNK));
        let middle = begin + chunk.left_count;
        if middle < end.min(left_count) {
            to_right.push(take(&mut low, &mut low_at, middle, end.min(left_count)));
        }
        if begin.max(left_count) < middle {
            to_left.push(take(&mut high, &mut high_at, begin.max(left_count), middle));
        }
    }
    let mut pairs = Vec::new();
    let (mut rights, mut lefts) = (to_right.into_iter(), to_left.into_iter());
    let (mut right, mut left): Pair = (&mut [], &mut []);
    loop {
        if right.is_empty() {
            let Some(next) = rights.next() else { return pairs };
            right = next;
        }
        if left.is_empty() {
            left = lefts.next().expect("as many belong left as belong right");
        }
        let len = right.len().min(left.len());
        let (a, rest) = right.split_at_mut(len);
        right = rest;
        let (b, rest) = left.split_at_mut(len);
        left = rest;
        pairs.push((a, b));
    }
}

/// `begin..end` of what begins at `at`; leaves what follows.
fn take<'a>(rest: &mut &'a mut [Reference], at: &mut usize, begin: usize, end: usize) -> &'a mut [Reference] {
    let (taken, after) = core::mem::take(rest).split_at_mut(end - *at);
    let taken = &mut taken[begin - *at..];
    (*rest, *at) = (after, end);
    taken
}
