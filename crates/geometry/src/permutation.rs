//! Permutations of `0..n` by hash, one number at a time, without a table.

use crate::hash::combine;

/// So many that even permutations of four bits are near uniform.
const ROUNDS: usize = 4;

/// The place of `i < n` in the permutation of `0..n` that `seed` names.
///
/// A bijection of the numbers below the next power of two (multiply by odd numbers, add, fold the upper half down), walked
/// until it lands below `n` (Black & Rogaway 2002: cycle walking; Kensler 2013 shuffles samples so).
pub fn permuted(i: u64, n: u64, seed: u64) -> u64 {
    debug_assert!(i < n);
    if n <= 1 {
        return 0;
    }
    let bits = 64 - (n - 1).leading_zeros();
    let (mask, half) = (u64::MAX >> (64 - bits), bits.div_ceil(2));
    let keys: [u64; ROUNDS] = std::array::from_fn(|k| combine(seed, k as u64));
    let mut x = i;
    loop {
        for key in keys {
            x = x.wrapping_mul(key | 1).wrapping_add(key >> 32) & mask;
            x ^= x >> half;
            x = x.wrapping_mul(key >> 16 | 1) & mask;
            x ^= x >> 1;
        }
        if x < n {
            return x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::mix64;

    #[test]
    fn every_number_has_a_place_of_its_own() {
        for n in (1..70).chain([100, 255, 256, 257, 1000]) {
            for seed in 0..5 {
                let mut places: Vec<u64> = (0..n).map(|i| permuted(i, n, seed)).collect();
                places.sort_unstable();
                assert_eq!(places, (0..n).collect::<Vec<_>>());
            }
        }
        assert!(permuted((1 << 40) - 1, 1 << 40, 3) < 1 << 40);
    }

    #[test]
    fn every_pair_of_places_is_about_as_likely() {
        for n in [2_u64, 4, 5, 16] {
            let rounds = 2000 * n * n;
            let mut counts = vec![0_u32; (n * n) as usize];
            for seed in 0..rounds {
                let (a, b) = (permuted(0, n, mix64(seed)), permuted(n - 1, n, mix64(seed)));
                counts[(a * n + b) as usize] += 1;
            }
            let expected = rounds as f64 / (n * (n - 1)) as f64;
            for a in 0..n {
                for b in (0..n).filter(|&b| b != a) {
                    let share = f64::from(counts[(a * n + b) as usize]) / expected;
                    assert!((0.8..1.2).contains(&share), "{n}: {a} {b} {share}");
                }
            }
        }
    }
}
