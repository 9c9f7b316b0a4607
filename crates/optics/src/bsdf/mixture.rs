//! Several models side by side, each with its weight.
//!
//! A direction is drawn from one of them, chosen by weight among those that have a lobe that was asked for. Where only one kind of lobe
//! is asked for, the first number of the pair chooses, since the one for lobes need not be given then.

use super::parts::{MOST_PARTS, Parts, Shares};
use super::{Branches, Bsdf, BsdfSample, LobeSet, Mode, Scatter};
use crate::Light;
use kirkas_geometry::Vec3;

/// Models and their weights, all above 0.
#[derive(Clone, Debug)]
pub struct Mixture(Vec<(f32, Bsdf)>);

const LAST: f32 = 1.0 - f32::EPSILON / 2.0;

impl Mixture {
    pub(super) const EMPTY: Self = Mixture(Vec::new());

    /// What is there of `parts`, by their shares. Where some are holed, it is what scatters where the mixture is not.
    pub(super) fn of(shares: &Shares, parts: &dyn Parts) -> Self {
        let present = || (0..MOST_PARTS).filter(|&i| shares[i] > 0.0);
        let (mut all, mut there) = (0.0, 0.0);
        for i in present() {
            all += shares[i];
            there += shares[i] * parts.opacity(i);
        }
        let whole = there >= all;
        let weight = |i: usize| if whole { shares[i] } else { shares[i] * parts.opacity(i) * (all / there) };
        Mixture(present().map(|i| (weight(i), i)).filter(|(w, _)| *w > 0.0).map(|(w, i)| (w, parts.part(i))).collect())
    }

    /// Those that have such lobes, with their weights, and the sum of these.
    fn candidates(&self, lobes: LobeSet) -> (impl Iterator<Item = &(f32, Bsdf)>, f32) {
        let able = move |part: &&(f32, Bsdf)| part.1.lobes().intersects(lobes);
        (self.0.iter().filter(able), self.0.iter().filter(able).map(|part| part.0).sum())
    }
}

impl Scatter for Mixture {
    fn lobes(&self) -> LobeSet {
        self.0.iter().fold(LobeSet::NONE, |all, part| all | part.1.lobes())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        self.0.iter().map(|(weight, part)| part.eval(wo, wi, lobes, mode) * *weight).sum()
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> f32 {
        let (candidates, total) = self.candidates(lobes);
        candidates.map(|(weight, part)| weight / total * part.pdf(wo, wi, lobes, mode)).sum()
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        let is_single = (self.lobes() & lobes).is_single();
        let (candidates, total) = self.candidates(lobes);
        let mut left = if is_single { u.0 } else { u_lobe } * total;
        let mut chosen = None;
        for (weight, part) in candidates {
            chosen = Some((weight / total, part, (left / weight).min(LAST)));
            if left < *weight {
                break;
            }
            left -= weight;
        }
        let (chance, part, rest) = chosen?;
        let (u_lobe, u) = if is_single { (u_lobe, (rest, u.1)) } else { (rest, u) };
        let s = part.sample(wo, u_lobe, u, lobes, mode)?;
        if s.lobe.is_delta() {
            return Some(BsdfSample { f: s.f * (chance * total), pdf: s.pdf * chance, ..s });
        }
        let pdf = self.pdf(wo, s.wi, lobes, mode);
        (pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample { f: self.eval(wo, s.wi, lobes, mode), pdf, ..s })
    }

    fn delta_branches(&self, wo: Vec3, mode: Mode) -> Branches {
        let mut all = Branches::default();
        for (weight, part) in &self.0 {
            for s in part.delta_branches(wo, mode) {
                all.push(BsdfSample { f: s.f * *weight, ..s });
            }
        }
        all
    }

    fn traced_lobes(&self) -> LobeSet {
        self.0.iter().fold(LobeSet::NONE, |all, part| all | part.1.traced_lobes())
    }

    fn ambient(&self) -> Light {
        self.0.iter().map(|(weight, part)| part.ambient() * *weight).sum()
    }
}
