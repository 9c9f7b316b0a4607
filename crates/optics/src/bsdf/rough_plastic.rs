//! # rough_plastic
//!
//! A rough clear coat over a diffuse base: matt plastic, latex paint, satin varnish. As `plastic`, with facets in place of the mirror.
//!
//! `f = k_s F D G / (4 (n.v)(n.l)) + rho (1 - R(v)) (1 - R(l)) / (pi eta^2 (1 - rho R_in))`, where `R` is how much of the light from a
//! direction the coat reflects, and `R_in` how much of the diffuse light from below.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 0.5 | rho of the base |
//! | `specular` | colour or texture, 0..1 | | 1 | k_s: tints the highlight; 1 is physical |
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index of the coat |
//! | `roughness` | number or texture, 0..1 | | 0.2 | alpha: about the RMS slope of the facets; 0.05 polished, 0.5 dull |
//! | `anisotropy` | number or texture, -1..1 | | 0 | `alpha_u = roughness (1 + anisotropy)` along the texture's u, `alpha_v = roughness (1 - anisotropy)` |
//! | `distribution` | `ggx`, `beckmann` | | `ggx` | slopes with long tails, or Gaussian ones |
//! | `saturates` | true or false | | true | bounces under the coat deepen the colour; see `plastic` |
//!
//! ## Example
//!
//! ```toml
//! [materials.latex_paint]
//! type = "rough_plastic"
//! reflectance = [0.1, 0.3, 0.5]
//! roughness = 0.3
//! ```
//!
//! ## Limits
//!
//! Light that would bounce among the facets passes through them, so nothing is lost: white gives back all it gets within 1 % (3 % with `anisotropy`). `R`
//! is tabulated once per `ior`; with `anisotropy`, and under another medium than vacuum, it is that of a like coat.
//!
//! ## References
//!
//! As `plastic`; see `microfacet` for the distributions, G and sampling. The balance of coat and base by the coat's albedo: Kulla &
//! Conty, SIGGRAPH 2017 courses; C. Kelemen & L. Szirmay-Kalos, Eurographics 2001, equations 5-8.

use super::opaque::{Opaque, Reflector};
use super::plastic::{IOR, REFLECTANCE_ROW, SATURATES, SPECULAR_ROW};
use super::rough_coat::{CoatAt, RoughCoat};
use super::roughness::{ANISOTROPY, DISTRIBUTION, Kind as Facetting};
use super::{Interface, Mode, Prepare, roughness, slot};
use crate::fresnel::reflect;
use crate::microfacet::Facets;
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "rough_plastic",
    doc: "A rough clear coat over a diffuse base.",
    params: &[REFLECTANCE_ROW, SPECULAR_ROW, IOR, roughness::ROUGHNESS, ANISOTROPY, DISTRIBUTION, SATURATES],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const SPECULAR: usize = slot(SPEC.params, "specular");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");
const STRETCH: usize = slot(SPEC.params, "anisotropy");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    table: &'static RoughCoat,
    facetting: Facetting,
    saturates: bool,
}

/// At a point.
pub type RoughPlastic = Opaque<Coated>;

/// A diffuser under a rough coat.
#[derive(Clone, Debug)]
pub struct Coated {
    /// What lies on the two transmittances.
    base: Light,
    reflectance: Light,
    specular: Light,
    coat: CoatAt,
    facets: Facets,
}

impl Prepare for Prepared {
    type At = RoughPlastic;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        let facetting = Facetting::read(params);
        let table = RoughCoat::of(facetting.distribution(), palette.index(params, "ior").at_d_line());
        Prepared { table, facetting, saturates: params.bool("saturates") }
    }
    fn at(&self, _: &Lanes, slots: &[Light], interface: Interface) -> RoughPlastic {
        let facets = self.facetting.facets(slots[ROUGHNESS], slots[STRETCH]);
        let coat = self.table.at(&facets, interface.eta_above);
        let beneath = coat.beneath();
        let reflectance = slots[REFLECTANCE];
        let base = beneath.after_bounces(reflectance, self.saturates) * (beneath.thinning() / PI);
        Opaque(Coated { base, reflectance, specular: slots[SPECULAR], coat, facets })
    }
}

impl Reflector for Coated {
    fn parts(&self) -> (bool, bool) {
        (!self.reflectance.is_black(), !self.specular.is_black())
    }
    fn weights(&self, wo: Vec3) -> (f32, f32) {
        let r = self.coat.reflectance(wo.z);
        ((self.reflectance.max_component() * (1.0 - r)).max(1e-4), (self.specular.max_component() * r).max(1e-4))
    }
    fn base(&self, wo: Vec3, wi: Vec3) -> Light {
        self.base * ((1.0 - self.coat.reflectance(wo.z)) * (1.0 - self.coat.reflectance(wi.z)))
    }
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        let h = (wo + wi).normalize();
        let dg = self.facets.d(h) * self.facets.g2_reflection(wo, wi) / (4.0 * wo.z * wi.z);
        self.specular * (self.coat.coat.reflectance(wo.dot(h)) * dg)
    }
    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        reflect(wo, self.facets.sample_visible_normal(wo, u))
    }
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        self.facets.visible_normal_pdf(wo, h) / (4.0 * wo.dot(h))
    }
    fn ambient(&self) -> Light {
        self.reflectance
    }
}
