//! # rough_dielectric
//!
//! A clear boundary of tiny facets (GGX or Beckmann): frosted glass, ice, worn acrylic. Each facet reflects and refracts as `dielectric`
//! does.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index inside |
//! | `fresnel` | `exact`, `schlick`, `constant` | | `exact` | how much each facet reflects; see `dielectric` |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints the reflection; k_s with `constant` |
//! | `transmittance` | colour or texture, 0..1 | | 1 | tints the refraction; k_t with `constant` |
//! | `absorption` | colour | 1/scene unit | 0 | light inside fades as `exp(-absorption distance)` |
//! | `priority` | whole number | | 0 | among overlapping insides the highest wins |
//! | `interior` | medium | | none | what scatters inside |
//! | `film_thickness` | number or texture, 0..10^5 | nm | 0 | thickness of a film that interferes; 0 is none |
//! | `film_ior` | number, at least 0.01 | | 1.33 | refractive index of the film |
//! | `roughness` | number or texture, 0..1 | | 0.2 | alpha: about the RMS slope of the facets; 0.05 polished, 0.5 dull |
//! | `anisotropy` | number or texture, -1..1 | | 0 | `alpha_u = roughness (1 + anisotropy)` along the texture's u, `alpha_v = roughness (1 - anisotropy)` |
//! | `distribution` | `ggx`, `beckmann` | | `ggx` | slopes with long tails, or Gaussian ones |
//! | `compensation` | true or false | | false | gives back the light that bounces among the facets |
//!
//! ## Example
//!
//! ```toml
//! [materials.frosted]
//! type = "rough_dielectric"
//! ior = 1.5
//! roughness = 0.3
//! ```
//!
//! ## Limits
//!
//! Without `compensation` light that would bounce among the facets is lost. With it white glass of round facets stands a furnace within
//! 0.5 %; stretched facets are taken for round ones, a film's colour is left out, and under another medium than vacuum, or with
//! `fresnel = "constant"`, nothing is given back. Roughness below 0.001 acts as 0.001, and indices nearer than 0.1 % as
//! 0.1 % apart. Radiance over n^2, and `constant`, as in `dielectric`. Transmission uses the separable G of Walter et al.
//!
//! With a film, colour is exact in spectral renders; in RGB it is that of 27 bands of the spectrum under D65. See `thin_film`.
//!
//! ## References
//!
//! B. Walter, S. R. Marschner, H. Li & K. E. Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007,
//! equations 16, 17, 20, 21. Compensation: C. Kulla & A. Conty, SIGGRAPH 2017 courses. See `microfacet` for the distributions, G and sampling.

use super::boundary::{Fresnel, Split, pick, square};
use super::dielectric::{ABSORPTION, FRESNEL, IOR, PRIORITY, REFLECTANCE_ROW, TRANSMITTANCE_ROW, read_medium};
use super::film::{FILM_IOR, FILM_THICKNESS, FilmKind};
use super::glass_losses::{GlassLosses, GlassLossesAt};
use super::hull::INTERIOR;
use super::roughness::{ANISOTROPY, COMPENSATION, DISTRIBUTION, Kind as Facetting};
use super::{BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, roughness, slot};
use crate::fresnel::{reflect, refract};
use crate::microfacet::Facets;
use crate::{Lanes, Light, Medium, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::square_to_cosine_hemisphere;
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "rough_dielectric",
    doc: "A clear boundary of tiny facets: frosted glass.",
    params: &[
        IOR,
        FRESNEL,
        REFLECTANCE_ROW,
        TRANSMITTANCE_ROW,
        ABSORPTION,
        PRIORITY,
        roughness::ROUGHNESS,
        ANISOTROPY,
        DISTRIBUTION,
        INTERIOR,
        FILM_THICKNESS,
        FILM_IOR,
        COMPENSATION,
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const THICKNESS: usize = slot(SPEC.params, "film_thickness");
const TRANSMITTANCE: usize = slot(SPEC.params, "transmittance");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");
const STRETCH: usize = slot(SPEC.params, "anisotropy");

/// Indices nearer than this (relative) are moved apart to it, or the half vector drowns in rounding.
const LEAST_CONTRAST: f32 = 1e-3;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
    film: FilmKind,
    facetting: Facetting,
    medium: Medium,
    losses: Option<&'static GlassLosses>,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct RoughDielectric {
    split: Split,
    facets: Facets,
    interface: Interface,
    losses: Option<GlassLossesAt>,
}

impl Prepare for Prepared {
    type At = RoughDielectric;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        let (fresnel, facetting) = (Fresnel::of(params.text("fresnel")), Facetting::read(params));
        let medium = read_medium(params, palette);
        let ior = apart(1.0, medium.ior.at_d_line());
        Prepared {
            losses: (params.bool("compensation") && fresnel != Fresnel::Constant)
                .then(|| GlassLosses::of(facetting.distribution(), ior)),
            film: FilmKind::read(params),
            fresnel,
            facetting,
            medium,
        }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], mut interface: Interface) -> RoughDielectric {
        interface.eta_below = apart(interface.eta_above, interface.eta_below);
        let facets = self.facetting.facets(slots[ROUGHNESS], slots[STRETCH]);
        RoughDielectric {
            split: Split {
                reflect: slots[REFLECTANCE],
                transmit: slots[TRANSMITTANCE],
                fresnel: self.fresnel,
                film: self.film.at(lanes, slots[THICKNESS]),
            },
            losses: self.losses.and_then(|l| l.at(&facets, interface.eta_above, interface.eta_below)),
            facets,
            interface,
        }
    }
    fn medium(&self) -> Option<&Medium> {
        Some(&self.medium)
    }
}

