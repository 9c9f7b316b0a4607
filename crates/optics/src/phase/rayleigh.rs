//! # rayleigh
//!
//! Scattering by what is much smaller than a wavelength, such as the molecules of the air, for light that is not polarised:
//! `p = 3 (1 + cos^2) / (16 pi)`. That blue light scatters more (as wavelength^-4) is the medium's `scattering` to say.
//!
//! ## Parameters
//!
//! None.
//!
//! ## Example
//!
//! ```toml
//! [phases.air]
//! type = "rayleigh"
//! ```
//!
//! ## Limits
//!
//! Polarisation is not carried from one scattering to the next, and molecules are taken for spheres (no depolarisation).
//!
//! ## References
//!
//! Lord Rayleigh, "On the Light from the Sky, its Polarization and Colour", Phil. Mag. 41, 1871. The inverse of the
//! distribution: J. R. Frisvad, "Importance Sampling the Rayleigh Phase Function", JOSA A 28(12), 2011, equation 17.

use super::{Scatter, Turn};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::cbrt;
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec =
    TypeSpec { kind: Kind::Phase, name: "rayleigh", doc: "Scattering by molecules of the air.", params: &[] };

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Rayleigh;

impl Scatter for Rayleigh {
    fn prepare(_: &Params, _: &Palette) -> Self {
        Rayleigh
    }

    fn value(&self, lanes: &Lanes, wo: Vec3, wi: Vec3) -> Light {
        let cos = wo.dot(wi);
        lanes.one() * (3.0 / (16.0 * PI) * (1.0 + cos * cos))
    }

    fn turn(&self, _: &Lanes, _: usize, u: f32) -> Turn {
        // The root of c^3 + 3 c = 8 u - 4.
        let q = 4.0 * f64::from(u) - 2.0;
        let root = cbrt(q.abs() + (q * q + 1.0).sqrt());
        let cos = (root - 1.0 / root).min(1.0) as f32;
        Turn::from_cos(if q < 0.0 { -cos } else { cos })
    }
}
