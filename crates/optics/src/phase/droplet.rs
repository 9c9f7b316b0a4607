//! # droplet
//!
//! How a raindrop scatters, computed from nothing but Snell's and Fresnel's laws: rays through a ball of water make the
//! primary bow (one reflection inside, 42 degrees from the point opposite the sun, red outside), the secondary (two, 51
//! degrees, red inside), Alexander's dark band between them, and the bright sky within.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflections` | whole number, 0..12 | | 5 | reflections inside that are followed: 1 ends with the primary bow, 2 with the secondary |
//! | `ior` | number, 1..4 | | water's | refractive index, the same at all wavelengths; else that of water at 20 C by wavelength |
//!
//! ## Example
//!
//! ```toml
//! [phases.rain]
//! type = "droplet"
//! ```
//!
//! ## Limits
//!
//! Geometric optics: no supernumerary arcs, no glory, no corona, none of the white bows of fog; right for drops of half a
//! millimetre and more. Drops are round, and polarisation is not carried on. The light that is diffracted around a drop, half of
//! what it takes out of a beam, stays near the beam and is left in it. In RGB the bow has the colours that it has under
//! daylight, as far as they are inside the gamut. The angle is kept in bins of 0.02
//! degrees, wavelengths 5 nm apart.
//!
//! ## References
//!
//! R. Descartes, "Les Meteores", 1637, discourse 8. H. C. van de Hulst, "Light Scattering by Small Particles", 1957, chapter
//! 12. M. Daimon & A. Masumura, "Measurement of the refractive index of distilled water from the near-infrared region to the
//! ultraviolet region", Applied Optics 46(18), 2007, table 3 (20 C).

use super::scattering_table::{BINS, ScatteringTable};
use super::{Scatter, Turn};
use crate::index::known;
use crate::spectrum::curve::{FIRST, SAMPLES, STEP, wavelength};
use crate::spectrum::observer::observer;
use crate::{ColorMode, Lanes, Light, Palette};
use core::f64::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{asin, sin};
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use std::sync::Arc;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Phase,
    name: "droplet",
    doc: "Drops of water: the rainbow.",
    params: &[
        ParamSpec::integer(
            "reflections",
            5,
            (0.0, 12.0),
            "Reflections inside that are followed: 1 ends with the primary bow, 2 with the secondary.",
        ),
        ParamSpec::new(
            "ior",
            ParamType::Number,
            Fallback::Absent,
            "Refractive index, the same at all wavelengths; without it that of water by wavelength.",
        )
        .range((1.0, 4.0)),
    ],
};

/// What light sees of a drop.
#[derive(Clone, Debug)]
pub struct Droplet {
    /// Red, green, blue; or one for each of the wavelengths that curves are sampled at.
    columns: Arc<[Column]>,
}

/// One distribution over the angle, ready to be asked.
#[derive(Clone, Debug)]
struct Column {
    /// 1/sr in each bin.
    values: Vec<f32>,
    /// The part below each bin's lower end, and 1.
    below: Vec<f64>,
}

impl Scatter for Droplet {
    fn prepare(params: &Params, palette: &Palette) -> Self {
        let reflections = params.integer("reflections") as u32;
        let even = params.optional_number("ior").map(|n| ScatteringTable::of_ball(n, reflections));
        let table = |nanometres: f64| match &even {
            Some(table) => table.clone(),
            None => ScatteringTable::of_ball(water_index(nanometres) / AIR_INDEX, reflections),
        };
        let columns = match palette.mode() {
            ColorMode::Spectral => (0..SAMPLES).map(|i| Column::new(&table(wavelength(i)))).collect(),
            ColorMode::Rgb => {
                let tables: Vec<_> = steps().map(table).collect();
                let column = |c: usize| {
                    let weights: Vec<f64> = steps().map(|w| film_weights(w)[c]).collect();
                    Column::new(&ScatteringTable::blend(&tables, &weights))
                };
                (0..3).map(column).collect()
            }
        };
        Droplet { columns }
    }

