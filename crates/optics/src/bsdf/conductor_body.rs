//! What smooth and rough conductors share: their rows and the reflectance of a metal at an angle.

use super::mirror_body::Reflective;
use crate::index::MetalCurves;
use crate::thin_film::{Beneath, Film};
use crate::{Lanes, Light, Palette, fresnel};
use kirkas_scene::{Fallback, ParamSpec, ParamType, Params};

/// Row `ior`.
pub(super) const IOR: ParamSpec = ParamSpec::new(
    "ior",
    ParamType::Index,
    Fallback::Required,
    "refractive index n + ik: { material = \"gold\" }, { file = \"Au.yml\" }, or a number for n",
)
.range((0.01, f64::INFINITY));
/// Row `k`.
pub(super) const K: ParamSpec = ParamSpec::new(
    "k",
    ParamType::Color,
    Fallback::Vector([0.0; 3]),
    "extinction coefficient, where `ior` is a number",
)
.range((0.0, f64::INFINITY));
/// Row `reflectance`.
pub(super) const REFLECTANCE_ROW: ParamSpec = ParamSpec::reflectance("reflectance", [1.0; 3], "tints the reflection");

/// The constants of a conductor.
#[derive(Clone, Debug)]
pub enum Constants {
    /// As measured.
    Measured(MetalCurves),
    /// n, and k as a colour.
    Plain(f32, crate::Spectrum),
}

/// A metal at a path's lanes.
#[derive(Clone, Copy, Debug)]
pub struct Metal {
    n: Light,
    k: Light,
    tint: Light,
    /// Index outside.
    eta_o: f32,
    film: Option<Film>,
}

impl Constants {
    pub(super) fn read(params: &Params, palette: &Palette) -> Self {
        match palette.constants(params, "ior").as_ref().and_then(MetalCurves::new) {
            Some(curves) => Constants::Measured(curves),
            None => Constants::Plain(palette.index(params, "ior").at_d_line(), palette.absorption(params, "k")),
        }
    }

    pub(super) fn at(&self, lanes: &Lanes, tint: Light, eta_o: f32, film: Option<Film>) -> Metal {
        let (n, k) = match self {
            Constants::Measured(curves) => curves.at(lanes),
            Constants::Plain(n, k) => (Light::splat(*n), k.at(lanes)),
        };
        Metal { n, k, tint, eta_o, film }
    }
}

impl Reflective for Metal {
    fn reflectance(&self, cos: f32) -> Light {
        if let Some(film) = &self.film {
            return film.reflectance(cos, self.eta_o, &Beneath { n: self.n, k: self.k }) * self.tint;
        }
        let at = |lane: usize| fresnel::conductor(cos, self.n[lane] / self.eta_o, self.k[lane] / self.eta_o);
        Light(core::array::from_fn(at)) * self.tint
    }

    /// By the curve through its values at 0, 82 and 90 degrees (Lazányi & Szirmay-Kalos 2005; N. Hoffman, "Fresnel Equations
    /// Considered Harmful", 2019): `F0 + (1 - F0)(1 - mu)^5 - a mu (1 - mu)^6`, whose mean is `F0 + (1 - F0) / 21 - a / 126`.
    fn mean(&self) -> Light {
        if self.film.is_some() {
            // Gauss & Legendre in the cosine's square.
            let at = |x: f32| self.reflectance(x.sqrt());
            return (at(0.112_701_67) + at(0.887_298_35)) * (5.0 / 18.0) + at(0.5) * (8.0 / 18.0);
        }
        const MU: f32 = 1.0 / 7.0;
        const FIFTH: f32 = 7776.0 / 16807.0;
        const A: f32 = 46656.0 / 823_543.0;
        let at = |lane: usize| {
            let of = |cos| fresnel::conductor(cos, self.n[lane] / self.eta_o, self.k[lane] / self.eta_o);
            let (f0, f82) = (of(1.0), of(MU));
            (f0 + (1.0 - f0) / 21.0 - (f0 + (1.0 - f0) * FIFTH - f82) / (126.0 * A)).clamp(0.0, 1.0)
        };
        Light(core::array::from_fn(at)) * self.tint
    }

    fn is_black(&self) -> bool {
        self.tint.is_black()
    }
}
