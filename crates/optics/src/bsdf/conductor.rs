//! # conductor
//!
//! A perfectly smooth metal, by Fresnel's equations for a complex refractive index: gold, copper, aluminium by name.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | index | | required | `{ material = "gold" }`, `{ file = "Au.yml" }` of refractiveindex.info, or a number for n |
//! | `k` | colour | | 0 | extinction coefficient, where `ior` is a number |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints the reflection |
//! | `film_thickness` | number or texture, 0..10^5 | nm | 0 | thickness of a film that interferes; 0 is none |
//! | `film_ior` | number, at least 0.01 | | 1.33 | refractive index of the film |
//!
//! ## Example
//!
//! ```toml
//! [materials.ring]
//! type = "conductor"
//! ior = { material = "gold" }
//! ```
//!
//! ## Limits
//!
//! In RGB mode n and k are chosen so that the reflectance at normal incidence has the metal's colour under D65; towards grazing
//! the colour is nearly right.
//! A film's colours are exact in spectral renders; in RGB they are those of 27 bands of the spectrum under D65, good to about 3000 nm.
//!
//! ## References
//!
//! The film: see `thin_film`. M. Born, E. Wolf, "Principles of Optics" (7th ed., 1999), section 14.2.

use super::conductor_body::{Constants, IOR, K, Metal, REFLECTANCE_ROW};
use super::film::{FILM_IOR, FILM_THICKNESS, FilmKind};
use super::mirror_body::Smooth;
use super::{Interface, Prepare, slot};
use crate::{Lanes, Light, Palette};
use kirkas_scene::{Kind, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "conductor",
    doc: "A smooth metal, by its complex refractive index.",
    params: &[IOR, K, REFLECTANCE_ROW, FILM_THICKNESS, FILM_IOR],
};

const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const THICKNESS: usize = slot(SPEC.params, "film_thickness");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    constants: Constants,
    film: FilmKind,
}

/// At a point.
pub type Conductor = Smooth<Metal>;

impl Prepare for Prepared {
    type At = Conductor;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared { constants: Constants::read(params, palette), film: FilmKind::read(params) }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> Conductor {
        let film = self.film.at(lanes, slots[THICKNESS]);
        Smooth(self.constants.at(lanes, slots[REFLECTANCE], interface.eta_above, film))
    }
}
