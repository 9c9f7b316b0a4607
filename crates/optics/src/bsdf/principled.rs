//! # principled
//!
//! One model for most opaque things, with parameters that artists know, after OpenPBR: a base between a diffuser under a dielectric
//! skin and a metal, under a clear coat, under fuzz. Car paint, leather, wood, cloth, worn metal.
//!
//! From below: the diffuser is `oren_nayar`'s `eon`; skin and metal are GGX facets of one roughness, the skin by Fresnel's equations,
//! the metal by Schlick's curve with a tint at 82 degrees; what bounces among metal facets is given back. The coat is as
//! `rough_plastic`'s, the fuzz as `velvet`'s fibres. Each layer takes what it reflects from those below.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `base_color` | colour or texture, 0..1 | | 0.8 | of the diffuser, and the metal's reflectance straight on |
//! | `diffuse_roughness` | number or texture, 0..1 | | 0 | r of `oren_nayar` |
//! | `metalness` | number or texture, 0..1 | | 0 | from the diffuser under its skin to the metal |
//! | `specular` | number or texture, 0..1 | | 1 | weight of the skin's reflection |
//! | `specular_color` | colour or texture, 0..1 | | 1 | tints the skin's reflection, and the metal's near grazing angles |
//! | `roughness` | number or texture, 0..1 | | 0.1 | alpha of skin and metal (the square of what OpenPBR calls roughness) |
//! | `anisotropy` | number or texture, -1..1 | | 0 | `alpha_u = roughness (1 + anisotropy)` along the texture's u, `alpha_v = roughness (1 - anisotropy)` |
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index of the skin |
//! | `coat` | number or texture, 0..1 | | 0 | weight of the coat |
//! | `coat_color` | colour or texture, 0..1 | | 1 | what passes through the coat and back |
//! | `coat_roughness` | number or texture, 0..1 | | 0.01 | alpha of the coat |
//! | `coat_ior` | number, at least 0.01 | | 1.6 | refractive index of the coat |
//! | `fuzz` | number or texture, 0..1 | | 0 | weight of the fuzz |
//! | `fuzz_color` | colour or texture, 0..1 | | 1 | of the fuzz |
//! | `fuzz_roughness` | number or texture, 0..1 | | 0.5 | roughness of the fuzz; see `velvet` |
//!
//! ## Example
//!
//! ```toml
//! [materials.car_paint]
//! type = "principled"
//! base_color = [0.5, 0.02, 0.03]
//! metalness = 0.4
//! roughness = 0.2
//! coat = 1
//! ```
//!
//! ## Limits
//!
//! Opaque: no transmission, no subsurface, no thin film; those are `dielectric` and its kin. The coat does not roughen or darken what
//! lies below it. White gives back at most all it gets, within 2 %, and loses up to 7 % under a coat and 13 % under full fuzz, seen
//! straight on, since both shade it both ways. Under another medium than vacuum, tables are scaled as in `rough_plastic`.
//!
//! ## References
//!
//! Academy Software Foundation, "OpenPBR Surface" 1.1, 2024 (where we deviate: alpha in place of its root, symmetric layering). N.
//! Hoffman, "Fresnel Equations Considered Harmful", 2019 (the tint at 82 degrees). Layering: skin over diffuser, C. Kelemen & L.
//! Szirmay-Kalos 2001; coat and fuzz over the rest, A. C. Estevez & C. Kulla 2017, equation 5.

use super::mirror_body::{Facetted, Reflective};
use super::opaque::{Opaque, Reflector};
use super::oren_nayar::Matte;
use super::rough_coat::{CoatAt, RoughCoat};
use super::roughness::{ANISOTROPY, alphas};
use super::velvet::{Fibres, fibre_albedo};
use super::{Interface, Mode, Prepare, slot};
use crate::fresnel::{reflect, schlick};
use crate::microfacet::albedo::Losses;
use crate::microfacet::{Distribution, Facets};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

