//! Drawing directions for isotropic tables: the half vector, by what reflects about it, tabulated for some angles of `wo`.
//!
//! For each of [`ANGLES`] angles of `wo` the half vector's hemisphere is cut into cells (along `theta_h` those of MERL, along the
//! longitude from the plane of `wo` equal ones, the same to the left and to the right), each of an even density that follows
//! the mean of `f cos 4 (wo.h)` there: what `f cos` is worth per solid angle of `h` (Walter et al. 2007, equation 14). Between
//! the angles the two densities around are mixed, and one draws from either. [`COSINE_SHARE`] of all samples follow the cosine.

use super::COSINE_SHARE;
use super::merl::{THETA_H, theta_h_at};
use crate::fresnel::reflect;
use core::f32::consts::{FRAC_PI_2, PI};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{acos_f32, atan2_f32, sin_cos, sin_cos_f32};
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};

/// Angles of `wo`, in the middle of equal steps to 90 degrees.
const ANGLES: usize = 32;
/// Cells along the longitude, over half a turn.
const LONGITUDES: usize = 24;
/// Points each way at which a cell is looked at.
const POINTS: usize = 2;

/// What half vectors are drawn with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HalfVectorTables {
    tables: Vec<Table>,
    /// 1 - cos of `theta_h` where cells begin, and at the end.
    edges: Vec<f32>,
    /// The part of even light from all round that is reflected.
    pub albedo: [f32; 3],
}

/// For one angle of `wo`.
#[derive(Clone, Debug, PartialEq)]
struct Table {
    /// Probability of all rows of `theta_h` before each, and 1 at the end.
    rows: Vec<f32>,
    /// Within each row, the same for the longitudes.
    longitudes: Vec<[f32; LONGITUDES + 1]>,
    /// Per solid angle of the half vector.
    density: Vec<[f32; LONGITUDES]>,
}

impl HalfVectorTables {
    /// For a reflectance `f(wo, wi)`, both above the surface.
    pub fn new(f: impl Fn(Vec3, Vec3) -> [f32; 3]) -> Self {
        // 2 sin^2 of half the angle: no digits are lost near 0.
        let one_minus_cos = |place: f64| {
            let s = sin_cos(0.5 * theta_h_at(place)).0;
            2.0 * s * s
        };
        let edges: Vec<f64> = (0..=THETA_H).map(|i| one_minus_cos(i as f64)).collect();
        let (mut albedo, mut weights) = ([0.0; 3], 0.0);
        let tables = (0..ANGLES).map(|k| {
            let (sin_o, cos_o) = sin_cos(f64::from(FRAC_PI_2) * (k as f64 + 0.5) / ANGLES as f64);
            let (table, reflected) = Table::new(Vec3::new(sin_o as f32, 0.0, cos_o as f32), &edges, &f);
            // Even light: by the solid angle and cosine of wo.
            let weight = sin_o * cos_o;
            weights += weight;
            for c in 0..3 {
                albedo[c] += weight * reflected[c];
            }
            table
        });
        HalfVectorTables {
            tables: tables.collect(),
            edges: edges.into_iter().map(|x| x as f32).collect(),
            albedo: albedo.map(|a| (a / weights) as f32),
        }
    }

    /// The density per solid angle of `wi`.
    pub fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        let cosine = COSINE_SHARE * square_to_cosine_hemisphere_pdf(wi);
        let sum = wi + wo;
        let across = (sum.x * sum.x + sum.y * sum.y).sqrt();
        let theta_h = atan2_f32(across, sum.z);
        let row = ((THETA_H as f32 * (theta_h / FRAC_PI_2).sqrt()) as usize).min(THETA_H - 1);
        let (ox, oy) = plane_of(wo);
        let phi = atan2_f32((sum.y * ox - sum.x * oy).abs(), sum.x * ox + sum.y * oy);
        let longitude = ((LONGITUDES as f32 * (phi / PI)) as usize).min(LONGITUDES - 1);
        let (k, share) = angle_place(wo);
        let of = |k: usize| self.tables[k].density[row][longitude];
        let half = of(k) * (1.0 - share) + of(k + 1) * share;
        // wo.h is half the sum's length.
        cosine + (1.0 - COSINE_SHARE) * half / (2.0 * sum.length())
    }

    /// A direction.
    pub fn draw(&self, wo: Vec3, u_lobe: f32, u: (f32, f32)) -> Vec3 {
        if u_lobe < COSINE_SHARE {
            return square_to_cosine_hemisphere(u);
        }
        let (k, share) = angle_place(wo);
        let u_angle = (u_lobe - COSINE_SHARE) / (1.0 - COSINE_SHARE);
        let table = &self.tables[if u_angle < share { k + 1 } else { k }];
        let (row, within_row) = find(&table.rows, u.0);
        // Left and right of the plane of wo.
        let (side, v) = if u.1 < 0.5 { (1.0, 2.0 * u.1) } else { (-1.0, 2.0 * u.1 - 1.0) };
        let (longitude, within) = find(&table.longitudes[row], v);
        let one_minus_cos = self.edges[row] + (self.edges[row + 1] - self.edges[row]) * within_row;
        let sin = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
        let (s, c) = sin_cos_f32(PI * (longitude as f32 + within) / LONGITUDES as f32);
        let (s, (ox, oy)) = (side * s, plane_of(wo));
        let h = Vec3::new(sin * (c * ox - s * oy), sin * (c * oy + s * ox), 1.0 - one_minus_cos);
        reflect(wo, h)
    }
}

