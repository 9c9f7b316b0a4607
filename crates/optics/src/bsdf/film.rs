//! The rows of a thin film on a clear or metallic body.

use crate::Lanes;
use crate::Light;
use crate::thin_film::Film;
use kirkas_scene::{ParamSpec, Params};

/// Row `film_thickness`.
pub(super) const FILM_THICKNESS: ParamSpec =
    ParamSpec::number_texture("film_thickness", 0.0, (0.0, 1e5), "thickness of a film that interferes; 0 = none")
        .unit("nm");
/// Row `film_ior`.
pub(super) const FILM_IOR: ParamSpec =
    ParamSpec::number("film_ior", 1.33, "refractive index of the film").range((0.01, f64::INFINITY));

/// What is fixed about a film.
#[derive(Clone, Copy, Debug)]
pub(super) struct FilmKind {
    ior: f32,
}

impl FilmKind {
    pub(super) fn read(params: &Params) -> Self {
        FilmKind { ior: params.f32("film_ior") }
    }

    pub(super) fn at(&self, lanes: &Lanes, thickness: Light) -> Option<Film> {
        Film::new(lanes, thickness[0], self.ior)
    }
}
