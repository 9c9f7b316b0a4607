//! A model whose normal a map has turned: V. Schuessler, E. Heitz, J. Hanika & C. Dachsbacher, "Microfacet-Based Normal Mapping for
//! Robust Monte Carlo Path Tracing", SIGGRAPH Asia 2017.
//!
//! The surface is a row of facets with the turned normal `p`, which carry the model, joined by upright mirrors of normal `t`, so that
//! on average it faces +z. Symbols: `a(w) = <w, p>` and `b(w) = <w, t>`, clamped, on `w`'s side; `X(w) = a(w) + b(w) sin`, what is seen
//! of the facets times `cos`, the cosine of the turn (so masking is `G1(w) = |w.z| cos / X(w)`); `w'` is `w` mirrored by `t`. Light
//! meets a facet, or a facet and a mirror in either order, and then leaves (equations 11-13, with `a(w') (1 - G1(w')) = b(w) sin`):
//!
//! `f(o, i) = cos / (X(o) X(i)) (a(o) a(i) f_p(o, i) + a(o) sin b(i) f_p(o, i') + sin b(o) a(i) f_p(o', i))`
//!
//! That is as reciprocal as `f_p`, gives no more than it gets, and goes to 0 without a hard edge where the horizon hides the light. The
//! same holds from below, and for what passes from one side to the other.

use super::{Branches, Bsdf, BsdfSample, LobeSet, Mode, Scatter};
use crate::Light;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Frame, Vec3};

/// A model with another normal.
#[derive(Clone, Debug)]
pub struct Tilted(Box<Facets>);

#[derive(Clone, Debug)]
struct Facets {
    model: Bsdf,
    /// Its z is `p`.
    frame: Frame,
    t: Vec3,
    sin: f32,
    cos: f32,
}

/// The flattest that a normal may lie: its cosine.
const FLATTEST: f32 = 0.05;
/// A turn by less than this (its sine) is none.
const LEAST: f32 = 1e-4;

/// `model` with this normal (of any length, in the frame of the surface).
pub(super) fn tilted(model: Bsdf, normal: Vec3) -> Bsdf {
    let flat = (normal.x * normal.x + normal.y * normal.y).sqrt();
    let length = normal.length();
    if !(flat > LEAST * length) || !length.is_finite() {
        return model;
    }
    let cos = (normal.z / length).clamp(FLATTEST, 1.0);
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let t = Vec3::new(-normal.x / flat, -normal.y / flat, 0.0);
    let p = Vec3::new(-t.x * sin, -t.y * sin, cos).normalize();
    let frame = Frame::from_z_and_tangent(p, Vec3::X);
    Bsdf::Tilted(Tilted(Box::new(Facets { model, frame, t, sin, cos })))
}

/// One direction as the facets see it.
struct Seen {
    /// In the facets' frame, and mirrored.
    local: Vec3,
    mirrored: Vec3,
    a: f32,
    /// `b sin`
    side: f32,
    x: f32,
    /// `a` of the mirrored direction: above 0 where a mirror throws light onto a facet.
    a_mirrored: f32,
    g1: f32,
}

impl Facets {
    fn mirror(&self, w: Vec3) -> Vec3 {
        w - self.t * (2.0 * w.dot(self.t))
    }