const IOR_RANGE: (f64, f64) = (0.01, f64::INFINITY);

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "principled",
    doc: "One model for most opaque things: diffuser or metal, coat, fuzz (after OpenPBR).",
    params: &[
        ParamSpec::reflectance("base_color", [0.8; 3], "of the diffuser, and the metal straight on"),
        ParamSpec::number_texture("diffuse_roughness", 0.0, UNIT, "roughness of the diffuser"),
        ParamSpec::number_texture("metalness", 0.0, UNIT, "from diffuser to metal"),
        ParamSpec::number_texture("specular", 1.0, UNIT, "weight of the skin's reflection"),
        ParamSpec::reflectance("specular_color", [1.0; 3], "tints the skin's reflection and the metal's edge"),
        ParamSpec::number_texture("roughness", 0.1, UNIT, "alpha of skin and metal"),
        ANISOTROPY,
        ParamSpec::number("ior", 1.5, "refractive index of the skin").range(IOR_RANGE),
        ParamSpec::number_texture("coat", 0.0, UNIT, "weight of the coat"),
        ParamSpec::reflectance("coat_color", [1.0; 3], "what passes through the coat and back"),
        ParamSpec::number_texture("coat_roughness", 0.01, UNIT, "alpha of the coat"),
        ParamSpec::number("coat_ior", 1.6, "refractive index of the coat").range(IOR_RANGE),
        ParamSpec::number_texture("fuzz", 0.0, UNIT, "weight of the fuzz"),
        ParamSpec::reflectance("fuzz_color", [1.0; 3], "of the fuzz"),
        ParamSpec::number_texture("fuzz_roughness", 0.5, UNIT, "roughness of the fuzz"),
    ],
};
const BASE_COLOR: usize = slot(SPEC.params, "base_color");
const DIFFUSE_ROUGHNESS: usize = slot(SPEC.params, "diffuse_roughness");
const METALNESS: usize = slot(SPEC.params, "metalness");
const SPECULAR: usize = slot(SPEC.params, "specular");
const SPECULAR_COLOR: usize = slot(SPEC.params, "specular_color");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");
const STRETCH: usize = slot(SPEC.params, "anisotropy");
const COAT: usize = slot(SPEC.params, "coat");
const COAT_COLOR: usize = slot(SPEC.params, "coat_color");
const COAT_ROUGHNESS: usize = slot(SPEC.params, "coat_roughness");
const FUZZ: usize = slot(SPEC.params, "fuzz");
const FUZZ_COLOR: usize = slot(SPEC.params, "fuzz_color");
const FUZZ_ROUGHNESS: usize = slot(SPEC.params, "fuzz_roughness");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    skin: &'static RoughCoat,
    coat: &'static RoughCoat,
}

/// At a point.
pub type Principled = Opaque<Layers>;

/// Skin and metal, facets of one roughness.
#[derive(Clone, Debug)]
pub struct Skin {
    metalness: f32,
    /// The metal's reflectance straight on, and how much it falls short of Schlick's curve near 82 degrees.
    f0: Light,
    dip: Light,
    /// Weight and tint of the skin.
    specular: Light,
    coat: CoatAt,
}

/// All of it.
#[derive(Clone, Debug)]
pub struct Layers {
    matte: Matte,
    /// The diffuser's weight.
    diffuse: f32,
    facets: Facetted<Skin>,
    /// Its weight and roughness besides.
    coat: Option<(f32, CoatAt, f32)>,
    /// What the coat's colour does to all below.
    below: Light,
    /// 1 in every lane in use.
    white: Light,
    fuzz: Option<(Light, Fibres)>,
}

impl Reflective for Skin {
    fn reflectance(&self, cos: f32) -> Light {
        let skin = self.specular * ((1.0 - self.metalness) * self.coat.coat.reflectance(cos));
        if self.metalness == 0.0 {
            return skin;
        }
        let away = 1.0 - cos.min(1.0);
        let dip = cos * (away * away * away) * (away * away * away);
        let metal = Light(core::array::from_fn(|lane| {
            if self.f0[lane] > 0.0 { (schlick(self.f0[lane], cos) - self.dip[lane] * dip).max(0.0) } else { 0.0 }
        }));
        skin + metal * self.metalness
    }

