//! Real roots of quadratics, without loss.

/// The roots of `a t^2 + 2 b t + c`, rising; none where it touches zero at most. With `a = 0` there is at most one, and it
/// stands twice.
pub fn roots(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    if a == 0.0 {
        let r = -0.5 * c / b;
        return (b != 0.0 && r.is_finite()).then_some((r, r));
    }
    let discriminant = b * b - a * c;
    if !(discriminant > 0.0) {
        return None;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let (r0, r1) = (q / a, c / q);
    Some(if r0 < r1 { (r0, r1) } else { (r1, r0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_roots_beside_large_ones_stay_exact() {
        let (a, b) = roots(1.0, -0.5 * (1e8 + 1e-8), 1.0).unwrap();
        assert!((a - 1e-8).abs() < 1e-23 && (b - 1e8).abs() < 1e-6);
        assert_eq!(roots(0.0, 1.0, -4.0), Some((2.0, 2.0)));
        assert_eq!(roots(1.0, 0.0, 1.0), None);
        assert_eq!(roots(0.0, 0.0, 1.0), None);
    }
}
