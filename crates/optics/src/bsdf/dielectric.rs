//! # dielectric
//!
//! A smooth clear boundary: glass, water, diamond. Light is reflected and refracted (Snell & Descartes), in parts that
//! Fresnel's equations give; beyond the critical angle all is reflected. Put it on a closed surface: what is inside has the
//! index `ior`, and where several insides overlap the highest `priority` wins.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index inside |
//! | `fresnel` | `exact`, `schlick`, `constant` | | `exact` | Fresnel's equations for unpolarised light; Schlick's approximation; or the classics' constants k_s and k_t |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints the reflection; k_s with `constant` |
//! | `transmittance` | colour or texture, 0..1 | | 1 | tints the refraction; k_t with `constant` |
//! | `absorption` | colour | 1/scene unit | 0 | light inside fades as `exp(-absorption distance)` (Beer & Lambert) |
//! | `priority` | whole number | | 0 | among overlapping insides the highest wins |
//! | `interior` | medium | | none | what scatters inside |
//! | `film_thickness` | number or texture, 0..10^5 | nm | 0 | thickness of a film that interferes; 0 is none |
//! | `film_ior` | number, at least 0.01 | | 1.33 | refractive index of the film |
//!
//! ## Example
//!
//! ```toml
//! [materials.bottle]
//! type = "dielectric"
//! ior = 1.52
//! absorption = [1.2, 0.3, 0.9]
//! ```
//!
//! ## Limits
//!
//! Radiance is divided by n^2 on entering and multiplied on leaving, as physics has it: what is seen *through* a body is
//! unchanged, but a lamp or a lit surface *inside* glass looks 1/n^2 as bright from outside, and a camera inside sees the
//! outside n^2 as bright. `fresnel = "constant"` does not scale, does not depend on the angle (but still reflects totally, when
//! only the `reflectance` part remains), and with its defaults gives back twice the light it gets: choose k_s + k_t <= 1.
//!
//! Let bodies overlap where they meet (`priority` says who fills the overlap) or leave a gap: boundaries that coincide exactly
//! are met as one, so that touching bodies of different index look too dark or too bright.
//!
//! With a film, colour is exact in spectral renders; in RGB it is that of 27 bands of the spectrum under D65. See `thin_film`.
//!
//! ## References
//!
//! M. Born & E. Wolf, "Principles of Optics", 7th ed., section 1.5. C. Schlick 1994, equation 15. E. Veach 1997, section 5.2
//! (radiance over n^2). C. M. Schmidt & B. Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002.

use super::boundary::{DeltaPair, Fresnel, Split, pick};
use super::film::{FILM_IOR, FILM_THICKNESS, FilmKind};
use super::hull::INTERIOR;
use super::{Branches, BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::{Lanes, Light, Medium, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "dielectric",
    doc: "A smooth clear boundary: glass, water, diamond.",
    params: &[
        IOR,
        FRESNEL,
        REFLECTANCE_ROW,
        TRANSMITTANCE_ROW,
        ABSORPTION,
        PRIORITY,
        INTERIOR,
        FILM_THICKNESS,
        FILM_IOR,
    ],
};
pub(super) const IOR: ParamSpec = ParamSpec::new(
    "ior",
    ParamType::Index,
    Fallback::Number(1.5),
    "refractive index inside: a number, { material = \"N-BK7\" }, { file = \"x.yml\" }, { cauchy = [A, B] } or { sellmeier = [B.., C..] }",
)
.range((0.01, f64::INFINITY));
pub(super) const FRESNEL: ParamSpec = ParamSpec::choice(
    "fresnel",
    Fresnel::WORDS,
    "Fresnel's equations, Schlick's approximation, or constant k_s and k_t",
);
pub(super) const REFLECTANCE_ROW: ParamSpec =
    ParamSpec::reflectance("reflectance", [1.0; 3], "tints the reflection; k_s with constant fresnel");
pub(super) const TRANSMITTANCE_ROW: ParamSpec =
    ParamSpec::reflectance("transmittance", [1.0; 3], "tints the refraction; k_t with constant fresnel");
pub(super) const ABSORPTION: ParamSpec =
    ParamSpec::color("absorption", [0.0; 3], "light inside fades as exp(-absorption distance)").unit("1/scene unit");
pub(super) const PRIORITY: ParamSpec =
    ParamSpec::integer("priority", 0, (-1e6, 1e6), "where insides overlap, the highest wins");

const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const THICKNESS: usize = slot(SPEC.params, "film_thickness");
const TRANSMITTANCE: usize = slot(SPEC.params, "transmittance");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
    film: FilmKind,
    medium: Medium,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct Dielectric {
    pair: DeltaPair,
}

/// The filling that a dielectric's rows describe.
pub(super) fn read_medium(params: &Params, palette: &Palette) -> Medium {
    Medium {
        ior: palette.index(params, "ior"),
        priority: params.integer("priority") as i32,
        absorption: palette.absorption(params, "absorption"),
    }
}

impl Prepare for Prepared {
    type At = Dielectric;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared {
            fresnel: Fresnel::of(params.text("fresnel")),
            film: FilmKind::read(params),
            medium: read_medium(params, palette),
        }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> Dielectric {
        let split = Split {
            reflect: slots[REFLECTANCE],
            transmit: slots[TRANSMITTANCE],
            fresnel: self.fresnel,
            film: self.film.at(lanes, slots[THICKNESS]),
        };
        Dielectric { pair: DeltaPair { split, interface } }
    }
    fn medium(&self) -> Option<&Medium> {
        Some(&self.medium)
    }
}

impl Scatter for Dielectric {
    fn lobes(&self) -> LobeSet {
        self.pair.lobes()
    }
    fn eval(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> Light {
        Light::BLACK
    }
    fn pdf(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> f32 {
        0.0
    }
    fn sample(&self, wo: Vec3, u_lobe: f32, _: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (r, t) = self.pair.weights(wo);
        let wanted = |lobe, w: Light| if lobes.contains(lobe) { w.max_component() } else { 0.0 };
        match pick([wanted(Lobe::DeltaReflection, r), wanted(Lobe::DeltaTransmission, t)], u_lobe)? {
            (0, p) => Some(self.pair.reflected(wo, r, p)),
            (_, p) => self.pair.refracted(wo, t, p, mode),
        }
    }
    fn delta_branches(&self, wo: Vec3, mode: Mode) -> Branches {
        self.pair.branches(wo, mode)
    }
}
