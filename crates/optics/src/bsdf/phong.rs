//! # phong
//!
//! Phong's highlight around the mirrored direction, over a diffuse base, with the classics' ideal mirror and pane on top.
//! `normalized` is the modified model of Lafortune & Willems, which conserves energy and is reciprocal; `classic` is the
//! one that courses teach.
//!
//! With `r` the mirrored `wo` and `q` the exponent:
//!
//! - `normalized`: `f = k_d / pi + k_s (q + 2) / (2 pi) (r.l)^q`
//! - `classic`: `f (n.l) = (k_d (n.l) + k_s (r.l)^q) / pi`, so that under a plain light of strength 1 the picture shows
//!   `k_d (n.l) + k_s (r.l)^q`
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture | | 0.5 | diffuse colour k_d |
//! | `specular` | colour or texture | | 0 | colour of the highlight k_s |
//! | `exponent` | number or texture, 0..10^6 | | 32 | sharpness of the highlight q |
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
//! [materials.red_plastic]
//! type = "phong"
//! diffuse = [0.7, 0.1, 0.1]
//! specular = 0.2
//! exponent = 60
//! ```
//!
//! ## Limits
//!
//! `normalized` conserves energy only where `diffuse + specular <= 1` (and `reflect`, `transmit` come on top); its highlight
//! loses what falls below the horizon at grazing angles. `classic` breaks energy conservation (with `specular` 1 and a
//! low exponent it gives back up to twice what it gets) and reciprocity, since the cosine of the light is missing from its
//! highlight: grazing light shows as strongly as steep light. With constant `fresnel`, `reflect` and `transmit` hold at every angle; under total
//! reflection only `reflect` remains, as in the course.
//!
//! ## References
//!
//! B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975. E. P. Lafortune & Y. D. Willems, "Using the
//! Modified Phong Reflectance Model for Physically Based Rendering", Report CW197, K.U. Leuven, 1994, equation 4.

use super::phong_body::{self, Highlight, ROWS, power};
use core::f32::consts::PI;
use kirkas_geometry::elementary::{pow_f32, sin_cos_f32};
use kirkas_geometry::{Frame, Vec3};
use kirkas_scene::{Kind, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "phong",
    doc: "Phong's highlight over a diffuse base, with ideal mirror and pane.",
    params: ROWS,
};

/// The fixed parameters.
pub type Prepared = phong_body::Prepared<Mirrored>;

/// At a point.
pub type Phong = phong_body::Body<Mirrored>;

/// The highlight about the mirrored direction.
#[derive(Clone, Debug)]
pub struct Mirrored;

impl Highlight for Mirrored {
    fn cosine(wo: Vec3, wi: Vec3) -> f32 {
        mirrored(wo).dot(wi).min(1.0)
    }

    fn normalisation(q: f32) -> f32 {
        (q + 2.0) / (2.0 * PI)
    }

    fn pdf(q: f32, wo: Vec3, wi: Vec3) -> f32 {
        (q + 1.0) / (2.0 * PI) * power(Self::cosine(wo, wi), q)
    }

    fn sample(q: f32, wo: Vec3, u: (f32, f32)) -> Vec3 {
        Frame::from_z(mirrored(wo)).to_world(square_to_power_cosine(u, q))
    }
}

fn mirrored(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}

/// A direction about +z with density `(q + 1) / (2 pi) cos^q` per solid angle (Lafortune & Willems 1994, equation 6).
pub(super) fn square_to_power_cosine(u: (f32, f32), q: f32) -> Vec3 {
    let cos = pow_f32(1.0 - u.0, 1.0 / (q + 1.0));
    let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
    let (s, c) = sin_cos_f32(2.0 * PI * u.1);
    Vec3::new(sin * c, sin * s, cos)
}
