//! Instances: aggregates placed into the world or into other aggregates, still or moving.
//!
//! However deep an instance stands, the ray within it is made from the world's own by one f64 map, the inverse of the
//! product of all transforms on the way, and rounded to f32 once.

use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Instance;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, Ray, Vec3};

/// An instance, ready to be entered by rays.
pub(crate) struct PlacedInstance {
    pub aggregate: usize,
    pub mask: u32,
    /// Bounds over the whole shutter in the space that it is placed into: part of the definition of a hit inside.
    pub bounds: Bounds3,
    motion: Motion,
}

enum Motion {
    /// `object_from_outer`.
    Still(DAffine3),
    /// `outer_from_object`, and the shutter.
    Moving(AnimatedTransform, (f64, f64)),
}

/// What a ray within instances was made from.
#[derive(Clone, Copy)]
pub(crate) struct Entered {
    pub ray: PreparedRay,
    /// The inverse of what made it.
    pub world_from_object: DAffine3,
}

impl PlacedInstance {
    /// Place an aggregate of these object-space bounds.
    pub fn new(instance: &Instance, object_bounds: &Bounds3, shutter: (f64, f64)) -> Self {
        let m = &instance.outer_from_object;
        PlacedInstance {
            aggregate: instance.aggregate,
            mask: instance.mask,
            bounds: padded(m.swept_bounds(object_bounds, shutter.0, shutter.1)),
            motion: match m.is_moving() {
                true => Motion::Moving(m.clone(), shutter),
                false => Motion::Still(m.at(shutter.0).inverse()),
            },
        }
    }

    /// A ray of the world itself as the instance's aggregate sees it: `t` stays the world's. `None` when it passes the bounds by.
    #[inline]
    pub fn enter(&self, ray: &PreparedRay) -> Option<PreparedRay> {
        let clip = self.clip(ray)?;
        let object_from_world = match &self.motion {
            Motion::Still(m) => *m,
            Motion::Moving(..) => self.outer_from_object(ray.clipped.time)?.inverse(),
        };
        in_object(&object_from_world, &ray.clipped, ray, clip)
    }

    /// The ray `world`, which is `outer.ray` in the space around this instance, as the aggregate sees it.
    pub fn enter_from(&self, instance: &Instance, outer: &Entered, world: &Ray) -> Option<Entered> {
        let clip = self.clip(&outer.ray)?;
        let world_from_object = outer.world_from_object * self.place(instance, world.time);
        let ray = in_object(&world_from_object.inverse(), world, &outer.ray, clip)?;
        Some(Entered { ray, world_from_object })
    }

    /// `outer_from_object` at a ray's time; `instance` is the one that this was made from.
    pub fn place(&self, instance: &Instance, time: f32) -> DAffine3 {
        self.outer_from_object(time).unwrap_or_else(|| instance.outer_from_object.at(0.0))
    }

    /// `None` when it stands still.
    fn outer_from_object(&self, time: f32) -> Option<DAffine3> {
        match &self.motion {
            Motion::Still(_) => None,
            Motion::Moving(m, (open, close)) => Some(m.at(f64::from(time).clamp(*open, *close))),
        }
    }

    #[inline]
    fn clip(&self, outer: &PreparedRay) -> Option<(f32, f32)> {
        if outer.clipped.mask & self.mask == 0 {
            return None;
        }
        self.bounds.intersect(&outer.clipped, outer.inverse())
    }
}

#[inline]
fn in_object(
    object_from_world: &DAffine3,
    world: &Ray,
    outer: &PreparedRay,
    (t_min, t_max): (f32, f32),
) -> Option<PreparedRay> {
    let origin = object_from_world.transform_point3(world.origin.as_dvec3()).as_vec3();
    let direction = object_from_world.transform_vector3(world.direction.as_dvec3()).as_vec3();
    PreparedRay::clipped(Ray { origin, direction, t_min, t_max, ..*world }, (outer.t_min, outer.t_max))
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
