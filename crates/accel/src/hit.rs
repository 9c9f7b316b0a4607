//! What a ray finds, and what the search cost.

use crate::path::InstancePath;

/// Where a ray meets a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in units of the length of the ray's direction; also for hits inside an instance.
    pub t: f32,
    /// Triangles: barycentric weight of vertex 1. Spheres: 0. User shapes: theirs. Others: see the heads of their modules.
    pub u: f32,
    /// Triangles: barycentric weight of vertex 2. Spheres: 0. User shapes: theirs. Others: see there.
    pub v: f32,
    /// The instances around the primitive, outermost first; [`InstancePath::WORLD`] for geometry of the world itself.
    pub instance: InstancePath,
    /// Index into `SceneGeometry::world`, or into the innermost instance's aggregate.
    pub geometry: u32,
    /// Index within its geometry.
    pub primitive: u32,
}

/// A primitive, as a hit names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimitiveId {
    /// `Hit::instance`.
    pub instance: InstancePath,
    /// `Hit::geometry`.
    pub geometry: u32,
    /// `Hit::primitive`.
    pub primitive: u32,
}

impl Hit {
    /// What was hit.
    #[inline]
    pub fn id(&self) -> PrimitiveId {
        PrimitiveId { instance: self.instance, geometry: self.geometry, primitive: self.primitive }
    }

    /// The order in which hits win: nearest first, then lowest (instance, geometry, primitive).
    #[inline]
    pub(crate) fn beats(&self, other: &Hit) -> bool {
        self.t < other.t || (self.t == other.t && self.id() < other.id())
    }
}

/// What searches cost, always counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Rays searched for.
    pub rays: u64,
    /// Inner nodes of which the children's boxes were tested.
    pub nodes_visited: u64,
    /// Primitives (triangles, spheres, user shapes) tested.
    pub primitives_tested: u64,
}

impl core::ops::AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.nodes_visited += other.nodes_visited;
        self.primitives_tested += other.primitives_tested;
    }
}
