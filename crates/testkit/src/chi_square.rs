//! Pearson's chi-square test of a sampler of directions against its density (after `chi2test` of Nori and Mitsuba, by
//! W. Jakob).

use crate::Random;
use crate::sphere::{Cell, integrate_cell};
use crate::statistics::{chi_square_tail, normal_two_sided_tail};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::atan2;
use std::f64::consts::PI;

/// How to test.
#[derive(Clone, Copy, Debug)]
pub struct ChiSquare {
    /// Steps in height; even, so that the horizon is a line of the grid.
    pub rows: usize,
    /// Steps in longitude.
    pub columns: usize,
    /// How many samples to draw.
    pub samples: usize,
    /// Which random numbers.
    pub seed: u64,
}

impl Default for ChiSquare {
    fn default() -> Self {
        ChiSquare { rows: 16, columns: 32, samples: 100_000, seed: 1 }
    }
}

/// What came out.
#[derive(Clone, Debug)]
pub struct ChiSquareResult {
    /// Pearson's statistic.
    pub statistic: f64,
    /// Its degrees of freedom.
    pub degrees: usize,
    /// Probability of a deviation at least as great if sampler and density agree.
    pub p_value: f64,
    /// The density's integral.
    pub total: f64,
    /// Part of the calls that gave a direction.
    pub drawn: f64,
}

/// Densities that break off along a line integrate no better than this.
const QUADRATURE_ERROR: f64 = 3e-4;

/// Cells that expect fewer samples are pooled.
const LEAST_EXPECTED: f64 = 5.0;

impl ChiSquare {
    /// Test `sample` (from three random numbers; `None` is a sample that failed) against `pdf` (per solid angle; its
    /// integral falls short of 1 by the probability of failure).
    pub fn run(
        &self,
        mut sample: impl FnMut(f32, (f32, f32)) -> Option<Vec3>,
        pdf: impl Fn(Vec3) -> f32,
    ) -> ChiSquareResult {
        let cells = self.rows * self.columns;
        // The last entry counts failures.
        let mut observed = vec![0_u32; cells + 1];
        let mut random = Random::new(self.seed);
        for _ in 0..self.samples {
            let (u, v) = (random.number(), random.pair());
            let cell = sample(u, v).map_or(cells, |w| self.cell_of(w));
            observed[cell] += 1;
        }
        let drawn = 1.0 - f64::from(observed[cells]) / self.samples as f64;
        let density = |w: Vec3| f64::from(pdf(w));
        let mut expected: Vec<f64> = (0..cells)
            .map(|i| {
                integrate_cell(
                    &density,
                    Cell::of_grid(i / self.columns, self.rows, i % self.columns, self.columns),
                    1e-4,
                )
            })
            .collect();
        let total: f64 = expected.iter().sum();
        // What quadrature leaves over is no failure, and few failures may hide in it.
        let mut missing = 1.0 - total;
        if missing.abs() < QUADRATURE_ERROR {
            missing = 0.0;
            if f64::from(observed[cells]) < 2.0 * QUADRATURE_ERROR * self.samples as f64 {
                observed[cells] = 0;
            }
        }
        expected.push(missing.max(0.0));
        let (statistic, degrees) = self.pearson(&observed, &expected);
        let mut p_value = chi_square_tail(statistic, degrees);
        // Hundreds of cells hide a small error of the whole, so that is tested besides; two tests, twice the p-value.
        if missing * self.samples as f64 >= LEAST_EXPECTED {
            let spread = (total * missing / self.samples as f64).max(0.0).sqrt();
            let z = if drawn == total { 0.0 } else { (drawn - total) / spread };
            p_value = (2.0 * p_value.min(normal_two_sided_tail(z))).min(1.0);
        }
        if !(total <= 1.0 + 3.0 * QUADRATURE_ERROR) {
            p_value = 0.0;
        }
        ChiSquareResult { statistic, degrees, p_value, total, drawn }
    }

    fn cell_of(&self, w: Vec3) -> usize {
        let place = |x: f64, n: usize| ((x * n as f64).max(0.0) as usize).min(n - 1);
        let row = place(0.5 * (f64::from(w.z) + 1.0), self.rows);
        // f32 z near 0 must not be rounded onto the other side.
        let row = if w.z < 0.0 { row.min(self.rows / 2 - 1) } else { row };
        let column = place((atan2(f64::from(w.y), f64::from(w.x)) + PI) / (2.0 * PI), self.columns);
        row * self.columns + column
    }

    fn pearson(&self, observed: &[u32], probability: &[f64]) -> (f64, usize) {
        let n = self.samples as f64;
        let (mut statistic, mut terms) = (0.0, 0);
        let (mut pooled_observed, mut pooled_expected) = (0.0, 0.0);
        for (&o, &p) in observed.iter().zip(probability) {
            let (o, e) = (f64::from(o), n * p);
            if e < LEAST_EXPECTED {
                pooled_observed += o;
                pooled_expected += e;
            } else {
                statistic += (o - e) * (o - e) / e;
                terms += 1;
            }
        }
        if pooled_expected >= LEAST_EXPECTED {
            statistic += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
            terms += 1;
        } else if pooled_observed > pooled_expected + 12.0 {
            // Too few expected for chi-square, and more seen than a Poisson variable of mean 5 ever shows.
            statistic = f64::INFINITY;
        }
        (statistic, usize::max(terms, 2) - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::warp::*;

    fn cosine(pdf_factor: f32, tilt: f32) -> f64 {
        let sample = |_, u| Some(square_to_cosine_hemisphere(u));
        let pdf = |w: Vec3| pdf_factor * square_to_cosine_hemisphere_pdf(Vec3::new(w.x, w.y, w.z + tilt * w.x));
        ChiSquare::default().run(sample, pdf).p_value
    }

    #[test]
    fn the_right_density_passes_and_wrong_ones_fail() {
        assert!(cosine(1.0, 0.0) > 0.01);
        assert!(cosine(0.98, 0.0) < 1e-6);
        assert!(cosine(1.02, 0.0) < 1e-6);
        assert!(cosine(1.0, 0.05) < 1e-6);
    }

    #[test]
    fn failures_must_match_what_the_density_lacks() {
        let sample = |u: f32, v| (u < 0.7).then(|| square_to_uniform_sphere(v));
        let at = |d: f32| ChiSquare::default().run(sample, move |_| d / (4.0 * PI as f32));
        assert!(at(0.7).p_value > 0.01 && (at(0.7).drawn - 0.7).abs() < 0.01 && (at(0.7).total - 0.7).abs() < 1e-5);
        assert!(at(0.69).p_value < 1e-6);
    }

    #[test]
    fn samples_where_the_density_is_zero_fail() {
        let both = |u: f32, v| {
            let w = square_to_cosine_hemisphere(v);
            Some(if u < 0.001 { -w } else { w })
        };
        assert!(ChiSquare::default().run(both, square_to_cosine_hemisphere_pdf).p_value < 1e-6);
    }

    /// Over 200 seeds half of the p-values lie below a half, and none is tiny.
    #[test]
    fn p_values_are_fair_under_agreement() {
        let p = |seed| {
            let c = ChiSquare { rows: 4, columns: 8, samples: 4000, seed };
            c.run(|_, u| Some(square_to_uniform_sphere(u)), |_| 1.0 / (4.0 * PI as f32)).p_value
        };
        let all: Vec<f64> = (0..200).map(p).collect();
        let below = |x: f64| all.iter().filter(|p| **p < x).count();
        assert!((80..120).contains(&below(0.5)) && (5..40).contains(&below(0.1)) && below(1e-4) == 0, "{all:?}");
    }
}