    /// Of the metal alone: what the skin lets through, the diffuser gets.
    fn mean(&self) -> Light {
        let mean = |lane: usize| {
            if self.f0[lane] > 0.0 {
                self.f0[lane] + (1.0 - self.f0[lane]) / 21.0 - self.dip[lane] / 126.0
            } else {
                0.0
            }
        };
        Light(core::array::from_fn(mean))
    }

    fn is_black(&self) -> bool {
        (self.metalness == 0.0 || self.f0.is_black()) && self.specular.is_black()
    }
}

impl Prepare for Prepared {
    type At = Principled;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        let table = |name: &str| RoughCoat::of(Distribution::Ggx, palette.index(params, name).at_d_line());
        Prepared { skin: table("ior"), coat: table("coat_ior") }
    }

    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> Principled {
        let outside = interface.eta_above;
        let metalness = slots[METALNESS][0];
        let facets = Facets::new(Distribution::Ggx, alphas(slots[ROUGHNESS], slots[STRETCH]));
        let f0 = slots[BASE_COLOR];
        // The tint is what remains of Schlick's curve at a cosine of 1/7 (Hoffman 2019, equation 7).
        let dip =
            |lane: usize| schlick(f0[lane], 1.0 / 7.0) * (1.0 - slots[SPECULAR_COLOR][lane]) * 823_543.0 / 46656.0;
        let skin = Skin {
            metalness,
            f0,
            dip: Light(core::array::from_fn(dip)),
            specular: slots[SPECULAR_COLOR] * slots[SPECULAR][0],
            coat: self.skin.at(&facets, outside),
        };
        let rest = (metalness > 0.0).then(|| {
            let losses = Losses::new(&facets);
            (losses, skin.mean().map(|f| losses.tint(f.clamp(0.0, 1.0)) * metalness))
        });
        let coat = (slots[COAT][0] > 0.0).then(|| {
            let alpha = slots[COAT_ROUGHNESS][0];
            (slots[COAT][0], self.coat.at(&Facets::ggx(alpha), outside), alpha)
        });
        let passed = slots[COAT_COLOR].map(|c| 1.0 - slots[COAT][0] * (1.0 - c));
        let fuzz = slots[FUZZ_COLOR] * slots[FUZZ][0];
        Opaque(Layers {
            matte: Matte::energy_preserving_of(slots[BASE_COLOR], slots[DIFFUSE_ROUGHNESS][0]),
            diffuse: 1.0 - metalness,
            facets: Facetted { mirror: skin, facets, rest },
            coat,
            below: passed * lanes.one(),
            white: lanes.one(),
            fuzz: (!fuzz.is_black()).then(|| (fuzz, Fibres::new(slots[FUZZ_ROUGHNESS][0]))),
        })
    }
}

impl Layers {
    /// What coat and fuzz leave for the layers below, from a direction of this cosine.
    fn passed(&self, cos: f32) -> (f32, f32) {
        let coat = self.coat.as_ref().map_or(1.0, |(weight, coat, _)| 1.0 - weight * coat.reflectance(cos));
        let fuzz = self
            .fuzz
            .as_ref()
            .map_or(1.0, |(color, fibres)| (1.0 - color.max_component() * fibre_albedo(fibres, cos)).max(0.0));
        (coat, fuzz)
    }

    /// `(under the coat, under the fuzz)` for a pair of directions: the lesser of both ways, which gives and takes the same both ways
    /// and never leaves more than is there.
    fn shading(&self, wo: Vec3, wi: Vec3) -> (f32, f32) {
        let ((coat_o, fuzz_o), (coat_i, fuzz_i)) = (self.passed(wo.z), self.passed(wi.z));
        let fuzz = fuzz_o.min(fuzz_i);
        (coat_o.min(coat_i) * fuzz, fuzz)
    }

    /// How strongly facets, coat and fuzz are drawn.
    fn shares(&self, wo: Vec3) -> [f32; 3] {
        let skin = &self.facets.mirror;
        let metal = skin.metalness * skin.f0.max_component();
        let facets = metal + (1.0 - skin.metalness) * skin.specular.max_component() * skin.coat.reflectance(wo.z);
        let coat = self.coat.as_ref().map_or(0.0, |(weight, coat, _)| weight * coat.reflectance(wo.z));
        let fuzz =
            self.fuzz.as_ref().map_or(0.0, |(c, fibres)| c.max_component() * fibre_albedo(fibres, wo.z).max(0.05));
        let (under_coat, under_fuzz) = self.passed(wo.z);
        let facets = if skin.is_black() { 0.0 } else { (facets * under_coat * under_fuzz).max(1e-3) };
        [facets, coat * under_fuzz, fuzz]
    }
}

