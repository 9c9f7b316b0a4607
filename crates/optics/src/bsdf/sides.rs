//! One model above and one below, both opaque.

use super::opaque::upper;
use super::{Branches, Bsdf, BsdfSample, LobeSet, Mode, Scatter};
use crate::Light;
use kirkas_geometry::Vec3;

/// What is seen from above, and from below: each as if from above.
#[derive(Clone, Debug)]
pub struct Sides(pub(super) Box<[Bsdf; 2]>);

const KEPT: LobeSet = LobeSet::REFLECTION;

impl Sides {
    fn seen_from(&self, wo: Vec3) -> &Bsdf {
        &self.0[usize::from(wo.z < 0.0)]
    }
}

impl Scatter for Sides {
    fn lobes(&self) -> LobeSet {
        (self.0[0].lobes() | self.0[1].lobes()) & KEPT
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        if wo.z * wi.z > 0.0 {
            self.seen_from(wo).eval(upper(wo, wo), upper(wi, wo), lobes & KEPT, mode)
        } else {
            Light::BLACK
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> f32 {
        if wo.z * wi.z > 0.0 { self.seen_from(wo).pdf(upper(wo, wo), upper(wi, wo), lobes & KEPT, mode) } else { 0.0 }
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        let s = self.seen_from(wo).sample(upper(wo, wo), u_lobe, u, lobes & KEPT, mode)?;
        Some(BsdfSample { wi: upper(s.wi, wo), ..s })
    }

    fn delta_branches(&self, wo: Vec3, mode: Mode) -> Branches {
        let mut all = Branches::default();
        for s in self.seen_from(wo).delta_branches(upper(wo, wo), mode).iter().filter(|s| KEPT.contains(s.lobe)) {
            all.push(BsdfSample { wi: upper(s.wi, wo), ..*s });
        }
        all
    }

    fn traced_lobes(&self) -> LobeSet {
        (self.0[0].traced_lobes() | self.0[1].traced_lobes()) & KEPT
    }

    /// The mean of both sides: ambient light does not know from where it is seen.
    fn ambient(&self) -> Light {
        (self.0[0].ambient() + self.0[1].ambient()) * 0.5
    }
}
