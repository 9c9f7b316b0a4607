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
//! Corners are rounded to f32 (about 7 digits) after the transform. A mirroring transform keeps the side that it faced, although the
//! edges then turn the other way.
//!
//! ## References
//! Intersection: two triangles, Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", 2013.

use super::analytic::degenerate;
use super::triangles::{PlacedMesh, TriangleSurface};
use super::{AreaSample, Detail, Part, ShapeInput, Surface, SurfacePoint};
use crate::lights::Cone;
use crate::textures::SurfacePatch;
use kirkas_geometry::transform::is_invertible;
use kirkas_geometry::{Bounds3, DAffine3, DMat3, DVec3, Ray};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};
use std::sync::Arc;

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
    let m = &input.part_from_object;
    let (corner, edge_u, edge_v) =
        (m.transform_point3(center - u * 0.5 - v * 0.5), m.transform_vector3(u), m.transform_vector3(v));
    let placed = edge_u.cross(edge_v);
    let corners = [corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v].map(|c| c.as_vec3());
    if !(is_invertible(m) && placed.length() > 0.0 && corners.iter().all(|c| c.is_finite())) {
        let name = &input.params.entity.name;
        let what = format!("object `{}` is flat or too large to be computed with", name.text);
        return Err(Diagnostic::error("degenerate-shape", what)
            .at(name.span, "this one")
            .help("make its sizes differ less from each other, and its transform invertible"));
    }

    // Keep the outside outside.
    let is_mirrored = m.matrix3.determinant() < 0.0;
    let triangles = if is_mirrored { vec![[0, 2, 1], [0, 3, 2]] } else { vec![[0, 1, 2], [0, 2, 3]] };
    let mesh = PlacedMesh {
        positions: Arc::new(corners.to_vec()),
        normals: Vec::new(),
        uvs: Vec::new(),
        colors: Vec::new(),
        object_from_part: m.inverse(),
    };
    let (triangles, shape) = TriangleSurface::new(Arc::new(mesh), triangles);
    let normal = placed.normalize() * if is_mirrored { -1.0 } else { 1.0 };
    let (area, object_from_part) = (placed.length(), m.inverse());
    let surface = Rectangle { triangles, is_mirrored, corner, edge_u, edge_v, normal, area, object_from_part };
    Ok(vec![Part { shape, surface: Arc::new(surface), own_material: None }])
}

/// Two triangles for rays, and the exact rectangle for light; in part space.
struct Rectangle {
    triangles: TriangleSurface,
    is_mirrored: bool,
    corner: DVec3,
    edge_u: DVec3,
    edge_v: DVec3,
    /// Outward.
    normal: DVec3,
    area: f64,
    object_from_part: DAffine3,
}

impl Surface for Rectangle {
    fn point(&self, primitive: u32, u: f32, v: f32, t: f32, ray: &Ray, detail: Detail) -> SurfacePoint {
        // The triangles' edges run from the first corner to the others in turn; mirrored the other way round.
        let (first, second) = if self.is_mirrored { (v, u) } else { (u, v) };
        let both = (first + second).min(1.0);
        let uv = if primitive == 0 { [both, second] } else { [first, both] };
        SurfacePoint { uv, tangent: self.edge_u, ..self.triangles.point(primitive, u, v, t, ray, detail) }
    }

    fn patch(&self, _primitive: u32, _u: f32, _v: f32, _point: &SurfacePoint) -> SurfacePatch {
        SurfacePatch { tangents: [self.edge_u, self.edge_v], color: [0.0; 4] }
    }

    fn object_from_part(&self) -> DMat3 {
        self.object_from_part.matrix3
    }

    fn area(&self) -> Option<f64> {
        Some(self.area)
    }

    fn sample_area(&self, u: (f32, f32), detail: Detail) -> Option<AreaSample> {
        let position = self.corner + self.edge_u * f64::from(u.0) + self.edge_v * f64::from(u.1);
        let object_position = match detail {
            Detail::Place => DVec3::ZERO,
            Detail::Texture => self.object_from_part.transform_point3(position),
        };
        Some(AreaSample {
            position,
            normal: self.normal,
            uv: [u.0, u.1],
            object_position,
            part_normal: self.normal,
            color: [0.0; 4],
            pdf_area: 1.0 / self.area,
        })
    }

    fn pane(&self, _primitive: u32) -> u32 {
        0
    }

    fn bounds(&self) -> Bounds3 {
        self.triangles.bounds()
    }

    fn normals(&self) -> Cone {
        Cone::of(self.normal)
    }
}
