//! Reflectance as it was measured: tables of real materials, read from the files of the two public databases.
//!
//! Each kind answers two questions about a pair of directions above the surface, its value and the density with which it
//! draws the second for the first. The model that scenes name is [`bsdf::measured`](crate::bsdf::measured).

pub mod fits;
pub mod half;
pub mod merl;
mod merl_sampling;
mod merl_writer;
pub mod rgl;
mod rgl_values;
mod rgl_writer;
pub mod tensor_file;
pub mod warp;

use crate::{ColorMode, Lanes, Light};
use kirkas_geometry::Vec3;
use merl::MerlTable;
pub use merl_writer::write_merl;
use rgl::RglTable;
pub use rgl_writer::{RglGrid, write_rgl};

/// The share of samples that follow the cosine, whatever the data says: where a table is coarse or empty, no light is missed.
pub const COSINE_SHARE: f32 = 1.0 / 16.0;

/// A file of either database.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasuredData {
    /// MERL `.binary`: isotropic, RGB.
    Merl(Box<MerlTable>),
    /// RGL `.bsdf`: isotropic or anisotropic, RGB or spectral.
    Rgl(Box<RglTable>),
}

/// What a table answers for directions above the surface (z > 0 for both). Without the cosine, 1/sr.
pub(crate) trait Reflectance {
    /// The value for light that arrives along `wi` and leaves along `wo`, in the path's lanes.
    fn value(&self, wo: Vec3, wi: Vec3, lanes: &Lanes) -> Light;
    /// The density per solid angle with which [`Reflectance::draw`] gives `wi`.
    fn density(&self, wo: Vec3, wi: Vec3) -> f32;
    /// A direction that tends to carry much light; it may end below the surface and is lost then.
    fn draw(&self, wo: Vec3, u_lobe: f32, u: (f32, f32)) -> Vec3;
    /// The part of even light from all round that is reflected.
    fn albedo(&self, lanes: &Lanes) -> Light;
}

impl MeasuredData {
    /// From a file's bytes, for renders that carry colour as `mode` says; the first of them tell which database it is of.
    pub fn read(bytes: &[u8], mode: ColorMode) -> Result<Self, String> {
        if bytes.starts_with(tensor_file::MAGIC) {
            return Ok(MeasuredData::Rgl(Box::new(RglTable::read(bytes, mode)?)));
        }
        if !bytes.starts_with(&merl::HEADER) {
            return Err("it is neither a MERL `.binary` nor an RGL `.bsdf`".into());
        }
        Ok(MeasuredData::Merl(Box::new(MerlTable::read(bytes)?)))
    }

    /// The reflectance (1/sr, without the cosine) for light that arrives along `wi` and leaves along `wo`, both above the surface.
    pub fn value(&self, wo: Vec3, wi: Vec3, lanes: &Lanes) -> Light {
        self.reflectance().value(wo, wi, lanes)
    }

    /// The density per solid angle with which `wi` is drawn for `wo`, both above the surface.
    pub fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.reflectance().density(wo, wi)
    }

    pub(crate) fn reflectance(&self) -> &dyn Reflectance {
        match self {
            MeasuredData::Merl(table) => &**table,
            MeasuredData::Rgl(table) => &**table,
        }
    }
}

/// Colour of a path's lanes from linear Rec.709.
fn in_lanes(rgb: [f32; 3], lanes: &Lanes) -> Light {
    lanes.unbounded(rgb)
}
