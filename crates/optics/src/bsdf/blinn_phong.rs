//! # blinn_phong
//!
//! The highlight of Blinn (after Torrance & Sparrow) around the half vector, over a diffuse base, with the classics' ideal
//! mirror and pane on top. Towards grazing angles its highlight narrows across the plane of incidence, as measured ones do,
//! where Phong's stays round.
//!
//! With `h` the normalised `wo + wi` and `q` the exponent:
//!
//! - `normalized`: `f = k_d / pi + k_s N (n.h)^q`, `N = (q + 2)(q + 4) / (8 pi (2^(-q/2) + q))`
//! - `classic`: `f (n.l) = (k_d (n.l) + k_s (n.h)^q) / pi`, so that under a plain light of strength 1 the picture shows
//!   `k_d (n.l) + k_s (n.h)^q`
//!
//! `N` makes the highlight's albedo exactly `k_s` at normal incidence, where it is greatest.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture | | 0.5 | diffuse colour k_d |
//! | `specular` | colour or texture | | 0 | colour of the highlight k_s |
//! | `exponent` | number or texture, 0..10^6 | | 32 | sharpness of the highlight q; about four times Phong's for the same size |
//! | `form` | `normalized`, `classic` | | `normalized` | energy-conserving, or as the textbooks of old have it |
//! | `ambient` | colour or texture | | `diffuse` | factor of ambient light k_a |
//! | `reflect` | colour or texture | | 0 | ideal mirror reflection on top |
//! | `transmit` | colour or texture | | 0 | ideal refraction, on closed surfaces |
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index inside |
//! | `fresnel` | `constant`, `schlick`, `exact` | | `constant` | how `reflect` and `transmit` depend on the angle; see `dielectric` |
//! | `priority` | whole number | | 0 | where insides overlap, the highest wins |
//!
//! ## Example
//!
//! ```toml
//! [materials.blue_paint]
//! type = "blinn_phong"
//! diffuse = [0.05, 0.1, 0.4]
//! specular = 0.3
//! exponent = 200
//! ```
//!
//! ## Limits
//!
//! `normalized` conserves energy where `diffuse + specular <= 1`, and darkens towards grazing angles. `classic` breaks energy
//! conservation and reciprocity as `phong`'s does.
//!
//! ## References
//!
//! J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977. F. Giesen, "Phong and
//! Blinn-Phong Normalization Factors", 2009, gives `N`. A. Ngan, F. Durand & W. Matusik, "Experimental Analysis of BRDF
//! Models", EGSR 2005.

use super::phong::square_to_power_cosine;
use super::phong_body::{self, Highlight, ROWS, power};
use crate::fresnel::reflect;
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::pow_f32;
use kirkas_scene::{Kind, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "blinn_phong",
    doc: "Blinn's half-vector highlight over a diffuse base, with ideal mirror and pane.",
    params: ROWS,
};

/// The fixed parameters.
pub type Prepared = phong_body::Prepared<HalfVector>;

/// At a point.
pub type BlinnPhong = phong_body::Body<HalfVector>;

/// The highlight about the half vector.
#[derive(Clone, Debug)]
pub struct HalfVector;

impl Highlight for HalfVector {
    fn cosine(wo: Vec3, wi: Vec3) -> f32 {
        (wo + wi).normalize().z.min(1.0)
    }

    fn normalisation(q: f32) -> f32 {
        (q + 2.0) * (q + 4.0) / (8.0 * PI * (pow_f32(2.0, -0.5 * q) + q))
    }

    fn pdf(q: f32, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        (q + 1.0) / (2.0 * PI) * power(Self::cosine(wo, wi), q) / (4.0 * wo.dot(h))
    }

    fn sample(q: f32, wo: Vec3, u: (f32, f32)) -> Vec3 {
        reflect(wo, square_to_power_cosine(u, q))
    }
}
