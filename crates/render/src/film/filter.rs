//! Pixel filters: how the light around a pixel's middle counts for it.
//!
//! A sample lands in one pixel: instead of spreading a value over its neighbours with weights, its place on the film is
//! drawn around the pixel with the density of the filter's absolute value (filter importance sampling), and its weight is
//! the filter's sign times a constant whose mean is 1.
//!
//! | name | radius | shape along each axis, `t = x / radius` |
//! |---|---|---|
//! | `point` | 0 | the pixel's middle only |
//! | `box` | 0.5 | 1 |
//! | `tent` | 1 | `1 - abs(t)` |
//! | `gaussian` | 1.5 | `exp(-x^2 / (2 sigma^2))` less its value at the radius, `sigma = radius / 3` |
//! | `mitchell` | 2 | Mitchell & Netravali's cubic with B = C = 1/3: sharp, with a negative rim |
//! | `blackman_harris` | 1.5 | the 4-term window: like a Gaussian, and 0 at the radius |
//!
//! References: M. Ernst, M. Stamminger, G. Greiner: "Filter Importance Sampling", 2006,
//! <https://doi.org/10.1109/RT.2006.280223>. D. Mitchell, A. Netravali: "Reconstruction Filters in Computer Graphics", 1988,
//! <https://doi.org/10.1145/54852.378514>. F. Harris: "On the use of windows for harmonic analysis with the discrete Fourier
//! transform", 1978, <https://doi.org/10.1109/PROC.1978.10837>.

use kirkas_geometry::elementary::{cos, exp};

/// Names of all filters, the default first.
pub const FILTERS: &[&str] = &["gaussian", "box", "tent", "mitchell", "blackman_harris", "point"];

/// Where a sample looks, and how much it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// From the middle of the pixel, in pixels.
    pub offset: (f32, f32),
    /// Times the light found there. Its mean is 1; it is negative in the negative parts of the filter.
    pub weight: f32,
}

/// A filter that is a product of one function of x and the same of y.
#[derive(Clone, Debug)]
pub struct Filter {
    shape: Shape,
    /// In pixels.
    radius: f64,
    /// `None` for `point` and `box`.
    table: Option<Table>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Point,
    Box,
    Tent,
    Gaussian,
    Mitchell,
    BlackmanHarris,
}

impl Filter {
    /// A filter by name; `radius` in pixels, `None` for its own. `None` if there is no such filter.
    pub fn new(name: &str, radius: Option<f32>) -> Option<Filter> {
        let (shape, own_radius) = match name {
            "point" => (Shape::Point, 0.0),
            "box" => (Shape::Box, 0.5),
            "tent" => (Shape::Tent, 1.0),
            "gaussian" => (Shape::Gaussian, 1.5),
            "mitchell" => (Shape::Mitchell, 2.0),
            "blackman_harris" => (Shape::BlackmanHarris, 1.5),
            _ => return None,
        };
        let radius = match radius {
            Some(r) if shape != Shape::Point && r.is_finite() && r > 0.0 => f64::from(r),
            _ => own_radius,
        };
        let table = match shape {
            Shape::Point | Shape::Box => None,
            _ => Some(Table::new(|t| shape.at(t))),
        };
        Some(Filter { shape, radius, table })
    }

    /// How far from the pixel's middle it reaches along each axis, in pixels.
    pub fn radius(&self) -> f32 {
        self.radius as f32
    }

    /// A place around the pixel and its weight; `u` in the unit square.
    pub fn sample(&self, u: (f32, f32)) -> FilterSample {
        let (x, y) = (self.sample_axis(u.0), self.sample_axis(u.1));
        let r = self.radius;
        FilterSample { offset: ((x.0 * r) as f32, (y.0 * r) as f32), weight: (x.1 * y.1) as f32 }
    }

    /// The filter at a distance from the pixel's middle in pixels, scaled so that its integral is 1. (`point`, which has no
    /// such function, is 1 in the middle and 0 elsewhere.)
    pub fn value(&self, x: f32, y: f32) -> f64 {
        if self.shape == Shape::Point {
            return if (x, y) == (0.0, 0.0) { 1.0 } else { 0.0 };
        }
        let integral = self.table.as_ref().map_or(2.0, |table| table.integral) * self.radius;
        let axis = |x: f32| self.shape.at(f64::from(x) / self.radius) / integral;
        axis(x) * axis(y)
    }

