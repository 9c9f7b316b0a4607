//! What smooth and rough mirrors and conductors share: the mirror, and the mirror of tiny facets, of whatever reflects.

use super::boundary::Fresnel;
use super::opaque::{Opaque, Reflector};
use super::roughness::Kind;
use super::{Branches, BsdfSample, Lobe, LobeSet, Mode, Scatter};
use crate::Light;
use crate::fresnel::{reflect, schlick};
use crate::microfacet::Facets;
use crate::microfacet::albedo::Losses;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};

/// What a mirror, or one of its facets, reflects.
pub trait Reflective {
    /// At an angle from the normal.
    fn reflectance(&self, cos: f32) -> Light;
    /// Its mean over all directions, weighted by their cosines.
    fn mean(&self) -> Light;
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

    fn mean(&self) -> Light {
        match self.fresnel {
            Fresnel::Constant => self.reflectance,
            // 2 int mu (r0 + (1 - r0) (1 - mu)^5) dmu
            _ => self.reflectance.map(|r0| if r0 > 0.0 { r0 + (1.0 - r0) / 21.0 } else { 0.0 }),
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

/// A mirror of tiny facets: `f = F D G / (4 (n.v)(n.l))`, and what bounces among them if that is wanted.
#[derive(Clone, Debug)]
pub struct Facetted<R> {
    pub(super) mirror: R,
    pub(super) facets: Facets,
    /// What is given back, and its colour.
    pub(super) rest: Option<(Losses, Light)>,
}

/// It from both sides.
pub type Rough<R> = Opaque<Facetted<R>>;

impl<R: Reflective> Facetted<R> {
    pub(super) fn new(mirror: R, kind: &Kind, roughness: Light, anisotropy: Light) -> Rough<R> {
        let facets = kind.facets(roughness, anisotropy);
        let rest = kind.losses(&facets).map(|losses| (losses, mirror.mean().map(|f| losses.tint(f))));
        Opaque(Facetted { mirror, facets, rest })
    }

    /// The chance that a direction is drawn from the lobe of what bounces.
    fn bounced(&self, wo: Vec3) -> f32 {
        self.rest.as_ref().map_or(0.0, |(losses, _)| losses.at(wo.z))
    }
}

impl<R: Reflective> Reflector for Facetted<R> {
    fn parts(&self) -> (bool, bool) {
        (false, !self.mirror.is_black())
    }
    fn weights(&self, _: Vec3) -> (f32, f32) {
        (0.0, 1.0)
    }
    fn base(&self, _: Vec3, _: Vec3) -> Light {
        Light::BLACK
    }

    #[inline]
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        let h = (wo + wi).normalize();
        let dg = self.facets.d(h) * self.facets.g2_reflection(wo, wi) / (4.0 * wo.z * wi.z);
        let once = self.mirror.reflectance(wo.dot(h)) * dg;
        match &self.rest {
            Some((losses, tint)) => once + *tint * losses.lobe(wo.z, wi.z),
            None => once,
        }
    }

    #[inline]
    fn sample_highlight(&self, wo: Vec3, mut u: (f32, f32)) -> Vec3 {
        let bounced = self.bounced(wo);
        if bounced > 0.0 {
            // One number picks the lobe and draws from it.
            if u.0 < bounced {
                return square_to_cosine_hemisphere(((u.0 / bounced).min(LAST), u.1));
            }
            u.0 = ((u.0 - bounced) / (1.0 - bounced)).min(LAST);
        }
        reflect(wo, self.facets.sample_visible_normal(wo, u))
    }

    #[inline]
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        let once = self.facets.visible_normal_pdf(wo, h) / (4.0 * wo.dot(h));
        match self.bounced(wo) {
            b if b > 0.0 => (1.0 - b) * once + b * square_to_cosine_hemisphere_pdf(wi),
            _ => once,
        }
    }

    fn ambient(&self) -> Light {
        Light::BLACK
    }
    fn is_traced(&self) -> bool {
        true
    }
}

/// The greatest f32 below 1.
const LAST: f32 = 1.0 - f32::EPSILON / 2.0;
