//! Fixed-point numbers: sums that do not care about order.
//!
//! A contribution is rounded once, to a multiple of 2^-64, and added as a 128-bit integer. Integer sums give the same bits for
//! any order of threads, flocks, splits, merges and resumes.

/// Beyond this a contribution is absurd: it is reported, not added.
pub const LARGEST: f64 = (1_u64 << 40) as f64;

const UNIT: f64 = 18_446_744_073_709_551_616.0; // 2^64

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

/// The square of a sum in units of 2^-64, for second moments; at most `i128::MAX`.
pub fn square(sum: i128) -> i128 {
    let v = to_f64(sum);
    let square = v * v * UNIT;
    const SMALL: f64 = (1_u64 << 63) as f64;
    if square < SMALL { i128::from(square as u64) } else { square as i128 }
}

/// Back to a number.
pub fn square_to_f64(sum: i128) -> f64 {
    sum as f64 / UNIT
}

/// `sum * factor`, rounded once to the nearest, ties to even; at most `i128::MAX`. Nothing where the factor is no finite number.
pub fn scaled(sum: i128, factor: f64) -> i128 {
    let bits = factor.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    if exponent == 0 || exponent == 0x7ff {
        return 0;
    }
    // factor = mantissa * 2^-shift; the product has 181 bits at most.
    let mantissa = u128::from(bits & ((1 << 52) - 1) | 1 << 52);
    let magnitude = sum.unsigned_abs();
    let low = (magnitude & u128::from(u64::MAX)) * mantissa;
    let high = (magnitude >> 64) * mantissa + (low >> 64);
    let rounded = shifted(high >> 64, high << 64 | low & u128::from(u64::MAX), 1075 - exponent).min(i128::MAX as u128);
    if (sum < 0) != (factor < 0.0) { -(rounded as i128) } else { rounded as i128 }
}

/// (high * 2^128 + low) / 2^shift, rounded to the nearest, ties to even; at most `u128::MAX`. `high` has 53 bits at most.
fn shifted(high: u128, low: u128, shift: i32) -> u128 {
    let fits = |value: u128, by: u32| value == 0 || by <= value.leading_zeros();
    let (whole, rest) = match shift {
        // The rest is what is cut off, in units of 2^-128.
        ..=0 => match high == 0 && fits(low, shift.unsigned_abs()) {
            true => (low.checked_shl(shift.unsigned_abs()).unwrap_or(0), 0),
            false => return u128::MAX,
        },
        1..128 => match fits(high, 128 - shift as u32) {
            true => (high << (128 - shift) | low >> shift, low << (128 - shift)),
            false => return u128::MAX,
        },
        128 => (high, low),
        // What is below the last bit of `low` only breaks ties.
        129..256 => (high >> (shift - 128), high << (256 - shift) | low >> (shift - 128) | u128::from(low != 0)),
        _ => (0, 0),
    };
    const HALF: u128 = 1 << 127;
    whole + u128::from(rest > HALF || (rest == HALF && whole & 1 == 1))
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
        assert_eq!(square(from_f64(LARGEST).unwrap()), i128::MAX);
        for v in [3.0, 0.5, -1e-6, 1e9] {
            let square = square_to_f64(square(from_f64(v).unwrap()));
            assert!((square - v * v).abs() <= 1e-15 * v * v + 2.0_f64.powi(-64), "{v}: {square}");
        }
    }

    #[test]
    fn scaling_rounds_once_to_the_nearest() {
        for (sum, factor, expected) in [
            (12, 1.0, 12),
            (-12, 0.25, -3),
            (10, 0.25, 2),
            (14, 0.25, 4),
            (-7, -2.0, 14),
            (1 << 100, 2.0_f64.powi(-100), 1),
            (i128::MAX, 1.0, i128::MAX),
            (i128::MAX, 4.0, i128::MAX),
            (-i128::MAX, 2.0, -i128::MAX),
            (1, 2.0_f64.powi(126), 1 << 126),
            (1, 2.0_f64.powi(-2000), 0),
            (0, 1e300, 0),
            (5, f64::NAN, 0),
            (5, f64::INFINITY, 0),
            (3, 0.5, 2),
            (1, 0.5, 0),
            (1, 0.500_000_1, 1),
        ] {
            assert_eq!(scaled(sum, factor), expected, "{sum} * {factor}");
        }
        let mut bits = 0x3ff1_2345_6789_abcd_u64;
        for _ in 0..5000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let (sum, factor) = (i128::from(bits as i64 >> 20), f64::from(bits as u32) / 65_536.0);
            // Products of up to 52 bits times up to 32: exact in 128, factor in units of 2^-16.
            let exact = sum * i128::from(bits as u32);
            let (whole, rest) = (exact >> 16, exact & 0xffff);
            let up = rest > 0x8000 || (rest == 0x8000 && whole & 1 == 1);
            assert_eq!(scaled(sum, factor), whole + i128::from(up), "{sum} * {factor}");
        }
    }
}
