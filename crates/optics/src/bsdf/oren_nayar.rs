//! # oren_nayar
//!
//! A matte surface of rough facets that are themselves ideal diffusers: clay, plaster, sand, the full moon. It looks flatter than
//! `lambert`, and brighter where one looks along the light.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 0.5 | reflectance rho of the facets; with `eon` about that of the whole surface |
//! | `roughness` | number or texture, 0..2 | | 0.5 | `sigma`: spread of the slopes' angle, radians, for the two forms of 1994; `r` in 0..1 for `eon` |
//! | `form` | `eon`, `full`, `qualitative` | | `eon` | the energy-preserving model of 2024; the model of 1994 with interreflection; its usual short form |
//!
//! ## Example
//!
//! ```toml
//! [materials.clay]
//! type = "oren_nayar"
//! reflectance = [0.6, 0.35, 0.25]
//! roughness = 0.8
//! ```
//!
//! ## Limits
//!
//! `full` and `qualitative` lose light that facets pass on among each other (`full` counts one such bounce). Of white seen straight
//! on, `full` keeps 90 % at sigma 0.5 and 77 % at 1, `qualitative` 78 % and 62 %; at grazing angles `full` gives up to half a
//! percent too much. `eon` loses and gains nothing: white stays white at every roughness. `roughness = 0` is `lambert` in all three.
//!
//! ## References
//!
//! M. Oren & S. K. Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, equations 27-30. J. Portsmouth,
//! P. Kutz & S. Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 14(1), 2025 (preprint 2024), equations 13, 17, 23-27; after
//! Y. Fujii, "A Tiny Improvement of Oren-Nayar Reflectance Model", 2012. Directions are drawn by the cosine.

use super::boundary::square;
use super::opaque::{Opaque, Reflector};
use super::{Interface, Mode, Prepare, slot};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::acos_f32;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "oren_nayar",
    doc: "Rough diffuse reflection: clay, plaster, the moon.",
    params: &[
        ParamSpec::reflectance("reflectance", [0.5; 3], "reflectance rho of the facets"),
        ParamSpec::number_texture(
            "roughness",
            0.5,
            (0.0, 2.0),
            "r of `eon` (at most 1), sigma in radians of the forms of 1994",
        ),
        ParamSpec::choice(
            "form",
            &["eon", "full", "qualitative"],
            "energy-preserving (2024), or the two forms of 1994",
        ),
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    EnergyPreserving,
    Full,
    Qualitative,
}

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    form: Form,
}

/// At a point.
pub type OrenNayar = Opaque<Matte>;

/// A rough diffuser.
#[derive(Clone, Debug)]
pub struct Matte {
    reflectance: Light,
    roughness: f32,
    form: Form,
}

impl Prepare for Prepared {
    type At = OrenNayar;
    fn prepare(params: &Params, _: &Palette) -> Self {
        let form = match params.text("form") {
            Some("full") => Form::Full,
            Some("qualitative") => Form::Qualitative,
            _ => Form::EnergyPreserving,
        };
        Prepared { form }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> OrenNayar {
        Opaque(Matte { reflectance: slots[REFLECTANCE], roughness: slots[ROUGHNESS][0], form: self.form })
    }
}

/// A pair of directions as the papers see it.
struct Angles {
    cos_o: f32,
    cos_i: f32,
    /// Cosine between their projections on the surface, times both sines.
    s: f32,
}

impl Angles {
    fn new(wo: Vec3, wi: Vec3) -> Self {
        Angles { cos_o: wo.z, cos_i: wi.z, s: wo.x * wi.x + wo.y * wi.y }
    }
}

/// Fujii's constants: `1/2 - 2/(3 pi)` and `2/3 - 28/(15 pi)`.
const FUJII_A: f32 = 0.5 - 2.0 / (3.0 * PI);
const FUJII_MEAN: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// What Fujii's white facets do not give back after one bounce, from cosine `mu` (1 less Portsmouth et al., equation 23),
/// times `1 + FUJII_A r`.
fn lost(mu: f32, r: f32) -> f32 {
    let sin = sine(mu);
    // (1 - sin^3) / cos, without the cancellation at grazing.
    let ratio = (1.0 + sin + sin * sin) * mu / (1.0 + sin);
    let g = sin * (acos_f32(mu.min(1.0)) - sin * mu) + 2.0 / 3.0 * sin * (ratio - 1.0);
    r * (FUJII_A - g / PI).max(0.0)
}

impl Matte {
    /// The energy-preserving form.
    pub(super) fn energy_preserving_of(reflectance: Light, roughness: f32) -> Self {
        Matte { reflectance, roughness, form: Form::EnergyPreserving }
    }

