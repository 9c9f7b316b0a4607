//! The point of all surfaces that is closest to a given one, in world space and f64.
//!
//! A primitive's closest point is found exactly (to f64); boxes that cannot hold a closer one are left out, with room for
//! rounding, so every structure answers as brute force does, to the bit. Ties go to the lowest (path, geometry, primitive).

mod ask;
mod distance;
mod space;

pub(crate) use space::PointSpace;

use crate::hit::PrimitiveId;
use crate::path::InstancePath;
use crate::search::Level;
use kirkas_geometry::{Bounds3, DVec3, Vec3};

/// Where to look for surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointQuery {
    /// From here, in world space.
    pub point: Vec3,
    /// Only closer than this.
    pub max_distance: f32,
    /// Time in seconds, as a ray has it.
    pub time: f32,
    /// A geometry is seen when `mask & geometry_mask != 0`, and the masks of all instances around agree.
    pub mask: u32,
}

impl PointQuery {
    /// From `point`, closer than `max_distance`, at time 0, seeing everything.
    pub fn new(point: Vec3, max_distance: f32) -> Self {
        PointQuery { point, max_distance, time: 0.0, mask: u32::MAX }
    }
}

/// The point of a surface that is closest to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointHit {
    /// How far it is, in world space.
    pub distance: f32,
    /// Where it is, in world space.
    pub position: Vec3,
    /// As `Hit::u` there; where several would do, one of them.
    pub u: f32,
    /// As `Hit::v` there.
    pub v: f32,
    /// As `Hit::instance`.
    pub instance: InstancePath,
    /// As `Hit::geometry`.
    pub geometry: u32,
    /// As `Hit::primitive`.
    pub primitive: u32,
}

impl PointHit {
    /// On what it is.
    pub fn id(&self) -> PrimitiveId {
        PrimitiveId { instance: self.instance, geometry: self.geometry, primitive: self.primitive }
    }
}

/// A point of a surface, in the surface's own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it is.
    pub position: DVec3,
    /// As `Hit::u`.
    pub u: f32,
    /// As `Hit::v`.
    pub v: f32,
}

/// Looks into the instance of this index, from the level that holds it.
pub(crate) type EnterPoint<'e> = &'e dyn Fn(&mut PointSearch, u32);

/// What has been found so far.
pub(crate) struct PointSearch {
    query: PointQuery,
    point: DVec3,
    /// Farther boxes hold nothing better. An equal distance may still win by its ids.
    limit: f64,
    best: Option<PointHit>,
}

impl PointSearch {
    /// The least distance to anything in a box; `None` when that is too far.
    #[inline]
    pub fn box_distance(&self, space: &PointSpace, bounds: &Bounds3) -> Option<f64> {
        let distance = space.box_distance(bounds);
        (distance <= self.limit).then_some(distance)
    }

    /// True when what is this far away, as [`PointSearch::box_distance`] told, may still be better.
    #[inline]
    pub fn is_near(&self, distance: f64) -> bool {
        distance <= self.limit
    }

    /// The query's time as a part of the shutter.
    pub fn moment(&self, level: Level) -> f32 {
        crate::moving::moment(self.query.time, level.shutter)
    }

    /// Look at a primitive.
    pub fn consider(&mut self, level: Level, space: &PointSpace, geometry: u32, primitive: u32) {
        let g = &level.geometries[geometry as usize];
        if g.mask & self.query.mask == 0 {
            return;
        }
        let Some(found) = distance::closest(&g.shape, primitive, self.moment(level), space) else { return };
        let off = (found.position - self.point).length();
        let hit = PointHit {
            distance: off as f32,
            position: found.position.as_vec3(),
            u: found.u,
            v: found.v,
            instance: level.instance,
            geometry,
            primitive,
        };
        let is_first = match &self.best {
            // NaN is not closer.
            None => off < f64::from(self.query.max_distance),
            Some(best) => off < self.limit || (off == self.limit && hit.id() < best.id()),
        };
        if is_first {
            self.best = Some(hit);
            self.limit = off;
        }
    }
}
