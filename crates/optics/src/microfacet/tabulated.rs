//! Any distribution of facets, as a table over the hemisphere of their normals.
//!
//! Symbols of M. Ashikhmin, S. Premože & P. Shirley, "A Microfacet-Based BRDF Generator", SIGGRAPH 2000: `p(h)` facets per solid
//! angle, at any scale, which cancels; `<n.h>` the integral of `(n.h) p(h)`; `g(k)` that of `(h.k) p(h)` where `h.k > 0`.
//!
//! Nodes lie at `s = sqrt(1 - h.z) = i / 64` and longitude `2 pi j / 64`; `p` is bilinear between them. The integrals are sums over the
//! cells, each the mean of its corners at its centre.

use core::f32::consts::PI;
use kirkas_geometry::elementary::{atan2_f32, cos, sin, sin_cos_f32};
use kirkas_geometry::{DVec3, Vec3};

/// Steps of `s`, and of the longitude.
pub const STEPS: usize = 64;
/// Steps of the cosine of `k` (and one node more), and of its longitude, in the table of `g`.
const G_COSINES: usize = 32;
const G_TURNS: usize = 32;

/// A table of facets.
#[derive(Clone, Debug)]
pub struct Tabulated {
    p: Vec<f32>,
    /// Running sums of the cells' shares, up to 1.
    shares: Vec<f32>,
    g: Vec<f32>,
    /// `<n.h>`
    mean_cosine: f32,
    total: f32,
}

impl Tabulated {
    /// From `p` at polar angle (0..pi/2) and longitude (0..2 pi), radians; negative and what is no number counts nothing. `None`
    /// where that leaves no facets.
    pub fn new(p: impl Fn(f64, f64) -> f64) -> Option<Self> {
        use core::f64::consts::TAU;
        let mut nodes = Vec::with_capacity((STEPS + 1) * STEPS);
        for i in 0..=STEPS {
            let s = i as f64 / STEPS as f64;
            let theta = 2.0 * kirkas_geometry::elementary::asin((s * core::f64::consts::FRAC_1_SQRT_2).min(1.0));
            nodes.extend((0..STEPS).map(|j| p(theta, TAU * j as f64 / STEPS as f64).clamp(0.0, 1e12) as f32));
        }
        nodes.iter_mut().filter(|x| x.is_nan()).for_each(|x| *x = 0.0);
        // Each cell's centre and how many facets it holds.
        let mut cells = Vec::with_capacity(STEPS * STEPS);
        for i in 0..STEPS {
            let (s0, s1) = (i as f64 / STEPS as f64, (i + 1) as f64 / STEPS as f64);
            let z = 1.0 - 0.5 * (s0 * s0 + s1 * s1);
            let r = (1.0 - z * z).sqrt();
            for j in 0..STEPS {
                let corner = |a: usize, b: usize| f64::from(nodes[(i + a) * STEPS + (j + b) % STEPS]);
                let mean = 0.25 * (corner(0, 0) + corner(0, 1) + corner(1, 0) + corner(1, 1));
                let phi = TAU * (j as f64 + 0.5) / STEPS as f64;
                let area = (s1 * s1 - s0 * s0) * TAU / STEPS as f64;
                cells.push((DVec3::new(r * cos(phi), r * sin(phi), z), mean * area));
            }
        }
        let total: f64 = cells.iter().map(|c| c.1).sum();
        if !(total > 0.0) {
            return None;
        }
        let mut sum = 0.0;
        let mut shares = Vec::with_capacity(cells.len());
        for (_, facets) in &cells {
            sum += facets / total;
            shares.push(sum as f32);
        }
        let mut g = Vec::with_capacity((G_COSINES + 1) * G_TURNS);
        for i in 0..=G_COSINES {
            let z = i as f64 / G_COSINES as f64;
            let r = (1.0 - z * z).sqrt();
            for j in 0..G_TURNS {
                let phi = TAU * j as f64 / G_TURNS as f64;
                let k = DVec3::new(r * cos(phi), r * sin(phi), z);
                g.push(cells.iter().map(|(h, facets)| h.dot(k).max(0.0) * facets).sum::<f64>() as f32);
            }
        }
        let mean_cosine = cells.iter().map(|(h, facets)| h.z * facets).sum::<f64>() as f32;
        Some(Tabulated { p: nodes, shares, g, mean_cosine, total: total as f32 })
    }

    /// `p(h)`.
    pub fn p(&self, h: Vec3) -> f32 {
        let s = ((1.0 - h.z).max(0.0) * STEPS as f32 * STEPS as f32).sqrt();
        bilinear(&self.p, STEPS, s, STEPS, turn(h))
    }

    /// `<n.h> / (g(wo) g(wi))`: what `p F / 4` is multiplied by.
    pub fn visibility(&self, wo: Vec3, wi: Vec3) -> f32 {
        let g = |w: Vec3| bilinear(&self.g, G_COSINES, w.z * G_COSINES as f32, G_TURNS, turn(w));
        let both = g(wo) * g(wi);
        if both > 0.0 { self.mean_cosine / both } else { 0.0 }
    }

    /// A facet, drawn by how many of them a cell holds.
    pub fn sample(&self, u: (f32, f32)) -> Vec3 {
        let cell = self.shares.partition_point(|&sum| sum <= u.0).min(self.shares.len() - 1);
        let start = if cell == 0 { 0.0 } else { self.shares[cell - 1] };
        let within = ((u.0 - start) / (self.shares[cell] - start).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let (i, j) = (cell / STEPS, cell % STEPS);
        let (s0, s1) = (i as f32 / STEPS as f32, (i + 1) as f32 / STEPS as f32);
        let z = 1.0 - (s0 * s0 + u.1 * (s1 * s1 - s0 * s0));
        let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let (sin, cos) = sin_cos_f32(2.0 * PI * (j as f32 + within) / STEPS as f32);
        Vec3::new(r * cos, r * sin, z)
    }

    /// Density per solid angle of [`Tabulated::sample`].
    pub fn pdf(&self, h: Vec3) -> f32 {
        let s = ((1.0 - h.z).max(0.0)).sqrt() * STEPS as f32;
        let i = (s as usize).min(STEPS - 1);
        let j = ((turn(h) * STEPS as f32) as usize).min(STEPS - 1);
        let corner = |a: usize, b: usize| self.p[(i + a) * STEPS + (j + b) % STEPS];
        0.25 * (corner(0, 0) + corner(0, 1) + corner(1, 0) + corner(1, 1)) / self.total
    }
}

/// The longitude as a part of a turn, in `[0, 1)`.
fn turn(w: Vec3) -> f32 {
    let t = atan2_f32(w.y, w.x) / (2.0 * PI);
    if t < 0.0 { (t + 1.0).min(1.0 - f32::EPSILON) } else { t }
}

/// Between the nodes of `rows + 1` rows of `columns`, at row `x` and part `t` of a turn.
fn bilinear(nodes: &[f32], rows: usize, x: f32, columns: usize, t: f32) -> f32 {
    let i = (x as usize).min(rows - 1);
    let fx = (x - i as f32).clamp(0.0, 1.0);
    let y = t * columns as f32;
    let j = (y as usize).min(columns - 1);
    let fy = y - j as f32;
    let along = |row: usize| {
        let (a, b) = (nodes[row * columns + j], nodes[row * columns + (j + 1) % columns]);
        a + (b - a) * fy
    };
    let (a, b) = (along(i), along(i + 1));
    a + (b - a) * fx
}
