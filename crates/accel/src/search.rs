//! What a search for hits has found so far.

use crate::hit::{Counters, Hit, HitFilter};
use crate::scene_geometry::Geometry;
use kirkas_geometry::Ray;

/// Where the geometry that is being searched stands.
#[derive(Clone, Copy)]
pub(crate) struct Level<'a> {
    pub geometries: &'a [Geometry],
    /// How many instances stand among them.
    pub instances: u32,
    /// Index of the instance they stand in, or `NO_INSTANCE`.
    pub instance: u32,
}

/// One ray's search: for the closest hit, or (`ANY`) for any.
pub(crate) struct Search<'a, const ANY: bool> {
    /// The ray in world space, for the filter.
    pub ray: &'a Ray,
    pub ray_index: usize,
    pub filter: Option<&'a dyn HitFilter>,
    pub counters: &'a mut Counters,
    pub best: Option<Hit>,
    /// Boxes that are entered after this hold nothing better. Equal `t` may still win by its ids.
    pub limit: f32,
}

impl<'a, const ANY: bool> Search<'a, ANY> {
    pub fn new(ray: &'a Ray, ray_index: usize, filter: Option<&'a dyn HitFilter>, counters: &'a mut Counters) -> Self {
        counters.rays += 1;
        Search { ray, ray_index, filter, counters, best: None, limit: ray.t_max }
    }

    /// True when nothing more needs to be looked at.
    #[inline]
    pub fn is_done(&self) -> bool {
        ANY && self.best.is_some()
    }

    /// Consider a crossing. True when the farther crossings of the same primitive need not be looked at.
    #[inline]
    pub fn offer(&mut self, level: Level, geometry: u32, primitive: u32, (t, u, v): (f32, f32, f32)) -> bool {
        let hit = Hit { t, u, v, instance: level.instance, geometry, primitive };
        if self.best.is_some_and(|best| !hit.beats(&best)) {
            return true;
        }
        let g = &level.geometries[geometry as usize];
        if g.mask & self.ray.mask == 0 {
            return true;
        }
        if !g.opaque && self.filter.is_some_and(|f| !f.accept(self.ray_index, self.ray, &hit)) {
            return false;
        }
        self.best = Some(hit);
        self.limit = t;
        true
    }
}
