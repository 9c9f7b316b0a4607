//! # rough_conductor
//!
//! A metal of tiny facets (GGX or Beckmann), each by Fresnel's equations for a complex refractive index: brushed copper, blasted aluminium.
//! `f = F D G / (4 (n.v)(n.l))`.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | index | | required | `{ material = "copper" }`, `{ file = "Cu.yml" }` of refractiveindex.info, or a number for n |
//! | `k` | colour | | 0 | extinction coefficient, where `ior` is a number |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints the reflection |
//! | `roughness` | number or texture, 0..1 | | 0.2 | alpha: about the RMS slope of the facets; 0.05 polished, 0.5 dull |
//! | `anisotropy` | number or texture, -1..1 | | 0 | `alpha_u = roughness (1 + anisotropy)` along the texture's u, `alpha_v = roughness (1 - anisotropy)` |
//! | `distribution` | `ggx`, `beckmann` | | `ggx` | slopes with long tails, or Gaussian ones |
//! | `film_thickness` | number or texture, 0..10^5 | nm | 0 | thickness of a film that interferes; 0 is none |
//! | `film_ior` | number, at least 0.01 | | 1.33 | refractive index of the film |
//! | `compensation` | true or false | | false | gives back the light that bounces among the facets (Kulla & Conty 2017) |
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
//! As `rough_mirror`: light that would bounce among the facets is lost unless `compensation` gives it back. Colours in RGB mode, and of films: as `conductor`.
//!
//! ## References
//!
//! See `microfacet` for the distributions, G and sampling, `conductor` for the reflectance.

use super::conductor_body::{Constants, IOR, K, Metal, REFLECTANCE_ROW};
use super::film::{FILM_IOR, FILM_THICKNESS, FilmKind};
use super::mirror_body::{Facetted, Rough};
use super::roughness::{ANISOTROPY, COMPENSATION, DISTRIBUTION, Kind as Facetting};
use super::{Interface, Prepare, roughness, slot};
use crate::{Lanes, Light, Palette};
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "rough_conductor",
    doc: "A metal of tiny facets, by its complex refractive index.",
    params: &[
        IOR,
        K,
        REFLECTANCE_ROW,
        roughness::ROUGHNESS,
        ANISOTROPY,
        DISTRIBUTION,
        COMPENSATION,
        FILM_THICKNESS,
        FILM_IOR,
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");
const THICKNESS: usize = slot(SPEC.params, "film_thickness");
const STRETCH: usize = slot(SPEC.params, "anisotropy");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    constants: Constants,
    facetting: Facetting,
    film: FilmKind,
}

/// At a point.
pub type RoughConductor = Rough<Metal>;

impl Prepare for Prepared {
    type At = RoughConductor;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared {
            constants: Constants::read(params, palette),
            facetting: Facetting::read(params),
            film: FilmKind::read(params),
        }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> RoughConductor {
        let film = self.film.at(lanes, slots[THICKNESS]);
        let mirror = self.constants.at(lanes, slots[REFLECTANCE], interface.eta_above, film);
        Facetted::new(mirror, &self.facetting, slots[ROUGHNESS], slots[STRETCH])
    }
}
