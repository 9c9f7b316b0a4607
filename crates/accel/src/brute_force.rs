//! Every primitive against every ray: the simple twin that tests every structure.

use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::prepared_ray::PreparedRay;
use crate::primitive;
use crate::search::{Enter, Level, Search};

/// Look at each primitive of a level and enter each of its instances.
pub(crate) fn search<const ANY: bool>(level: Level, ray: &PreparedRay, search: &mut Search<ANY>, enter: Enter<ANY>) {
    for (g, geometry) in level.geometries.iter().enumerate() {
        for p in 0..geometry.shape.len() as u32 {
            if search.is_done() {
                return;
            }
            search.counters.primitives_tested += 1;
            let offer = |t, u, v| search.offer(level, g as u32, p, (t, u, v));
            primitive::intersect(&geometry.shape, p, ray, level.shutter, offer);
        }
    }
    for instance in 0..level.instances {
        enter(ray, search, instance);
    }
}

/// Look for the closest point on each primitive of a level and in each of its instances.
pub(crate) fn closest_point(level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
    for (g, geometry) in level.geometries.iter().enumerate() {
        for p in 0..geometry.shape.len() as u32 {
            search.consider(level, space, g as u32, p);
        }
    }
    for instance in 0..level.instances {
        enter(search, instance);
    }
}
