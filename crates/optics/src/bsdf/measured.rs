//! # measured
//!
//! A real material as an instrument saw it: a file of the MERL or of the RGL database. `f` is what the file says,
//! interpolated between its measurements.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `file` | path | | required | a MERL `.binary` or an RGL `.bsdf`; which of them, its first bytes tell |
//!
//! ## Example
//!
//! ```toml
//! [materials.paint]
//! type = "measured"
//! file = "blue-metallic-paint.binary"
//! ```
//!
//! ## Limits
//!
//! As good as the instrument: towards grazing (above about 80 degrees) measurements are noisy, extrapolated or missing, and
//! nothing keeps them from reflecting more than they get. MERL materials are isotropic and RGB, RGL ones isotropic or not, RGB or
//! spectral; in spectral renders RGB files get the smooth spectra of all colours, in RGB renders spectral ones their colour
//! under D65. RGL files are reciprocal up to the noise of their measurements only; light that is traced from the lamps sees the
//! same value as light that is traced from the camera. A file is one material: it takes no textures and no tint. Anisotropic
//! ones lie along the surface's `u`. Looks the same from both sides.
//!
//! ## References
//!
//! W. Matusik, H. Pfister, M. Brand, L. McMillan, "A Data-Driven Reflectance Model", SIGGRAPH 2003. J. Dupuy, W. Jakob, "An Adaptive
//! Parameterization for Efficient Material Acquisition and Rendering", TOG 37(6), 2018. The tables and how directions are
//! drawn: `measured::merl`, `measured::rgl`.

use super::{BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter};
use crate::measured::MeasuredData;
use crate::{Lanes, Light, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use std::sync::Arc;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "measured",
    doc: "A real material, from a file of measurements.",
    params: &[ParamSpec::new("file", ParamType::Path, Fallback::Required, "a MERL `.binary` or an RGL `.bsdf`")],
};
const LOBE: Lobe = Lobe::GlossyReflection;

/// The data; none is black.
#[derive(Clone, Debug)]
pub struct Prepared {
    data: Option<Arc<MeasuredData>>,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct Measured {
    data: Option<Arc<MeasuredData>>,
    lanes: Lanes,
}

impl Prepare for Prepared {
    type At = Measured;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared { data: palette.measured(params, "file") }
    }
    fn at(&self, lanes: &Lanes, _: &[Light], _: Interface) -> Measured {
        Measured { data: self.data.clone(), lanes: *lanes }
    }
}

impl Measured {
    /// Where `wo` and `wi` are on one side, both turned to the upper one; nothing for lobes that are not there.
    fn above(&self, wo: Vec3, wi: Vec3, lobes: LobeSet) -> Option<(&MeasuredData, Vec3, Vec3)> {
        let data = self.data.as_deref()?;
        let is_seen = lobes.contains(LOBE) && wo.z * wi.z > 0.0;
        is_seen.then(|| (data, Vec3::new(wo.x, wo.y, wo.z.abs()), Vec3::new(wi.x, wi.y, wi.z.abs())))
    }
}

impl Scatter for Measured {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(LOBE).when(self.data.is_some())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        let Some((data, wo, wi)) = self.above(wo, wi, lobes) else { return Light::BLACK };
        match mode {
            Mode::Radiance => data.reflectance().value(wo, wi, &self.lanes),
            Mode::Importance => data.reflectance().value(wi, wo, &self.lanes),
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        let Some((data, wo, wi)) = self.above(wo, wi, lobes) else { return 0.0 };
        data.reflectance().density(wo, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        let data = self.data.as_deref()?;
        if !lobes.contains(LOBE) || wo.z == 0.0 {
            return None;
        }
        let mut wi = data.reflectance().draw(Vec3::new(wo.x, wo.y, wo.z.abs()), u_lobe, u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        let pdf = self.pdf(wo, wi, lobes, mode);
        (pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample {
            wi,
            f: self.eval(wo, wi, lobes, mode),
            pdf,
            lobe: LOBE,
            eta: 1.0,
            disperses: false,
        })
    }

    fn ambient(&self) -> Light {
        self.data.as_ref().map_or(Light::BLACK, |data| data.reflectance().albedo(&self.lanes))
    }
}
