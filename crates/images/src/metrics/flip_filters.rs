//! The filters of FLIP: sums of separable kernels, borders repeated outwards.
//!
//! Reference: Andersson et al. 2020, section 4.1.1 and table 1 (contrast sensitivity), 4.2.1 (features).

use kirkas_geometry::elementary::exp;
use std::f64::consts::PI;

/// One value per pixel.
pub(super) struct Plane {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

/// A sum of Gaussian blurs.
pub(super) struct Blur {
    terms: Vec<BlurTerm>,
}

struct BlurTerm {
    weight: f64,
    kernel: Kernel,
}

/// A derivative along one axis, a blur along the other; used both ways round.
pub(super) struct Feature {
    derivative: Kernel,
    smoothing: Kernel,
}

/// Weights at offsets `-radius ..= radius`.
struct Kernel {
    weights: Vec<f64>,
}

/// The blur of the achromatic, the red-green and the blue-yellow plane.
///
/// A row of table 1 gives Gaussians `a * sqrt(pi / b) * exp(-pi^2 x^2 / b)`, x in degrees.
pub(super) fn contrast_sensitivity_filters(pixels_per_degree: f64) -> [Blur; 3] {
    let table: [&[[f64; 2]]; 3] = [&[[1.0, 0.0047]], &[[1.0, 0.0053]], &[[34.1, 0.04], [13.5, 0.025]]];
    // All reach three deviations of the widest.
    let widest = 0.04;
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i64;
    table.map(|row| {
        let mut terms: Vec<BlurTerm> = row
            .iter()
            .map(|&[a, b]| {
                let gaussian = |x: f64| exp(-(PI * x / pixels_per_degree) * (PI * x / pixels_per_degree) / b);
                let (kernel, sum) = Kernel::from_fn(radius, gaussian).normalised();
                BlurTerm { weight: a * (PI / b).sqrt() * sum * sum, kernel }
            })
            .collect();
        let total: f64 = terms.iter().map(|term| term.weight).sum();
        terms.iter_mut().for_each(|term| term.weight /= total);
        Blur { terms }
    })
}

/// The detectors of edges and of points: first and second derivative of a Gaussian 0.082 degrees wide.
pub(super) fn feature_filters(pixels_per_degree: f64) -> [Feature; 2] {
    let deviation = 0.5 * 0.082 * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as i64;
    let gaussian = |x: f64| exp(-x * x / (2.0 * deviation * deviation));
    let slope = |x: f64| -x * gaussian(x);
    let curvature = |x: f64| (x * x / (deviation * deviation) - 1.0) * gaussian(x);
    let feature = |derivative: &dyn Fn(f64) -> f64| Feature {
        derivative: Kernel::from_fn(radius, derivative).balanced(),
        smoothing: Kernel::from_fn(radius, gaussian).normalised().0,
    };
    [feature(&slope), feature(&curvature)]
}

impl Plane {
    pub(super) fn new([width, height]: [u32; 2], values: Vec<f64>) -> Self {
        Self { width: width as usize, height: height as usize, values }
    }

    pub(super) fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        Self { values: self.values.iter().map(|&value| f(value)).collect(), ..*self }
    }

    fn along_rows(&self, kernel: &Kernel) -> Self {
        let mut values = Vec::with_capacity(self.values.len());
        for row in self.values.chunks_exact(self.width.max(1)) {
            let at = |x: i64| row[x.clamp(0, self.width as i64 - 1) as usize];
            values.extend((0..self.width as i64).map(|x| kernel.sum(|offset| at(x + offset))));
        }
        Self { values, ..*self }
    }

    fn along_columns(&self, kernel: &Kernel) -> Self {
        let mut values = vec![0.0; self.values.len()];
        let radius = kernel.radius();
        for (y, sums) in values.chunks_exact_mut(self.width.max(1)).enumerate() {
            // Whole rows at a time, so that memory is read in order.
            for (offset, weight) in (-radius..=radius).zip(&kernel.weights) {
                let from = (y as i64 + offset).clamp(0, self.height as i64 - 1) as usize * self.width;
                for (sum, value) in sums.iter_mut().zip(&self.values[from..from + self.width]) {
                    *sum += weight * value;
                }
            }
        }
        Self { values, ..*self }
    }
}

impl Blur {
    pub(super) fn apply(&self, plane: &Plane) -> Vec<f64> {
        let mut sums = vec![0.0; plane.values.len()];
        for term in &self.terms {
            let blurred = plane.along_rows(&term.kernel).along_columns(&term.kernel);
            for (sum, value) in sums.iter_mut().zip(&blurred.values) {
                *sum += term.weight * value;
            }
        }
        sums
    }
}

impl Feature {
    /// The length of the vector of the answers along x and y.
    pub(super) fn gradient_length(&self, plane: &Plane) -> Vec<f64> {
        let dx = plane.along_rows(&self.derivative).along_columns(&self.smoothing);
        let dy = plane.along_rows(&self.smoothing).along_columns(&self.derivative);
        dx.values.iter().zip(&dy.values).map(|(dx, dy)| (dx * dx + dy * dy).sqrt()).collect()
    }
}

impl Kernel {
    fn from_fn(radius: i64, weight: impl Fn(f64) -> f64) -> Self {
        Self { weights: (-radius..=radius).map(|offset| weight(offset as f64)).collect() }
    }

    fn radius(&self) -> i64 {
        self.weights.len() as i64 / 2
    }

    fn sum(&self, value: impl Fn(i64) -> f64) -> f64 {
        let offsets = -self.radius()..=self.radius();
        offsets.zip(&self.weights).map(|(offset, weight)| weight * value(offset)).sum()
    }

    /// Weights that sum to 1, and what they summed to.
    fn normalised(self) -> (Self, f64) {
        let sum: f64 = self.weights.iter().sum();
        (Self { weights: self.weights.iter().map(|weight| weight / sum).collect() }, sum)
    }

    /// Weights of which the positive sum to 1 and the negative to -1.
    fn balanced(self) -> Self {
        let positive: f64 = self.weights.iter().filter(|weight| **weight > 0.0).sum();
        let negative: f64 = -self.weights.iter().filter(|weight| **weight < 0.0).sum::<f64>();
        let scaled = |&weight: &f64| if weight > 0.0 { weight / positive } else { weight / negative };
        Self { weights: self.weights.iter().map(scaled).collect() }
    }
}