    /// `None` where none of it is seen.
    fn seen(&self, w: Vec3) -> Option<Seen> {
        if w.z == 0.0 {
            return None;
        }
        let sign = if w.z < 0.0 { -1.0 } else { 1.0 };
        let mirrored = self.mirror(w);
        let on_facets = |v: Vec3| sign * v.dot(self.frame.z);
        let (a, side) = (on_facets(w).max(0.0), (sign * w.dot(self.t)).max(0.0) * self.sin);
        let x = a + side;
        let a_mirrored = if side > 0.0 { on_facets(mirrored).max(0.0) } else { 0.0 };
        let g1 = (w.z.abs() * self.cos / x).min(1.0);
        let (local, mirrored) = (self.frame.to_local(w), self.frame.to_local(mirrored));
        (x > 0.0).then_some(Seen { local, mirrored, a, side, x, a_mirrored, g1 })
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        let (Some(o), Some(i)) = (self.seen(wo), self.seen(wi)) else { return Light::BLACK };
        let term = |weight: f32, a: Vec3, b: Vec3| match weight > 0.0 {
            true => self.model.eval(a, b, lobes, mode) * weight,
            false => Light::BLACK,
        };
        let straight = term(o.a * i.a, o.local, i.local);
        let mirror_after = if i.a_mirrored > 0.0 { term(o.a * i.side, o.local, i.mirrored) } else { Light::BLACK };
        let mirror_before = if o.a_mirrored > 0.0 { term(o.side * i.a, o.mirrored, i.local) } else { Light::BLACK };
        (straight + mirror_after + mirror_before) * (self.cos / (o.x * i.x))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> f32 {
        let (Some(o), Some(i)) = (self.seen(wo), self.seen(wi)) else { return 0.0 };
        let term = |weight: f32, a: Vec3, b: Vec3| match weight > 0.0 {
            true => weight * self.model.pdf(a, b, lobes, mode),
            false => 0.0,
        };
        let mut pdf = 0.0;
        if i.a > 0.0 {
            pdf += term(o.a / o.x * i.g1, o.local, i.local);
            if o.a_mirrored > 0.0 {
                pdf += term(o.side / o.x, o.mirrored, i.local);
            }
        }
        if i.a_mirrored > 0.0 {
            // What does not leave from the facet: 1 - G1 of the mirrored direction.
            pdf += term(o.a / o.x * (i.side / i.a_mirrored).min(1.0), o.local, i.mirrored);
        }
        pdf
    }

    /// A way through the facets: where it leaves, what part of the light does, the chance of this way, and the sample at the facet.
    fn walk(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<Walk> {
        let o = self.seen(wo)?;
        let key = combine(u64::from(u.0.to_bits()) << 32 | u64::from(u.1.to_bits()), u64::from(u_lobe.to_bits()));
        let by_mirror = o.side / o.x;
        if unit_f32(key as u32) < by_mirror {
            // Mirror first, then a facet.
            if !(o.a_mirrored > 0.0) {
                return None;
            }
            let s = self.model.sample(o.mirrored, u_lobe, u, lobes, mode)?;
            let wi = self.frame.to_world(s.wi);
            let i = self.seen(wi).filter(|i| i.a > 0.0)?;
            return Some(Walk { wi, left: by_mirror * i.g1, chance: by_mirror, at_facet: s });
        }
        let by_facet = o.a / o.x;
        let s = self.model.sample(o.local, u_lobe, u, lobes, mode)?;
        let wi = self.frame.to_world(s.wi);
        let i = self.seen(wi).filter(|i| i.a > 0.0)?;
        if unit_f32((key >> 32) as u32) < i.g1 {
            return Some(Walk { wi, left: by_facet * i.g1, chance: by_facet * i.g1, at_facet: s });
        }
        // A mirror sends it on.
        let wi = self.mirror(wi);
        let out = self.seen(wi).filter(|out| out.side > 0.0)?;
        let stays = (out.side / out.a_mirrored).min(1.0);
        Some(Walk { wi, left: by_facet * stays * out.g1, chance: by_facet * stays, at_facet: s })
    }
}

struct Walk {
    wi: Vec3,
    left: f32,
    chance: f32,
    at_facet: BsdfSample,
}

impl Scatter for Tilted {
    fn lobes(&self) -> LobeSet {
        self.0.model.lobes()
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        self.0.eval(wo, wi, lobes, mode)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> f32 {
        self.0.pdf(wo, wi, lobes, mode)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        let walk = self.0.walk(wo, u_lobe, u, lobes, mode)?;
        let s = walk.at_facet;
        let wi = walk.wi.normalize();
        if (wi.z * wo.z < 0.0) != s.lobe.is_transmission() {
            return None;
        }
        let (f, pdf) = match s.lobe.is_delta() {
            true => (s.f * walk.left, s.pdf * walk.chance),
            false => (self.eval(wo, wi, lobes, mode), self.pdf(wo, wi, lobes, mode)),
        };
        (pdf > 0.0 && pdf.is_finite()).then_some(BsdfSample { wi, f, pdf, ..s })
    }

    fn delta_branches(&self, wo: Vec3, mode: Mode) -> Branches {
        let mut all = Branches::default();
        let facets = &self.0;
        let Some(o) = facets.seen(wo) else { return all };
        let mut add = |from: Vec3, share: f32, may_meet_mirror: bool| {
            for s in facets.model.delta_branches(from, mode) {
                let wi = facets.frame.to_world(s.wi).normalize();
                let leaves = (wi.z * wo.z < 0.0) == s.lobe.is_transmission();
                let Some(i) = facets.seen(wi).filter(|i| i.a > 0.0 && leaves) else { continue };
                all.push(BsdfSample { wi, f: s.f * (share * i.g1), ..s });
                let wi = facets.mirror(wi);
                if let Some(out) = facets.seen(wi).filter(|out| may_meet_mirror && out.side > 0.0) {
                    all.push(BsdfSample { wi, f: s.f * (share * (out.side / out.a_mirrored).min(1.0) * out.g1), ..s });
                }
            }
        };
        if o.a > 0.0 {
            add(o.local, o.a / o.x, true);
        }
        if o.a_mirrored > 0.0 {
            add(o.mirrored, o.side / o.x, false);
        }
        all
    }

    fn traced_lobes(&self) -> LobeSet {
        self.0.model.traced_lobes()
    }

    fn ambient(&self) -> Light {
        self.0.model.ambient()
    }
}
