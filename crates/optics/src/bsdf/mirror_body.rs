//! What smooth and rough mirrors and conductors share: the mirror, and the mirror of tiny facets (GGX), of whatever reflects.

use super::boundary::Fresnel;
use super::{Branches, BsdfSample, Lobe, LobeSet, Mode, Scatter};
use crate::Light;
use crate::fresnel::{reflect, schlick};
use crate::microfacet::Ggx;
use kirkas_geometry::Vec3;

/// What a mirror, or one of its facets, reflects.
pub trait Reflective {
    /// At an angle from the normal.
    fn reflectance(&self, cos: f32) -> Light;
    /// Nothing at any angle.
    fn is_black(&self) -> bool;
}

/// The same at every angle, or rising along Schlick's curve.
#[derive(Clone, Copy, Debug)]
pub struct Tinted {
    pub(super) reflectance: Light,
    pub(super) fresnel: Fresnel,
}

impl Reflective for Tinted {
    fn reflectance(&self, cos: f32) -> Light {
        match self.fresnel {
            Fresnel::Constant => self.reflectance,
            // A lane without any reflectance, the idle one too, stays without.
            _ => self.reflectance.map(|r0| if r0 > 0.0 { schlick(r0, cos) } else { 0.0 }),
        }
    }

    fn is_black(&self) -> bool {
        self.reflectance.is_black()
    }
}

/// A smooth mirror.
#[derive(Clone, Debug)]
pub struct Smooth<R>(pub(super) R);

const SMOOTH: Lobe = Lobe::DeltaReflection;

impl<R: Reflective> Smooth<R> {
    fn reflected(&self, wo: Vec3) -> Option<BsdfSample> {
        let f = self.0.reflectance(wo.z.abs());
        let (wi, lobe) = (Vec3::new(-wo.x, -wo.y, wo.z), SMOOTH);
        (wo.z != 0.0 && !f.is_black()).then_some(BsdfSample { wi, f, pdf: 1.0, lobe, eta: 1.0, disperses: false })
    }
}

impl<R: Reflective> Scatter for Smooth<R> {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(SMOOTH).when(!self.0.is_black())
    }
    fn eval(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> Light {
        Light::BLACK
    }
    fn pdf(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> f32 {
        0.0
    }
    fn sample(&self, wo: Vec3, _: f32, _: (f32, f32), lobes: LobeSet, _: Mode) -> Option<BsdfSample> {
        if lobes.contains(SMOOTH) { self.reflected(wo) } else { None }
    }
    fn delta_branches(&self, wo: Vec3, _: Mode) -> Branches {
        let mut all = Branches::default();
        if let Some(s) = self.reflected(wo) {
            all.push(s);
        }
        all
    }
}

/// A mirror of tiny facets: `f = F D G / (4 (n.v)(n.l))`.
#[derive(Clone, Debug)]
pub struct Rough<R> {
    pub(super) mirror: R,
    pub(super) facets: Ggx,
}

const ROUGH: Lobe = Lobe::GlossyReflection;

/// `v` with z turned over when `wo` is below: the model looks the same from both sides.
fn upper(v: Vec3, wo: Vec3) -> Vec3 {
    if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v }
}

impl<R: Reflective> Scatter for Rough<R> {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(ROUGH).when(!self.mirror.is_black())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> Light {
        if !lobes.contains(ROUGH) || !(wo.z * wi.z > 0.0) {
            return Light::BLACK;
        }
        let (wo, wi) = (upper(wo, wo), upper(wi, wo));
        let h = (wo + wi).normalize();
        let dg = self.facets.d(h) * self.facets.g2_reflection(wo, wi) / (4.0 * wo.z * wi.z);
        self.mirror.reflectance(wo.dot(h)) * dg
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        if !(lobes & self.lobes()).contains(ROUGH) || !(wo.z * wi.z > 0.0) {
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
            lobe: ROUGH,
            eta: 1.0,
            disperses: false,
        })
    }

    fn traced_lobes(&self) -> LobeSet {
        self.lobes()
    }
}
