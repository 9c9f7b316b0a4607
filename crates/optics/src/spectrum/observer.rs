//! The eye of the film: what a wavelength adds to red, green and blue, and which wavelengths paths take.
//!
//! Colours are those that the CIE 1931 2-degree observer sees, in linear Rec.709 with the white of daylight D65: light with
//! the spectrum of D65 and luminance 1 is (1, 1, 1). Integrals are those of the straight lines between samples, exactly.

use super::curve::{FIRST, SAMPLES, STEP, interpolate, place};
use super::tables;
use std::sync::LazyLock;

/// Stretches of equal probability that wavelengths are drawn from.
pub const CELLS: usize = 256;
/// Bands that a spectrum is cut into for what RGB renders must add up.
pub const BANDS: usize = 27;
const WIDTH: usize = SAMPLES / BANDS;

/// How paths share out the wavelengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Draw {
    /// As they matter to the colour of white light.
    Color,
    /// Half like that and half evenly: for renders that keep spectra, in which all wavelengths matter.
    Spectrum,
}

/// Everything derived from the tables.
pub struct Observer {
    /// Film red, green, blue per nm of radiance at each sample, and nothing.
    film: [[f32; 4]; SAMPLES],
    /// D65 with luminance 1.
    white: [f32; SAMPLES],
    /// Weights of a curve's samples in its red, green and blue.
    light_weights: [[f64; 3]; SAMPLES],
    /// Weights of a curve's samples in its red, green and blue when lit by `white`.
    reflected_weights: [[f64; 3]; SAMPLES],
    /// Ends of the cells, nm, by [`Draw`].
    bands: [(f32, [f64; 3]); BANDS],
    ends: [[f32; CELLS + 1]; 2],
}

static OBSERVER: LazyLock<Observer> = LazyLock::new(Observer::new);

/// The one observer.
#[inline]
pub fn observer() -> &'static Observer {
    &OBSERVER
}

impl Observer {
    fn new() -> Self {
        // Primaries of Rec.709 (ITU-R BT.709-6, item 1.3), as columns scaled so that they make D65.
        let xyz = [&tables::X, &tables::Y, &tables::Z];
        let integral =
            |a: &[f64; SAMPLES], b: &[f64; SAMPLES]| -> f64 { tent_weights(a).iter().zip(b).map(|(w, b)| w * b).sum() };
        let luminance = integral(&tables::D65, &tables::Y);
        let white = tables::D65.map(|p| p / luminance);
        let white_xyz = xyz.map(|bar| integral(&white, bar));
        let column = |x: f64, y: f64| [x / y, 1.0, (1.0 - x - y) / y];
        let primaries = [column(0.64, 0.33), column(0.30, 0.60), column(0.15, 0.06)];
        let rows = inverse(transposed(primaries));
        let scale = apply(&rows, white_xyz);
        let film_from_xyz: [[f64; 3]; 3] = core::array::from_fn(|c| rows[c].map(|m| m / scale[c]));
        let bars: [[f64; SAMPLES]; 3] = core::array::from_fn(|c| {
            core::array::from_fn(|i| apply(&film_from_xyz, [tables::X[i], tables::Y[i], tables::Z[i]])[c])
        });

        // A curve's integral against a product of two others, exact for straight lines.
        let light = bars.map(|bar| tent_weights(&bar));
        let reflected = bars.map(|bar| tent_product_weights(&bar, &white));
        let by_sample = |w: &[[f64; SAMPLES]; 3], i: usize| [w[0][i], w[1][i], w[2][i]];
        Observer {
            film: core::array::from_fn(|i| [bars[0][i] as f32, bars[1][i] as f32, bars[2][i] as f32, 0.0]),
            white: white.map(|x| x as f32),
            light_weights: core::array::from_fn(|i| by_sample(&light, i)),
            reflected_weights: core::array::from_fn(|i| by_sample(&reflected, i)),
            bands: core::array::from_fn(|band| {
                let middle = WIDTH * band + WIDTH / 2;
                let weights = core::array::from_fn(|c| (0..WIDTH).map(|i| reflected[c][WIDTH * band + i]).sum());
                ((FIRST + STEP * middle as f64) as f32, weights)
            }),
            ends: [0.01, 1.0].map(|floor| cell_ends(&bars, &white, floor)),
        }
    }

    /// D65 of luminance 1 at a wavelength in nm, per nm.
    #[inline]
    pub fn white(&self, nanometres: f32) -> f32 {
        interpolate(&self.white, nanometres)
    }

    /// The samples of D65 of luminance 1.
    pub fn white_samples(&self) -> &[f32; SAMPLES] {
        &self.white
    }

