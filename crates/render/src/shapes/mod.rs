//! Shapes: what rays hit. Each turns its parameters into geometry for the accelerator and a [`Surface`] that says, for a
//! hit, exactly where it is and which way it faces.
//!
//! Contract: everything a shape returns is in *part space*: the space in which the accelerator holds the geometry (the
//! world, or the aggregate that is instanced). The object's own transform is baked in: `part_from_object`.

pub mod r#box;
pub mod cone;
pub mod cylinder;
pub mod disk;
pub mod group;
pub mod instance;
pub mod mesh;
pub mod plane;
pub mod rectangle;
pub mod sphere;
pub mod sphereflake;
pub mod torus;
pub mod triangle;

mod analytic;
mod displace;
mod frustum;
mod polynomial;
mod quadratic;
mod spheres;
mod triangles;

use crate::lights::Cone;
use crate::textures::{SurfacePatch, Textures};
use kirkas_accel as accel;
use kirkas_geometry::{Bounds3, DAffine3, DMat3, DVec3, Ray};
use kirkas_scene::{Assets, Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, SourceId, TypeSpec};
use std::sync::Arc;

/// All shapes: the one list.
pub const SHAPES: &[ShapeType] = &[
    ShapeType { spec: &sphere::SPEC, build: sphere::build },
    ShapeType { spec: &plane::SPEC, build: plane::build },
    ShapeType { spec: &disk::SPEC, build: disk::build },
    ShapeType { spec: &rectangle::SPEC, build: rectangle::build },
    ShapeType { spec: &r#box::SPEC, build: r#box::build },
    ShapeType { spec: &cylinder::SPEC, build: cylinder::build },
    ShapeType { spec: &cone::SPEC, build: cone::build },
    ShapeType { spec: &torus::SPEC, build: torus::build },
    ShapeType { spec: &triangle::SPEC, build: triangle::build },
    ShapeType { spec: &mesh::SPEC, build: mesh::build },
    ShapeType { spec: &sphereflake::SPEC, build: sphereflake::build },
];

/// Objects that hold others; `compile_scene` takes them apart.
pub const GROUP: TypeSpec = group::SPEC;
/// See [`GROUP`].
pub const INSTANCE: TypeSpec = instance::SPEC;

/// What every object takes, shapes, groups and instances alike.
pub const COMMON: &[ParamSpec] = &[
    ParamSpec::new(
        "material",
        ParamType::Reference(Kind::Material),
        Fallback::Absent,
        "What it is made of; absent: as its parent, or the file's own, or grey.",
    ),
    ParamSpec::new("parent", ParamType::Reference(Kind::Object), Fallback::Absent, "The group that it belongs to."),
    ParamSpec::new("transform", ParamType::Transform, Fallback::Absent, "Steps that place it in its parent."),
    ParamSpec::new("motion", ParamType::Motion, Fallback::Absent, "Key frames; they come after `transform`."),
    ParamSpec::bool(
        "visible",
        true,
        "False: the camera does not see it; mirrors show it, and its shadow and light stay.",
    ),
];

/// What a shape is built from.
pub struct ShapeInput<'a> {
    /// Its parameters.
    pub params: Params<'a>,
    /// For meshes.
    pub assets: &'a dyn Assets,
    /// For displacement.
    pub textures: &'a Textures,
    /// The source that paths are relative to.
    pub source: Option<SourceId>,
    /// Object to part space.
    pub part_from_object: DAffine3,
}

/// One piece of geometry with one material.
pub struct Part {
    /// For the accelerator, in part space.
    pub shape: accel::Shape,
    /// For shading.
    pub surface: Arc<dyn Surface>,
    /// The material that the mesh's own file names, if any (an index into `MeshData.materials` by name).
    pub own_material: Option<String>,
}

/// How much is asked of a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Where it is and which way it faces. Nobody looks at texture coordinates and object space: they are left 0.
    Place,
    /// All of it.
    Texture,
}

