//! Fixed-point numbers: sums that do not care about order.
//!
//! A contribution is rounded once, to a multiple of 2^-64, and added as a 128-bit integer. Integer sums give the same bits for
//! any order of threads, flocks, splits, merges and resumes.

/// Beyond this a contribution is absurd: it is reported, not added.
pub const LARGEST: f64 = (1_u64 << 40) as f64;

const UNIT: f64 = 18_446_744_073_709_551_616.0; // 2^64
const SQUARE_UNIT: f64 = 4_294_967_296.0; // 2^32

/// `v` in units of 2^-64; `None` when it is not finite or absurdly large.
pub fn from_f64(v: f64) -> Option<i128> {
    (v.abs() <= LARGEST).then(|| (v * UNIT).round_ties_even() as i128)
}

/// Back to a number.
pub fn to_f64(sum: i128) -> f64 {
    sum as f64 / UNIT
}

/// The square of a sum in units of 2^-32, for second moments.
pub fn square(sum: i128) -> i128 {
    let v = to_f64(sum);
    (v * v * SQUARE_UNIT).round_ties_even() as i128
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