/// The index below, moved away from the one above if it is too near.
fn apart(above: f32, below: f32) -> f32 {
    if (below / above - 1.0).abs() < LEAST_CONTRAST {
        above * if below < above { 1.0 - LEAST_CONTRAST } else { 1.0 + LEAST_CONTRAST }
    } else {
        below
    }
}

/// One pair of directions through one facet, turned so that `wo` is above.
struct Passage {
    wo: Vec3,
    wi: Vec3,
    /// The facet that connects them, above.
    h: Vec3,
    eta_o: f32,
    eta_i: f32,
}

impl Passage {
    fn is_reflection(&self) -> bool {
        self.wi.z > 0.0
    }

    /// `eta_i (wi.h) + eta_o (wo.h)`, the length of the half vector before it was normalised (sign aside).
    fn half_length(&self) -> f32 {
        self.eta_i * self.wi.dot(self.h) + self.eta_o * self.wo.dot(self.h)
    }
}

impl RoughDielectric {
    /// `None` where no facet connects the two.
    fn passage(&self, wo: Vec3, wi: Vec3) -> Option<Passage> {
        let (eta_o, eta_i) = self.interface.seen_from(wo);
        let turn = |v: Vec3| if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v };
        let (wo, wi) = (turn(wo), turn(wi));
        if wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        if wi.z > 0.0 {
            return Some(Passage { wo, wi, h: (wo + wi).normalize(), eta_o, eta_i });
        }
        // Walter et al. 2007, equation 16; turned so that it points up.
        let sum = wo * eta_o + wi * eta_i;
        let h = sum / if sum.z < 0.0 { -sum.length() } else { sum.length() };
        // A facet seen from behind, or from the wrong sides, refracts nothing.
        let connects = wo.dot(h) > 0.0 && wi.dot(h) < 0.0;
        connects.then_some(Passage { wo, wi, h, eta_o, eta_i })
    }

    /// Weights of power of the lobes asked for, at one facet.
    fn wanted(&self, cos_o: f32, wo: Vec3, lobes: LobeSet) -> (Light, Light) {
        let (r, t) = self.split.at(cos_o, &self.interface, wo);
        let keep = |lobe, w| if lobes.contains(lobe) { w } else { Light::BLACK };
        (keep(Lobe::GlossyReflection, r), keep(Lobe::GlossyTransmission, t))
    }

    /// The value of single facets.
    fn facet_value(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        let Some(p) = self.passage(wo, wi) else { return Light::BLACK };
        let (r, t) = self.wanted(p.wo.dot(p.h), wo, lobes);
        let d = self.facets.d(p.h);
        if p.is_reflection() {
            return r * (d * self.facets.g2_reflection(p.wo, p.wi) / (4.0 * p.wo.z * p.wi.z));
        }
        // Walter et al. 2007, equation 21, for importance (eta_i^2 on top).
        let cosines = (p.wo.dot(p.h) * p.wi.dot(p.h) / (p.wo.z * p.wi.z)).abs();
        let f = cosines * d * self.facets.g2_transmission(p.wo, p.wi) * square(p.eta_i / p.half_length());
        let power = t * (f * self.split.transmission_scale(p.eta_o, p.eta_i, mode));
        power * self.interface.refracted_weight()
    }

    fn facet_pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet) -> f32 {
        let Some(p) = self.passage(wo, wi) else { return 0.0 };
        let cos_o = p.wo.dot(p.h);
        let (r, t) = self.wanted(cos_o, wo, lobes);
        let (r, t) = (r.max_component(), t.max_component());
        // How much solid angle of wi a solid angle of h covers (equations 14 and 17), and the chance of this way.
        let (chosen, dh_dwi) = if p.is_reflection() {
            (r, 1.0 / (4.0 * cos_o))
        } else {
            (t, p.wi.dot(p.h).abs() * square(p.eta_i / p.half_length()))
        };
        if chosen > 0.0 { chosen / (r + t) * self.facets.visible_normal_pdf(p.wo, p.h) * dh_dwi } else { 0.0 }
    }

    /// What is given back along `wi`.
    fn given_back(&self, losses: &GlassLossesAt, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Light::BLACK;
        }
        let (side_o, side_i) = (side(wo), side(wi));
        let f = losses.lobe((side_o, wo.z.abs()), (side_i, wi.z.abs()));
        let (r, t) = losses.parts(side_o);
        if side_o == side_i {
            return if lobes.contains(Lobe::GlossyReflection) { self.split.reflect * (f * r) } else { Light::BLACK };
        }
        if !lobes.contains(Lobe::GlossyTransmission) {
            return Light::BLACK;
        }
        let (eta_o, eta_i) = self.interface.seen_from(wo);
        self.split.transmit
            * (f * t * self.split.transmission_scale(eta_o, eta_i, mode))
            * self.interface.refracted_weight()
    }

    /// The chances that a direction is drawn from what is given back, reflected and transmitted.
    fn chances(&self, wo: Vec3, lobes: LobeSet) -> (f32, f32) {
        let Some(losses) = &self.losses else { return (0.0, 0.0) };
        let (r, t) = losses.parts(side(wo));
        let keep = |lobe, w: f32, tint: Light| if lobes.contains(lobe) { w * tint.max_component() } else { 0.0 };
        let r = keep(Lobe::GlossyReflection, r, self.split.reflect);
        let t = keep(Lobe::GlossyTransmission, t, self.split.transmit);
        if r + t > 0.0 {
            let lost = losses.lost(side(wo), wo.z.abs());
            (lost * r / (r + t), lost * t / (r + t))
        } else {
            (0.0, 0.0)
        }
    }
}