/// What is known of a surface at a hit, in part space.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// The point, on the surface to f64 rounding (recomputed, not `origin + t direction`).
    pub position: DVec3,
    /// Absolute bound per axis on how far `position` may be from the true surface once stored as f32, and on what the next
    /// ray's intersection test with this surface may get wrong.
    pub error: DVec3,
    /// Unit geometric normal, outward (meshes: by winding, counter-clockwise seen from outside).
    pub normal: DVec3,
    /// Unit shading normal, on the same side as `normal` or interpolated.
    pub shading_normal: DVec3,
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Derivative of position by u: the tangent (any length; zero if unknown).
    pub tangent: DVec3,
    /// The point in object space: where solid textures look.
    pub object_position: DVec3,
}

/// A point chosen on a surface, in part space.
#[derive(Clone, Copy, Debug)]
pub struct AreaSample {
    /// The point.
    pub position: DVec3,
    /// Unit outward normal.
    pub normal: DVec3,
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// The point in object space: where solid textures look.
    pub object_position: DVec3,
    /// The normal in part space, also once the sample has been placed in the world.
    pub part_normal: DVec3,
    /// Colour of the mesh's vertices, linear, and 1; zeros where it has none.
    pub color: [f32; 4],
    /// Density per area of part space (1 / scene unit squared).
    pub pdf_area: f64,
}

/// A flat piece of a surface, in part space.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// Around it.
    pub bounds: Bounds3,
    /// Unit outward normal; any where it has no area.
    pub normal: DVec3,
    /// Area.
    pub area: f64,
}

/// Answers shading's questions about one part.
pub trait Surface: Send + Sync {
    /// The surface at a hit. `ray` is in part space.
    fn point(&self, primitive: u32, u: f32, v: f32, t: f32, ray: &Ray, detail: Detail) -> SurfacePoint;

    /// Total area in part space; `None` if it cannot be a light (infinite or not samplable).
    fn area(&self) -> Option<f64>;

    /// A point, uniform by area, for a light. `u` in the unit square.
    fn sample_area(&self, u: (f32, f32), detail: Detail) -> Option<AreaSample>;

    /// Flat facets, by number as hits name their primitives, that can be sampled one by one; 0 where there are none.
    fn facet_count(&self) -> u32 {
        0
    }

    /// One of them.
    fn facet(&self, _facet: u32) -> Facet {
        Facet { bounds: self.bounds(), normal: DVec3::ZERO, area: 0.0 }
    }

    /// A point of it, uniform by area.
    fn sample_facet(&self, _facet: u32, _u: (f32, f32), _detail: Detail) -> Option<AreaSample> {
        None
    }

    /// A point as seen from `from`, with its density per solid angle there; `None` where the shape has nothing better
    /// than [`Surface::sample_area`] (or `from` is inside).
    fn sample_toward(&self, _from: DVec3, _u: (f32, f32), _detail: Detail) -> Option<(AreaSample, f64)> {
        None
    }

    /// The density per solid angle of [`Surface::sample_toward`] from `from`, uniform over the points that face `from`, which
    /// are all it covers; `None` as there.
    fn pdf_toward(&self, _from: DVec3) -> Option<f64> {
        None
    }

    /// The number of what is there or not as a whole where it is partly opaque: a facet, or several in one plane.
    fn pane(&self, primitive: u32) -> u32 {
        primitive
    }

    /// The surface around a hit at `point`, for textures that are filtered or that look at more than the point.
    fn patch(&self, primitive: u32, u: f32, v: f32, point: &SurfacePoint) -> SurfacePatch;

    /// From part space to the object's, for directions.
    fn object_from_part(&self) -> DMat3;

    /// Mean curvature at a hit (1 / radius of a sphere), positive where the surface bulges along its normal; 0 if unknown.
    fn curvature(&self, _primitive: u32, _u: f32, _v: f32) -> f64 {
        0.0
    }

    /// A box around all of it, in part space.
    fn bounds(&self) -> Bounds3;

    /// A cone that holds all its normals, in part space.
    fn normals(&self) -> Cone {
        Cone::ALL
    }
}

/// One entry of the list of shapes.
pub struct ShapeType {
    /// Its table.
    pub spec: &'static TypeSpec,
    /// Builds it.
    pub build: fn(&ShapeInput) -> Result<Vec<Part>, Diagnostic>,
}
