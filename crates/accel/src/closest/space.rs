//! The space of a level, as a search for the closest point sees it.

use crate::scene_geometry::Sphere;
use kirkas_geometry::{Bounds3, DAffine3, DVec3};

/// Where a level stands in the world, and the point within it.
pub(crate) struct PointSpace {
    pub world_from_object: DAffine3,
    /// True for the world itself.
    is_identity: bool,
    /// The point in world space, and in object space.
    pub point_in_world: DVec3,
    pub point: DVec3,
    /// True when lengths in all directions are stretched alike, so that what is closest here is closest in the world.
    pub is_similar: bool,
    /// A distance here is at least this much in the world.
    least_stretch: f64,
    /// And at most this much.
    most_stretch: f64,
    /// Largest coordinate of what the world adds.
    size: f64,
}

impl PointSpace {
    pub fn new(world_from_object: DAffine3, point_in_world: DVec3) -> Self {
        let m = &world_from_object.matrix3;
        let object_from_world = world_from_object.inverse();
        let norm = |m: &kirkas_geometry::DMat3| {
            (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
        };
        let (x, y, z) = (m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
        let skew = m.x_axis.dot(m.y_axis).abs().max(m.y_axis.dot(m.z_axis).abs()).max(m.z_axis.dot(m.x_axis).abs());
        let is_similar = (x - y).abs() <= 1e-9 * x && (x - z).abs() <= 1e-9 * x && skew <= 1e-9 * x * x;
        PointSpace {
            point: object_from_world.transform_point3(point_in_world),
            is_similar,
            least_stretch: if is_similar { x * (1.0 - 1e-8) } else { 1.0 / norm(&object_from_world.matrix3) },
            most_stretch: norm(m),
            size: world_from_object.translation.abs().max_element() + point_in_world.abs().max_element(),
            is_identity: world_from_object == DAffine3::IDENTITY,
            world_from_object,
            point_in_world,
        }
    }

    /// A point of the level in world space.
    #[inline]
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        if self.is_identity { point } else { self.world_from_object.transform_point3(point) }
    }

    /// As [`PointSpace::box_distance`] for what a ball holds.
    #[inline]
    pub fn ball_distance(&self, ball: &Sphere) -> f64 {
        let (center, radius) = (ball.center.as_dvec3(), f64::from(ball.radius));
        let off = ((center - self.point).length() - radius).max(0.0);
        let size = center.abs().max_element() + radius + self.point.abs().max_element();
        off * self.least_stretch * (1.0 - 1e-12) - 1e-12 * (self.size + self.most_stretch * size)
    }

    /// No more than the world distance to anything in the box, as `PointSearch::consider` computes it.
    #[inline]
    pub fn box_distance(&self, bounds: &Bounds3) -> f64 {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let off = (min - self.point).max(self.point - max).max(DVec3::ZERO);
        let size = min.abs().max(max.abs()).max_element() + self.point.abs().max_element();
        off.length() * self.least_stretch * (1.0 - 1e-12) - 1e-12 * (self.size + self.most_stretch * size)
    }
}
