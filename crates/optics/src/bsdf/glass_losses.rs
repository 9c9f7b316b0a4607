//! What rough glass loses because its facets scatter light only once, and the lobes that give it back.
//!
//! After C. Kulla & A. Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017 courses. `L(w)` is what is lost of
//! light from `w` on its side, `M` its mean there. From side s to itself goes `R L(o) L(i) / (pi M)`, to the other side s'
//! `T L(o) L'(i) / (pi M')` (power): together just what was lost. `T = (1 - F) min(M, M') / M`, with `F` the mean of Fresnel's
//! reflectance, makes it reciprocal up to the square of the indices, and `R = 1 - T`. Tables are made when the scene is compiled.

use crate::fresnel::{dielectric, reflect, refract};
use crate::microfacet::{Distribution, Facets};
use core::array::from_fn;
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::hash::unit_f32;
use std::sync::{Mutex, PoisonError};

/// Steps of the cosine, `(i / 27)^2`.
const COSINES: usize = 28;
/// Steps of the roughness, `(i / 15)^2`.
const ROUGHS: usize = 16;
/// Visible normals, by Hammersley's points.
const NORMALS: u32 = 1024;

/// The tables of one refractive index, against vacuum: side above, side below.
#[derive(Debug)]
pub(super) struct GlassLosses {
    distribution: Distribution,
    ior: f32,
    lost: [[[f32; COSINES]; ROUGHS]; 2],
    means: [[f32; ROUGHS]; 2],
    /// `1 - F` of each side.
    passes: [f32; 2],
}

/// They at one roughness.
#[derive(Clone, Copy, Debug)]
pub(super) struct GlassLossesAt {
    table: &'static GlassLosses,
    row: u32,
    between: f32,
    means: [f32; 2],
}

impl GlassLosses {
    /// Made once for each refractive index in the life of the program (4 kilobytes), so that points may refer to it.
    pub(super) fn of(distribution: Distribution, ior: f32) -> &'static Self {
        static MADE: Mutex<Vec<&GlassLosses>> = Mutex::new(Vec::new());
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |t: &&&GlassLosses| t.distribution == distribution && t.ior.to_bits() == ior.to_bits();
        if let Some(table) = made.iter().find(is_it) {
            return table;
        }
        let table: &'static GlassLosses = Box::leak(Box::new(Self::new(distribution, ior)));
        made.push(table);
        table
    }

    fn new(distribution: Distribution, ior: f32) -> Self {
        let side = |(eta_o, eta_i): (f32, f32)| -> [[f32; COSINES]; ROUGHS] {
            from_fn(|k| {
                let alpha = square(k as f32 / (ROUGHS - 1) as f32);
                let facets = Facets::new(distribution, (alpha, alpha));
                from_fn(|i| if k == 0 { 0.0 } else { lost(&facets, cosine(i), eta_o, eta_i) })
            })
        };
        let lost = [side((1.0, ior)), side((ior, 1.0))];
        let passes = passes(ior);
        GlassLosses { distribution, ior, means: from_fn(|s| from_fn(|k| mean_of(&lost[s][k]))), lost, passes }
    }

    /// Of facets between these indices; `None` where the tables are of others.
    pub(super) fn at(&'static self, facets: &Facets, above: f32, below: f32) -> Option<GlassLossesAt> {
        if (below / above - self.ior).abs() > 1e-3 * self.ior {
            return None;
        }
        let (row, between) = place(facets.mean_alpha(), ROUGHS);
        let means = self.means.map(|m| mix(m[row], m[row + 1], between));
        (means[0].min(means[1]) > 1e-6).then_some(GlassLossesAt { table: self, row: row as u32, between, means })
    }
}

impl GlassLossesAt {
    /// `L` on side 0 (above) or 1.
    #[inline]
    pub(super) fn lost(&self, side: usize, cos: f32) -> f32 {
        let (i, t) = place(cos, COSINES);
        let rows = &self.table.lost[side];
        let at = |row: usize| mix(rows[row][i], rows[row][i + 1], t);
        mix(at(self.row as usize), at(self.row as usize + 1), self.between)
    }

