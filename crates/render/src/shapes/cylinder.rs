//! # cylinder
//!
//! A round rod between two points, closed by a disk at either end unless `caps = false`.
//!
//! ## Parameters
//! - `from` (point, scene units, default `[0, -1, 0]`): centre of one end.
//! - `to` (point, scene units, default `[0, 1, 0]`): centre of the other end.
//! - `radius` (above 0, scene units, default 1).
//! - `caps` (default `true`): closed by two disks; needed for glass.
//!
//! Texture: `u` runs once around, counter-clockwise about `from -> to`; `v` runs from 0 at `from` to 1 at `to`. On a cap both
//! run from 0 to 1 across the disk.
//!
//! ## Example
//! ```toml
//! [objects.pillar]
//! type = "cylinder"
//! from = [0, 0, 0]
//! to = [0, 3, 0]
//! radius = 0.5
//! ```
//!
//! ## Limits
//! As a light it must not be scaled unevenly.
//!
//! ## References
//! Line against convex quadric, clipped by a slab: Kay & Kajiya, "Ray Tracing Complex Scenes", 1986.

use super::analytic::{degenerate, frame_around, place};
use super::frustum::Frustum;
use super::{Part, ShapeInput};
use kirkas_geometry::{DAffine3, DVec3};
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "cylinder",
    doc: "A round rod between two points.",
    params: &[
        ParamSpec::vector("from", [0.0, -1.0, 0.0], "Centre of one end.").unit("scene units"),
        ParamSpec::vector("to", [0.0, 1.0, 0.0], "Centre of the other end.").unit("scene units"),
        ParamSpec::number("radius", 1.0, "Radius.").unit("scene units").range(POSITIVE),
        ParamSpec::bool("caps", true, "Closed by a disk at either end."),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let radius = input.params.number("radius");
    place_between(input, radius, |height| Frustum { top: 1.0, height, caps: input.params.bool("caps") })
}

/// Places a frustum, made from its height in base radii, between the points `from` and `to`.
pub(super) fn place_between(
    input: &ShapeInput,
    radius: f64,
    frustum: impl Fn(f64) -> Frustum,
) -> Result<Vec<Part>, Diagnostic> {
    let from = DVec3::from_array(input.params.vector("from"));
    let to = DVec3::from_array(input.params.vector("to"));
    let length = (to - from).length();
    let Some(axis) = (to - from).try_normalize().filter(|_| length > 0.0) else {
        return Err(degenerate(input, "to", "`from` and `to` are the same point".into(), "same as `from`")
            .help("move `to` away from `from`; their distance is the height"));
    };
    let object_from_canonical = DAffine3 { matrix3: frame_around(axis) * radius, translation: from };
    place(frustum(length / radius), object_from_canonical, input)
}
