//! # rough_mirror
//!
//! A mirror of tiny facets (GGX): brushed or blasted metal, blurred reflections.
//! `f = F D G / (4 (n.v)(n.l))`.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 1 | part of the light that a facet reflects |
//! | `roughness` | number or texture, 0..1 | | 0.2 | alpha of GGX: about the RMS slope of the facets; 0.05 polished, 0.5 dull |
//! | `fresnel` | `constant`, `schlick` | | `constant` | the same at every angle, or rising from `reflectance` to 1 at grazing |
//!
//! ## Example
//!
//! ```toml
//! [materials.brushed_gold]
//! type = "rough_mirror"
//! reflectance = [1.0, 0.78, 0.34]
//! roughness = 0.25
//! fresnel = "schlick"
//! ```
//!
//! ## Limits
//!
//! Light that would bounce among the facets is lost, so rough mirrors come out too dark: seen straight on by 1 % at
//! roughness 0.1, 8 % at 0.25, 31 % at 0.5, 69 % at 1.
//! Roughness below 0.001 acts as 0.001: use `mirror`.
//!
//! ## References
//!
//! See `microfacet` for GGX, G and sampling. R. L. Cook & K. E. Torrance, "A Reflectance Model for Computer Graphics",
//! SIGGRAPH 1981.

use super::boundary::Fresnel;
use super::mirror_body::{Rough, Tinted};
use super::{Interface, Prepare, slot};
use crate::microfacet::Ggx;
use crate::{Lanes, Light, Palette};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "rough_mirror",
    doc: "A mirror of tiny facets (GGX): brushed metal, blurred reflections.",
    params: &[
        ParamSpec::reflectance("reflectance", [1.0; 3], "part of the light that a facet reflects"),
        ParamSpec::number_texture("roughness", 0.2, UNIT, "alpha of GGX"),
        ParamSpec::choice("fresnel", &["constant", "schlick"], "the same at every angle, or rising to 1 at grazing"),
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
}

/// At a point.
pub type RoughMirror = Rough<Tinted>;

impl Prepare for Prepared {
    type At = RoughMirror;
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { fresnel: Fresnel::of(params.text("fresnel")) }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> RoughMirror {
        let mirror = Tinted { reflectance: slots[REFLECTANCE], fresnel: self.fresnel };
        Rough { mirror, facets: Ggx::new(slots[ROUGHNESS][0]) }
    }
}
