//! What a question about rays leaves out: filters and excluded primitives.

use crate::hit::{Hit, PrimitiveId};
use kirkas_geometry::Ray;

/// Which hits count, beyond the masks. `Query::ALL` leaves out nothing.
#[derive(Clone, Copy, Default)]
pub struct Query<'a> {
    /// Asked about every hit on geometry with `opaque == false`.
    pub filter: Option<&'a dyn HitFilter>,
    /// At the index of a ray: the primitive that it does not see, such as the one that it starts on. Rays beyond the end of
    /// the slice see everything.
    pub excluded: &'a [Option<PrimitiveId>],
}

impl<'a> Query<'a> {
    /// Every hit counts.
    pub const ALL: Query<'static> = Query { filter: None, excluded: &[] };

    /// Hits on what is not opaque count when the filter accepts them.
    pub fn filtered(filter: &'a dyn HitFilter) -> Self {
        Query { filter: Some(filter), excluded: &[] }
    }

    /// The same question, leaving out one primitive for each ray.
    pub fn excluding(self, excluded: &'a [Option<PrimitiveId>]) -> Self {
        Query { excluded, ..self }
    }
}

/// Decides whether a hit counts. Asked only for geometry with `opaque == false`; must be a pure function of its
/// arguments, since how often and in which order it is asked depends on the structure.
pub trait HitFilter: Sync {
    /// `ray_index` is the ray's place in the batch; `ray` is in world space, also for hits inside an instance.
    fn accept(&self, ray_index: usize, ray: &Ray, hit: &Hit) -> bool;
}
