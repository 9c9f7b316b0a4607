//! Real roots of polynomials within an interval: between the roots of its derivative a polynomial rises or falls, so a change
//! of sign there is one root, found by Newton's method within the bracket.
//!
//! After Yuksel, "High-Performance Polynomial Root Finding for Graphics", 2022. A root that only touches zero is not found,
//! on purpose: it is no crossing. Between two places of equal sign the number of roots found is even.

use super::quadratic;

/// The roots of a quartic `c[0] + c[1] t + ... + c[4] t^4` in the open interval, rising; how many is the second value.
pub fn quartic_roots(c: &[f64; 5], low: f64, high: f64) -> ([f64; 4], usize) {
    let slope = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]];
    let bend = [slope[1], 2.0 * slope[2], 3.0 * slope[3]];
    let mut knots = [low; 5];
    let mut n = 1;
    if let Some((r0, r1)) = quadratic::roots(bend[2], 0.5 * bend[1], bend[0]) {
        for r in [r0, r1] {
            if r > knots[n - 1] && r < high {
                knots[n] = r;
                n += 1;
            }
        }
    }
    knots[n] = high;
    let (turns, turn_count) = roots_between(&slope, &knots[..=n]);
    let mut knots = [low; 5];
    knots[1..=turn_count].copy_from_slice(&turns[..turn_count]);
    knots[turn_count + 1] = high;
    roots_between(c, &knots[..turn_count + 2])
}

/// At most one root between each two neighbouring knots.
fn roots_between(c: &[f64], knots: &[f64]) -> ([f64; 4], usize) {
    let mut found = ([0.0; 4], 0);
    let mut below = value(c, knots[0]).0 < 0.0;
    for pair in knots.windows(2) {
        let next_below = value(c, pair[1]).0 < 0.0;
        if below != next_below && found.1 < 4 {
            found.0[found.1] = root_in(c, pair[0], pair[1], below);
            found.1 += 1;
        }
        below = next_below;
    }
    found
}

/// The root in `[a, b]`, where the sign changes; `below`: negative at `a`. Newton, and bisection where that is slow.
fn root_in(c: &[f64], mut a: f64, mut b: f64, below: bool) -> f64 {
    let mut x = 0.5 * (a + b);
    let mut last_width = b - a;
    for step in 0..200 {
        let (f, df) = value(c, x);
        if (f < 0.0) == below {
            a = x;
        } else {
            b = x;
        }
        let newton = x - f / df;
        let mut next = if newton > a && newton < b { newton } else { 0.5 * (a + b) };
        if step % 4 == 3 {
            if b - a > 0.5 * last_width {
                next = 0.5 * (a + b);
            }
            last_width = b - a;
        }
        if (next - x).abs() <= f64::EPSILON * (1.0 + x.abs()) * 0.25 || next == a && next == x {
            return next;
        }
        x = next;
    }
    x
}

/// Value and slope, by Horner's rule.
fn value(c: &[f64], x: f64) -> (f64, f64) {
    c.iter().rev().fold((0.0, 0.0), |(f, df), &k| (f * x + k, df * x + f))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_chosen_roots_are_found_again() {
        let r = [-0.9, -0.1, 0.1000001, 0.7];
        let mut c = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (degree, r) in r.iter().enumerate() {
            for i in (0..=degree + 1).rev() {
                c[i] = if i > 0 { c[i - 1] } else { 0.0 } - r * c[i];
            }
        }
        let (found, n) = quartic_roots(&c, -1.0, 1.0);
        assert_eq!(n, 4);
        assert!(found.iter().zip(r).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        assert_eq!(quartic_roots(&c, 0.0, 0.5).1, 1);
    }

    #[test]
    fn touching_zero_is_no_crossing() {
        // (t^2 - 1/4)^2 + a little
        assert_eq!(quartic_roots(&[0.0625 + 1e-12, 0.0, -0.5, 0.0, 1.0], -2.0, 2.0).1, 0);
        assert_eq!(quartic_roots(&[0.0625 - 1e-12, 0.0, -0.5, 0.0, 1.0], -2.0, 2.0).1, 4);
        assert_eq!(quartic_roots(&[0.0, 0.0, 0.0, 0.0, 1.0], -2.0, 2.0).1, 0);
    }
}
