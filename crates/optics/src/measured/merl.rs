//! The MERL database's files: isotropic reflectance of 100 materials by half vector, one value per cell.
//!
//! W. Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003. A file is three `i32` (90, 90, 180), then as `f64` all
//! red, all green and all blue values, each in the order `phi_d + 180 (theta_d + 90 theta_h)`. Cells are a degree of `theta_d` and
//! of `phi_d` (0..180: the two directions may be swapped) and grow with the square of `theta_h`, so that highlights are fine.
//! Stored values are scaled by 1500, 1500/1.15, 1500/1.66; a negative one says that nothing was measured there.
//!
//! **Between cells** values are interpolated along all three angles from the cells' centres; `phi_d` goes round, the other two
//! stay as they are before the first and after the last centre. A cell without measurement has no weight: the others around it
//! share its part, and where none of the eight was measured the value is 0. [`MerlTable::nearest`] is the plain cell.

use super::half::HalfAngles;
use super::merl_sampling::HalfVectorTables;
use super::{Reflectance, in_lanes};
use crate::{Lanes, Light};
use core::f32::consts::{FRAC_PI_2, PI};
use kirkas_geometry::Vec3;

/// Cells along `theta_h`.
pub const THETA_H: usize = 90;
/// Cells along `theta_d`.
pub const THETA_D: usize = 90;
/// Cells along `phi_d`, over half a turn.
pub const PHI_D: usize = 180;
/// Values of a channel.
pub const CELLS: usize = THETA_H * THETA_D * PHI_D;
/// Length of a file.
pub const FILE_BYTES: usize = 12 + 3 * 8 * CELLS;
/// What a file begins with.
pub const HEADER: [u8; 12] = [90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0];
/// What stored red, green and blue are multiplied by.
pub const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// Red of a cell where nothing was measured.
const INVALID: f32 = -1.0;

/// A material of the database.
#[derive(Clone, Debug, PartialEq)]
pub struct MerlTable {
    /// Linear values, 1/sr, by [`index`].
    cells: Vec<[f32; 3]>,
    sampling: HalfVectorTables,
}

/// Place of a cell in the table.
pub fn index(theta_h: usize, theta_d: usize, phi_d: usize) -> usize {
    phi_d + PHI_D * (theta_d + THETA_D * theta_h)
}

/// The half vector's angle at a place along its axis (0..90), radians.
pub fn theta_h_at(place: f64) -> f64 {
    let share = place / THETA_H as f64;
    share * share * core::f64::consts::FRAC_PI_2
}

