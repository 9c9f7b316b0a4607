//! # perspective: a pinhole camera
//!
//! Every ray leaves one point, so everything is sharp, and distant things are small.
//!
//! ## Parameters
//!
//! - `fov` (number, degrees, default 40): the full angle that the picture covers along `fov_axis`.
//! - `fov_axis` (`vertical`, `horizontal`, `smaller`; default `vertical`): the side of the picture that `fov` is measured
//!   along; `smaller` is the shorter of the two.
//! - and those of all cameras: `position`, `look_at`, `up`, `transform`, `motion`, `shutter`.
//!
//! ## Example
//!
//! ```toml
//! [cameras.main]
//! type = "perspective"
//! position = [0, 1, 6]
//! look_at = [0, 0.5, 0]
//! fov = 35
//! ```
//!
//! ## Limits
//!
//! The film is flat: towards the edges of a wide view things are stretched, as `1 / cos(angle)`.
//!
//! ## References
//!
//! Foley, van Dam, Feiner & Hughes 1990, "Computer Graphics: Principles and Practice", section 6.1.1 (perspective).

use super::{CameraRay, CameraSight, FilmPlace};
use kirkas_geometry::DVec3;
use kirkas_geometry::elementary::tan;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The words of `fov_axis`.
pub(super) const FOV_AXES: &[&str] = &["vertical", "horizontal", "smaller"];
/// The row `fov`.
pub(super) const FOV: ParamSpec =
    ParamSpec::number("fov", 40.0, "full angle of view along `fov_axis`").unit("degrees").range((0.001, 179.0));
/// The row `fov_axis`.
pub(super) const FOV_AXIS: ParamSpec =
    ParamSpec::choice("fov_axis", FOV_AXES, "the side of the picture that `fov` is measured along");

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Camera,
    name: "perspective",
    doc: "A pinhole camera: everything is sharp.",
    params: &[FOV, FOV_AXIS],
};

#[derive(Clone, Copy, Debug)]
pub(super) struct Perspective {
    /// Half the picture's side along `axis`, at distance 1.
    half_extent: f64,
    axis: Axis,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    Vertical,
    Horizontal,
    Smaller,
}

impl Perspective {
    pub(super) fn compile(params: &Params) -> Self {
        let axis = match params.text("fov_axis") {
            Some("horizontal") => Axis::Horizontal,
            Some("smaller") => Axis::Smaller,
            _ => Axis::Vertical,
        };
        Perspective { half_extent: tan(params.number("fov").to_radians() * 0.5), axis }
    }

    /// From the pinhole at the origin, with `direction.z == -1`.
    pub(super) fn ray(&self, film: &FilmPlace) -> CameraRay {
        let (half_x, half_y) = self.half_sides(film);
        CameraRay { origin: DVec3::ZERO, direction: DVec3::new(film.x * half_x, film.y * half_y, -1.0) }
    }

    /// The square root of the solid angle of a pixel at this place.
    pub(super) fn pixel_angle(&self, film: &FilmPlace) -> f64 {
        let (half_x, half_y) = self.half_sides(film);
        let pixel = (2.0 * half_x / film.width) * (2.0 * half_y / film.height);
        let length2 = 1.0 + film.x * half_x * film.x * half_x + film.y * half_y * film.y * half_y;
        (pixel / (length2 * length2.sqrt())).sqrt()
    }

    pub(super) fn project(&self, point: DVec3, film: &FilmPlace) -> Option<(f64, f64)> {
        let (half_x, half_y) = self.half_sides(film);
        (point.z < 0.0).then(|| (point.x / -point.z / half_x, point.y / -point.z / half_y))
    }

    /// `point` as a pinhole at `from`, a point of the plane z = 0, sees it.
    pub(super) fn see(&self, point: DVec3, from: DVec3, film: &FilmPlace) -> Option<CameraSight> {
        let (half_x, half_y) = self.half_sides(film);
        let depth = -point.z;
        let way = point - from;
        // The picture in the plane at depth 1 has 1 / cos^3 times the angle's size, and the surface cos / r^2 of its own.
        (depth > 0.0).then(|| CameraSight {
            from,
            place: (way.x / depth / half_x, way.y / depth / half_y),
            density: way.length() / (depth * depth * depth * half_x * half_y),
        })
    }

    fn half_sides(&self, film: &FilmPlace) -> (f64, f64) {
        let aspect = film.aspect();
        let is_along_y = match self.axis {
            Axis::Vertical => true,
            Axis::Horizontal => false,
            Axis::Smaller => aspect >= 1.0,
        };
        if is_along_y {
            (self.half_extent * aspect, self.half_extent)
        } else {
            (self.half_extent, self.half_extent / aspect)
        }
    }
}