    /// The pixels along one axis for which light at `place` (in pixels from the film's edge) counts: the first of them, and into
    /// `weights` the filter's value for each, scaled so that the filter's integral is 1. `point` does as the pixel's own box does.
    pub fn footprint(&self, place: f64, weights: &mut Vec<f64>) -> i64 {
        let radius = if self.shape == Shape::Point { 0.5 } else { self.radius };
        let integral = self.table.as_ref().map_or(2.0, |table| table.integral) * radius;
        let middle = |pixel: i64| pixel as f64 + 0.5;
        let first = (place - radius - 0.5).ceil() as i64;
        let last = (place + radius - 0.5).floor() as i64;
        weights.clear();
        weights.extend((first..=last).map(|pixel| self.shape.at((place - middle(pixel)) / radius) / integral));
        first
    }

    /// In units of the radius, and the weight.
    fn sample_axis(&self, u: f32) -> (f64, f64) {
        match &self.table {
            None => (2.0 * f64::from(u) - 1.0, 1.0),
            Some(table) => table.sample(f64::from(u)),
        }
    }
}

impl Shape {
    /// The shape at `t = x / radius`, 0 beyond -1 and 1; of any scale.
    fn at(self, t: f64) -> f64 {
        let t = t.abs();
        if t > 1.0 {
            return 0.0;
        }
        match self {
            Shape::Point | Shape::Box => 1.0,
            Shape::Tent => 1.0 - t,
            // sigma = 1/3: the exponent is -(3 t)^2 / 2.
            Shape::Gaussian => exp(-4.5 * t * t) - exp(-4.5),
            Shape::Mitchell => mitchell(2.0 * t),
            Shape::BlackmanHarris => {
                let c = |k: f64| cos(core::f64::consts::PI * k * t);
                0.35875 + 0.48829 * c(1.0) + 0.14128 * c(2.0) + 0.01168 * c(3.0)
            }
        }
    }
}

/// Mitchell & Netravali 1988, equation 8, times 6, for `0 <= x <= 2`.
fn mitchell(x: f64) -> f64 {
    const B: f64 = 1.0 / 3.0;
    const C: f64 = 1.0 / 3.0;
    if x < 1.0 {
        ((12.0 - 9.0 * B - 6.0 * C) * x - 18.0 + 12.0 * B + 6.0 * C) * x * x + (6.0 - 2.0 * B)
    } else {
        (((-B - 6.0 * C) * x + 6.0 * B + 30.0 * C) * x - 12.0 * B - 48.0 * C) * x + (8.0 * B + 24.0 * C)
    }
}

/// A function on `[-1, 1]` in cells, to be sampled with the density of its absolute value.
#[derive(Clone, Debug)]
struct Table {
    /// Integral of the absolute value up to each border of a cell, scaled to end at 1.
    cumulative: Vec<f64>,
    is_negative: Vec<bool>,
    /// Integral of the absolute value over that of the function.
    weight: f64,
    /// Of the function.
    integral: f64,
}

/// Enough that a cell's density is constant to 10^-5 of the filter's peak.
const CELLS: usize = 2048;

impl Table {
    fn new(f: impl Fn(f64) -> f64) -> Self {
        let width = 2.0 / CELLS as f64;
        let border = |i: usize| i as f64 * width - 1.0;
        // Simpson's rule: exact for the cubics.
        let masses: Vec<f64> = (0..CELLS)
            .map(|i| {
                let (a, b) = (border(i), border(i + 1));
                (f(a) + 4.0 * f(0.5 * (a + b)) + f(b)) * (width / 6.0)
            })
            .collect();
        let integral: f64 = masses.iter().sum();
        let mut cumulative = vec![0.0];
        let mut total = 0.0;
        for mass in &masses {
            total += mass.abs();
            cumulative.push(total);
        }
        cumulative.iter_mut().for_each(|c| *c /= total);
        let is_negative = masses.iter().map(|&mass| mass < 0.0).collect();
        Table { cumulative, is_negative, weight: total / integral, integral }
    }

    /// A place in `[-1, 1]` and its weight, whose mean over `u` is 1 exactly.
    fn sample(&self, u: f64) -> (f64, f64) {
        let cell = self.cumulative.partition_point(|&c| c <= u).clamp(1, CELLS) - 1;
        let (low, high) = (self.cumulative[cell], self.cumulative[cell + 1]);
        let part = if high > low { ((u - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        let t = (cell as f64 + part) * (2.0 / CELLS as f64) - 1.0;
        (t, if self.is_negative[cell] { -self.weight } else { self.weight })
    }
}
