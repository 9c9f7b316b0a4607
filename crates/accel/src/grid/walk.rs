//! Takes a ray from cell to cell.

use super::build::for_each_cell;
use super::{Cells, Grid};
use crate::cells::{Mailbox, thickness};
use crate::prepared_ray::PreparedRay;
use crate::search::{Enter, Level, Search};

impl Grid {
    /// Search all that the grid holds; `enter` searches an instance.
    pub fn search<const ANY: bool>(
        &self,
        level: Level,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        enter: Enter<ANY>,
    ) {
        for record in &self.unbounded {
            record.test(level, ray, search, enter);
        }
        let Some(cells) = &self.cells else { return };
        let thickness = thickness(&ray.clipped, &cells.bounds);
        if thickness == f32::INFINITY {
            search.counters.nodes_visited += 1;
            return self.records.iter().for_each(|r| {
                if !search.is_done() {
                    r.test(level, ray, search, enter)
                }
            });
        }
        let mut mailbox = Mailbox::new();
        let mut test = |search: &mut Search<ANY>, at: [usize; 3]| {
            search.counters.nodes_visited += 1;
            for &i in cells.lists.of(cells.planes.index(at)) {
                if mailbox.is_new(i) {
                    self.records[i as usize].test(level, ray, search, enter);
                }
            }
        };
        if thickness == 0.0 {
            cells.walk(ray, search, &mut test)
        } else {
            cells.sweep(ray, thickness, search, &mut test)
        }
    }
}

impl Cells {
    /// The cells along a near ray, in order: a plane counts as crossed when its computed distance is less than `t`.
    fn walk<const ANY: bool>(
        &self,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        test: &mut impl FnMut(&mut Search<ANY>, [usize; 3]),
    ) {
        let Some((near, far)) = self.bounds.intersect(&ray.clipped, ray.inverse()) else { return };
        let backward = [0, 1, 2].map(|k: usize| ray.inverse[k].is_sign_negative());
        // NaN, a ray within the plane: it is never crossed.
        let distance = |k: usize, plane: f32| (plane - ray.clipped.origin[k]) * ray.inverse[k];
        let mut at = [0, 1, 2].map(|k| {
            let crossed = |plane: f32| distance(k, plane) < near;
            match backward[k] {
                false => self.planes.inner(k).partition_point(|&p| crossed(p)),
                true => self.planes.inner(k).partition_point(|&p| !crossed(p)),
            }
        });
        let exit = |k: usize, i: usize| {
            let last = if backward[k] { 0 } else { self.planes.resolution(k) - 1 };
            let t = distance(k, self.planes.along(k)[i + usize::from(!backward[k])]);
            if i == last || t.is_nan() { f32::INFINITY } else { t }
        };
        let mut exits = [0, 1, 2].map(|k| exit(k, at[k]));
        loop {
            test(search, at);
            let k = if exits[0] < exits[1] {
                2 * usize::from(exits[2] < exits[0])
            } else {
                1 + usize::from(exits[2] < exits[1])
            };
            // A cell entered at the best `t` itself may hold an equal hit.
            let goes_on = exits[k] < f32::INFINITY && exits[k] <= far && exits[k] <= search.limit;
            if !goes_on || search.is_done() {
                return;
            }
            at[k] = if backward[k] { at[k] - 1 } else { at[k] + 1 };
            exits[k] = exit(k, at[k]);
        }
    }

    /// All cells within `thickness` of the line of a far ray, slice by slice along its main axis.
    fn sweep<const ANY: bool>(
        &self,
        ray: &PreparedRay,
        thickness: f32,
        search: &mut Search<ANY>,
        test: &mut impl FnMut(&mut Search<ANY>, [usize; 3]),
    ) {
        let (origin, direction) = (ray.clipped.origin.as_dvec3(), ray.clipped.direction.as_dvec3());
        let (thickness, [_, _, main]) = (f64::from(thickness), ray.axes.map(|k| k as usize));
        for slice in self.planes.along(main).windows(2).enumerate() {
            let (i, [low, high]) = (slice.0, [slice.1[0], slice.1[1]].map(f64::from));
            let t = [low - thickness, high + thickness].map(|p| (p - origin[main]) / direction[main]);
            let ranges = [0, 1, 2].map(|k| {
                if k == main {
                    return i..=i;
                }
                let [a, b] = t.map(|t| origin[k] + direction[k] * t);
                let (from, to) = (a.min(b) - thickness, a.max(b) + thickness);
                let misses = from > f64::from(self.bounds.max[k]) || to < f64::from(self.bounds.min[k]);
                #[allow(clippy::reversed_empty_ranges)]
                if misses { 1..=0 } else { self.planes.touched(k, from, to) }
            });
            for_each_cell(ranges, |at| {
                if !search.is_done() {
                    test(search, at);
                }
            });
        }
    }
}
