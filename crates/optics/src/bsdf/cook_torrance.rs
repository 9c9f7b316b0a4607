//! # cook_torrance
//!
//! The model of Cook & Torrance as courses write it: a diffuse base and a highlight of V-shaped grooves whose slopes Beckmann's
//! distribution spreads. `f = k_d / pi + k_s D G F / (c (n.l)(n.v))` with
//!
//! - `D = exp(-(tan delta / m)^2) / (m^2 cos^4 delta)`, where delta is the angle between the half vector h and the normal
//! - `G = min(1, 2 (n.h)(n.v) / (v.h), 2 (n.h)(n.l) / (v.h))`
//! - `F` by Fresnel's equations, or Schlick's approximation of them, or 1
//! - `c = pi` in the `classic` form, as printed in 1981; `c = 4 pi` in the `normalized` form, which later work found right
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture, 0..1 | | 0.5 | diffuse colour k_d |
//! | `specular` | colour or texture, 0..1 | | 0.2 | colour of the highlight k_s |
//! | `roughness` | number or texture, 0..1 | | 0.2 | m: RMS slope of the facets times the root of 2 |
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index of the facets |
//! | `fresnel` | `exact`, `schlick`, `constant` | | `exact` | Fresnel's equations, Schlick's approximation, or F = 1 |
//! | `form` | `normalized`, `classic` | | `normalized` | c = 4 pi, or pi as printed |
//!
//! ## Example
//!
//! ```toml
//! [materials.dark_blue_paint]
//! type = "cook_torrance"
//! diffuse = [0.02, 0.03, 0.15]
//! specular = 0.8
//! roughness = 0.15
//! ior = 1.6
//! ```
//!
//! ## Limits
//!
//! `classic` reflects four times the light of its facets, so it gives back up to 4 k_s F. `normalized` conserves energy where
//! `diffuse + specular <= 1`; it loses light that would bounce among the facets, and its G, which knows grooves of one shape,
//! has a crease where the terms change. For better-behaved facets see `rough_conductor` and `rough_plastic`.
//!
//! ## References
//!
//! R. L. Cook & K. E. Torrance, "A Reflectance Model for Computer Graphics", SIGGRAPH 1981 (ACM TOG 1(1), 1982). The factor 4:
//! B. Walter et al. 2007, section 5.1, note to equation 20. C. Schlick 1994. Directions are drawn by `D (n.h) / pi`.

use super::boundary::{Fresnel, square};
use super::opaque::{Opaque, Reflector};
use super::{Interface, Mode, Prepare, roughness, slot};
use crate::fresnel::{dielectric, dielectric_schlick, reflect};
use crate::microfacet::LEAST_ALPHA;
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{exp_f32, ln_f32, sin_cos_f32};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "cook_torrance",
    doc: "Cook & Torrance as courses write it: Beckmann's grooves over a diffuse base.",
    params: &[
        ParamSpec::reflectance("diffuse", [0.5; 3], "diffuse colour k_d"),
        ParamSpec::reflectance("specular", [0.2; 3], "colour of the highlight k_s"),
        roughness::ROUGHNESS,
        ParamSpec::number("ior", 1.5, "refractive index of the facets").range((0.01, f64::INFINITY)),
        ParamSpec::choice("fresnel", Fresnel::WORDS, "Fresnel's equations, Schlick's approximation, or 1"),
        ParamSpec::choice(
            "form",
            &["normalized", "classic"],
            "as later work corrects it, or four times that, as printed",
        ),
    ],
};
const DIFFUSE: usize = slot(SPEC.params, "diffuse");
const SPECULAR: usize = slot(SPEC.params, "specular");
const ROUGHNESS: usize = slot(SPEC.params, "roughness");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    ior: f32,
    fresnel: Fresnel,
    /// 1, or 4.
    scale: f32,
}

/// At a point.
pub type CookTorrance = Opaque<Grooves>;

/// Grooves over a diffuser.
#[derive(Clone, Debug)]
pub struct Grooves {
    diffuse: Light,
    specular: Light,
    m: f32,
    scale: f32,
    fresnel: Fresnel,
    /// Outside and of the facets.
    eta: (f32, f32),
}

impl Prepare for Prepared {
    type At = CookTorrance;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared {
            ior: palette.index(params, "ior").at_d_line(),
            fresnel: Fresnel::of(params.text("fresnel")),
            scale: if params.text("form") == Some("classic") { 4.0 } else { 1.0 },
        }
    }
    fn at(&self, _: &Lanes, slots: &[Light], interface: Interface) -> CookTorrance {
        Opaque(Grooves {
            diffuse: slots[DIFFUSE],
            specular: slots[SPECULAR],
            m: slots[ROUGHNESS][0].max(LEAST_ALPHA),
            scale: self.scale,
            fresnel: self.fresnel,
            eta: (interface.eta_above, self.ior),
        })
    }
}

impl Grooves {
    fn reflectance(&self, cos: f32) -> f32 {
        match self.fresnel {
            Fresnel::Exact => dielectric(cos.min(1.0), self.eta.0, self.eta.1),
            Fresnel::Schlick => dielectric_schlick(cos.min(1.0), self.eta.0, self.eta.1),
            Fresnel::Constant => 1.0,
        }
    }

    /// `D / pi`: facets per solid angle.
    fn d(&self, h: Vec3) -> f32 {
        let z2 = h.z * h.z;
        let m2 = self.m * self.m;
        // x^2 + y^2 in place of 1 - z^2: exact where the lobe is narrow.
        exp_f32(-(h.x * h.x + h.y * h.y) / (z2 * m2)) / (PI * m2 * square(z2))
    }
}

impl Reflector for Grooves {
    fn parts(&self) -> (bool, bool) {
        (!self.diffuse.is_black(), !self.specular.is_black())
    }
    fn weights(&self, wo: Vec3) -> (f32, f32) {
        (self.diffuse.max_component(), self.specular.max_component() * self.reflectance(wo.z).max(0.01))
    }
    fn base(&self, _: Vec3, _: Vec3) -> Light {
        self.diffuse / PI
    }
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        let h = (wo + wi).normalize();
        let cos = wo.dot(h);
        let g = (2.0 * h.z * wo.z.min(wi.z) / cos).min(1.0);
        self.specular * (self.reflectance(cos) * self.scale * self.d(h) * g / (4.0 * wo.z * wi.z))
    }
    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        let slope = self.m * (-ln_f32(1.0 - u.0)).sqrt();
        let (sin, cos) = sin_cos_f32(2.0 * PI * u.1);
        reflect(wo, Vec3::new(slope * cos, slope * sin, 1.0).normalize())
    }
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        self.d(h) * h.z / (4.0 * wo.dot(h))
    }
    fn ambient(&self) -> Light {
        self.diffuse
    }
}
