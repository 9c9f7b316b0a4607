//! `grid`: space is cut into equal cells, each with the list of what can be hit there; rays go from cell to cell (Fujimoto,
//! Tanaka & Iwata 1986; Amanatides & Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing"). The quickest to build;
//! good where primitives are small and evenly spread, bad for a teapot in a stadium.
//!
//! No hit is lost: the cell in which the computed distances to the planes put a hit's `t` is within `4 u D` of the hit, the
//! hit within `20 u D` of its primitive's bounds and `48 u D` of a triangle's plane. Bounds and planes are listed grown by
//! `128 u D`; rays from too far away for that visit all cells around them (head of `cells`).

mod build;
mod closest;
mod validate;
mod walk;

use crate::Serial;
use crate::gather::{Gathered, gather};
use crate::instance::PlacedInstance;
use crate::record::Record;
use crate::scene_geometry::Geometry;
use build::{Lists, Planes};
use kirkas_geometry::Bounds3;

/// A grid over one level: the world with its instances, or one aggregate.
#[derive(Default)]
pub(crate) struct Grid {
    /// `None` when nothing bounded is there.
    cells: Option<Cells>,
    records: Vec<Record>,
    /// What no box holds; tested by every ray.
    unbounded: Vec<Record>,
}

struct Cells {
    bounds: Bounds3,
    planes: Planes,
    lists: Lists,
}

impl Grid {
    /// Build over a level.
    pub fn build(geometries: &[Geometry], instances: &[PlacedInstance]) -> Self {
        let Gathered { references, unbounded, .. } = gather(geometries, instances, &Serial);
        let records: Vec<Record> = references.iter().map(|r| Record::new(geometries, r.ids().0, r.ids().1)).collect();
        let bounds = references.iter().map(|r| r.bounds()).reduce(Bounds3::union);
        let cells = bounds.map(|bounds| {
            let (planes, lists) = build::cells(&bounds, &references, &records);
            Cells { bounds, planes, lists }
        });
        Grid { cells, records, unbounded }
    }

    pub fn cell_count(&self) -> usize {
        self.cells.as_ref().map_or(0, |c| c.planes.cell_count())
    }

    pub fn bytes(&self) -> usize {
        let cells = self.cells.as_ref().map_or(0, |c| c.planes.bytes() + c.lists.bytes());
        cells + size_of_val(&*self.records) + size_of_val(&*self.unbounded)
    }
}
