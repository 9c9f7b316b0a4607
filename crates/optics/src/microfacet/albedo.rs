//! What rough mirrors lose because their facets scatter light only once, and the lobe that gives it back.
//!
//! C. Kulla & A. Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017 courses, equations 3-7: the lobe
//! `(1 - E(wo)) (1 - E(wi)) / (pi (1 - E_mean))`, where `E` is the albedo of white facets. With equal roughness in all directions
//! `E` is from a table; with unequal ones it is that of their root mean square.

use super::losses::{self, N};
use super::{Distribution, Facets};
use core::f32::consts::PI;

/// The losses of one roughness.
#[derive(Clone, Copy, Debug)]
pub struct Losses {
    table: &'static [f32; N * N],
    row: usize,
    /// Between this row and the next.
    between: f32,
    mean: f32,
}

impl Losses {
    /// Of these facets.
    pub fn new(facets: &Facets) -> Self {
        let (table, means) = match facets.distribution() {
            Distribution::Ggx => (&losses::GGX, &losses::GGX_MEAN),
            Distribution::Beckmann => (&losses::BECKMANN, &losses::BECKMANN_MEAN),
        };
        let (row, between) = place(facets.mean_alpha());
        Losses { table, row, between, mean: mix(means[row], means[row + 1], between) }
    }

    /// What is lost of the light from (or to) a direction of this cosine: `1 - E`.
    #[inline]
    pub fn at(&self, cos: f32) -> f32 {
        let (column, across) = place(cos);
        let at = |row: usize| {
            let start = row * N + column;
            mix(self.table[start], self.table[start + 1], across)
        };
        mix(at(self.row), at(self.row + 1), self.between)
    }

    /// Its mean over all directions, weighted by their cosines: `1 - E_mean`.
    pub fn mean(&self) -> f32 {
        self.mean
    }

    /// The lobe that gives back what white facets lose (1/sr).
    #[inline]
    pub fn lobe(&self, cos_o: f32, cos_i: f32) -> f32 {
        if self.mean > 0.0 { self.at(cos_o) * self.at(cos_i) / (PI * self.mean) } else { 0.0 }
    }

    /// What coloured facets do to the lobe; `mean` is their reflectance's mean over all directions. Each further bounce reflects
    /// `mean`, and lets out `E_mean`.
    pub fn tint(&self, mean: f32) -> f32 {
        mean * mean * (1.0 - self.mean) / (1.0 - mean * self.mean)
    }
}

/// The cell of the table for a number in 0..1, and the place in it.
fn place(x: f32) -> (usize, f32) {
    let scaled = x.clamp(0.0, 1.0).sqrt() * (N - 1) as f32;
    let cell = (scaled as usize).min(N - 2);
    (cell, scaled - cell as f32)
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}
