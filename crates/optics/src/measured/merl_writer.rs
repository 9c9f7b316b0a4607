//! Writing MERL files: any isotropic reflectance, looked at in the middle of each cell.

use super::half::HalfAngles;
use super::merl::{CELLS, FILE_BYTES, PHI_D, SCALES, THETA_D, THETA_H, index, theta_h_at};
use core::f64::consts::{FRAC_PI_2, PI};
use kirkas_geometry::DVec3;

/// The bytes of a MERL file of the reflectance `f(wo, wi)`, linear Rec.709 in 1/sr without the cosine. Cells whose middle has a
/// direction below the surface are marked as not measured.
pub fn write_merl(f: impl Fn(DVec3, DVec3) -> [f64; 3]) -> Vec<u8> {
    let mut bytes = vec![0; FILE_BYTES];
    for (i, size) in [THETA_H, THETA_D, PHI_D].into_iter().enumerate() {
        bytes[4 * i..][..4].copy_from_slice(&(size as i32).to_le_bytes());
    }
    for theta_h in 0..THETA_H {
        for theta_d in 0..THETA_D {
            for phi_d in 0..PHI_D {
                let (wo, wi) = centre(theta_h, theta_d, phi_d);
                let value = if wo.z > 0.0 && wi.z > 0.0 { f(wo, wi) } else { [-1.0; 3] };
                for (c, v) in value.into_iter().enumerate() {
                    let at = 12 + 8 * (c * CELLS + index(theta_h, theta_d, phi_d));
                    bytes[at..][..8].copy_from_slice(&(v / SCALES[c]).to_le_bytes());
                }
            }
        }
    }
    bytes
}

/// The directions `(wo, wi)` in the middle of a cell.
pub(super) fn centre(theta_h: usize, theta_d: usize, phi_d: usize) -> (DVec3, DVec3) {
    let middle = |i: usize| i as f64 + 0.5;
    HalfAngles::directions(
        theta_h_at(middle(theta_h)),
        FRAC_PI_2 * middle(theta_d) / THETA_D as f64,
        PI * middle(phi_d) / PHI_D as f64,
    )
}
