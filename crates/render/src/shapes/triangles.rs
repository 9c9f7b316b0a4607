//! The surface of triangles over shared vertices, in part space.

use super::analytic::flat_error;
use super::{AreaSample, Detail, Facet, Part, Surface, SurfacePoint};
use crate::lights::Cone;
use crate::textures::SurfacePatch;
use kirkas_accel::Shape;
use kirkas_geometry::warp::square_to_uniform_triangle;
use kirkas_geometry::{Bounds3, DAffine3, DMat3, DVec2, DVec3, Ray, Vec2, Vec3};
use std::sync::{Arc, OnceLock};

/// Some triangles of a mesh: those with one material.
pub struct TriangleSurface {
    mesh: Arc<PlacedMesh>,
    indices: Arc<Vec<[u32; 3]>>,
    bounds: Bounds3,
    /// Area of the first, of the first two, ...
    cumulative_area: OnceLock<Vec<f64>>,
}

/// What all parts of a mesh share, in part space.
pub struct PlacedMesh {
    /// Corners.
    pub positions: Arc<Vec<Vec3>>,
    /// Shading normals, one per position (zero where unknown), or empty: flat.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one per position, or empty: each triangle its own barycentric ones.
    pub uvs: Vec<Vec2>,
    /// Linear colours, one per position, or empty.
    pub colors: Vec<Vec3>,
    /// For solid textures.
    pub object_from_part: DAffine3,
}

impl TriangleSurface {
    /// The part that these triangles make.
    pub fn part(mesh: Arc<PlacedMesh>, indices: Vec<[u32; 3]>, own_material: Option<String>) -> Part {
        let (surface, shape) = Self::new(mesh, indices);
        Part { shape, surface: Arc::new(surface), own_material }
    }

    /// The surface of these triangles, and what the accelerator holds.
    pub fn new(mesh: Arc<PlacedMesh>, indices: Vec<[u32; 3]>) -> (Self, Shape) {
        let indices = Arc::new(indices);
        let corner = |&i: &u32| mesh.positions[i as usize];
        let bounds = Bounds3::around(indices.iter().flatten().map(corner));
        let shape = Shape::Triangles { positions: mesh.positions.clone(), indices: indices.clone() };
        (TriangleSurface { mesh, indices, bounds, cumulative_area: OnceLock::new() }, shape)
    }

    fn corners(&self, primitive: u32) -> [DVec3; 3] {
        self.indices[primitive as usize].map(|i| self.mesh.positions[i as usize].as_dvec3())
    }

    fn uvs(&self, primitive: u32) -> [DVec2; 3] {
        if self.mesh.uvs.is_empty() {
            return [DVec2::ZERO, DVec2::X, DVec2::Y];
        }
        self.indices[primitive as usize].map(|i| self.mesh.uvs[i as usize].as_dvec2())
    }

    /// Derivative of position by the first texture coordinate.
    fn tangent(&self, corners: [DVec3; 3], uvs: [DVec2; 3]) -> DVec3 {
        // Its own barycentric coordinates grow along the first edge.
        if self.mesh.uvs.is_empty() { corners[1] - corners[0] } else { tangent(corners, uvs) }
    }

    fn shading_normal(&self, primitive: u32, weights: [f64; 3], normal: DVec3) -> DVec3 {
        if self.mesh.normals.is_empty() {
            return normal;
        }
        let n = self.indices[primitive as usize].map(|i| self.mesh.normals[i as usize].as_dvec3());
        // Files whose normals point inward where their winding says outward are common: the winding wins.
        let sign = if (n[0] + n[1] + n[2]).dot(normal) < 0.0 { -1.0 } else { 1.0 };
        (mix(n, weights) * sign).try_normalize().unwrap_or(normal)
    }

    fn object_position(&self, position: DVec3, detail: Detail) -> DVec3 {
        match detail {
            Detail::Place => DVec3::ZERO,
            Detail::Texture => self.mesh.object_from_part.transform_point3(position),
        }
    }

    fn color(&self, primitive: u32, weights: [f64; 3]) -> [f32; 4] {
        if self.mesh.colors.is_empty() {
            return [0.0; 4];
        }
        let c = self.indices[primitive as usize].map(|i| self.mesh.colors[i as usize].as_dvec3());
        mix(c, weights).as_vec3().extend(1.0).to_array()
    }

    fn cumulative_area(&self) -> &[f64] {
        self.cumulative_area.get_or_init(|| {
            let mut sum = 0.0;
            (0..self.indices.len() as u32).map(|i| (sum += area(self.corners(i)), sum).1).collect()
        })
    }
}

/// Weighted sum of three points.
fn mix(p: [DVec3; 3], w: [f64; 3]) -> DVec3 {
    p[0] * w[0] + p[1] * w[1] + p[2] * w[2]
}

fn uv(uvs: [DVec2; 3], w: [f64; 3]) -> [f32; 2] {
    (uvs[0] * w[0] + uvs[1] * w[1] + uvs[2] * w[2]).as_vec2().to_array()
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Unit normal by winding; any for a triangle without area, which no ray hits.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).try_normalize().unwrap_or_else(|| {
        // Sizes below 1e-150 and above 1e150 cannot occur in f32, but their squares' product may still vanish.
        let (e1, e2) = (b - a, c - a);
        let large = e1.abs().max(e2.abs()).max_element();
        (e1 / large).cross(e2 / large).try_normalize().unwrap_or(DVec3::Z)
    })
}

