//! # rough_mirror
//!
//! A mirror of tiny facets (GGX or Beckmann): brushed or blasted metal, blurred reflections.
//! `f = F D G / (4 (n.v)(n.l))`.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 1 | part of the light that a facet reflects |
//! | `roughness` | number or texture, 0..1 | | 0.2 | alpha: about the RMS slope of the facets; 0.05 polished, 0.5 dull |
//! | `anisotropy` | number or texture, -1..1 | | 0 | `alpha_u = roughness (1 + anisotropy)` along the texture's u, `alpha_v = roughness (1 - anisotropy)` |
//! | `distribution` | `ggx`, `beckmann` | | `ggx` | slopes with long tails, or Gaussian ones |
//! | `compensation` | true or false | | false | gives back the light that bounces among the facets (Kulla & Conty 2017) |
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
//! Light that would bounce among the facets is lost, so rough mirrors come out too dark: seen straight on, with GGX, by 1 % at
//! roughness 0.1, 8 % at 0.25, 31 % at 0.5, 69 % at 1. `compensation` gives it back: white stays white within 0.5 %; with
//! `anisotropy` it is that of one mean roughness, and white comes out up to 5 % (0.3) or 9 % (0.7) too bright or too dark.
//! Roughness below 0.001 acts as 0.001: use `mirror`.
//!
//! ## References
//!
//! See `microfacet` for the distributions, G and sampling. R. L. Cook & K. E. Torrance, "A Reflectance Model for Computer Graphics",
//! SIGGRAPH 1981.

use super::boundary::Fresnel;
use super::mirror_body::{Facetted, Rough, Tinted};
use super::roughness::{ANISOTROPY, COMPENSATION, DISTRIBUTION, Kind as Facetting};
use super::{Interface, Prepare, roughness, slot};
use crate::{Lanes, Light, Palette};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "rough_mirror",
    doc: "A mirror of tiny facets (GGX or Beckmann): brushed metal, blurred reflections.",
    params: &[
        ParamSpec::reflectance("reflectance", [1.0; 3], "part of the light that a facet reflects"),
        roughness::ROUGHNESS,
        ANISOTROPY,
        DISTRIBUTION,
        COMPENSATION,
        ParamSpec::choice("fresnel", &["constant", "schlick"], "the same at every angle, or rising to 1 at grazing"),
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");
const STRETCH: usize = slot(SPEC.params, "anisotropy");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
    facetting: Facetting,
}

/// At a point.
pub type RoughMirror = Rough<Tinted>;

impl Prepare for Prepared {
    type At = RoughMirror;
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { fresnel: Fresnel::of(params.text("fresnel")), facetting: Facetting::read(params) }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> RoughMirror {
        let mirror = Tinted { reflectance: slots[REFLECTANCE], fresnel: self.fresnel };
        Facetted::new(mirror, &self.facetting, slots[ROUGHNESS], slots[STRETCH])
    }
}