impl Reflector for Layers {
    fn parts(&self) -> (bool, bool) {
        let highlight = !self.facets.mirror.is_black() || self.coat.is_some() || self.fuzz.is_some();
        (self.diffuse > 0.0 && self.matte.parts().0, highlight)
    }

    fn weights(&self, wo: Vec3) -> (f32, f32) {
        let skin = &self.facets.mirror;
        let through = 1.0 - skin.specular.max_component() * skin.coat.reflectance(wo.z);
        let (coat, fuzz) = self.passed(wo.z);
        let base = self.diffuse * self.matte.ambient().max_component() * through * coat * fuzz;
        (base.max(1e-3), self.shares(wo).iter().sum::<f32>().max(1e-3))
    }

    fn base(&self, wo: Vec3, wi: Vec3) -> Light {
        let skin = &self.facets.mirror;
        // Per lane, since the skin may be tinted.
        let through = |w: Vec3| skin.specular.map(|s| 1.0 - s * skin.coat.reflectance(w.z));
        let mean = skin.specular.map(|s| 1.0 / (1.0 - s * skin.coat.mean()).max(1e-3));
        let balance = through(wo) * through(wi) * mean;
        self.matte.base(wo, wi) * balance * self.below * (self.diffuse * self.shading(wo, wi).0)
    }

    fn highlight(&self, wo: Vec3, wi: Vec3, mode: Mode) -> Light {
        let (under_coat, under_fuzz) = self.shading(wo, wi);
        let mut f = Light::BLACK;
        if !self.facets.mirror.is_black() {
            f += self.facets.highlight(wo, wi, mode) * self.below * under_coat;
        }
        if let Some((weight, coat, alpha)) = &self.coat {
            let (h, facets) = ((wo + wi).normalize(), Facets::ggx(*alpha));
            let dg = facets.d(h) * facets.g2_reflection(wo, wi) / (4.0 * wo.z * wi.z);
            f += self.white * (weight * coat.coat.reflectance(wo.dot(h)) * dg * under_fuzz);
        }
        if let Some((color, fibres)) = &self.fuzz {
            f += *color * fibres.value(wo, wi);
        }
        f
    }

    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        const LAST: f32 = 1.0 - f32::EPSILON / 2.0;
        let shares = self.shares(wo);
        let mut left = u.0 * shares.iter().sum::<f32>();
        // One number picks the layer and draws from it.
        for (which, share) in shares.into_iter().enumerate().filter(|(_, share)| *share > 0.0) {
            if left < share {
                let u = ((left / share).min(LAST), u.1);
                return match (which, &self.coat) {
                    (0, _) => self.facets.sample_highlight(wo, u),
                    (1, Some((_, _, alpha))) => reflect(wo, Facets::ggx(*alpha).sample_visible_normal(wo, u)),
                    _ => square_to_uniform_sphere((0.5 * u.0, u.1)),
                };
            }
            left -= share;
        }
        Vec3::ZERO
    }

    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let shares = self.shares(wo);
        let total: f32 = shares.iter().sum();
        if !(total > 0.0) {
            return 0.0;
        }
        let mut pdf = 0.0;
        if shares[0] > 0.0 {
            pdf += shares[0] * self.facets.highlight_pdf(wo, wi);
        }
        if let Some((_, _, alpha)) = &self.coat {
            let (h, facets) = ((wo + wi).normalize(), Facets::ggx(*alpha));
            pdf += shares[1] * facets.visible_normal_pdf(wo, h) / (4.0 * wo.dot(h));
        }
        if self.fuzz.is_some() {
            pdf += shares[2] / (2.0 * PI);
        }
        pdf / total
    }

    fn ambient(&self) -> Light {
        self.matte.ambient()
    }
}
