//! How far two pictures are from each other: a number, and a map of where.
//!
//! All take linear colours. A pixel that is not finite in exactly one picture, or differently so, has an infinite
//! error: no broken picture passes a threshold.

mod flip;
mod flip_filters;
mod pixelwise;

use crate::error::{ImageError, Result};
use crate::image::RgbImage;
pub use flip::{DEFAULT_PIXELS_PER_DEGREE, flip};
pub use pixelwise::{MRSE_EPSILON, fraction_within, max_difference, max_difference8};

/// The metrics, by the names of the option `--metric`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// Mean absolute error over pixels and channels.
    Mae,
    /// Mean squared error over pixels and channels.
    Mse,
    /// Square root of the mean squared error.
    Rmse,
    /// Mean relative squared error, `(test - reference)^2 / (reference^2 + 0.01)`.
    Mrse,
    /// LDR-FLIP at its default viewing distance: errors as an eye sees them when it flips between the pictures.
    Flip,
}

/// What a metric found.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The one number, 0 for equal pictures.
    pub score: f64,
    /// Columns of the map.
    pub width: u32,
    /// Rows of the map.
    pub height: u32,
    /// The error of each pixel, rows from the top, not negative; its mean (for RMSE the root of it) is the score.
    pub map: Vec<f32>,
}

impl Metric {
    /// All metrics.
    pub const ALL: [Self; 5] = [Self::Mae, Self::Mse, Self::Rmse, Self::Mrse, Self::Flip];

    /// The name a user types.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mae => "mae",
            Self::Mse => "mse",
            Self::Rmse => "rmse",
            Self::Mrse => "mrse",
            Self::Flip => "flip",
        }
    }

    /// One line for a manual.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Mae => "mean absolute error of linear values",
            Self::Mse => "mean squared error of linear values",
            Self::Rmse => "root of the mean squared error",
            Self::Mrse => "mean relative squared error, (a - b)^2 / (b^2 + 0.01) with b the reference",
            Self::Flip => "LDR-FLIP (Andersson et al. 2020), what an eye sees; both pictures clipped to [0, 1]",
        }
    }

    /// The metric of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|metric| metric.name() == name)
    }

    /// Compare two pictures of one size.
    pub fn compare(self, test: &RgbImage, reference: &RgbImage) -> Result<Difference> {
        match self {
            Self::Flip => flip(test, reference, DEFAULT_PIXELS_PER_DEGREE),
            other => pixelwise::compare(other, test, reference),
        }
    }
}

fn check_sizes(a: &RgbImage, b: &RgbImage) -> Result<()> {
    a.validate()?;
    b.validate()?;
    if a.size() != b.size() {
        return Err(ImageError::SizesDiffer { a: a.size(), b: b.size() });
    }
    Ok(())
}

/// The mean of a map, 0 of an empty one.
fn mean(map: &[f64]) -> f64 {
    if map.is_empty() { 0.0 } else { map.iter().sum::<f64>() / map.len() as f64 }
}