    fn value(&self, lanes: &Lanes, wo: Vec3, wi: Vec3) -> Light {
        let bin = bin_between(wo, wi);
        match lanes.mode() {
            ColorMode::Rgb => {
                Light([self.columns[0].values[bin], self.columns[1].values[bin], self.columns[2].values[bin], 0.0])
            }
            ColorMode::Spectral => Light(lanes.wavelengths().map(|w| {
                let (column, beyond) = place(w);
                let (a, b) = (self.columns[column].values[bin], self.columns[column + 1].values[bin]);
                a + (b - a) * beyond
            })),
        }
    }

    fn turn(&self, lanes: &Lanes, lane: usize, u: f32) -> Turn {
        match lanes.mode() {
            ColorMode::Rgb => self.columns[lane.min(2)].turn(u),
            ColorMode::Spectral => {
                let (column, beyond) = place(lanes.wavelengths()[lane]);
                let here = 1.0 - beyond;
                if u < here {
                    self.columns[column].turn(u / here)
                } else {
                    self.columns[column + 1].turn((u - here) / beyond)
                }
            }
        }
    }
}

/// The column at or below a wavelength (nm), and how far towards the next it is.
fn place(nanometres: f32) -> (usize, f32) {
    let at = ((nanometres - FIRST as f32) / STEP as f32).clamp(0.0, (SAMPLES - 1) as f32);
    let column = (at as usize).min(SAMPLES - 2);
    (column, at - column as f32)
}

impl Column {
    fn new(table: &ScatteringTable) -> Self {
        let total: f64 = table.masses().iter().sum();
        let mut sum = 0.0;
        let mut below = vec![0.0];
        below.extend(table.masses().iter().map(|m| {
            sum += m / total;
            sum
        }));
        below[BINS] = 1.0;
        let density = |bin: usize| {
            let mass = below[bin + 1] - below[bin];
            (mass / (4.0 * PI * (haversine(bin + 1) - haversine(bin)))) as f32
        };
        Column { values: (0..BINS).map(density).collect(), below }
    }

    /// Evenly by solid angle within a bin.
    fn turn(&self, u: f32) -> Turn {
        let u = f64::from(u);
        let bin = self.below.partition_point(|&b| b <= u).clamp(1, BINS) - 1;
        let (low, high) = (self.below[bin], self.below[bin + 1]);
        let within = ((u - low) / (high - low)).clamp(0.0, 1.0);
        let h = haversine(bin) + within * (haversine(bin + 1) - haversine(bin));
        Turn { cos: (1.0 - 2.0 * h) as f32, sin: (2.0 * (h * (1.0 - h)).sqrt()) as f32 }
    }
}

/// sin^2(angle / 2) at the lower end of a bin.
fn haversine(bin: usize) -> f64 {
    let s = sin(0.5 * PI * bin as f64 / BINS as f64);
    s * s
}

/// The bin of the angle between `-wo` and `wi`, from the shorter chord, which keeps its digits.
fn bin_between(wo: Vec3, wi: Vec3) -> usize {
    let is_forward = wo.dot(wi) < 0.0;
    let chord = if is_forward { (wo + wi).length() } else { (wo - wi).length() };
    let half = asin((0.5 * f64::from(chord)).min(1.0)) / (0.5 * PI) * BINS as f64;
    (if is_forward { half } else { BINS as f64 - half }).clamp(0.0, BINS as f64 - 1.0) as usize
}

/// Refractive index of water at 20 C from vacuum, at a wavelength in nm.
pub fn water_index(nanometres: f64) -> f64 {
    known::constants("water").map_or(4.0 / 3.0, |c| c.n.at(nanometres))
}

/// Refractive index of air at 15 C in green light (Ciddor 1996); it varies by 4e-6 over the visible range.
pub const AIR_INDEX: f64 = 1.000278;

/// Wavelengths that red, green and blue are mixed of, nm.
fn steps() -> impl Iterator<Item = f64> {
    (0..=136).map(|i| 390.0 + 2.5 * f64::from(i))
}

/// Red, green, blue of a wavelength (nm) under daylight, up to a scale.
fn film_weights(nanometres: f64) -> [f64; 3] {
    let (observer, nanometres) = (observer(), nanometres as f32);
    observer.film(nanometres).map(|c| f64::from(c) * f64::from(observer.white(nanometres)))
}
