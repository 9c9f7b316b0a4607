//! The question itself, through the levels of instances.

use super::{PointHit, PointQuery, PointSearch, PointSpace};
use crate::accel::{Accel, Built};
use crate::scene_geometry::Instance;
use crate::search::Level;
use kirkas_geometry::DAffine3;

impl Accel {
    /// The point of all surfaces that is closest to the query's point, if any is closer than its largest distance. Surfaces
    /// only: from the inside of a sphere as well. User shapes take part when they implement
    /// [`UserShape::closest_point`](crate::UserShape::closest_point). In instances that are stretched unevenly or sheared,
    /// only triangles and quads take part.
    pub fn closest_point(&self, query: &PointQuery) -> Option<PointHit> {
        let point = query.point.as_dvec3();
        let limit = f64::from(query.max_distance);
        if !point.is_finite() || limit.is_nan() {
            return None;
        }
        let mut search = PointSearch { query: *query, point, limit, best: None };
        let space = PointSpace::new(DAffine3::IDENTITY, point);
        self.closest_in_level(&self.world, &self.scene.instances, self.world_level(), &space, &mut search);
        search.best
    }

    fn closest_in_level(
        &self,
        built: &Built,
        instances: &[Instance],
        level: Level,
        space: &PointSpace,
        search: &mut PointSearch,
    ) {
        built.structure.closest_point(level, space, search, &|search, index| {
            let placed = &built.instances[index as usize];
            if placed.mask & search.query.mask == 0 {
                return;
            }
            let outer_from_object = placed.place(&instances[index as usize], search.query.time);
            let inner = PointSpace::new(space.world_from_object * outer_from_object, search.point);
            let (built, held) = (&self.aggregates[placed.aggregate], &self.scene.aggregates[placed.aggregate]);
            let level = self.level(&held.geometries, built, level.instance.then(index));
            self.closest_in_level(built, &held.instances, level, &inner, search);
        });
    }
}
