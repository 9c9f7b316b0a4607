//! Integer hashes: small, portable, and good enough to decorrelate samples.

/// A 64-bit finaliser with full avalanche (Stafford 2011, "Mix13", as in SplitMix64).
#[inline]
pub const fn mix64(mut x: u64) -> u64 {
    x ^= x >> 30;
    x = x.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Fold `value` into the running hash `seed`.
#[inline]
pub const fn combine(seed: u64, value: u64) -> u64 {
    mix64(seed.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_add(mix64(value ^ 0xd1b5_4a32_d192_ed03)))
}

/// Hash of a name, usable in constants (FNV-1a, then mixed).
pub const fn of_name(name: &str) -> u64 {
    let bytes = name.as_bytes();
    let mut h = 0xcbf2_9ce4_8422_2325_u64;
    let mut i = 0;
    while i < bytes.len() {
        h = (h ^ bytes[i] as u64).wrapping_mul(0x0100_0000_01b3);
        i += 1;
    }
    mix64(h)
}

/// 32 random bits as a number in `[0, 1)`, exact.
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_changed_bit_changes_about_half_of_the_output() {
        let mut total = 0;
        for bit in 0..64 {
            total += (combine(7, 1 << bit) ^ combine(7, 0)).count_ones();
        }
        assert!((24 * 64..40 * 64).contains(&total));
        assert_ne!(of_name("lens"), of_name("time"));
    }

    #[test]
    fn the_largest_unit_float_is_below_one() {
        assert!(unit_f32(u32::MAX) < 1.0);
        assert_eq!(unit_f32(0), 0.0);
    }
}
