//! # cone
//!
//! A cone, or with `top_radius` a truncated one, standing on its base disk and closed unless `caps = false`.
//!
//! ## Parameters
//! - `from` (point, scene units, default `[0, 0, 0]`): centre of the base.
//! - `to` (point, scene units, default `[0, 1, 0]`): the apex, or the centre of the top.
//! - `radius` (above 0, scene units, default 1): of the base.
//! - `top_radius` (0 or more, scene units, default 0): of the top; may exceed `radius`.
//! - `caps` (default `true`): closed by disks; needed for glass.
//!
//! Texture: as for `cylinder`.
//!
//! ## Example
//! ```toml
//! [objects.hat]
//! type = "cone"
//! from = [0, 0, 0]
//! to = [0, 2, 0]
//! radius = 1
//! ```
//!
//! ## Limits
//! The shading normal at the very apex is that of one side. As a light it must not be scaled unevenly.
//!
//! ## References
//! Line against convex quadric, clipped by a slab: Kay & Kajiya, "Ray Tracing Complex Scenes", 1986.

use super::cylinder::place_between;
use super::frustum::Frustum;
use super::{Part, ShapeInput};
use kirkas_scene::spec::{NOT_NEGATIVE, POSITIVE};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "cone",
    doc: "A cone or truncated cone on its base disk.",
    params: &[
        ParamSpec::vector("from", [0.0, 0.0, 0.0], "Centre of the base.").unit("scene units"),
        ParamSpec::vector("to", [0.0, 1.0, 0.0], "The apex, or the centre of the top.").unit("scene units"),
        ParamSpec::number("radius", 1.0, "Radius of the base.").unit("scene units").range(POSITIVE),
        ParamSpec::number("top_radius", 0.0, "Radius of the top.").unit("scene units").range(NOT_NEGATIVE),
        ParamSpec::bool("caps", true, "Closed by a disk at either end."),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let radius = input.params.number("radius");
    let top = input.params.number("top_radius") / radius;
    place_between(input, radius, |height| Frustum { top, height, caps: input.params.bool("caps") })
}
