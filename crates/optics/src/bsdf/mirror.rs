//! # mirror
//!
//! Ideal specular reflection: one direction, angle out equals angle in. A delta, so point lights cannot show in it.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 1 | part of the light that is reflected |
//! | `fresnel` | `constant`, `schlick` | | `constant` | the same at every angle, or rising from `reflectance` at normal incidence to 1 at grazing, as metals do |
//!
//! ## Example
//!
//! ```toml
//! [materials.gold_mirror]
//! type = "mirror"
//! reflectance = [1.0, 0.78, 0.34]
//! fresnel = "schlick"
//! ```
//!
//! ## Limits
//!
//! Schlick's curve misses the slight dip that real metals have before grazing.
//!
//! ## References
//!
//! C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, equation 15.

use super::boundary::Fresnel;
use super::{Branches, BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::{Lanes, Light, Palette, fresnel};
use kirkas_geometry::Vec3;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "mirror",
    doc: "Ideal specular reflection.",
    params: &[
        ParamSpec::reflectance("reflectance", [1.0; 3], "part of the light that is reflected"),
        ParamSpec::choice("fresnel", &["constant", "schlick"], "the same at every angle, or rising to 1 at grazing"),
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const LOBE: Lobe = Lobe::DeltaReflection;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct Mirror {
    reflectance: Light,
    fresnel: Fresnel,
}

impl Prepare for Prepared {
    type At = Mirror;
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { fresnel: Fresnel::of(params.text("fresnel")) }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> Mirror {
        Mirror { reflectance: slots[REFLECTANCE], fresnel: self.fresnel }
    }
}

impl Mirror {
    fn reflected(&self, wo: Vec3) -> Option<BsdfSample> {
        let f = metal(self.reflectance, self.fresnel, wo.z.abs());
        let wi = Vec3::new(-wo.x, -wo.y, wo.z);
        (wo.z != 0.0 && !f.is_black()).then_some(BsdfSample { wi, f, pdf: 1.0, lobe: LOBE, eta: 1.0, disperses: false })
    }
}

/// The reflectance of a metal-like (micro)mirror at an angle: Schlick's curve, or constant.
pub(super) fn metal(reflectance: Light, kind: Fresnel, cos: f32) -> Light {
    match kind {
        Fresnel::Constant => reflectance,
        // A lane without any reflectance, the idle one too, stays without.
        _ => reflectance.map(|r0| if r0 > 0.0 { fresnel::schlick(r0, cos) } else { 0.0 }),
    }
}

impl Scatter for Mirror {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(LOBE).when(!self.reflectance.is_black())
    }
    fn eval(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> Light {
        Light::BLACK
    }
    fn pdf(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> f32 {
        0.0
    }
    fn sample(&self, wo: Vec3, _: f32, _: (f32, f32), lobes: LobeSet, _: Mode) -> Option<BsdfSample> {
        if lobes.contains(LOBE) { self.reflected(wo) } else { None }
    }
    fn delta_branches(&self, wo: Vec3, _: Mode) -> Branches {
        let mut all = Branches::default();
        if let Some(s) = self.reflected(wo) {
            all.push(s);
        }
        all
    }
}
