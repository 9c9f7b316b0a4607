//! # rough_conductor
//!
//! A metal of tiny facets (GGX), each by Fresnel's equations for a complex refractive index: brushed copper, blasted aluminium.
//! `f = F D G / (4 (n.v)(n.l))`.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | index | | required | `{ material = "copper" }`, `{ file = "Cu.yml" }` of refractiveindex.info, or a number for n |
//! | `k` | colour | | 0 | extinction coefficient, where `ior` is a number |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints the reflection |
//! | `roughness` | number or texture, 0..1 | | 0.2 | alpha of GGX: about the RMS slope of the facets; 0.05 polished, 0.5 dull |
//!
//! ## Example
//!
//! ```toml
//! [materials.kettle]
//! type = "rough_conductor"
//! ior = { material = "copper" }
//! roughness = 0.15
//! ```
//!
//! ## Limits
//!
//! As `rough_mirror`: light that would bounce among the facets is lost. Colours in RGB mode: as `conductor`.
//!
//! ## References
//!
//! See `microfacet` for GGX, G and sampling, `conductor` for the reflectance.

use super::conductor_body::{Constants, IOR, K, Metal, REFLECTANCE_ROW};
use super::mirror_body::Rough;
use super::{Interface, Prepare, slot};
use crate::microfacet::Ggx;
use crate::{Lanes, Light, Palette};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "rough_conductor",
    doc: "A metal of tiny facets (GGX), by its complex refractive index.",
    params: &[IOR, K, REFLECTANCE_ROW, ParamSpec::number_texture("roughness", 0.2, UNIT, "alpha of GGX")],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    constants: Constants,
}

/// At a point.
pub type RoughConductor = Rough<Metal>;

impl Prepare for Prepared {
    type At = RoughConductor;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared { constants: Constants::read(params, palette) }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> RoughConductor {
        let mirror = self.constants.at(lanes, slots[REFLECTANCE], interface.eta_above);
        Rough { mirror, facets: Ggx::new(slots[ROUGHNESS][0]) }
    }
}
