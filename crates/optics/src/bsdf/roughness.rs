//! The rows of rough models and what they mean.
//!
//! `roughness` is alpha of the papers, about the RMS slope of the facets, as in pbrt and Mitsuba (Disney-style renderers show its
//! square root). `anisotropy` stretches it: `alpha_u = roughness (1 + anisotropy)` along the surface's first tangent (its texture's
//! u), `alpha_v = roughness (1 - anisotropy)` across (C. Kulla & A. Conty, "Revisiting Physically Based Shading at Imageworks",
//! SIGGRAPH 2017 courses). So any pair is written as roughness = (alpha_u + alpha_v) / 2, anisotropy = (alpha_u - alpha_v) /
//! (alpha_u + alpha_v).

use crate::Light;
use crate::microfacet::albedo::Losses;
use crate::microfacet::{Distribution, Facets};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{ParamSpec, Params};

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
/// Row `distribution`.
pub(super) const DISTRIBUTION: ParamSpec =
    ParamSpec::choice("distribution", &["ggx", "beckmann"], "slopes with long tails, or Gaussian ones");
/// Row `compensation`.
pub(super) const COMPENSATION: ParamSpec =
    ParamSpec::bool("compensation", false, "gives back the light that bounces among the facets");

/// `(alpha_u, alpha_v)`.
pub(super) fn alphas(roughness: Light, anisotropy: Light) -> (f32, f32) {
    let (r, a) = (roughness[0], anisotropy[0]);
    (r * (1.0 + a), r * (1.0 - a))
}

/// What is fixed about facets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    distribution: Distribution,
    compensates: bool,
}

impl Kind {
    pub(super) fn read(params: &Params) -> Self {
        let distribution =
            if params.text("distribution") == Some("beckmann") { Distribution::Beckmann } else { Distribution::Ggx };
        let compensates =
            params.spec().params.iter().any(|row| row.name == "compensation") && params.bool("compensation");
        Kind { distribution, compensates }
    }

    pub(super) fn distribution(&self) -> Distribution {
        self.distribution
    }

    pub(super) fn facets(&self, roughness: Light, anisotropy: Light) -> Facets {
        Facets::new(self.distribution, alphas(roughness, anisotropy))
    }

    /// What they lose, if it is to be given back.
    pub(super) fn losses(&self, facets: &Facets) -> Option<Losses> {
        self.compensates.then(|| Losses::new(facets))
    }
}
