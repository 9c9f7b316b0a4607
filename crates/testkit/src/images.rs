//! Do two pictures agree? By their own noise (Z-test), or within a tolerance.

use crate::statistics::{normal_two_sided_tail, sidak};

/// An image that knows its noise: per value the mean of the samples and the variance *of that mean*
/// (sample variance over number of samples).
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// Means.
    pub mean: &'a [f64],
    /// Variances of the means.
    pub variance: &'a [f64],
}

/// What a Z-test found.
#[derive(Clone, Debug, PartialEq)]
pub struct ZTest {
    /// True when no value differs more than chance explains.
    pub passed: bool,
    /// The least p-value, before correction.
    pub p_value: f64,
    /// Where it is.
    pub worst: usize,
    /// How many values fail at the corrected level.
    pub failing: usize,
}

/// Test value by value whether two measured images have the same expectation; together they err with probability `level`
/// (Sidak). Where neither has variance, values must agree to `rounding` (relative).
///
/// The normal approximation wants a few dozen samples per pixel; fireflies make it too strict.
///
/// # Panics
///
/// If the four slices differ in length: the images do not belong together.
pub fn z_test(a: Measured, b: Measured, level: f64, rounding: f64) -> ZTest {
    let n = a.mean.len();
    assert!([a.variance.len(), b.mean.len(), b.variance.len()] == [n; 3], "images of different sizes");
    let threshold = sidak(level, n.max(1));
    let mut found = ZTest { passed: true, p_value: 1.0, worst: 0, failing: 0 };
    for i in 0..n {
        let (x, y) = (a.mean[i], b.mean[i]);
        let difference = (x - y).abs();
        let slack = rounding * x.abs().max(y.abs());
        let p = if difference <= slack {
            1.0
        } else {
            // Without variance z is infinite and p is 0.
            let z = (difference - slack) / (a.variance[i] + b.variance[i]).sqrt();
            if z.is_nan() { 0.0 } else { normal_two_sided_tail(z) }
        };
        if p < found.p_value {
            (found.p_value, found.worst) = (p, i);
        }
        found.failing += usize::from(p < threshold);
    }
    found.passed = found.failing == 0;
    found
}

/// The part of the pixels (`channels` values each) whose values all differ by at most `tolerance`.
///
/// # Panics
///
/// If the slices differ in length.
pub fn fraction_within(a: &[u8], b: &[u8], channels: usize, tolerance: u8) -> f64 {
    assert_eq!(a.len(), b.len(), "images of different sizes");
    let pixels = a.len() / channels;
    let near = |(x, y): (&[u8], &[u8])| x.iter().zip(y).all(|(p, q)| p.abs_diff(*q) <= tolerance);
    let good = a.chunks_exact(channels).zip(b.chunks_exact(channels)).filter(|&p| near(p)).count();
    if pixels == 0 { 1.0 } else { good as f64 / pixels as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Estimate, Random};

    /// Means and variances of 64 uniform samples per pixel about `level`.
    fn noisy(seed: u64, level: f64) -> (Vec<f64>, Vec<f64>) {
        let mut random = Random::new(seed);
        let pixel = |_| {
            let e = Estimate::of((0..64).map(|_| level - 0.5 + f64::from(random.number())));
            (e.mean, e.standard_error * e.standard_error)
        };
        (0..2000).map(pixel).unzip()
    }

    #[test]
    fn equal_scenes_pass_and_a_dent_fails() {
        let ((a, va), (mut b, vb)) = (noisy(1, 1.0), noisy(2, 1.0));
        fn measured<'a>(mean: &'a [f64], variance: &'a [f64]) -> Measured<'a> {
            Measured { mean, variance }
        }
        assert!(z_test(measured(&a, &va), measured(&b, &vb), 0.01, 0.0).passed);
        b[77] += 0.5;
        let dent = z_test(measured(&a, &va), measured(&b, &vb), 0.01, 0.0);
        assert!(!dent.passed && dent.worst == 77 && dent.failing == 1);
        let (c, vc) = noisy(3, 1.2);
        assert!(!z_test(measured(&a, &va), measured(&c, &vc), 0.01, 0.0).passed);
    }

    #[test]
    fn values_without_noise_must_be_equal() {
        let still = |mean| Measured { mean, variance: &[0.0; 2] };
        assert!(z_test(still(&[1.0, 2.0]), still(&[1.0, 2.0]), 0.01, 0.0).passed);
        assert!(!z_test(still(&[1.0, 2.0]), still(&[1.0, 2.000_1]), 0.01, 1e-6).passed);
        assert!(z_test(still(&[1.0, 2.0]), still(&[1.0, 2.000_001]), 0.01, 1e-6).passed);
        assert!(!z_test(still(&[1.0, f64::NAN]), still(&[1.0, 2.0]), 0.01, 1e-6).passed);
    }

    #[test]
    fn a_pixel_counts_when_all_its_channels_are_near() {
        let (a, b) = ([10, 20, 30, 10, 20, 30], [13, 20, 30, 10, 16, 30]);
        assert_eq!(fraction_within(&a, &b, 3, 3), 0.5);
        assert_eq!(fraction_within(&a, &b, 3, 2), 0.0);
        assert_eq!(fraction_within(&a, &b, 3, 4), 1.0);
    }
}
