//! What a ray finds, who may refuse it, and what the search cost.

use kirkas_geometry::Ray;

/// `Hit::instance` of geometry that stands in the world itself.
pub const NO_INSTANCE: u32 = u32::MAX;

/// Where a ray meets a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in units of the length of the ray's direction; also for hits inside an instance.
    pub t: f32,
    /// Triangles: barycentric weight of vertex 1. Spheres: 0. User shapes: theirs.
    pub u: f32,
    /// Triangles: barycentric weight of vertex 2. Spheres: 0. User shapes: theirs.
    pub v: f32,
    /// Index into `SceneGeometry::instances`, or [`NO_INSTANCE`].
    pub instance: u32,
    /// Index into `SceneGeometry::world`, or into the instance's aggregate.
    pub geometry: u32,
    /// Index of the triangle, sphere or user primitive within its geometry.
    pub primitive: u32,
}

impl Hit {
    /// The order in which hits win: nearest first, then lowest (instance, geometry, primitive).
    #[inline]
    pub(crate) fn beats(&self, other: &Hit) -> bool {
        let ids = |h: &Hit| (h.instance, h.geometry, h.primitive);
        self.t < other.t || (self.t == other.t && ids(self) < ids(other))
    }
}

/// Decides whether a hit counts. Asked only for geometry with `opaque == false`; must be a pure function of its
/// arguments, since how often and in which order it is asked depends on the structure.
pub trait HitFilter: Sync {
    /// `ray_index` is the ray's place in the batch; `ray` is in world space, also for hits inside an instance.
    fn accept(&self, ray_index: usize, ray: &Ray, hit: &Hit) -> bool;
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