    /// Red, green, blue that radiance of 1 per nm at this wavelength adds, per nm.
    #[inline]
    pub fn film(&self, nanometres: f32) -> [f32; 3] {
        let (i, share) = place(nanometres);
        let (a, b) = (&self.film[i], &self.film[i + 1]);
        let [red, green, blue, _]: [f32; 4] = core::array::from_fn(|c| a[c] + (b[c] - a[c]) * share);
        [red, green, blue]
    }

    /// The colour of light with this spectrum, per nm.
    pub fn color_of_light(&self, samples: &[f32; SAMPLES]) -> [f64; 3] {
        weighted(&self.light_weights, samples)
    }

    /// The colour of a surface with this reflectance under D65.
    pub fn color_of_reflectance(&self, samples: &[f32; SAMPLES]) -> [f64; 3] {
        weighted(&self.reflected_weights, samples)
    }

    /// Bands of the spectrum, their middles in nm, with what they add to the red, green and blue of a surface under D65.
    pub fn bands(&self) -> &[(f32, [f64; 3]); BANDS] {
        &self.bands
    }

    /// See `reflected_weights`.
    pub(super) fn reflected_weights(&self) -> &[[f64; 3]; SAMPLES] {
        &self.reflected_weights
    }

    /// The wavelength at a place in `[0, CELLS)`, nm, and the nm per unit of probability there.
    #[inline]
    pub fn wavelength(&self, draw: Draw, place: f32) -> (f32, f32) {
        let cell = (place as usize).min(CELLS - 1);
        let ends = &self.ends[draw as usize];
        let (start, end) = (ends[cell], ends[cell + 1]);
        let width = end - start;
        (start + width * (place - cell as f32), width * CELLS as f32)
    }
}

fn weighted(weights: &[[f64; 3]; SAMPLES], samples: &[f32; SAMPLES]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (w, &s) in weights.iter().zip(samples) {
        for c in 0..3 {
            sum[c] += w[c] * f64::from(s);
        }
    }
    sum
}

/// `w` such that the integral of `a` times any curve `b` is the sum of `w b`.
fn tent_weights(a: &[f64; SAMPLES]) -> [f64; SAMPLES] {
    tent_product_weights(a, &[1.0; SAMPLES])
}

/// `w` such that the integral of `a` times `b` times any curve `c` is the sum of `w c`. Between samples the product is a
/// cubic, for which Simpson's rule is exact.
fn tent_product_weights(a: &[f64; SAMPLES], b: &[f64; SAMPLES]) -> [f64; SAMPLES] {
    let mut weights = [0.0; SAMPLES];
    for i in 0..SAMPLES - 1 {
        let middle = 0.25 * (a[i] + a[i + 1]) * (b[i] + b[i + 1]);
        weights[i] += STEP / 6.0 * (a[i] * b[i] + 2.0 * middle);
        weights[i + 1] += STEP / 6.0 * (2.0 * middle + a[i + 1] * b[i + 1]);
    }
    weights
}

/// Cells of equal probability. The density is the length of what white light adds to the film, (r, g, b) as a vector, which
/// makes the sum of the three variances least; and everywhere `floor` of its mean more.
fn cell_ends(bars: &[[f64; SAMPLES]; 3], white: &[f64; SAMPLES], floor: f64) -> [f32; CELLS + 1] {
    let length = |i: usize| {
        let part = |c: usize| bars[c][i] * white[i];
        (part(0) * part(0) + part(1) * part(1) + part(2) * part(2)).sqrt()
    };
    let lengths: [f64; SAMPLES] = core::array::from_fn(length);
    let least = floor * lengths.iter().sum::<f64>() / SAMPLES as f64;
    // Mass of each stretch between samples; the density is taken as even within it.
    let masses: Vec<f64> = lengths.windows(2).map(|l| 0.5 * (l[0] + l[1]) + least).collect();
    let total: f64 = masses.iter().sum();
    let mut ends = [0.0_f32; CELLS + 1];
    let (mut stretch, mut before) = (0, 0.0);
    for (k, end) in ends.iter_mut().enumerate() {
        let target = total * k as f64 / CELLS as f64;
        while stretch + 1 < masses.len() && before + masses[stretch] < target {
            before += masses[stretch];
            stretch += 1;
        }
        let share = ((target - before) / masses[stretch]).clamp(0.0, 1.0);
        *end = (FIRST + STEP * (stretch as f64 + share)) as f32;
    }
    ends
}

type Matrix = [[f64; 3]; 3];

fn transposed(m: Matrix) -> Matrix {
    core::array::from_fn(|r| core::array::from_fn(|c| m[c][r]))
}

pub(super) fn apply(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// By cofactors.
pub(super) fn inverse(m: Matrix) -> Matrix {
    let minor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    core::array::from_fn(|r| core::array::from_fn(|c| minor(c, r) / determinant))
}
