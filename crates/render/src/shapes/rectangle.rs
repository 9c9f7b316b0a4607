//! # rectangle
//!
//! A flat rectangle (or parallelogram) about its centre. Both sides are seen; a light shines from the side of
//! `edge_u x edge_v`.
//!
//! ## Parameters
//! - `center` (point, scene units, default `[0, 0, 0]`).
//! - `edge_u` (vector, scene units, default `[1, 0, 0]`): one whole edge.
//! - `edge_v` (vector, scene units, default `[0, 1, 0]`): the other; the rectangle faces `edge_u x edge_v`.
//!
//! Texture: `u` runs from 0 to 1 along `edge_u`, `v` along `edge_v`.
//!
//! ## Example
//! ```toml
//! [objects.picture]
//! type = "rectangle"
//! center = [0, 1, -2]
//! edge_u = [1.6, 0, 0]
//! edge_v = [0, 0.9, 0]
//! ```
//!
//! ## Limits
//! A mirroring transform keeps the side that it faced, although the edges then turn the other way.
//!
//! ## References
//! None needed.

use super::analytic::{Canonical, Crossings, Local, degenerate, place};
use super::{Part, ShapeInput};
use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "rectangle",
    doc: "A flat rectangle or parallelogram.",
    params: &[
        ParamSpec::vector("center", [0.0; 3], "Its centre.").unit("scene units"),
        ParamSpec::vector("edge_u", [1.0, 0.0, 0.0], "One whole edge.").unit("scene units"),
        ParamSpec::vector("edge_v", [0.0, 1.0, 0.0], "The other; it faces `edge_u x edge_v`.").unit("scene units"),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let center = DVec3::from_array(input.params.vector("center"));
    let u = DVec3::from_array(input.params.vector("edge_u"));
    let v = DVec3::from_array(input.params.vector("edge_v"));
    for (name, edge) in [("edge_u", u), ("edge_v", v)] {
        if edge == DVec3::ZERO {
            return Err(degenerate(input, name, format!("`{name}` is zero"), "has no length")
                .help("write the whole edge, such as `edge_u = [2, 0, 0]`"));
        }
    }
    let across = u.cross(v);
    if !(across.length() > 1e-12 * u.length() * v.length()) {
        return Err(degenerate(input, "edge_v", "`edge_u` and `edge_v` are parallel".into(), "parallel to `edge_u`")
            .help("turn one of the edges; a right angle between them makes a rectangle"));
    }
    // As long as the edges, so that the map is well conditioned.
    let normal = across / across.length().sqrt();
    let object_from_canonical =
        DAffine3 { matrix3: DMat3::from_cols(u, v, normal), translation: center - u * 0.5 - v * 0.5 };
    place(Rectangle, object_from_canonical, input)
}

/// Canonical: the unit square from the origin in the plane z = 0, facing +z.
struct Rectangle;

impl Canonical for Rectangle {
    const FLAT: bool = true;

    fn support(&self, n: DVec3) -> f64 {
        n.x.max(0.0) + n.y.max(0.0)
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        if d.z != 0.0 {
            let t = -o.z / d.z;
            let (x, y) = (o.x + t * d.x, o.y + t * d.y);
            if (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y) {
                found.push(t, 0);
            }
        }
        found
    }

    fn project(&self, p: DVec3, _face: u8) -> DVec3 {
        DVec3::new(p.x.clamp(0.0, 1.0), p.y.clamp(0.0, 1.0), 0.0)
    }

    fn local(&self, p: DVec3, _face: u8) -> Local {
        Local { normal: DVec3::Z, uv: [p.x, p.y], tangent: DVec3::X }
    }

    fn area(&self, m: &DMat3) -> Option<f64> {
        Some(m.x_axis.cross(m.y_axis).length())
    }

    fn sample(&self, _m: &DMat3, u: (f64, f64)) -> (DVec3, u8) {
        (DVec3::new(u.0, u.1, 0.0), 0)
    }
}
