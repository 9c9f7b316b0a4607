//! Owen-scrambled Sobol' points, as pure functions of their index.
//!
//! The first two Sobol' dimensions form a (0, 2)-sequence. Each use of a pair shuffles the index and scrambles the digits
//! by hash (Burley 2020, "Practical Hash-based Owen Scrambling"), which keeps the net and decorrelates the uses. The
//! hash is Vegdahl's (2021) improvement of Laine & Karras (2011).

use crate::hash::{mix64, unit_f32};

/// Point `index` of the two-dimensional sequence that `seed` names, in `[0, 1)^2`.
#[inline]
pub fn owen_sobol_2d(index: u32, seed: u64) -> (f32, f32) {
    let s = mix64(seed);
    let shuffled = nested_uniform_shuffle(index, s as u32);
    let t = mix64(s ^ 0x5851_f42d_4c95_7f2d);
    let x = laine_karras(shuffled, (s >> 32) as u32);
    let y = laine_karras(sobol_second_reversed(shuffled), t as u32);
    // Both back to normal order at once.
    let both = (u64::from(x) << 32 | u64::from(y)).reverse_bits();
    (unit_f32(both as u32), unit_f32((both >> 32) as u32))
}

/// Point `index` of the one-dimensional sequence that `seed` names, in `[0, 1)`.
#[inline]
pub fn owen_sobol_1d(index: u32, seed: u64) -> f32 {
    let s = mix64(seed);
    unit_f32(owen_scramble_reversed(nested_uniform_shuffle(index, s as u32), (s >> 32) as u32))
}

/// Owen's scramble of the digits of a number given with its bits reversed; returns it in normal order.
pub(crate) fn owen_scramble_reversed(reversed: u32, seed: u32) -> u32 {
    laine_karras(reversed, seed).reverse_bits()
}

/// A random permutation of the index that maps every aligned power-of-two block onto one.
fn nested_uniform_shuffle(index: u32, seed: u32) -> u32 {
    laine_karras(index.reverse_bits(), seed).reverse_bits()
}

/// A hash whose every output bit depends on lower input bits only (Vegdahl 2021).
fn laine_karras(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x
}

/// The second Sobol' dimension (direction numbers of the polynomial `x + 1`: Pascal's triangle modulo 2), bits reversed.
///
/// By Lucas' theorem bit k is the sum of all index bits j whose position contains k's bits: a superset sum in five steps.
fn sobol_second_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^ (x >> 16) & 0x0000_ffff
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every elementary interval of area 1/n holds exactly one of the first n points.
    #[test]
    fn the_pair_is_a_zero_two_sequence_for_every_seed() {
        for seed in 0..20 {
            for log_n in [4_u32, 6, 8] {
                let n = 1_u32 << log_n;
                let points: Vec<_> = (0..n).map(|i| owen_sobol_2d(i, seed)).collect();
                for log_x in 0..=log_n {
                    let (nx, ny) = (1_u32 << log_x, 1_u32 << (log_n - log_x));
                    let mut seen = vec![false; n as usize];
                    for &(x, y) in &points {
                        let cell = (x * nx as f32) as u32 + nx * (y * ny as f32) as u32;
                        assert!(!std::mem::replace(&mut seen[cell as usize], true));
                    }
                }
            }
        }
    }

    /// The definition, direction number by direction number.
    fn sobol_second_simple(mut index: u32) -> u32 {
        let (mut result, mut v) = (0, 1_u32 << 31);
        while index != 0 {
            result ^= if index & 1 != 0 { v } else { 0 };
            index >>= 1;
            v ^= v >> 1;
        }
        result
    }

    #[test]
    fn the_superset_sum_is_the_second_dimension() {
        for i in (0..2000).chain((0..2000).map(|i: u32| i.wrapping_mul(0x9e37_79b9))) {
            assert_eq!(sobol_second_reversed(i).reverse_bits(), sobol_second_simple(i));
        }
    }

    #[test]
    fn one_number_is_the_first_of_the_pair() {
        assert!((0..1000).all(|i| owen_sobol_1d(i, 7) == owen_sobol_2d(i, 7).0));
    }

    #[test]
    fn seeds_are_independent() {
        let mean: f32 = (0..4096).map(|s| owen_sobol_1d(3, s)).sum::<f32>() / 4096.0;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
    }
}
