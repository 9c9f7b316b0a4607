//! How much a rough clear coat reflects from each direction: a table per refractive index, over roughness and cosine, made when
//! the scene is compiled. What is not reflected passes: what bounces among the facets is taken to come through.

use super::coat::Coat;
use crate::fresnel::{dielectric, reflect};
use crate::microfacet::{Distribution, Facets};
use core::array::from_fn;
use kirkas_geometry::Vec3;
use std::sync::{Mutex, PoisonError};

/// Steps of the cosine, `(i / 15)^2`.
const COSINES: usize = 16;
/// Steps of the roughness, `(i / 11)^2`.
const ROUGHS: usize = 12;
/// Visible normals each way, the midpoints of a grid.
const NORMALS: usize = 24;

/// The table of one refractive index.
#[derive(Debug)]
pub(super) struct RoughCoat {
    distribution: Distribution,
    ior: f32,
    coat: Coat,
    rows: [[f32; COSINES]; ROUGHS],
    /// Of white light from everywhere outside, by row.
    means: [f32; ROUGHS],
}

/// It at one roughness, under one medium.
#[derive(Clone, Copy, Debug)]
pub(super) struct CoatAt {
    table: &'static RoughCoat,
    pub(super) coat: Coat,
    row: u32,
    between: f32,
    /// Of white light from everywhere outside.
    mean: f32,
}

impl RoughCoat {
    /// Made once for each refractive index in the life of the program (800 bytes), so that points may refer to it.
    pub(super) fn of(distribution: Distribution, ior: f32) -> &'static Self {
        static MADE: Mutex<Vec<&RoughCoat>> = Mutex::new(Vec::new());
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |t: &&&RoughCoat| t.distribution == distribution && t.ior.to_bits() == ior.to_bits();
        if let Some(table) = made.iter().find(is_it) {
            return table;
        }
        let table: &'static RoughCoat = Box::leak(Box::new(Self::new(distribution, ior)));
        made.push(table);
        table
    }

    fn new(distribution: Distribution, ior: f32) -> Self {
        let coat = Coat::new(1.0, ior);
        let row = |k: usize| {
            let alpha = square(k as f32 / (ROUGHS - 1) as f32);
            let facets = Facets::new(distribution, (alpha, alpha));
            from_fn(|i| if k == 0 { coat.reflectance(cosine(i)) } else { albedo(&facets, cosine(i), ior) })
        };
        let rows: [[f32; COSINES]; ROUGHS] = from_fn(row);
        RoughCoat { distribution, ior, coat, means: rows.map(|row| mean_of(|i| row[i])), rows }
    }

    /// Of facets, under a medium. For any but vacuum the table is scaled as smooth coats would be.
    pub(super) fn at(&'static self, facets: &Facets, outside: f32) -> CoatAt {
        let (row, between) = place(facets.mean_alpha(), ROUGHS);
        let mean = mix(self.means[row], self.means[row + 1], between);
        let mut at = CoatAt { table: self, coat: self.coat.under(outside), row: row as u32, between, mean };
        if !at.coat.is_under_vacuum() {
            at.mean = mean_of(|i| at.node(i));
        }
        at
    }
}

impl CoatAt {
    /// Part of white light from everywhere outside that is reflected.
    pub(super) fn mean(&self) -> f32 {
        self.mean
    }

    /// Part of the light from a direction of this cosine that is reflected.
    #[inline]
    pub(super) fn reflectance(&self, cos: f32) -> f32 {
        let (i, t) = place(cos, COSINES);
        mix(self.node(i), self.node(i + 1), t)
    }

    fn node(&self, i: usize) -> f32 {
        let row = self.row as usize;
        let r = mix(self.table.rows[row][i], self.table.rows[row + 1][i], self.between);
        if self.coat.is_under_vacuum() {
            return r;
        }
        let cos = cosine(i);
        (r * self.coat.reflectance(cos) / self.table.coat.reflectance(cos).max(1e-6)).min(1.0)
    }

    /// The same coat as if smooth, letting out of diffuse light from below as much as this one.
    pub(super) fn beneath(&self) -> Coat {
        self.coat.letting_out((1.0 - self.mean).max(1e-4) * self.coat.thinning())
    }
}

/// Albedo of facets that reflect as a dielectric, from this cosine: `G2 / G1` and Fresnel over visible normals.
fn albedo(facets: &Facets, cos: f32, ior: f32) -> f32 {
    let wo = Vec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos);
    let lambda = facets.lambda(wo);
    let mut sum = 0.0;
    for i in 0..NORMALS {
        for j in 0..NORMALS {
            let u = |n: usize| (n as f32 + 0.5) / NORMALS as f32;
            let h = facets.sample_visible_normal(wo, (u(i), u(j)));
            let wi = reflect(wo, h);
            if wi.z > 0.0 {
                let fresnel = dielectric(wo.dot(h).clamp(0.0, 1.0), 1.0, ior);
                sum += fresnel * (1.0 + lambda) / (1.0 + lambda + facets.lambda(wi));
            }
        }
    }
    sum / (NORMALS * NORMALS) as f32
}

/// The cosine of a step; the first one is all but grazing.
fn cosine(i: usize) -> f32 {
    square(i as f32 / (COSINES - 1) as f32).max(1e-3)
}

/// The mean over all directions, weighted by their cosines.
fn mean_of(node: impl Fn(usize) -> f32) -> f32 {
    (0..COSINES - 1).map(|i| mean_between(node(i), node(i + 1), i)).sum::<f32>().min(1.0)
}

/// The integral of `2 mu` times what lies between two steps, linear in the root of `mu`.
fn mean_between(a: f32, b: f32, i: usize) -> f32 {
    // mu = x^2, 2 mu dmu = 4 x^3 dx, over x from x0 to x0 + w, where the value is a + (b - a)(x - x0) / w.
    let w = 1.0 / (COSINES - 1) as f32;
    let x0 = i as f32 * w;
    let x1 = x0 + w;
    let quartic = square(square(x1)) - square(square(x0));
    let quintic = 0.8 * (square(square(x1)) * x1 - square(square(x0)) * x0);
    let slope = (b - a) / w;
    (a - slope * x0) * quartic + slope * quintic
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::coat::diffuse_reflectance;

    #[test]
    fn smooth_coats_have_the_mean_of_fresnel() {
        for ior in [1.3, 1.5, 2.0] {
            let table = RoughCoat::of(Distribution::Ggx, ior);
            let at = table.at(&Facets::ggx(0.0), 1.0);
            let mean = diffuse_reflectance(f64::from(ior));
            assert!((f64::from(at.mean) - mean).abs() < 3e-3, "{} {mean}", at.mean);
        }
    }
}