impl MerlTable {
    /// From a file's bytes.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let Some(header) = bytes.first_chunk::<12>() else {
            return Err(format!("it is only {} bytes long", bytes.len()));
        };
        let size = |i: usize| i32::from_le_bytes([header[i], header[i + 1], header[i + 2], header[i + 3]]);
        let sizes = [size(0), size(4), size(8)];
        if sizes != [THETA_H as i32, THETA_D as i32, PHI_D as i32] {
            return Err(format!("it is no MERL file: it begins with {sizes:?} instead of [90, 90, 180]"));
        }
        if bytes.len() != FILE_BYTES {
            return Err(format!("a MERL file has {FILE_BYTES} bytes, this one {}", bytes.len()));
        }
        let stored = |i: usize| {
            let at = 12 + 8 * i;
            f64::from_le_bytes(core::array::from_fn(|k| bytes[at + k]))
        };
        let mut cells = vec![[INVALID; 3]; CELLS];
        for (i, cell) in cells.iter_mut().enumerate() {
            let raw = [stored(i), stored(CELLS + i), stored(2 * CELLS + i)];
            if let Some(x) = raw.iter().find(|x| !(x.abs() < 1e30)) {
                return Err(format!("value {i} is {x}"));
            }
            if raw.iter().all(|&x| x >= 0.0) {
                *cell = core::array::from_fn(|c| (raw[c] * SCALES[c]) as f32);
            }
        }
        if cells.iter().all(|c| c[0] < 0.0) {
            return Err("no cell of it was measured".into());
        }
        let mut table = MerlTable { cells, sampling: HalfVectorTables::default() };
        table.sampling = HalfVectorTables::new(|wo, wi| table.rgb(&HalfAngles::of(wo, wi)));
        Ok(table)
    }

    /// The value of a cell; `None` where nothing was measured.
    pub fn cell(&self, theta_h: usize, theta_d: usize, phi_d: usize) -> Option<[f32; 3]> {
        let cell = self.cells[index(theta_h, theta_d, phi_d)];
        (cell[0] >= 0.0).then_some(cell)
    }

    /// The value of the cell that the angles lie in, linear Rec.709, 1/sr; 0 where nothing was measured.
    pub fn nearest(&self, at: &HalfAngles) -> [f32; 3] {
        let place = places(at);
        let last = [THETA_H, THETA_D, PHI_D];
        let [h, d, p] = core::array::from_fn(|i| (place[i] as usize).min(last[i] - 1));
        self.cell(h, d, p).unwrap_or_default()
    }

    /// The interpolated value, linear Rec.709, 1/sr.
    #[inline]
    pub fn rgb(&self, at: &HalfAngles) -> [f32; 3] {
        let [h, d, p] = places(at);
        let (h0, h1, dh) = between(h, THETA_H);
        let (d0, d1, dd) = between(d, THETA_D);
        // Around, the cell after the last is the first.
        let p = if p < 0.5 { p + (PHI_D as f32 - 0.5) } else { p - 0.5 };
        let p0 = (p as usize).min(PHI_D - 1);
        let p1 = if p0 + 1 < PHI_D { p0 + 1 } else { 0 };
        let dp = (p - p0 as f32).min(1.0);
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for (h, wh) in [(h0, 1.0 - dh), (h1, dh)] {
            for (d, wd) in [(d0, 1.0 - dd), (d1, dd)] {
                let row = &self.cells[index(h, d, 0)..][..PHI_D];
                for (p, wp) in [(p0, 1.0 - dp), (p1, dp)] {
                    let (cell, w) = (row[p], wh * wd * wp);
                    if cell[0] >= 0.0 {
                        weights += w;
                        for c in 0..3 {
                            sum[c] += w * cell[c];
                        }
                    }
                }
            }
        }
        if weights > 0.0 { sum.map(|s| s / weights) } else { [0.0; 3] }
    }
}

/// Where angles lie along the table's axes: cell i from i to i + 1.
fn places(at: &HalfAngles) -> [f32; 3] {
    let phi = if at.phi_d < 0.0 { at.phi_d + PI } else { at.phi_d };
    [
        THETA_H as f32 * (at.theta_h / FRAC_PI_2).max(0.0).sqrt(),
        THETA_D as f32 * (at.theta_d / FRAC_PI_2).max(0.0),
        PHI_D as f32 * (phi / PI).max(0.0),
    ]
}

/// The cells whose centres are on both sides of a place, and how far it lies towards the second.
#[inline]
fn between(place: f32, cells: usize) -> (usize, usize, f32) {
    let x = (place - 0.5).max(0.0).min((cells - 1) as f32);
    let i = (x as usize).min(cells - 2);
    (i, i + 1, x - i as f32)
}

impl Reflectance for MerlTable {
    fn value(&self, wo: Vec3, wi: Vec3, lanes: &Lanes) -> Light {
        in_lanes(self.rgb(&HalfAngles::of(wo, wi)), lanes)
    }
    fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.sampling.density(wo, wi)
    }
    fn draw(&self, wo: Vec3, u_lobe: f32, u: (f32, f32)) -> Vec3 {
        self.sampling.draw(wo, u_lobe, u)
    }
    fn albedo(&self, lanes: &Lanes) -> Light {
        in_lanes(self.sampling.albedo, lanes)
    }
}
