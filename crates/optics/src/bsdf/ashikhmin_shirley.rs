//! # ashikhmin_shirley
//!
//! A polished surface: a Phong-like highlight around the half vector with two exponents, brighter towards grazing angles, over a
//! diffuse base that gets what the highlight leaves. Brushed metal, varnished wood, glazed tiles.
//!
//! - `f_s = sqrt((n_u + 1)(n_v + 1)) / (8 pi) (n.h)^((n_u h_u^2 + n_v h_v^2) / (1 - (n.h)^2)) F(l.h) / ((l.h) max(n.l, n.v))`, `F`
//!   Schlick's curve from k_s
//! - `f_d = 28 k_d / (23 pi) (1 - k_s) (1 - (1 - n.l / 2)^5) (1 - (1 - n.v / 2)^5)`
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture, 0..1 | | 0.5 | k_d |
//! | `specular` | colour or texture, 0..1 | | 0.05 | k_s: reflectance of the highlight straight on |
//! | `exponent_u` | number or texture, 0..10^6 | | 100 | sharpness along the texture's u |
//! | `exponent_v` | number or texture, 0..10^6 | | 100 | sharpness across it |
//!
//! ## Example
//!
//! ```toml
//! [materials.varnish]
//! type = "ashikhmin_shirley"
//! diffuse = [0.4, 0.2, 0.1]
//! specular = 0.05
//! exponent_u = 1000
//! exponent_v = 50
//! ```
//!
//! ## Limits
//!
//! The highlight loses light as its exponents fall: there is no masking term, only `max(n.l, n.v)`.
//!
//! ## References
//!
//! M. Ashikhmin & P. Shirley, "An Anisotropic Phong BRDF Model", Journal of Graphics Tools 5(2), 2000, equations 4-10.

use super::boundary::square;
use super::opaque::{Opaque, Reflector};
use super::{Interface, Mode, Prepare, slot};
use crate::fresnel::{reflect, schlick};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{atan2_f32, pow_f32, sin_cos_f32};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "ashikhmin_shirley",
    doc: "A polished surface with a highlight of two exponents over a diffuse base.",
    params: &[
        ParamSpec::reflectance("diffuse", [0.5; 3], "k_d"),
        ParamSpec::reflectance("specular", [0.05; 3], "k_s, the highlight's reflectance straight on"),
        ParamSpec::number_texture("exponent_u", 100.0, (0.0, 1e6), "sharpness along the texture's u"),
        ParamSpec::number_texture("exponent_v", 100.0, (0.0, 1e6), "sharpness across it"),
    ],
};
const DIFFUSE: usize = slot(SPEC.params, "diffuse");
const SPECULAR: usize = slot(SPEC.params, "specular");
const EXPONENT_U: usize = slot(SPEC.params, "exponent_u");
const EXPONENT_V: usize = slot(SPEC.params, "exponent_v");

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

/// At a point.
pub type AshikhminShirley = Opaque<Polish>;

/// Polish over a diffuser.
#[derive(Clone, Debug)]
pub struct Polish {
    diffuse: Light,
    specular: Light,
    u: f32,
    v: f32,
}

impl Prepare for Prepared {
    type At = AshikhminShirley;
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> AshikhminShirley {
        Opaque(Polish {
            diffuse: slots[DIFFUSE],
            specular: slots[SPECULAR],
            u: slots[EXPONENT_U][0],
            v: slots[EXPONENT_V][0],
        })
    }
}

impl Polish {
    /// Density of facets per solid angle (equation 6); its integral over the hemisphere is 1.
    fn normal_pdf(&self, h: Vec3) -> f32 {
        let aside = h.x * h.x + h.y * h.y;
        let exponent = if aside > 0.0 { (self.u * h.x * h.x + self.v * h.y * h.y) / aside } else { 0.0 };
        ((self.u + 1.0) * (self.v + 1.0)).sqrt() / (2.0 * PI) * pow_f32(h.z, exponent)
    }
}

/// `1 - (1 - cos / 2)^5`.
fn dimming(cos: f32) -> f32 {
    let x = 1.0 - 0.5 * cos;
    1.0 - square(x * x) * x
}

impl Reflector for Polish {
    fn parts(&self) -> (bool, bool) {
        let base = self.diffuse * self.specular.map(|s| 1.0 - s);
        (!base.is_black(), !self.specular.is_black())
    }
    fn weights(&self, wo: Vec3) -> (f32, f32) {
        let highlight = schlick(self.specular.max_component(), wo.z);
        ((self.diffuse * self.specular.map(|s| 1.0 - s)).max_component(), highlight)
    }
    fn base(&self, wo: Vec3, wi: Vec3) -> Light {
        let shape = 28.0 / (23.0 * PI) * dimming(wo.z) * dimming(wi.z);
        self.diffuse * self.specular.map(|s| 1.0 - s) * shape
    }
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        let h = (wo + wi).normalize();
        let cos = wo.dot(h).min(1.0);
        let shape = self.normal_pdf(h) / (4.0 * cos * wo.z.max(wi.z));
        self.specular.map(|s| if s > 0.0 { schlick(s, cos) } else { 0.0 }) * shape
    }
    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        // Equations 9 and 10: the longitude within one of four quadrants, then the height.
        let quadrant = (4.0 * u.0).min(3.0).floor();
        let (sin, cos) = sin_cos_f32(0.5 * PI * (4.0 * u.0 - quadrant).min(1.0));
        let phi = atan2_f32((self.u + 1.0).sqrt() * sin, (self.v + 1.0).sqrt() * cos.max(0.0));
        let phi = match quadrant as u32 {
            0 => phi,
            1 => PI - phi,
            2 => PI + phi,
            _ => -phi,
        };
        let (sin, cos) = sin_cos_f32(phi);
        let z = pow_f32(1.0 - u.1, 1.0 / (self.u * cos * cos + self.v * sin * sin + 1.0));
        let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        reflect(wo, Vec3::new(r * cos, r * sin, z))
    }
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        self.normal_pdf(h) / (4.0 * wo.dot(h))
    }
    fn ambient(&self) -> Light {
        self.diffuse
    }
}
