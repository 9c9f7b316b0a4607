//! What opaque models of a diffuse base under a highlight share: they look the same from both sides, mix two ways of drawing a
//! direction, and say only what happens above the surface.

use super::boundary::pick;
use super::{BsdfSample, Lobe, LobeSet, Mode, Scatter};
use crate::Light;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};

/// A model above the surface: `wo.z` and `wi.z` are greater than 0 throughout.
pub trait Reflector {
    /// True where the base is not black, and where the highlight is not.
    fn parts(&self) -> (bool, bool);

    /// How strongly the base and the highlight are drawn, seen from `wo`, where they are not black: not negative, not both 0.
    fn weights(&self, wo: Vec3) -> (f32, f32);

    /// The value (1/sr, no cosine) of the base.
    fn base(&self, wo: Vec3, wi: Vec3) -> Light;

    /// The value (1/sr, no cosine) of the highlight.
    fn highlight(&self, wo: Vec3, wi: Vec3, mode: Mode) -> Light;

    /// A direction from the highlight, perhaps below the horizon (then it carries nothing).
    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3;

    /// Density per solid angle of [`Reflector::sample_highlight`].
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32;

    /// A direction from the base, above.
    fn sample_base(&self, _wo: Vec3, u: (f32, f32)) -> Vec3 {
        square_to_cosine_hemisphere(u)
    }

    /// Density per solid angle of [`Reflector::sample_base`].
    fn base_pdf(&self, _wo: Vec3, wi: Vec3) -> f32 {
        square_to_cosine_hemisphere_pdf(wi)
    }

    /// See [`Scatter::ambient`].
    fn ambient(&self) -> Light;

    /// A highlight that a Whitted tree follows with rays.
    fn is_traced(&self) -> bool {
        false
    }
}

/// Such a model from both sides.
#[derive(Clone, Debug)]
pub struct Opaque<M>(pub M);

const BASE: Lobe = Lobe::DiffuseReflection;
const HIGHLIGHT: Lobe = Lobe::GlossyReflection;

/// `v` with z turned over when `wo` is below.
pub(super) fn upper(v: Vec3, wo: Vec3) -> Vec3 {
    if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v }
}

impl<M: Reflector> Opaque<M> {
    /// The chances of the parts that were asked for: they add up to 1, or are 0.
    #[inline]
    fn chances(&self, wo: Vec3, lobes: LobeSet) -> [f32; 2] {
        let (base, highlight) = self.0.parts();
        match (base && lobes.contains(BASE), highlight && lobes.contains(HIGHLIGHT)) {
            (false, false) => [0.0, 0.0],
            (true, false) => [1.0, 0.0],
            (false, true) => [0.0, 1.0],
            (true, true) => {
                let (b, h) = self.0.weights(wo);
                [b / (b + h), h / (b + h)]
            }
        }
    }

    fn mixed_pdf(&self, wo: Vec3, wi: Vec3, chances: [f32; 2]) -> f32 {
        let mut pdf = 0.0;
        if chances[0] > 0.0 {
            pdf += chances[0] * self.0.base_pdf(wo, wi);
        }
        if chances[1] > 0.0 {
            pdf += chances[1] * self.0.highlight_pdf(wo, wi);
        }
        pdf
    }

    fn value(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        let (base, highlight) = self.0.parts();
        let mut f = Light::BLACK;
        if base && lobes.contains(BASE) {
            f += self.0.base(wo, wi);
        }
        if highlight && lobes.contains(HIGHLIGHT) {
            f += self.0.highlight(wo, wi, mode);
        }
        f
    }
}

impl<M: Reflector> Scatter for Opaque<M> {
    fn lobes(&self) -> LobeSet {
        let (base, highlight) = self.0.parts();
        LobeSet::of(BASE).when(base) | LobeSet::of(HIGHLIGHT).when(highlight)
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        if wo.z * wi.z > 0.0 { self.value(upper(wo, wo), upper(wi, wo), lobes, mode) } else { Light::BLACK }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        if !(wo.z * wi.z > 0.0) {
            return 0.0;
        }
        let (wo, wi) = (upper(wo, wo), upper(wi, wo));
        self.mixed_pdf(wo, wi, self.chances(wo, lobes))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let up = upper(wo, wo);
        let chances = self.chances(up, lobes);
        let (wi, lobe) = match pick(chances, u_lobe)?.0 {
            0 => (self.0.sample_base(up, u), BASE),
            _ => (self.0.sample_highlight(up, u), HIGHLIGHT),
        };
        if !(wi.z > 0.0) {
            return None;
        }
        let pdf = self.mixed_pdf(up, wi, chances);
        (pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample {
            wi: upper(wi, wo),
            f: self.value(up, wi, lobes, mode),
            pdf,
            lobe,
            eta: 1.0,
            disperses: false,
        })
    }

    fn traced_lobes(&self) -> LobeSet {
        LobeSet::of(HIGHLIGHT).when(self.0.is_traced() && self.0.parts().1)
    }

    fn ambient(&self) -> Light {
        self.0.ambient()
    }
}
