//! # lambert
//!
//! Ideal diffuse reflection: a surface that looks equally bright from everywhere, `f = reflectance / pi`. The honest base
//! of chalk, plaster and paper.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 0.5 | part of the light that is reflected |
//!
//! ## Example
//!
//! ```toml
//! [materials.chalk]
//! type = "lambert"
//! reflectance = [0.8, 0.8, 0.75]
//! ```
//!
//! ## Limits
//!
//! Real matte surfaces flatten towards grazing light (Oren & Nayar 1994); this one does not.
//!
//! ## References
//!
//! J. H. Lambert, "Photometria", 1760.

use super::{BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "lambert",
    doc: "Ideal diffuse reflection.",
    params: &[ParamSpec::reflectance("reflectance", [0.5; 3], "part of the light that is reflected")],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const LOBE: Lobe = Lobe::DiffuseReflection;

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

/// At a point.
#[derive(Clone, Debug)]
pub struct Lambert {
    reflectance: Light,
}

impl Prepare for Prepared {
    type At = Lambert;
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> Lambert {
        Lambert::new(slots[REFLECTANCE])
    }
}

impl Lambert {
    pub(super) fn new(reflectance: Light) -> Self {
        Lambert { reflectance }
    }
}

impl Scatter for Lambert {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(LOBE).when(!self.reflectance.is_black())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> Light {
        if lobes.contains(LOBE) && wo.z * wi.z > 0.0 { self.reflectance / PI } else { Light::BLACK }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        if (lobes & self.lobes()).contains(LOBE) && wo.z * wi.z > 0.0 {
            square_to_cosine_hemisphere_pdf(Vec3::new(wi.x, wi.y, wi.z.abs()))
        } else {
            0.0
        }
    }

    fn sample(&self, wo: Vec3, _: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        let mut wi = square_to_cosine_hemisphere(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        let pdf = self.pdf(wo, wi, lobes, mode);
        (pdf > 0.0).then(|| BsdfSample {
            wi,
            f: self.eval(wo, wi, lobes, mode),
            pdf,
            lobe: LOBE,
            eta: 1.0,
            disperses: false,
        })
    }

    fn ambient(&self) -> Light {
        self.reflectance
    }
}
