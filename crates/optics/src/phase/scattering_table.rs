//! How a ball of clear matter scatters a broad parallel beam by geometric optics: every ray of the beam is traced, split at each
//! surface by Fresnel's formulas for both polarisations, and its energy is put into bins of the angle that it leaves with.
//!
//! A ray that meets the ball at angle of incidence `i` (`b = sin i` from the axis) and goes on inside at angle `r` has, after
//! `k` reflections inside, turned by `2 (i - r) + k (pi - 2 r)` (Descartes 1637; van de Hulst 1957, "Light Scattering by Small
//! Particles", section 12.22); reflected outside it has turned by `pi - 2 i`.

use crate::fresnel::dielectric_polarised;
use core::f64::consts::PI;
use kirkas_geometry::elementary::{asin, sin};

/// Bins between 0 and 180 degrees: 0.02 degrees each.
pub const BINS: usize = 9000;

/// Rings of the beam that are traced, evenly over the angle of incidence.
const RINGS: usize = 8192;

/// The part of the light in each bin.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatteringTable {
    masses: Vec<f64>,
}

impl ScatteringTable {
    /// Of a ball of relative refractive index `n` (at least 1), with up to `reflections` reflections inside.
    pub fn of_ball(n: f64, reflections: u32) -> Self {
        let mut table = ScatteringTable { masses: vec![0.0; BINS] };
        let incidence = |ring: usize| 0.5 * PI * ring as f64 / RINGS as f64;
        for ring in 0..RINGS {
            let (i0, i1) = (incidence(ring), incidence(ring + 1));
            let (b0, b1) = (sin(i0), sin(i1));
            let (r0, r1) = (asin(b0 / n), asin(b1 / n));
            let cos_i = sin(0.5 * PI - 0.5 * (i0 + i1)) as f32;
            let (rs, rp) = dielectric_polarised(cos_i, 1.0, n as f32);
            let area = b1 * b1 - b0 * b0;
            table.spread((PI - 2.0 * i0, PI - 2.0 * i1), 0.5 * area * f64::from(rs + rp));
            // What goes in, for each polarisation, and what is left of it after each reflection.
            let mut inside = [rs, rp].map(|r| (1.0 - f64::from(r), f64::from(r)));
            for k in 0..=reflections {
                let turn = |i: f64, r: f64| 2.0 * (i - r) + f64::from(k) * (PI - 2.0 * r);
                let leaving: f64 = inside.iter().map(|(left, r)| left * (1.0 - r)).sum();
                table.spread((turn(i0, r0), turn(i1, r1)), 0.5 * area * leaving);
                inside = inside.map(|(left, r)| (left * r, r));
            }
        }
        table
    }

    /// Put `mass` evenly between two angles, which may go around.
    fn spread(&mut self, turns: (f64, f64), mass: f64) {
        let place = |turn: f64| turn / PI * BINS as f64;
        let (low, high) = (place(turns.0.min(turns.1)), place(turns.0.max(turns.1)));
        let width = high - low;
        let (first, last) = (low as usize, high as usize);
        for bin in first..=last {
            let covered = (high.min(bin as f64 + 1.0) - low.max(bin as f64)).max(0.0);
            let part = if first == last { 1.0 } else { covered / width };
            let around = bin % (2 * BINS);
            self.masses[if around < BINS { around } else { 2 * BINS - 1 - around }] += mass * part;
        }
    }

    /// The part of the light in each bin. Their sum falls short of 1 by the light that is reflected still more often.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// Angle at the lower end of a bin, degrees.
    pub fn angle(bin: usize) -> f64 {
        180.0 * bin as f64 / BINS as f64
    }

    /// Weighted sum of tables, negative entries taken for 0, scaled to sum 1.
    pub fn blend(tables: &[ScatteringTable], weights: &[f64]) -> Self {
        let mut masses = vec![0.0; BINS];
        for (table, weight) in tables.iter().zip(weights) {
            for (sum, mass) in masses.iter_mut().zip(&table.masses) {
                *sum += weight * mass;
            }
        }
        masses.iter_mut().for_each(|m| *m = m.max(0.0));
        let total: f64 = masses.iter().sum();
        masses.iter_mut().for_each(|m| *m /= total);
        ScatteringTable { masses }
    }
}