/// 0 above, 1 below.
fn side(w: Vec3) -> usize {
    usize::from(w.z < 0.0)
}

impl Scatter for RoughDielectric {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(Lobe::GlossyReflection).when(!self.split.reflect.is_black())
            | LobeSet::of(Lobe::GlossyTransmission).when(!self.split.transmit.is_black())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        let single = self.facet_value(wo, wi, lobes, mode);
        match &self.losses {
            Some(losses) => single + self.given_back(losses, wo, wi, lobes, mode),
            None => single,
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        let single = self.facet_pdf(wo, wi, lobes);
        if self.losses.is_none() || wo.z == 0.0 {
            return single;
        }
        let (r, t) = self.chances(wo, lobes);
        let chance = if side(wo) == side(wi) { r } else { t };
        (1.0 - r - t) * single + chance * wi.z.abs() / PI
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (eta_o, eta_i) = self.interface.seen_from(wo);
        let turn = |v: Vec3| if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v };

        // Choose between single facets and what is given back. One lobe has no number of its own: it shares the direction's.
        let (mut u_lobe, mut u) = (u_lobe, u);
        let (given_r, given_t) = self.chances(wo, lobes);
        let given = given_r + given_t;
        let mut is_given = false;
        if given > 0.0 {
            let x = if (self.lobes() & lobes).is_single() { &mut u.0 } else { &mut u_lobe };
            is_given = *x < given;
            *x = if is_given { *x / given } else { (*x - given) / (1.0 - given) }.min(1.0 - f32::EPSILON / 2.0);
        }
        let (wi, lobe) = if is_given {
            let up = square_to_cosine_hemisphere(u);
            match pick([given_r, given_t], u_lobe)?.0 {
                0 => (up, Lobe::GlossyReflection),
                _ => (Vec3::new(up.x, up.y, -up.z), Lobe::GlossyTransmission),
            }
        } else {
            // Work above, turn back at the end.
            let up = turn(wo);
            let h = self.facets.sample_visible_normal(up, u);
            let (r, t) = self.wanted(up.dot(h), wo, lobes);
            match pick([r.max_component(), t.max_component()], u_lobe)?.0 {
                0 => (reflect(up, h), Lobe::GlossyReflection),
                _ => (refract(up, h, eta_o, eta_i)?, Lobe::GlossyTransmission),
            }
        };
        // A reflection that goes down, or a refraction that goes up, meets another facet: lost.
        if wi.z == 0.0 || (wi.z > 0.0) == lobe.is_transmission() {
            return None;
        }
        let eta = if lobe.is_transmission() { eta_i / eta_o } else { 1.0 };
        let wi = turn(wi);
        let pdf = self.pdf(wo, wi, lobes, mode);
        let disperses = lobe.is_transmission() && self.interface.disperses();
        let f = self.eval(wo, wi, lobes, mode);
        (pdf > 0.0 && pdf.is_finite()).then_some(BsdfSample { wi, f, pdf, lobe, eta, disperses })
    }

    fn traced_lobes(&self) -> LobeSet {
        self.lobes()
    }
}
