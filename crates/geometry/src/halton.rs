//! Owen-scrambled Halton points, as pure functions of their index.
//!
//! The pair is the radical inverse of the index in bases 2 and 3 (Halton 1960), each with its digits scrambled by hash
//! (Owen 1995). Each use shuffles the index, digit by digit in base 6: every aligned block of `6^k` indices maps onto one, so
//! any such block has one point in each box of `2^-a` by `3^-b` with `a = b = k`, and the uses are independent of each other.

use crate::hash::{combine, mix64, unit_f32};
use crate::low_discrepancy::owen_scramble_reversed;

/// Digits in base 6 that hold every index.
const INDEX_DIGITS: usize = 13;
/// Digits in base 3 that a number of 24 bits can show.
const DIGITS: u32 = 16;

/// Point `index` of the two-dimensional sequence that `seed` names, in `[0, 1)^2`.
pub fn owen_halton_2d(index: u32, seed: u64) -> (f32, f32) {
    let (x, y) = scrambled(index, seed);
    const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
    (unit_f32(x), ((f64::from(y) / f64::from(3_u32.pow(DIGITS))) as f32).min(BELOW_ONE))
}

/// The same before it is rounded: in units of `2^-32` and `3^-16`.
fn scrambled(index: u32, seed: u64) -> (u32, u32) {
    let s = mix64(seed);
    let shuffled = shuffled_in_base_6(index, mix64(s ^ 0x2545_f491_4f6c_dd1d));
    let x = owen_scramble_reversed(shuffled as u32, (s >> 32) as u32);
    (x, owen_inverse_base_3(shuffled, mix64(s ^ 0x5851_f42d_4c95_7f2d)))
}

/// The index with each digit permuted by a hash of the digits above it.
fn shuffled_in_base_6(index: u32, seed: u64) -> u64 {
    let mut digits = [0; INDEX_DIGITS];
    let mut rest = index;
    for d in digits.iter_mut().rev() {
        *d = rest % 6;
        rest /= 6;
    }
    let (mut shuffled, mut above) = (0, seed);
    for d in digits {
        shuffled = shuffled * 6 + u64::from(permuted(d, 6, above));
        above = combine(above, u64::from(d));
    }
    shuffled
}

/// The radical inverse in base 3 with nested uniform scrambling: each digit is permuted by a hash of those before it.
fn owen_inverse_base_3(index: u64, seed: u64) -> u32 {
    let (mut rest, mut value, mut before) = (index, 0, seed);
    for _ in 0..DIGITS {
        let digit = (rest % 3) as u32;
        value = value * 3 + permuted(digit, 3, before);
        before = combine(before, u64::from(digit));
        rest /= 3;
    }
    value
}

/// The place of `digit` in the permutation of `0..base` that `hash` names (Fisher & Yates); `base` is 6 at most.
fn permuted(digit: u32, base: u32, hash: u64) -> u32 {
    let (mut order, mut bits) = ([0, 1, 2, 3, 4, 5], mix64(hash));
    for last in (1..base).rev() {
        order.swap(last as usize, (bits % u64::from(last + 1)) as usize);
        bits /= u64::from(last + 1);
    }
    order[digit as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_permutation_is_one_and_every_order_is_as_likely() {
        let mut counts = [[0_u32; 6]; 6];
        for hash in 0..6000 {
            let order: Vec<u32> = (0..6).map(|d| permuted(d, 6, hash)).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3, 4, 5]);
            order.iter().enumerate().for_each(|(d, &p)| counts[d][p as usize] += 1);
        }
        assert!(counts.iter().flatten().all(|&c| (880..1120).contains(&c)), "{counts:?}");
    }

    #[test]
    fn every_block_of_a_power_of_six_fills_every_box() {
        for (k, first) in [(1, 0), (2, 0), (2, 36), (3, 432), (4, 1296 * 7)] {
            let (nx, ny) = (2_u32.pow(k), 3_u32.pow(k));
            for seed in 0..8 {
                let mut seen = vec![false; (nx * ny) as usize];
                for i in first..first + nx * ny {
                    let (x, y) = scrambled(i, seed);
                    let cell = (x >> (32 - k)) + nx * (y / 3_u32.pow(DIGITS - k));
                    assert!(!std::mem::replace(&mut seen[cell as usize], true), "{k} {first} {seed}");
                }
            }
        }
    }

    #[test]
    fn the_greatest_index_gives_a_point_of_the_square() {
        for seed in 0..1000 {
            let (x, y) = owen_halton_2d(u32::MAX, seed);
            assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
        }
    }
}