/// The horizontal direction of `wo`.
fn plane_of(wo: Vec3) -> (f32, f32) {
    let across = (wo.x * wo.x + wo.y * wo.y).sqrt();
    if across > 0.0 { (wo.x / across, wo.y / across) } else { (1.0, 0.0) }
}

/// The table before the angle of `wo`, and how far it lies towards the next.
fn angle_place(wo: Vec3) -> (usize, f32) {
    let place = ANGLES as f32 * acos_f32(wo.z.min(1.0)) / FRAC_PI_2 - 0.5;
    let place = place.max(0.0).min((ANGLES - 1) as f32);
    let k = (place as usize).min(ANGLES - 2);
    (k, place - k as f32)
}

/// The step of a rising table that `u` falls into, and how far, in 0..1.
fn find(cumulative: &[f32], u: f32) -> (usize, f32) {
    let i = cumulative.partition_point(|&c| c <= u).clamp(1, cumulative.len() - 1) - 1;
    let step = cumulative[i + 1] - cumulative[i];
    (i, if step > 0.0 { ((u - cumulative[i]) / step).max(0.0).min(1.0) } else { 0.5 })
}

impl Table {
    /// The table, and the part of the light from `wo` that is reflected.
    fn new(wo: Vec3, edges: &[f64], f: &impl Fn(Vec3, Vec3) -> [f32; 3]) -> (Self, [f64; 3]) {
        let mut weights = vec![[0.0_f64; LONGITUDES]; THETA_H];
        let mut reflected = [0.0; 3];
        for (row, out) in weights.iter_mut().enumerate() {
            // Both sides together.
            let solid_angle = (edges[row + 1] - edges[row]) * 2.0 * f64::from(PI) / LONGITUDES as f64;
            for (longitude, out) in out.iter_mut().enumerate() {
                let mean = cell_mean(wo, edges[row], edges[row + 1], longitude, f);
                *out = (mean[0] + mean[1] + mean[2]) * solid_angle;
                for c in 0..3 {
                    reflected[c] += mean[c] * solid_angle;
                }
            }
        }
        let total: f64 = weights.iter().flatten().sum();
        if !(total > 0.0) {
            weights = vec![[1.0; LONGITUDES]; THETA_H];
        }
        let total: f64 = weights.iter().flatten().sum();
        let mut rows = vec![0.0];
        let (mut longitudes, mut density, mut before) = (Vec::new(), Vec::new(), 0.0);
        for (row, weights) in weights.iter().enumerate() {
            let in_row: f64 = weights.iter().sum();
            before += in_row;
            rows.push((before / total) as f32);
            let (mut cumulative, mut sum) = ([0.0; LONGITUDES + 1], 0.0);
            for (i, w) in weights.iter().enumerate() {
                sum += w;
                cumulative[i + 1] =
                    if in_row > 0.0 { (sum / in_row) as f32 } else { (i + 1) as f32 / LONGITUDES as f32 };
            }
            longitudes.push(cumulative);
            let solid_angle = (edges[row + 1] - edges[row]) * 2.0 * f64::from(PI) / LONGITUDES as f64;
            density.push(weights.map(|w| (w / total / solid_angle) as f32));
        }
        (Table { rows, longitudes, density }, reflected)
    }
}

/// The mean of `f cos 4 (wo.h)` over a cell.
fn cell_mean(wo: Vec3, low: f64, high: f64, longitude: usize, f: &impl Fn(Vec3, Vec3) -> [f32; 3]) -> [f64; 3] {
    let mut mean = [0.0; 3];
    for i in 0..POINTS * POINTS {
        let part = |i: usize| (i as f64 + 0.5) / POINTS as f64;
        let one_minus_cos = low + (high - low) * part(i / POINTS);
        let sin = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
        let (s, c) = sin_cos(f64::from(PI) * (longitude as f64 + part(i % POINTS)) / LONGITUDES as f64);
        let h = Vec3::new((sin * c) as f32, (sin * s) as f32, (1.0 - one_minus_cos) as f32);
        let wi = reflect(wo, h);
        let facing = wo.dot(h);
        if wi.z > 0.0 && facing > 0.0 {
            let worth = f64::from(4.0 * facing * wi.z) / (POINTS * POINTS) as f64;
            for (m, v) in mean.iter_mut().zip(f(wo, wi)) {
                *m += worth * f64::from(v);
            }
        }
    }
    mean
}
