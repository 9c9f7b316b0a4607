//! # conductor
//!
//! A perfectly smooth metal, by Fresnel's equations for a complex refractive index: gold, copper, aluminium by name.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | index | | required | `{ material = "gold" }`, `{ file = "Au.yml" }` of refractiveindex.info, or a number for n |
//! | `k` | colour | | 0 | extinction coefficient, where `ior` is a number |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints the reflection |
//!
//! ## Example
//!
//! ```toml
//! [materials.ring]
//! type = "conductor"
//! ior = { material = "gold" }
//! ```
//!
//! ## Limits
//!
//! In RGB mode n and k are chosen so that the reflectance at normal incidence has the metal's colour under D65; towards grazing
//! the colour is nearly right.
//!
//! ## References
//!
//! M. Born, E. Wolf, "Principles of Optics" (7th ed., 1999), section 14.2.

use super::conductor_body::{Constants, IOR, K, Metal, REFLECTANCE, REFLECTANCE_ROW};
use super::{Branches, BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter};
use crate::{Lanes, Light, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "conductor",
    doc: "A smooth metal, by its complex refractive index.",
    params: &[IOR, K, REFLECTANCE_ROW],
};
const LOBE: Lobe = Lobe::DeltaReflection;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    constants: Constants,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct Conductor {
    metal: Metal,
    eta_o: f32,
}

impl Prepare for Prepared {
    type At = Conductor;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared { constants: Constants::read(params, palette) }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> Conductor {
        Conductor { metal: self.constants.at(lanes, slots[REFLECTANCE]), eta_o: interface.eta_above }
    }
}

impl Conductor {
    fn reflected(&self, wo: Vec3) -> Option<BsdfSample> {
        let f = self.metal.reflectance(wo.z.abs(), self.eta_o);
        let wi = Vec3::new(-wo.x, -wo.y, wo.z);
        (wo.z != 0.0 && !f.is_black()).then_some(BsdfSample { wi, f, pdf: 1.0, lobe: LOBE, eta: 1.0, disperses: false })
    }
}

impl Scatter for Conductor {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(LOBE).when(!self.metal.is_black())
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