    /// `(R, T)` for light that comes back out on `side`.
    pub(super) fn parts(&self, side: usize) -> (f32, f32) {
        let t = self.table.passes[side] * self.means[0].min(self.means[1]) / self.means[side];
        (1.0 - t, t)
    }

    /// The lobe to `side_i` (1/sr, of power), but for R or T.
    #[inline]
    pub(super) fn lobe(&self, (side_o, cos_o): (usize, f32), (side_i, cos_i): (usize, f32)) -> f32 {
        self.lost(side_o, cos_o) * self.lost(side_i, cos_i) / (PI * self.means[side_i])
    }
}

/// What is lost of light that meets facets at this cosine: by how much `G2 / G1` of what leaves falls short of 1.
fn lost(facets: &Facets, cos: f32, eta_o: f32, eta_i: f32) -> f32 {
    let wo = Vec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos);
    let lambda = facets.lambda(wo);
    let mut kept = 0.0;
    for i in 0..NORMALS {
        let u = ((i as f32 + 0.5) / NORMALS as f32, unit_f32(i.reverse_bits()));
        let h = facets.sample_visible_normal(wo, u);
        let r = dielectric(wo.dot(h).clamp(0.0, 1.0), eta_o, eta_i);
        let wi = reflect(wo, h);
        if wi.z > 0.0 {
            kept += r * (1.0 + lambda) / (1.0 + lambda + facets.lambda(wi));
        }
        if let Some(wi) = refract(wo, h, eta_o, eta_i).filter(|wi| wi.z < 0.0) {
            kept += (1.0 - r) * facets.g1(Vec3::new(wi.x, wi.y, -wi.z));
        }
    }
    (1.0 - kept / NORMALS as f32).max(0.0)
}

/// `1 - F` of both sides: what the mean of Fresnel's equations over all directions lets through.
fn passes(ior: f32) -> [f32; 2] {
    const STEPS: usize = 512;
    // From the thinner side nothing is reflected totally.
    let (thin, dense) = if ior >= 1.0 { (1.0, ior) } else { (ior, 1.0) };
    let at = |i: usize| {
        let cos = (i as f32 + 0.5) / STEPS as f32;
        2.0 * cos * (1.0 - dielectric(cos, thin, dense)) / STEPS as f32
    };
    let from_thin: f32 = (0..STEPS).map(at).sum();
    let from_dense = from_thin * square(thin / dense);
    if ior >= 1.0 { [from_thin, from_dense] } else { [from_dense, from_thin] }
}

/// The cosine of a step; the first one is all but grazing.
fn cosine(i: usize) -> f32 {
    square(i as f32 / (COSINES - 1) as f32).max(1e-3)
}

/// The mean over all directions, weighted by their cosines: Simpson's rule within each step.
fn mean_of(nodes: &[f32; COSINES]) -> f32 {
    let w = 1.0 / (COSINES - 1) as f32;
    // mu = x^2, 2 mu dmu = 4 x^3 dx.
    let weighted = |x: f32, value: f32| 4.0 * x * x * x * value;
    let step = |i: usize| {
        let (x0, x1) = (i as f32 * w, (i + 1) as f32 * w);
        let middle = weighted(0.5 * (x0 + x1), 0.5 * (nodes[i] + nodes[i + 1]));
        (weighted(x0, nodes[i]) + 4.0 * middle + weighted(x1, nodes[i + 1])) * w / 6.0
    };
    (0..COSINES - 1).map(step).sum()
}

fn place(x: f32, steps: usize) -> (usize, f32) {
    let scaled = x.clamp(0.0, 1.0).sqrt() * (steps - 1) as f32;
    let cell = (scaled as usize).min(steps - 2);
    (cell, scaled - cell as f32)
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

fn square(x: f32) -> f32 {
    x * x
}