/// Derivative of position by `uv[0]` (zero where the texture coordinates say nothing).
fn tangent(p: [DVec3; 3], uv: [DVec2; 3]) -> DVec3 {
    tangents(p, uv)[0]
}

/// Derivatives of position by both texture coordinates.
#[inline(always)]
fn tangents(p: [DVec3; 3], uv: [DVec2; 3]) -> [DVec3; 2] {
    let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
    let (d1, d2) = (uv[1] - uv[0], uv[2] - uv[0]);
    let determinant = d1.x * d2.y - d1.y * d2.x;
    let finite = |t: DVec3| if t.is_finite() { t } else { DVec3::ZERO };
    [finite((e1 * d2.y - e2 * d1.y) / determinant), finite((e2 * d1.x - e1 * d2.x) / determinant)]
}

impl Surface for TriangleSurface {
    fn point(&self, primitive: u32, u: f32, v: f32, _t: f32, _ray: &Ray, detail: Detail) -> SurfacePoint {
        let (u, v) = (f64::from(u), f64::from(v));
        let weights = [1.0 - u - v, u, v];
        let (corners, uvs) = (self.corners(primitive), self.uvs(primitive));
        let position = mix(corners, weights);
        let normal = normal(corners);
        // The second term: the position's own roundings and those of the plane test, both in f64.
        let largest = corners[0].abs().max(corners[1].abs()).max(corners[2].abs()).max_element();
        SurfacePoint {
            position,
            error: flat_error(position) + 1e-14 * largest,
            normal,
            shading_normal: self.shading_normal(primitive, weights, normal),
            uv: if detail == Detail::Texture { uv(uvs, weights) } else { [0.0; 2] },
            tangent: self.tangent(corners, uvs),
            object_position: self.object_position(position, detail),
        }
    }

    fn patch(&self, primitive: u32, u: f32, v: f32, _point: &SurfacePoint) -> SurfacePatch {
        let (u, v) = (f64::from(u), f64::from(v));
        let tangents = tangents(self.corners(primitive), self.uvs(primitive));
        SurfacePatch { tangents, color: self.color(primitive, [1.0 - u - v, u, v]) }
    }

    fn object_from_part(&self) -> DMat3 {
        self.mesh.object_from_part.matrix3
    }

    /// By how much the normals of the corners turn along the edges.
    fn curvature(&self, primitive: u32, _u: f32, _v: f32) -> f64 {
        if self.mesh.normals.is_empty() {
            return 0.0;
        }
        let (p, normal) = (self.corners(primitive), normal(self.corners(primitive)));
        let n = self.indices[primitive as usize].map(|i| self.mesh.normals[i as usize].as_dvec3());
        let turn = |i: usize, j: usize| (n[j] - n[i]).dot(p[j] - p[i]) / (p[j] - p[i]).length_squared();
        let mean = (turn(0, 1) + turn(1, 2) + turn(2, 0)) / 3.0;
        let sign = if (n[0] + n[1] + n[2]).dot(normal) < 0.0 { -1.0 } else { 1.0 };
        if mean.is_finite() { mean * sign } else { 0.0 }
    }

    fn area(&self) -> Option<f64> {
        self.cumulative_area().last().copied().filter(|a| *a > 0.0 && a.is_finite())
    }

    fn sample_area(&self, u: (f32, f32), detail: Detail) -> Option<AreaSample> {
        let total = self.area()?;
        let areas = self.cumulative_area();
        let target = f64::from(u.0) * total;
        let i = areas.partition_point(|&a| a <= target).min(areas.len() - 1);
        let before = if i == 0 { 0.0 } else { areas[i - 1] };
        let rest = ((target - before) / (areas[i] - before)).clamp(0.0, 1.0);
        let s = self.sample_facet(i as u32, (rest as f32, u.1), detail)?;
        Some(AreaSample { pdf_area: 1.0 / total, ..s })
    }

    fn facet_count(&self) -> u32 {
        self.indices.len() as u32
    }

    fn facet(&self, facet: u32) -> Facet {
        let corners = self.corners(facet);
        let bounds = Bounds3::around(corners.iter().map(|c| c.as_vec3()));
        Facet { bounds, normal: normal(corners), area: area(corners) }
    }

    fn sample_facet(&self, facet: u32, u: (f32, f32), detail: Detail) -> Option<AreaSample> {
        let (b1, b2) = square_to_uniform_triangle(u);
        let (b1, b2) = (f64::from(b1), f64::from(b2));
        let weights = [1.0 - b1 - b2, b1, b2];
        let corners = self.corners(facet);
        let position = mix(corners, weights);
        let normal = normal(corners);
        Some(AreaSample {
            position,
            normal,
            uv: if detail == Detail::Texture { uv(self.uvs(facet), weights) } else { [0.0; 2] },
            object_position: self.object_position(position, detail),
            part_normal: normal,
            color: match detail {
                Detail::Place => [0.0; 4],
                Detail::Texture => self.color(facet, weights),
            },
            pdf_area: 1.0 / area(corners),
        })
    }

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn normals(&self) -> Cone {
        Cone::around((0..self.indices.len() as u32).map(|i| normal(self.corners(i))))
    }
}
