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
use super::mirror::metal;
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
const LOBE: Lobe = Lobe::GlossyReflection;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct RoughMirror {
    reflectance: Light,
    facets: Ggx,
    fresnel: Fresnel,
}

impl Prepare for Prepared {
    type At = RoughMirror;
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { fresnel: Fresnel::of(params.text("fresnel")) }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> RoughMirror {
        RoughMirror { reflectance: slots[REFLECTANCE], facets: Ggx::new(slots[ROUGHNESS][0]), fresnel: self.fresnel }
    }
}

/// `v` with z turned over when `wo` is below: the model looks the same from both sides.
fn upper(v: Vec3, wo: Vec3) -> Vec3 {
    if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v }
}

impl Scatter for RoughMirror {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(LOBE).when(!self.reflectance.is_black())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> Light {
        if !lobes.contains(LOBE) || !(wo.z * wi.z > 0.0) {
            return Light::BLACK;
        }
        let (wo, wi) = (upper(wo, wo), upper(wi, wo));
        let h = (wo + wi).normalize();
        let dg = self.facets.d(h) * self.facets.g2_reflection(wo, wi) / (4.0 * wo.z * wi.z);
        metal(self.reflectance, self.fresnel, wo.dot(h)) * dg
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
