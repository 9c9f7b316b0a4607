//! # orthographic: parallel rays
//!
//! Every ray runs the same way, so things look equally large at any distance: for plans, and for comparing with numbers.
//!
//! ## Parameters
//!
//! - `height` (number, scene units, default 2): what the picture covers from bottom to top.
//! - and those of all cameras: `position`, `look_at`, `up`, `transform`, `motion`, `shutter`.
//!
//! ## Example
//!
//! ```toml
//! [cameras.plan]
//! type = "orthographic"
//! position = [0, 10, 0]
//! look_at = [0, 0, 0]
//! up = [0, 0, -1]
//! height = 6
//! ```
//!
//! ## Limits
//!
//! Rays start in the plane through `position`: what lies behind it is not seen.
//!
//! ## References
//!
//! Foley, van Dam, Feiner & Hughes 1990, "Computer Graphics: Principles and Practice", section 6.1.2 (parallel projections).

use super::{CameraRay, CameraSight, FilmPlace};
use kirkas_geometry::DVec3;
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Camera,
    name: "orthographic",
    doc: "A camera with parallel rays: size does not depend on distance.",
    params: &[ParamSpec::number("height", 2.0, "what the picture covers from bottom to top")
        .unit("scene units")
        .range(POSITIVE)],
};

#[derive(Clone, Copy, Debug)]
pub(super) struct Orthographic {
    half_height: f64,
}

impl Orthographic {
    pub(super) fn compile(params: &Params) -> Self {
        Orthographic { half_height: params.number("height") * 0.5 }
    }

    pub(super) fn ray(&self, film: &FilmPlace) -> CameraRay {
        let origin = DVec3::new(film.x * self.half_height * film.aspect(), film.y * self.half_height, 0.0);
        CameraRay { origin, direction: DVec3::NEG_Z }
    }

    /// The side of a pixel.
    pub(super) fn pixel_size(&self, film: &FilmPlace) -> f64 {
        2.0 * self.half_height / film.height
    }

    pub(super) fn see(&self, point: DVec3, film: &FilmPlace) -> Option<CameraSight> {
        let density = 1.0 / (self.half_height * self.half_height * film.aspect());
        let from = DVec3::new(point.x, point.y, 0.0);
        (point.z < 0.0).then(|| CameraSight { from, place: self.project(point, film), density })
    }

    pub(super) fn project(&self, point: DVec3, film: &FilmPlace) -> (f64, f64) {
        (point.x / (self.half_height * film.aspect()), point.y / self.half_height)
    }
}
