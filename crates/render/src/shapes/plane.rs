//! # plane
//!
//! An endless plane through a point.
//!
//! ## Parameters
//! - `point` (point, scene units, default `[0, 0, 0]`): any point of it.
//! - `normal` (direction, default `[0, 1, 0]`): the way it faces; any length but 0.
//!
//! Texture: `u` and `v` are distances from `point` in scene units; a level floor has `u` along x and `v` along -z.
//!
//! ## Example
//! ```toml
//! [objects.floor]
//! type = "plane"
//! point = [0, -1, 0]
//! normal = [0, 1, 0]
//! ```
//!
//! ## Limits
//! It has no area, so it cannot be a light that is sampled; each ray tests each plane. A `rectangle` costs less.
//!
//! ## References
//! None needed.

use super::analytic::{Canonical, Crossings, Local, frame_around, place, unit_vector};
use super::{Part, ShapeInput};
use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "plane",
    doc: "An endless plane.",
    params: &[
        ParamSpec::vector("point", [0.0; 3], "Any point of it.").unit("scene units"),
        ParamSpec::vector("normal", [0.0, 1.0, 0.0], "The way it faces."),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let normal = unit_vector(input, "normal")?;
    let point = DVec3::from_array(input.params.vector("point"));
    place(Plane, DAffine3 { matrix3: frame_around(normal), translation: point }, input)
}

/// Canonical: the plane z = 0, facing +z.
struct Plane;

impl Canonical for Plane {
    const FLAT: bool = true;

    fn support(&self, _n: DVec3) -> f64 {
        f64::INFINITY
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        if d.z != 0.0 {
            found.push(-o.z / d.z, 0);
        }
        found
    }

    fn project(&self, p: DVec3, _face: u8) -> DVec3 {
        DVec3::new(p.x, p.y, 0.0)
    }

    fn local(&self, p: DVec3, _face: u8) -> Local {
        Local { normal: DVec3::Z, uv: [p.x, p.y], tangent: DVec3::X }
    }

    fn bitangent(&self, _p: DVec3, _face: u8) -> DVec3 {
        DVec3::Y
    }

    fn area(&self, _m: &DMat3) -> Option<f64> {
        None
    }

    fn sample(&self, _m: &DMat3, _u: (f64, f64)) -> (DVec3, u8) {
        (DVec3::ZERO, 0)
    }
}
