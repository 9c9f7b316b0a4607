//! # triangle
//!
//! One triangle. Both sides are seen; a light shines from the side from which the vertices run counter-clockwise.
//!
//! ## Parameters
//! - `vertices` (three points, scene units, required).
//! - `uvs` (six numbers, default `[0, 0, 1, 0, 0, 1]`): texture coordinates of the three vertices, one after the other.
//!
//! ## Example
//! ```toml
//! [objects.sail]
//! type = "triangle"
//! vertices = [[0, 0, 0], [1, 0, 0], [0, 2, 0]]
//! uvs = [0, 0, 1, 0, 0, 1]
//! ```
//!
//! ## Limits
//! Vertices are rounded to f32 (about 7 digits).
//!
//! ## References
//! Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", 2013.

use super::analytic::degenerate;
use super::mesh::{Normals, Source, build_mesh};
use super::{Part, ShapeInput};
use kirkas_geometry::Vec3;
use kirkas_scene::{Diagnostic, Fallback, Kind, MeshData, ParamSpec, ParamType, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "triangle",
    doc: "One triangle.",
    params: &[
        ParamSpec::new("vertices", ParamType::Vectors, Fallback::Required, "Its three corners.").unit("scene units"),
        ParamSpec::new("uvs", ParamType::Numbers, Fallback::Absent, "Texture coordinates, two per corner."),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let vertices = super::mesh::points(input, "vertices");
    let count = vertices.len();
    if count != 3 {
        return Err(degenerate(input, "vertices", format!("it has {count} of three vertices"), "not three")
            .help("write three points; for more, use a `mesh`"));
    }
    let across = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
    if across.length() == 0.0 {
        return Err(degenerate(input, "vertices", "its vertices lie on one line".into(), "no area")
            .help("move one of the three off the line through the others"));
    }
    let uvs = match super::mesh::numbers(input, "uvs") {
        Some(uvs) if uvs.len() != 6 => {
            return Err(degenerate(input, "uvs", format!("{} texture numbers", uvs.len()), "not six")
                .help("write two numbers for each of the three vertices: `uvs = [0, 0, 1, 0, 0, 1]`"));
        }
        Some(uvs) => uvs,
        None => vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0],
    };
    let data = MeshData {
        positions: vertices.iter().map(|v| v.as_vec3()).collect::<Vec<Vec3>>(),
        uvs: super::mesh::pairs(&uvs),
        triangles: vec![[0, 1, 2]],
        ..MeshData::default()
    };
    build_mesh(Source::Inline { data: Box::new(data), exact: &vertices }, Normals::Flat, input)
}
