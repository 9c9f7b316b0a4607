//! What a search for hits has found so far.

use crate::hit::{Counters, Hit};
use crate::path::InstancePath;
use crate::prepared_ray::PreparedRay;
use crate::query::Query;
use crate::scene_geometry::Geometry;
use core::cell::RefCell;
use kirkas_geometry::Ray;

/// Where the geometry that is being searched stands.
#[derive(Clone, Copy)]
pub(crate) struct Level<'a> {
    pub geometries: &'a [Geometry],
    /// How many instances stand among them.
    pub instances: u32,
    /// The instances they stand in.
    pub instance: InstancePath,
    /// The scene's.
    pub shutter: (f64, f64),
}

/// Searches the instance of this index with the ray of the level that holds it.
pub(crate) type Enter<'e, const ANY: bool> = &'e dyn Fn(&PreparedRay, &mut Search<'_, ANY>, u32);

/// One ray's search: for the closest hit, or (`ANY`) for any.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a, const ANY: bool> {
    /// The ray in world space, for the filter and for instances.
    pub ray: &'a Ray,
    pub ray_index: usize,
    pub query: Query<'a>,
    pub counters: Counters,
    pub best: Option<Hit>,
    /// Where every hit is put, when all are asked for; `best` then stays `None`.
    pub all: Option<&'a RefCell<Vec<Hit>>>,
    /// Boxes that are entered after this hold nothing better. Equal `t` may still win by its ids.
    pub limit: f32,
}

impl<'a, const ANY: bool> Search<'a, ANY> {
    pub fn new(ray: &'a Ray, ray_index: usize, query: Query<'a>) -> Self {
        let counters = Counters { rays: 1, ..Counters::default() };
        Search { ray, ray_index, query, counters, best: None, all: None, limit: ray.t_max }
    }

    /// True when nothing more needs to be looked at.
    #[inline]
    pub fn is_done(&self) -> bool {
        ANY && self.best.is_some()
    }

    /// Consider a crossing. True when the farther crossings of the same primitive need not be looked at.
    #[inline]
    pub fn offer(&mut self, level: Level, geometry: u32, primitive: u32, (t, u, v): (f32, f32, f32)) -> bool {
        if t > self.limit {
            return true;
        }
        let hit = Hit { t, u, v, instance: level.instance, geometry, primitive };
        if self.best.is_some_and(|best| !hit.beats(&best)) {
            return true;
        }
        let g = &level.geometries[geometry as usize];
        if g.mask & self.ray.mask == 0 {
            return true;
        }
        if let Some(Some(excluded)) = self.query.excluded.get(self.ray_index)
            && *excluded == hit.id()
        {
            return true;
        }
        if !g.opaque && self.query.filter.is_some_and(|f| !f.accept(self.ray_index, self.ray, &hit)) {
            return false;
        }
        if let Some(all) = self.all {
            all.borrow_mut().push(hit);
            return false;
        }
        self.best = Some(hit);
        self.limit = t;
        true
    }
}
