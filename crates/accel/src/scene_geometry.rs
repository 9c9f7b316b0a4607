//! What there is to hit: shapes, geometries, aggregates of them, and instances of aggregates.

use crate::closest::SurfacePoint;
use kirkas_geometry::{AnimatedTransform, Bounds3, DVec3, Ray, Vec3};
use std::sync::Arc;

/// A ball's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its center.
    pub center: Vec3,
    /// Its radius, 0 or more.
    pub radius: f32,
}

/// A flat disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Its center.
    pub center: Vec3,
    /// Across it, of any length but 0.
    pub normal: Vec3,
    /// Its radius, 0 or more.
    pub radius: f32,
}

/// The lateral surface of a cylinder, open at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The middles of its ends.
    pub ends: [Vec3; 2],
    /// Its radius, 0 or more.
    pub radius: f32,
}

/// A point of a curve, with the curve's thickness there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Where it is.
    pub position: Vec3,
    /// Half the thickness, 0 or more.
    pub radius: f32,
}

impl CurvePoint {
    /// The ball that the curve fills at this point.
    pub(crate) fn ball(&self) -> Sphere {
        Sphere { center: self.position, radius: self.radius }
    }
}

/// Primitives of one type. What `u` and `v` of a hit mean stands at the head of each type's module.
#[derive(Clone)]
pub enum Shape {
    /// Triangles over shared vertices. Two-sided; those without area are never hit.
    Triangles {
        /// The vertices.
        positions: Arc<Vec<Vec3>>,
        /// Three vertices per triangle.
        indices: Arc<Vec<[u32; 3]>>,
    },
    /// Triangles whose vertices move. They are those of [`Shape::Triangles`] at each moment.
    MovingTriangles {
        /// The vertices at two or more keys, which divide the scene's shutter evenly, the first when it opens and the last
        /// when it closes. In between they move on straight lines.
        keys: Arc<Vec<Vec<Vec3>>>,
        /// Three vertices per triangle.
        indices: Arc<Vec<[u32; 3]>>,
    },
    /// Quads over shared vertices, each two triangles: see [`crate::quad`]. Two-sided.
    Quads {
        /// The vertices.
        positions: Arc<Vec<Vec3>>,
        /// Four vertices per quad, in order around it.
        indices: Arc<Vec<[u32; 4]>>,
    },
    /// Disks. Two-sided: see [`crate::disk`].
    Disks(Arc<Vec<Disk>>),
    /// Open cylinders. Hit from outside and from inside: see [`crate::cylinder`].
    Cylinders(Arc<Vec<Cylinder>>),
    /// Round curves of straight segments: see [`crate::curve`].
    Curves {
        /// The points of all curves.
        points: Arc<Vec<CurvePoint>>,
        /// For each segment its first point; its second is the one after.
        segments: Arc<Vec<u32>>,
    },
    /// Spheres. Hit from outside and from inside.
    Spheres(Arc<Vec<Sphere>>),
    /// Anything that can bound itself and be asked for its crossings.
    User(Arc<dyn UserShape>),
}

impl Shape {
    /// Number of primitives.
    pub fn len(&self) -> usize {
        match self {
            Shape::Triangles { indices, .. } | Shape::MovingTriangles { indices, .. } => indices.len(),
            Shape::Quads { indices, .. } => indices.len(),
            Shape::Disks(disks) => disks.len(),
            Shape::Cylinders(cylinders) => cylinders.len(),
            Shape::Curves { segments, .. } => segments.len(),
            Shape::Spheres(spheres) => spheres.len(),
            Shape::User(user) => user.len(),
        }
    }

    /// True without primitives.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Shapes that this crate does not know: analytic ones, with f64 inside. All methods are pure functions.
pub trait UserShape: Send + Sync {
    /// Number of primitives.
    fn len(&self) -> usize;

    /// True without primitives.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A box that holds the primitive. It may be unbounded (an infinite plane); such primitives are tested by every ray.
    fn bounds(&self, primitive: u32) -> Bounds3;

    /// Calls `visit(t, u, v)` for the crossings with `ray.t_min < t < ray.t_max`, in increasing `t`, until it returns true
    /// ("taken"). The ray is in the space of the shape, its direction of any length.
    fn intersect(&self, primitive: u32, ray: &Ray, visit: &mut dyn FnMut(f32, f32, f32) -> bool);

    /// The point of the primitive's surface that is closest to `point`, both in the space of the shape. `None`, unless
    /// implemented: the shape then takes no part in [`Accel::closest_point`](crate::Accel::closest_point).
    fn closest_point(&self, _primitive: u32, _point: DVec3) -> Option<SurfacePoint> {
        None
    }
}

/// A shape with its visibility.
#[derive(Clone)]
pub struct Geometry {
    /// The primitives.
    pub shape: Shape,
    /// True when every hit counts; false when a `HitFilter` is to be asked.
    pub opaque: bool,
    /// Seen by rays with `ray.mask & mask != 0`.
    pub mask: u32,
}

/// What can be placed as a whole, as often as wanted: geometry, and instances of other aggregates.
#[derive(Clone, Default)]
pub struct Aggregate {
    /// Geometry that stands in the aggregate itself.
    pub geometries: Vec<Geometry>,
    /// The places of other aggregates within this one. No aggregate may hold itself, and instances stand in instances at
    /// most [`MAX_NESTING`](crate::MAX_NESTING) deep.
    pub instances: Vec<Instance>,
}

impl From<Vec<Geometry>> for Aggregate {
    fn from(geometries: Vec<Geometry>) -> Self {
        Aggregate { geometries, instances: Vec::new() }
    }
}

/// An aggregate, placed into the world or into another aggregate.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Index into `SceneGeometry::aggregates`.
    pub aggregate: usize,
    /// Where it stands in the world, or in the aggregate that holds it, as a function of time.
    pub outer_from_object: AnimatedTransform,
    /// Seen by rays with `ray.mask & mask != 0`, where the masks of the geometry and of all instances around agree.
    pub mask: u32,
}

/// All that rays may meet.
#[derive(Clone, Default)]
pub struct SceneGeometry {
    /// Geometry that stands in the world itself.
    pub world: Vec<Geometry>,
    /// What is to be placed; each aggregate gets one tree, however often it is placed.
    pub aggregates: Vec<Aggregate>,
    /// The places of aggregates in the world.
    pub instances: Vec<Instance>,
    /// The times that rays may carry, in seconds; other times are clamped into it.
    pub shutter: (f64, f64),
}
