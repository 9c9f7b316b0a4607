//! `kd_tree` and `kd_tree_fast`: space is halved again and again by planes, at the least expected cost by the surface-area
//! heuristic (MacDonald & Booth 1990). Nodes of 8 bytes; leaves are runs of one list of indices, in which a primitive may
//! occur several times. The two kinds differ in how a plane is chosen: [`sweep`] looks at all, [`binned`] at some.

mod binned;
mod build;
mod closest;
mod node;
mod sweep;
mod traverse;
mod validate;

use crate::Executor;
use crate::build::reference::Reference;
use crate::cells::{Clip, growth};
use crate::gather::{Gathered, gather};
use crate::instance::PlacedInstance;
use crate::record::Record;
use crate::scene_geometry::Geometry;
use kirkas_geometry::Bounds3;
use node::Node;

/// How planes are chosen.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Planes {
    /// The best of all sides of boxes: the better tree.
    All,
    /// The best of some evenly spaced: the faster build.
    Some,
}

/// A tree over one level: the world with its instances, or one aggregate.
#[derive(Default)]
pub(crate) struct Tree {
    /// In depth-first order, the root first.
    nodes: Vec<Node>,
    /// The leaves' runs of indices into `records`.
    lists: Vec<u32>,
    records: Vec<Record>,
    /// What no box holds; tested by every ray.
    unbounded: Vec<Record>,
    /// `None` when nothing bounded is there.
    bounds: Option<Bounds3>,
}

impl Tree {
    /// Build over a level.
    pub fn build(
        planes: Planes,
        geometries: &[Geometry],
        instances: &[PlacedInstance],
        executor: &dyn Executor,
    ) -> Self {
        let Gathered { references, unbounded, .. } = gather(geometries, instances, executor);
        let Some(bounds) = references.iter().map(Reference::bounds).reduce(Bounds3::union) else {
            return Tree { unbounded, ..Tree::default() };
        };
        let record = |r: &Reference| Record::new(geometries, r.ids().0, r.ids().1);
        let records: Vec<Record> = references.iter().map(record).collect();
        let primitives = Primitives { references: &references, records: &records, growth: growth(&bounds) };
        let build::Part { nodes, lists } = match planes {
            Planes::All => build::tree(&sweep::Sweep(primitives), bounds, executor),
            Planes::Some => build::tree(&binned::Binned(primitives), bounds, executor),
        };
        Tree { nodes, lists, records, unbounded, bounds: Some(bounds) }
    }

    pub fn node_count(&self) -> usize {
        self.nodes.iter().filter(|n| !n.is_leaf()).count()
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
            + size_of_val(&*self.lists)
            + size_of_val(&*self.records)
            + size_of_val(&*self.unbounded)
    }
}

/// What the builders cut.
#[derive(Clone, Copy)]
struct Primitives<'a> {
    references: &'a [Reference],
    records: &'a [Record],
    growth: f64,
}

impl Primitives<'_> {
    /// The part of a primitive within each of two cells.
    fn cut(&self, primitive: u32, cells: &[Bounds3; 2]) -> [Bounds3; 2] {
        let i = primitive as usize;
        let clip = Clip::new(&self.records[i], self.references[i].bounds(), self.growth);
        cells.each_ref().map(|cell| clip.within(cell))
    }
}