    /// What lies on the reflectance: `f = rho / pi` times this.
    fn energy_preserving(&self, a: &Angles) -> Light {
        let r = self.roughness.min(1.0);
        let over_t = if a.s > 0.0 { a.s / a.cos_o.max(a.cos_i) } else { a.s };
        let af = 1.0 / (1.0 + FUJII_A * r);
        let single = af * (1.0 + r * over_t);
        let mean = af * (1.0 + FUJII_MEAN * r);
        // Light that met more than one facet. All three losses are proportional to r.
        let rest = if r > 0.0 { lost(a.cos_o, r) * lost(a.cos_i, r) * af / (r * (FUJII_A - FUJII_MEAN)) } else { 0.0 };
        let colour = self.reflectance.map(|rho| rho * mean / (1.0 - rho * (1.0 - mean)));
        Light::splat(single) + colour * rest
    }

    fn full(&self, a: &Angles) -> Light {
        let (theta_o, theta_i) = (acos_f32(a.cos_o.min(1.0)), acos_f32(a.cos_i.min(1.0)));
        let (alpha, beta) = (theta_o.max(theta_i), theta_o.min(theta_i));
        let s2 = self.roughness * self.roughness;
        let sines = sine(a.cos_o) * sine(a.cos_i);
        let cos_phi = if sines > 0.0 { (a.s / sines).clamp(-1.0, 1.0) } else { 0.0 };
        // tan(beta) is of the smaller angle, tan(alpha) of the greater one.
        let tan_beta = sine(a.cos_o.max(a.cos_i)) / a.cos_o.max(a.cos_i);
        // By the half-angle formula.
        let tan_half = (sine(a.cos_o) + sine(a.cos_i)) / (a.cos_o + a.cos_i);
        let c1 = 1.0 - 0.5 * s2 / (s2 + 0.33);
        let sine_alpha = sine(a.cos_o.min(a.cos_i));
        let tail = if cos_phi >= 0.0 { 0.0 } else { cube(2.0 * beta / PI) };
        let c2 = 0.45 * s2 / (s2 + 0.09) * (sine_alpha - tail);
        let c3 = 0.125 * s2 / (s2 + 0.09) * square(4.0 * alpha * beta / (PI * PI));
        let once = c1 + cos_phi * c2 * tan_beta + (1.0 - cos_phi.abs()) * c3 * tan_half;
        let twice = 0.17 * s2 / (s2 + 0.13) * (1.0 - cos_phi * square(2.0 * beta / PI));
        Light::splat(once) + self.reflectance * twice
    }

    fn qualitative(&self, a: &Angles) -> Light {
        let s2 = self.roughness * self.roughness;
        let b = 0.45 * s2 / (s2 + 0.09);
        // sin(alpha) tan(beta) cos(phi) = s / max(cos): the greater cosine belongs to beta.
        let term = if a.s > 0.0 { a.s / a.cos_o.max(a.cos_i) } else { 0.0 };
        Light::splat(1.0 - 0.5 * s2 / (s2 + 0.33) + b * term)
    }
}

fn sine(cos: f32) -> f32 {
    ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt()
}
fn cube(x: f32) -> f32 {
    x * x * x
}

impl Reflector for Matte {
    fn parts(&self) -> (bool, bool) {
        (!self.reflectance.is_black(), false)
    }
    fn weights(&self, _: Vec3) -> (f32, f32) {
        (1.0, 0.0)
    }
    fn base(&self, wo: Vec3, wi: Vec3) -> Light {
        let a = Angles::new(wo, wi);
        let shape = match self.form {
            Form::EnergyPreserving => self.energy_preserving(&a),
            Form::Full => self.full(&a),
            Form::Qualitative => self.qualitative(&a),
        };
        self.reflectance * shape.map(|x| x.max(0.0)) / PI
    }
    fn highlight(&self, _: Vec3, _: Vec3, _: Mode) -> Light {
        Light::BLACK
    }
    fn sample_highlight(&self, _: Vec3, _: (f32, f32)) -> Vec3 {
        Vec3::ZERO
    }
    fn highlight_pdf(&self, _: Vec3, _: Vec3) -> f32 {
        0.0
    }
    fn ambient(&self) -> Light {
        self.reflectance
    }
}
