//! # velvet
//!
//! Cloth with fibres that stand up and shine towards grazing angles, over a diffuse base: velvet, felt, peach skin, dust.
//! `f = k_d / pi + k_s D G / (4 (n.l)(n.v))` with `D = (2 + 1/r) sin(delta)^(1/r) / (2 pi)`, where delta is the angle between the half
//! vector and the normal, and `G = 1 / (1 + L(v) + L(l))`.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture, 0..1 | | 0.3 | diffuse colour k_d of the ground |
//! | `sheen` | colour or texture, 0..1 | | 0.5 | colour k_s of the fibres |
//! | `roughness` | number or texture, 0..1 | | 0.3 | r: how far the fibres lean from upright; small ones shine only at grazing angles |
//!
//! ## Example
//!
//! ```toml
//! [materials.curtain]
//! type = "velvet"
//! diffuse = [0.15, 0.01, 0.02]
//! sheen = [0.8, 0.3, 0.3]
//! roughness = 0.25
//! ```
//!
//! ## Limits
//!
//! It conserves energy where `diffuse + sheen <= 1`; the ground does not know how much the fibres shade it. Roughness below 0.07 acts
//! as 0.07. `L` is a fit to masking that was computed; the paper's softer terminator, which is not reciprocal, is left out.
//!
//! ## References
//!
//! A. C. Estevez & C. Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017 courses, equations 2-4. Directions are drawn
//! uniformly, as it recommends.

use super::opaque::{Opaque, Reflector};
use super::{Interface, Mode, Prepare, slot};
use crate::{Lanes, Light, Palette};
use core::array::from_fn;
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{exp_f32, pow_f32, sin_cos_f32};
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};
use std::sync::OnceLock;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "velvet",
    doc: "Upright fibres that shine towards grazing angles, over a diffuse base: cloth.",
    params: &[
        ParamSpec::reflectance("diffuse", [0.3; 3], "diffuse colour of the ground"),
        ParamSpec::reflectance("sheen", [0.5; 3], "colour of the fibres"),
        ParamSpec::number_texture("roughness", 0.3, UNIT, "how far the fibres lean from upright"),
    ],
};
const DIFFUSE: usize = slot(SPEC.params, "diffuse");
const SHEEN: usize = slot(SPEC.params, "sheen");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");

/// Below this the fit was not made.
const LEAST_ROUGHNESS: f32 = 0.07;

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

/// At a point.
pub type Velvet = Opaque<Cloth>;

/// Fibres over a diffuser.
#[derive(Clone, Debug)]
pub struct Cloth {
    diffuse: Light,
    sheen: Light,
    fibres: Fibres,
}

/// Upright fibres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fibres {
    roughness: f32,
}

impl Prepare for Prepared {
    type At = Velvet;
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> Velvet {
        Opaque(Cloth { diffuse: slots[DIFFUSE], sheen: slots[SHEEN], fibres: Fibres::new(slots[ROUGHNESS][0]) })
    }
}

impl Fibres {
    pub(super) fn new(roughness: f32) -> Self {
        Fibres { roughness: roughness.max(LEAST_ROUGHNESS) }
    }

    /// `D G / (4 (n.l)(n.v))`.
    pub(super) fn value(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        let sin = (h.x * h.x + h.y * h.y).sqrt().min(1.0);
        let inverse = 1.0 / self.roughness;
        let d = (2.0 + inverse) * pow_f32(sin, inverse) / (2.0 * PI);
        d / ((1.0 + self.lambda(wo.z) + self.lambda(wi.z)) * 4.0 * wo.z * wi.z)
    }

    /// The paper's fit of Lambda (equation 3 and table 1).
    fn lambda(&self, cos: f32) -> f32 {
        let cos = cos.min(1.0);
        if cos < 0.5 { exp_f32(self.fit(cos)) } else { exp_f32(2.0 * self.fit(0.5) - self.fit(1.0 - cos)) }
    }

    fn fit(&self, x: f32) -> f32 {
        const AT_0: [f32; 5] = [25.3245, 3.32435, 0.16801, -1.27393, -4.85967];
        const AT_1: [f32; 5] = [21.5473, 3.82987, 0.19823, -1.97760, -4.32054];
        let t = (1.0 - self.roughness) * (1.0 - self.roughness);
        let [a, b, c, d, e] = core::array::from_fn(|i| t * AT_0[i] + (1.0 - t) * AT_1[i]);
        a / (1.0 + b * pow_f32(x, c)) + d * x + e
    }
}

/// Steps of the cosine, `(i / 15)^2`, and of the roughness.
const COSINES: usize = 16;
const ROUGHS: usize = 8;

/// Albedo of white fibres from this cosine: from a table, made when it is first asked for, of midpoints over the hemisphere.
pub(super) fn fibre_albedo(fibres: &Fibres, cos: f32) -> f32 {
    static TABLE: OnceLock<[[f32; COSINES]; ROUGHS]> = OnceLock::new();
    let table = TABLE.get_or_init(|| from_fn(|k| from_fn(|i| tabulated_albedo(k, i))));
    let y = (fibres.roughness - LEAST_ROUGHNESS) / (1.0 - LEAST_ROUGHNESS) * (ROUGHS - 1) as f32;
    let x = cos.clamp(0.0, 1.0).sqrt() * (COSINES - 1) as f32;
    let (k, i) = ((y as usize).min(ROUGHS - 2), (x as usize).min(COSINES - 2));
    let along = |row: &[f32; COSINES]| row[i] + (row[i + 1] - row[i]) * (x - i as f32);
    along(&table[k]) + (along(&table[k + 1]) - along(&table[k])) * (y - k as f32)
}

fn tabulated_albedo(k: usize, i: usize) -> f32 {
    const HEIGHTS: usize = 32;
    const TURNS: usize = 16;
    let fibres = Fibres { roughness: LEAST_ROUGHNESS + (1.0 - LEAST_ROUGHNESS) * k as f32 / (ROUGHS - 1) as f32 };
    let root = i as f32 / (COSINES - 1) as f32;
    let mu = (root * root).max(1e-3);
    let wo = Vec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu);
    let mut sum = 0.0;
    for a in 0..HEIGHTS {
        let z = (a as f32 + 0.5) / HEIGHTS as f32;
        let r = ((1.0 - z) * (1.0 + z)).sqrt();
        for b in 0..TURNS {
            let (sin, cos) = sin_cos_f32(PI * (b as f32 + 0.5) / TURNS as f32);
            sum += fibres.value(wo, Vec3::new(r * cos, r * sin, z)) * z;
        }
    }
    2.0 * PI * sum / (HEIGHTS * TURNS) as f32
}

impl Reflector for Cloth {
    fn parts(&self) -> (bool, bool) {
        (!self.diffuse.is_black(), !self.sheen.is_black())
    }
    fn weights(&self, wo: Vec3) -> (f32, f32) {
        // The fibres shine at grazing angles.
        (self.diffuse.max_component(), self.sheen.max_component() * (1.0 - 0.8 * wo.z))
    }
    fn base(&self, _: Vec3, _: Vec3) -> Light {
        self.diffuse / PI
    }
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        self.sheen * self.fibres.value(wo, wi)
    }
    fn sample_highlight(&self, _: Vec3, u: (f32, f32)) -> Vec3 {
        square_to_uniform_sphere((0.5 * u.0, u.1))
    }
    fn highlight_pdf(&self, _: Vec3, _: Vec3) -> f32 {
        1.0 / (2.0 * PI)
    }
    fn ambient(&self) -> Light {
        self.diffuse
    }
}
