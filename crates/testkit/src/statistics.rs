//! Tail probabilities, and the correction for testing many things at once.

use kirkas_geometry::elementary::{exp, ln, pow, sin};

/// The level for each of `tests` independent tests so that all together err with probability `level`
/// (Sidak 1967): `1 - (1 - level)^(1/tests)`.
pub fn sidak(level: f64, tests: usize) -> f64 {
    // Through the logarithm: 1 - (1 - x) would lose a small level. ln(1 - level) by its series where it cancels.
    let log = if level < 1e-4 { -level - level * level / 2.0 } else { ln(1.0 - level) };
    let x = log / tests as f64;
    if x > -1e-4 { -(x + x * x / 2.0 + x * x * x / 6.0) } else { 1.0 - exp(x) }
}

/// Probability that a chi-square variable with `degrees` of freedom exceeds `statistic`.
pub fn chi_square_tail(statistic: f64, degrees: usize) -> f64 {
    gamma_q(0.5 * degrees as f64, 0.5 * statistic)
}

/// Probability that a standard normal variable is farther than `|z|` from 0.
pub fn normal_two_sided_tail(z: f64) -> f64 {
    gamma_q(0.5, 0.5 * z * z)
}

/// The regularised upper incomplete gamma function `Q(a, x)`, `a > 0`, `x >= 0`: a series below `a + 1`, Lentz's
/// continued fraction above (Press et al., "Numerical Recipes", 3rd ed., section 6.2).
pub fn gamma_q(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    if x == f64::INFINITY {
        return 0.0;
    }
    let front = exp(a * ln(x) - x - ln_gamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-16 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - sum * front;
    }
    const TINY: f64 = 1e-300;
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut h = d;
    for i in 1..100_000 {
        let an = -f64::from(i) * (f64::from(i) - a);
        b += 2.0;
        d = an * d + b;
        d = 1.0 / if d.abs() < TINY { TINY } else { d };
        c = b + an / c;
        c = if c.abs() < TINY { TINY } else { c };
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    h * front
}

/// `ln Gamma(x)`, `x > 0` (Lanczos 1964, g = 7, 9 terms; relative error below 1e-14).
pub fn ln_gamma(x: f64) -> f64 {
    const C: [f64; 9] = [
        0.999_999_999_999_809_9,
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    if x < 0.5 {
        let pi = std::f64::consts::PI;
        return ln(pi / sin(pi * x)) - ln_gamma(1.0 - x);
    }
    let x = x - 1.0;
    let t = x + 7.5;
    let sum: f64 = C[0] + C.iter().enumerate().skip(1).map(|(i, c)| c / (x + i as f64)).sum::<f64>();
    ln(pow(2.0 * std::f64::consts::PI, 0.5) * sum) + (x + 0.5) * ln(t) - t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn near(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs().max(1e-3), "{a} is not {b}");
    }

    #[test]
    fn the_gamma_functions_meet_their_closed_forms() {
        near(ln_gamma(0.5), ln(std::f64::consts::PI) / 2.0);
        near(ln_gamma(5.0), ln(24.0));
        near(ln_gamma(0.25) + ln_gamma(0.75), ln(std::f64::consts::PI * 2.0_f64.sqrt()));
        // Q(1, x) = e^-x;  Q(2, x) = (1 + x) e^-x;  both branches.
        for x in [0.1, 1.9, 2.1, 30.0] {
            near(gamma_q(1.0, x), exp(-x));
            near(gamma_q(2.0, x), (1.0 + x) * exp(-x));
        }
        assert_eq!((gamma_q(3.0, 0.0), gamma_q(3.0, f64::INFINITY)), (1.0, 0.0));
    }

    #[test]
    fn tails_meet_the_tables() {
        // Abramowitz & Stegun, tables 26.8 and 26.1: 5 % points.
        assert!((chi_square_tail(3.841_458_820_694_124, 1) - 0.05).abs() < 1e-10);
        assert!((chi_square_tail(18.307_038_053_275_146, 10) - 0.05).abs() < 1e-10);
        assert!((chi_square_tail(124.342_113_404_004_07, 100) - 0.05).abs() < 1e-10);
        assert!((normal_two_sided_tail(-1.959_963_984_540_054) - 0.05).abs() < 1e-12);
    }

    #[test]
    fn sidak_gives_back_the_level_it_was_made_from() {
        near(sidak(0.05, 1), 0.05);
        near(sidak(0.05, 10), 0.005_116_196_891_823_089);
        // 1 - (1 - 1e-6)^(1e-6)
        near(sidak(1e-6, 1_000_000) / 1e-12, 1.000_000_5);
    }
}
