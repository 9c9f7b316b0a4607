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
use super::{BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::fresnel::reflect;
use crate::microfacet::Ggx;
use crate::{Lanes, Light, Palette};
use kirkas_geometry::Vec3;
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
const LOBE: Lobe = Lobe::GlossyReflection;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    constants: Constants,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct RoughConductor {
    metal: Metal,
    facets: Ggx,
    eta_o: f32,
}

impl Prepare for Prepared {
    type At = RoughConductor;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared { constants: Constants::read(params, palette) }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> RoughConductor {
        RoughConductor {
            metal: self.constants.at(lanes, slots[REFLECTANCE]),
            facets: Ggx::new(slots[ROUGHNESS][0]),
            eta_o: interface.eta_above,
        }
    }
}

/// `v` with z turned over when `wo` is below: the model looks the same from both sides.
fn upper(v: Vec3, wo: Vec3) -> Vec3 {
    if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v }
}

impl Scatter for RoughConductor {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(LOBE).when(!self.metal.is_black())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> Light {
        if !lobes.contains(LOBE) || !(wo.z * wi.z > 0.0) {
            return Light::BLACK;
        }
        let (wo, wi) = (upper(wo, wo), upper(wi, wo));
        let h = (wo + wi).normalize();
        let dg = self.facets.d(h) * self.facets.g2_reflection(wo, wi) / (4.0 * wo.z * wi.z);
        self.metal.reflectance(wo.dot(h), self.eta_o) * dg
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        if !(lobes & self.lobes()).contains(LOBE) || !(wo.z * wi.z > 0.0) {
            return 0.0;
        }
        let (wo, wi) = (upper(wo, wo), upper(wi, wo));
        let h = (wo + wi).normalize();
        self.facets.visible_normal_pdf(wo, h) / (4.0 * wo.dot(h))
    }

    fn sample(&self, wo: Vec3, _: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let up = upper(wo, wo);
        let wi = upper(reflect(up, self.facets.sample_visible_normal(up, u)), wo);
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

    fn traced_lobes(&self) -> LobeSet {
        self.lobes()
    }
}
