//! # thin_lens: a camera with an aperture
//!
//! Rays leave all points of a lens and meet again in the plane of focus; what lies before or behind it is blurred, the
//! more so the wider the aperture.
//!
//! ## Parameters
//!
//! - `fov`, `fov_axis`: as for `perspective`.
//! - `aperture_radius` (number, scene units, default 0.05): radius of the lens; 0 makes it a pinhole.
//! - `focus_distance` (number, scene units, default: the distance to `look_at`): from the lens to the plane of focus,
//!   along the axis.
//! - `blades` (whole number, default 0): sides of the aperture, 3 or more; 0 makes it round.
//! - `blade_rotation` (number, degrees, default 0): turns the aperture; at 0 a corner points right.
//! - and those of all cameras: `position`, `look_at`, `up`, `transform`, `motion`, `shutter`.
//!
//! ## Example
//!
//! ```toml
//! [cameras.portrait]
//! type = "thin_lens"
//! position = [0, 1, 6]
//! look_at = [0, 0.5, 0]
//! fov = 35
//! aperture_radius = 0.1
//! blades = 6
//! ```
//!
//! ## Limits
//!
//! An ideal lens: no distortion, no vignetting, the plane of focus is flat and perpendicular to the axis. The aperture of
//! `blades` sides has its corners on the circle of `aperture_radius`, so it lets through less light than a round one would;
//! the picture does not get darker.
//!
//! ## References
//!
//! R. Cook, T. Porter, L. Carpenter: "Distributed Ray Tracing", 1984, <https://doi.org/10.1145/964965.808590>.

use super::perspective::{FOV, FOV_AXIS};
use super::{CameraRay, CameraSight, FilmPlace, Perspective};
use kirkas_geometry::DVec3;
use kirkas_geometry::warp::{square_to_uniform_disk, square_to_uniform_polygon};
use kirkas_scene::spec::{NOT_NEGATIVE, POSITIVE};
use kirkas_scene::{Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Camera,
    name: "thin_lens",
    doc: "A camera with a lens: sharp in one plane, blurred elsewhere.",
    params: &[
        FOV,
        FOV_AXIS,
        ParamSpec::number("aperture_radius", 0.05, "radius of the lens; 0 makes it a pinhole")
            .unit("scene units")
            .range(NOT_NEGATIVE),
        ParamSpec::new(
            "focus_distance",
            ParamType::Number,
            Fallback::Absent,
            "from the lens to the plane of focus; absent: the distance to `look_at`",
        )
        .unit("scene units")
        .range(POSITIVE),
        ParamSpec::integer("blades", 0, (0.0, 1000.0), "sides of the aperture, 3 or more; 0 makes it round"),
        ParamSpec::number("blade_rotation", 0.0, "turns the aperture; at 0 a corner points right").unit("degrees"),
    ],
};

#[derive(Clone, Copy, Debug)]
pub(super) struct ThinLens {
    pinhole: Perspective,
    aperture_radius: f64,
    focus_distance: f64,
    blades: u32,
    blade_rotation: f32,
}

impl ThinLens {
    pub(super) fn compile(params: &Params) -> Result<Self, Diagnostic> {
        let blades = params.integer("blades");
        if matches!(blades, 1 | 2) {
            return Err(Diagnostic::error("bad-camera", format!("an aperture of {blades} sides has no area"))
                .at(params.span("blades"), "too few")
                .help("write 3 or more, or 0 for a round aperture"));
        }
        let [from, to] = ["position", "look_at"].map(|name| DVec3::from_array(params.vector(name)));
        Ok(ThinLens {
            pinhole: Perspective::compile(params),
            aperture_radius: params.number("aperture_radius"),
            focus_distance: params.optional_number("focus_distance").unwrap_or((to - from).length()),
            blades: blades.clamp(0, 1000) as u32,
            blade_rotation: params.number("blade_rotation").to_radians() as f32,
        })
    }

    pub(super) fn ray(&self, film: &FilmPlace, lens: (f32, f32)) -> CameraRay {
        let central = self.pinhole.ray(film);
        if !self.uses_lens() {
            return central;
        }
        let origin = self.lens_point(lens);
        // Divided by the distance, so that huge distances keep their meaning: direction.z stays -1.
        CameraRay { origin, direction: central.direction - origin / self.focus_distance }
    }

    /// As a pinhole's: in the plane of focus it is the same.
    pub(super) fn pixel_angle(&self, film: &FilmPlace) -> f64 {
        self.pinhole.pixel_angle(film)
    }

    /// Where `u` is on the lens.
    fn lens_point(&self, u: (f32, f32)) -> DVec3 {
        let unit = match self.blades {
            0 => square_to_uniform_disk(u),
            sides => square_to_uniform_polygon(u, sides, self.blade_rotation),
        };
        unit.as_dvec2().extend(0.0) * self.aperture_radius
    }

    pub(super) fn see(&self, point: DVec3, film: &FilmPlace, lens: (f32, f32)) -> Option<CameraSight> {
        let from = if self.uses_lens() { self.lens_point(lens) } else { DVec3::ZERO };
        let straight = self.pinhole.see(point, from, film)?;
        // The central ray of the same place meets this one in the plane of focus.
        let shift = self.pinhole.see(from / self.focus_distance - DVec3::Z, DVec3::ZERO, film)?;
        let (a, b) = (straight.place, shift.place);
        Some(CameraSight { place: (a.0 + b.0, a.1 + b.1), ..straight })
    }

    pub(super) fn uses_lens(&self) -> bool {
        self.aperture_radius > 0.0
    }

    /// Through the middle of the lens.
    pub(super) fn project(&self, point: DVec3, film: &FilmPlace) -> Option<(f64, f64)> {
        self.pinhole.project(point, film)
    }
}
