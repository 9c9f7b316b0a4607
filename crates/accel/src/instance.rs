//! Instances: aggregates placed into the world, still or moving.

use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Instance;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, Ray, Vec3};

/// An instance, ready to be entered by rays.
pub(crate) struct PlacedInstance {
    pub aggregate: usize,
    pub mask: u32,
    /// World bounds over the whole shutter: part of the definition of a hit inside.
    pub bounds: Bounds3,
    motion: Motion,
}

enum Motion {
    /// `object_from_world`.
    Still(DAffine3),
    /// `world_from_object`, and the shutter.
    Moving(AnimatedTransform, (f64, f64)),
}

impl PlacedInstance {
    /// Place an aggregate of these object-space bounds.
    pub fn new(instance: &Instance, object_bounds: &Bounds3, shutter: (f64, f64)) -> Self {
        let m = &instance.world_from_object;
        let moving = m.is_moving() && shutter.0 < shutter.1;
        PlacedInstance {
            aggregate: instance.aggregate,
            mask: instance.mask,
            bounds: padded(m.swept_bounds(object_bounds, shutter.0, shutter.1)),
            motion: if moving { Motion::Moving(m.clone(), shutter) } else { Motion::Still(m.at(shutter.0).inverse()) },
        }
    }

    /// The ray as the instance's aggregate sees it: `t` stays the world's. `None` when it passes the bounds by.
    #[inline]
    pub fn enter(&self, ray: &PreparedRay) -> Option<PreparedRay> {
        let world = &ray.clipped;
        if world.mask & self.mask == 0 {
            return None;
        }
        let (near, far) = self.bounds.intersect(world, ray.inverse)?;
        let object_from_world = match &self.motion {
            Motion::Still(m) => *m,
            Motion::Moving(m, (open, close)) => m.at(f64::from(world.time).clamp(*open, *close)).inverse(),
        };
        let origin = object_from_world.transform_point3(world.origin.as_dvec3()).as_vec3();
        let direction = object_from_world.transform_vector3(world.direction.as_dvec3()).as_vec3();
        let clipped = Ray { origin, direction, t_min: near, t_max: far, ..*world };
        PreparedRay::clipped(clipped, (ray.t_min, ray.t_max))
    }
}

/// Grown by 1/8192 of its size. The bounds clip the hits inside, and a ray loses a few roundings of its distance when it
/// enters object space: the growth keeps that from clipping what stands on the bounds' faces, from up to some hundred
/// times the instance's size away. That all structures agree does not depend on it.
fn padded(b: Bounds3) -> Bounds3 {
    if b.is_empty() || !b.is_finite() {
        return b;
    }
    let grow = Vec3::splat(b.extent().max_element() / 8192.0) + b.min.abs().max(b.max.abs()) * 1e-6;
    Bounds3 { min: b.min - grow, max: b.max + grow }
}
