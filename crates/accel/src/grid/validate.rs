//! The grid's invariants, callable, and its measures.

use super::Grid;
use super::build::{for_each_cell, grown, region};
use crate::Serial;
use crate::cells::growth;
use crate::gather::gather;
use crate::instance::PlacedInstance;
use crate::record::check_complete;
use crate::scene_geometry::Geometry;
use kirkas_geometry::Bounds3;

/// Cost of visiting a cell; testing a primitive costs 1.
const CELL_COST: f64 = 0.75;

impl Grid {
    /// Each primitive in each cell where it can be hit, planes in order, indices in range.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        check_complete(self.records.iter().chain(&self.unbounded), geometries, instances)?;
        let Some(cells) = &self.cells else { return Ok(()) };
        let planes = &cells.planes;
        for k in 0..3 {
            let along = planes.along(k);
            let ends = (along[0], along[along.len() - 1]);
            if !along.is_sorted() || ends != (cells.bounds.min[k], cells.bounds.max[k]) {
                return Err(format!("the planes of axis {k} are not in order"));
            }
        }
        let references = gather(geometries, instances, &Serial).references;
        let grow = growth(&cells.bounds);
        for (i, (reference, record)) in references.iter().zip(&self.records).enumerate() {
            let (region, bounds) = (region(reference, record, grow), grown(&reference.bounds(), grow));
            // The cells that its bounds touch, found one after the other.
            let touches = |k: usize, c: usize| {
                let along = planes.along(k);
                along[c] <= bounds.max[k] && along[c + 1] >= bounds.min[k]
            };
            let touched = [0, 1, 2].map(|k| {
                let all = 0..planes.resolution(k);
                let first = all.clone().find(|&c| touches(k, c)).unwrap_or(0);
                first..=all.rev().find(|&c| touches(k, c)).unwrap_or(0)
            });
            let mut missing = None;
            for_each_cell(touched, |at| {
                let is_listed = cells.lists.of(planes.index(at)).binary_search(&(i as u32)).is_ok();
                if !is_listed && !region.within(&planes.cell(at)).is_empty() {
                    missing = Some(at);
                }
            });
            if let Some(at) = missing {
                return Err(format!("primitive {i} is missing in cell {at:?}"));
            }
        }
        Ok(())
    }

    /// Expected cost of a ray that meets the grid: cell visits times their cost (0.75) plus primitive tests. The chance to
    /// meet a cell is the ratio of the areas.
    pub fn sah_cost(&self) -> f64 {
        let Some(cells) = &self.cells else { return 0.0 };
        let area = |b: &Bounds3| {
            let [x, y, z] = (b.max.as_dvec3() - b.min.as_dvec3()).to_array();
            x * y + (x + y) * z
        };
        let root_area = area(&cells.bounds);
        if root_area <= 0.0 {
            return 0.0;
        }
        let planes = &cells.planes;
        let mut cost = 0.0;
        for_each_cell([0, 1, 2].map(|k| 0..=planes.resolution(k) - 1), |at| {
            let count = cells.lists.of(planes.index(at)).len() as f64;
            cost += area(&planes.cell(at)) / root_area * (CELL_COST + count);
        });
        cost
    }
}
