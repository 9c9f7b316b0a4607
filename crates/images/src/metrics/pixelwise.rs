//! The metrics that look at one pixel at a time.
//!
//! Reference for the relative error and its epsilon: F. Rousselle, C. Knaus, M. Zwicker, "Adaptive Sampling and
//! Reconstruction using Greedy Error Minimization", 2011, section 6 (<https://doi.org/10.1145/2070781.2024193>).

use super::{Difference, Metric, check_sizes, mean};
use crate::error::{ImageError, Result};
use crate::image::RgbImage;

/// What keeps the relative error of black pixels finite.
pub const MRSE_EPSILON: f64 = 0.01;

pub(super) fn compare(metric: Metric, test: &RgbImage, reference: &RgbImage) -> Result<Difference> {
    check_sizes(test, reference)?;
    let error_of_value = |a: f32, b: f32| {
        let d = difference(a, b);
        match metric {
            Metric::Mae => d,
            Metric::Mrse if d > 0.0 && d.is_finite() => d * d / (f64::from(b) * f64::from(b) + MRSE_EPSILON),
            _ => d * d,
        }
    };
    let map: Vec<f64> = test
        .pixels
        .iter()
        .zip(&reference.pixels)
        .map(|(a, b)| (0..3).map(|lane| error_of_value(a[lane], b[lane])).sum::<f64>() / 3.0)
        .collect();
    let score = match metric {
        Metric::Rmse => mean(&map).sqrt(),
        _ => mean(&map),
    };
    let map = map.into_iter().map(|error| error as f32).collect();
    Ok(Difference { score, width: test.width, height: test.height, map })
}

/// `|a - b|`; infinite if one is not finite and the other differs.
fn difference(a: f32, b: f32) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        0.0
    } else if a.is_finite() && b.is_finite() {
        (f64::from(a) - f64::from(b)).abs()
    } else {
        f64::INFINITY
    }
}

/// The largest difference of any channel of any pixel.
pub fn max_difference(a: &RgbImage, b: &RgbImage) -> Result<f64> {
    check_sizes(a, b)?;
    let values = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    Ok(values.map(|(&a, &b)| difference(a, b)).fold(0.0, f64::max))
}

/// The largest difference of 8-bit codes, for pictures as [`crate::to_srgb8`] gives them.
pub fn max_difference8(a: &[u8], b: &[u8]) -> Result<u8> {
    check_lengths(a, b)?;
    Ok(a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0))
}

/// The fraction of pixels of which all three 8-bit codes differ by at most `tolerance`; 1 of no pixels.
pub fn fraction_within(a: &[u8], b: &[u8], tolerance: u8) -> Result<f64> {
    check_lengths(a, b)?;
    let near = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).all(|(a, b)| a.abs_diff(*b) <= tolerance);
    let pixels = a.len() / 3;
    let within = a.chunks_exact(3).zip(b.chunks_exact(3)).filter(near).count();
    Ok(if pixels == 0 { 1.0 } else { within as f64 / pixels as f64 })
}

fn check_lengths(a: &[u8], b: &[u8]) -> Result<()> {
    if a.len() == b.len() && a.len().is_multiple_of(3) {
        return Ok(());
    }
    Err(ImageError::OutOfRange {
        name: "the number of codes",
        value: format!("{} and {}", a.len(), b.len()),
        range: "equal, three to a pixel",
    })
}
