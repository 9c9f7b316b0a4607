//! Elementary functions that give the same bits on every platform: the `libm` crate, never the platform's.
//!
//! `f32` answers are the `f64` ones rounded, so they are almost always correctly rounded.

/// Sine, radians.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}
/// Cosine, radians.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
/// Tangent, radians.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}
/// Arc sine.
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}
/// Arc cosine, in `[0, pi]`.
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}
/// Arc tangent.
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}
/// Angle of the point `(x, y)`, in `[-pi, pi]`.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
/// e to the x.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}
/// Natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}
/// Base-2 logarithm.
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}
/// x to the y.
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}
/// The greatest whole number that is not above `x`; what is not finite stays. Processors of 2003 have no instruction for it, and what is compiled for
/// them as well calls a function instead.
#[inline]
pub fn floor(x: f64) -> f64 {
    // From here on there are whole numbers only.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    if !(x.abs() < WHOLE) {
        return x;
    }
    let cut = x as i64 as f64;
    if cut > x { cut - 1.0 } else { cut }
}

/// Cube root.
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// The error function: `2 / sqrt(pi)` times the integral of `exp(-t^2)` from 0 to x.
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}
/// What [`erf`] makes `x` of, for `-1 < x < 1`, to about 1e-6 of it (M. Giles, "Approximating the erfinv Function", GPU Computing
/// Gems, 2012).
pub fn erf_inverse(x: f32) -> f32 {
    const CENTRE: [f32; 9] = [
        2.810_226_4e-8,
        3.432_739_4e-7,
        -3.523_387_7e-6,
        -4.391_506_5e-6,
        2.185_808_7e-4,
        -1.253_725e-3,
        -4.177_681_6e-3,
        0.246_640_73,
        1.501_409_4,
    ];
    const TAIL: [f32; 9] = [
        -2.002_142_6e-4,
        1.009_505_6e-4,
        1.349_343_2e-3,
        -3.673_428_4e-3,
        5.739_507_7e-3,
        -7.622_461_3e-3,
        9.438_870_5e-3,
        1.001_674_1,
        2.832_976_8,
    ];
    let w = -ln_f32((1.0 - x) * (1.0 + x));
    let (w, polynomial) = if w < 5.0 { (w - 2.5, &CENTRE) } else { (w.sqrt() - 3.0, &TAIL) };
    polynomial.iter().fold(0.0, |sum, c| sum * w + c) * x
}

/// Sine and cosine of an f32 angle in radians.
pub fn sin_cos_f32(x: f32) -> (f32, f32) {
    let (s, c) = sin_cos(f64::from(x));
    (s as f32, c as f32)
}
/// Sine and cosine, radians, with an error below 1e-11: their Taylor polynomials after a reduction to an eighth of a turn. For drawing
/// directions, which is done all the time.
pub fn sin_cos(x: f64) -> (f64, f64) {
    const MOST: f64 = 1e4;
    if !(x.abs() <= MOST) {
        return libm::sincos(x);
    }
    // The nearest multiple of a quarter turn: adding and taking away 1.5 * 2^52 rounds to a whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    const QUARTER: f64 = core::f64::consts::FRAC_PI_2;
    let shifted = x * core::f64::consts::FRAC_2_PI + ROUNDER;
    let r = x - (shifted - ROUNDER) * QUARTER;
    let q = r * r;
    let s = 1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0 - q * (1.0 / 362_880.0 - q * (1.0 / 39_916_800.0))));
    let s = r - r * q * s;
    let c = 1.0 / 24.0 - q * (1.0 / 720.0 - q * (1.0 / 40_320.0 - q * (1.0 / 3_628_800.0 - q * (1.0 / 479_001_600.0))));
    let c = 1.0 - q * (0.5 - q * c);
    // Each quarter turn puts one in the other's place.
    let turns = shifted.to_bits();
    let (a, b) = if turns & 1 == 0 { (s, c) } else { (c, s) };
    let flip = |v: f64, is_negative: bool| if is_negative { -v } else { v };
    (flip(a, turns & 2 != 0), flip(b, (turns + 1) & 2 != 0))
}
/// e to the x.
pub fn exp_f32(x: f32) -> f32 {
    libm::exp(f64::from(x)) as f32
}
/// x to the y.
pub fn pow_f32(x: f32, y: f32) -> f32 {
    libm::pow(f64::from(x), f64::from(y)) as f32
}
/// Arc cosine, in `[0, pi]`.
pub fn acos_f32(x: f32) -> f32 {
    libm::acos(f64::from(x)) as f32
}
/// Angle of the point `(x, y)`, in `[-pi, pi]`.
pub fn atan2_f32(y: f32, x: f32) -> f32 {
    libm::atan2(f64::from(y), f64::from(x)) as f32
}
/// Natural logarithm.
pub fn ln_f32(x: f32) -> f32 {
    libm::log(f64::from(x)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_is_that_of_the_platform() {
        let bits = (0..200_000_u64).map(|i| f64::from_bits(crate::hash::mix64(i)));
        let near = (-2000..2000).flat_map(|i| [0.25, 0.5, 1.0, 4.5e15 / 2000.0].map(|s| f64::from(i) * s));
        let odd =
            [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, 4_503_599_627_370_495.5, -4_503_599_627_370_495.5, -1e-300];
        for x in bits.chain(near).chain(odd) {
            assert!(floor(x) == x.floor() || x.is_nan() && floor(x).is_nan(), "{x:e}");
        }
    }

    #[test]
    fn the_inverse_of_erf_undoes_it() {
        for i in -9999..=9999 {
            let x = i as f32 / 10_000.0;
            let y = f64::from(erf_inverse(x));
            let slope = 2.0 / core::f64::consts::PI.sqrt() * exp(-y * y);
            assert!((erf(y) - f64::from(x)).abs() <= 2e-6 * y.abs() * slope + 1e-9, "{x}: {y}");
        }
    }

    #[test]
    fn sine_and_cosine_of_f32_are_those_of_f64_rounded() {
        let mut wrong = 0;
        for i in -400_000..400_000 {
            let x = match i % 4 {
                0 => i as f32 * 1e-5,
                1 => i as f32 * 0.249,
                2 => (i as f32).powi(3) * 1e-15,
                _ => i as f32 * core::f32::consts::FRAC_PI_4,
            };
            let (s, c) = sin_cos_f32(x);
            let (s0, c0) = libm::sincos(f64::from(x));
            assert!((f64::from(s) - s0).abs() <= 6e-8 * s0.abs() + 1e-11, "sin {x}: {s} instead of {s0}");
            assert!((f64::from(c) - c0).abs() <= 6e-8 * c0.abs() + 1e-11, "cos {x}: {c} instead of {c0}");
            let (s1, c1) = sin_cos(f64::from(x));
            assert!((s1 - s0).abs() < 1e-11 && (c1 - c0).abs() < 1e-11, "{x}");
            wrong += u32::from(s != s0 as f32) + u32::from(c != c0 as f32);
        }
        // Most of them next to multiples of a quarter turn, where one of the two vanishes.
        assert!(wrong < 400, "{wrong} of 1.6 million are not the nearest");
        assert!(sin_cos_f32(f32::NAN).0.is_nan() && sin_cos_f32(f32::INFINITY).1.is_nan());
    }
}
