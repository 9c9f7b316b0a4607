//! Fixed-point numbers: sums that do not care about order.
//!
//! A contribution is rounded once, to a multiple of 2^-64, and added as a 128-bit integer. Integer sums give the same bits for
//! any order of threads, flocks, splits, merges and resumes.

/// Beyond this a contribution is absurd: it is reported, not added.
pub const LARGEST: f64 = (1_u64 << 40) as f64;

const UNIT: f64 = 18_446_744_073_709_551_616.0; // 2^64
const SQUARE_UNIT: f64 = 4_294_967_296.0; // 2^32

/// `v` in units of 2^-64, rounded to the nearest, ties to even; `None` when it is not finite or absurdly large.
pub fn from_f64(v: f64) -> Option<i128> {
    if !(v.abs() <= LARGEST) {
        return None;
    }
    let bits = v.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    if exponent == 0 {
        return Some(0);
    }
    let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
    // v = mantissa * 2^(exponent - 1075), so in units of 2^-64 it is mantissa * 2^shift.
    let shift = exponent - 1075 + 64;
    let magnitude = if shift >= 0 {
        i128::from(mantissa) << shift
    } else if shift > -64 {
        let (whole, rest) = (mantissa >> -shift, mantissa & ((1 << -shift) - 1));
        let half = 1 << (-shift - 1);
        i128::from(whole + u64::from(rest > half || (rest == half && whole & 1 == 1)))
    } else {
        0
    };
    Some(if v < 0.0 { -magnitude } else { magnitude })
}

/// Back to a number, to within two roundings.
pub fn to_f64(sum: i128) -> f64 {
    let (high, low) = ((sum >> 64) as i64, sum as u64);
    high as f64 + low as f64 / UNIT
}

/// The square of a sum in units of 2^-32, for second moments.
pub fn square(sum: i128) -> i128 {
    let v = to_f64(sum);
    from_f64_scaled(v * v)
}

/// `v >= 0` in units of 2^-32; what a square of at most 2^80 needs.
fn from_f64_scaled(v: f64) -> i128 {
    const SMALL: f64 = (1_u64 << 30) as f64;
    if v < SMALL { i128::from((v * SQUARE_UNIT) as u64) } else { (v * SQUARE_UNIT) as i128 }
}

/// Back to a number.
pub fn square_to_f64(sum: i128) -> f64 {
    sum as f64 / SQUARE_UNIT
}

/// As four 32-bit words, lowest first: how images store it.
pub fn to_words(v: i128) -> [u32; 4] {
    std::array::from_fn(|i| (v as u128 >> (32 * i)) as u32)
}

/// Back from words.
pub fn from_words(w: [u32; 4]) -> i128 {
    w.iter().rev().fold(0_u128, |v, &x| v << 32 | u128::from(x)) as i128
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_words_round_trip() {
        for v in [0.0, 1.0, -1.5, 1e-12, 123_456.789, -1e9, 2.0_f64.powi(-64)] {
            let f = from_f64(v).unwrap();
            assert!((to_f64(f) - v).abs() <= v.abs() * 1e-15 + 2.0_f64.powi(-65));
            assert_eq!(from_words(to_words(f)), f);
        }
        assert_eq!(from_f64(2.0_f64.powi(-66)), Some(0));
        assert_eq!(from_f64(f64::MIN_POSITIVE / 4.0), Some(0));
    }

    #[test]
    fn rounding_is_to_the_nearest_ties_to_even() {
        let mut bits = 0x3ff1_2345_6789_abcd_u64;
        for i in 0..20_000_u64 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // Exponents around the unit and up to the largest.
            let exponent = 1023 - 70 + i % 110;
            let v = f64::from_bits(bits & 0x800f_ffff_ffff_ffff | exponent << 52);
            assert_eq!(from_f64(v), Some((v * UNIT).round_ties_even() as i128), "{v:e}");
        }
        for (units, rounded) in [(0.5, 0), (1.5, 2), (2.5, 2), (-0.5, 0), (-1.5, -2)] {
            assert_eq!(from_f64(units / UNIT), Some(rounded));
        }
    }

    #[test]
    fn nonsense_is_refused() {
        for v in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e13] {
            assert_eq!(from_f64(v), None);
        }
    }

    #[test]
    fn squares_of_large_sums_do_not_overflow() {
        let largest = from_f64(LARGEST).unwrap();
        assert!(square(largest).checked_mul(1 << 14).is_some());
        assert_eq!(square_to_f64(square(from_f64(3.0).unwrap())), 9.0);
    }
}
