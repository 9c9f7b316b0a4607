//! The rows of rough models and what they mean.
//!
//! `roughness` is alpha of the papers, about the RMS slope of the facets, as in pbrt and Mitsuba (Disney-style renderers show its
//! square root). `anisotropy` stretches it: `alpha_u = roughness (1 + anisotropy)` along the surface's first tangent (its texture's
//! u), `alpha_v = roughness (1 - anisotropy)` across (C. Kulla & A. Conty, "Revisiting Physically Based Shading at Imageworks",
//! SIGGRAPH 2017 courses). So any pair is written as roughness = (alpha_u + alpha_v) / 2, anisotropy = (alpha_u - alpha_v) /
//! (alpha_u + alpha_v).

use crate::Light;
use crate::microfacet::LEAST_ALPHA;
use kirkas_scene::ParamSpec;
use kirkas_scene::spec::UNIT;

/// Row `roughness`.
pub(super) const ROUGHNESS: ParamSpec =
    ParamSpec::number_texture("roughness", 0.2, UNIT, "alpha of the facets' slopes");
/// Row `anisotropy`.
pub(super) const ANISOTROPY: ParamSpec = ParamSpec::number_texture(
    "anisotropy",
    0.0,
    (-1.0, 1.0),
    "above 0 rougher along the texture's u and smoother across, below 0 the other way round",
);

/// `(alpha_u, alpha_v)`, neither below [`LEAST_ALPHA`].
pub(super) fn alphas(roughness: Light, anisotropy: Light) -> (f32, f32) {
    let (r, a) = (roughness[0], anisotropy[0]);
    ((r * (1.0 + a)).max(LEAST_ALPHA), (r * (1.0 - a)).max(LEAST_ALPHA))
}
