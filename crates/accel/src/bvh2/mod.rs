//! `bvh2`: a binary tree of boxes, split by the binned surface-area heuristic. Quick to build, a fair traversal, little memory
//! (about 70 bytes per triangle).

mod binned_sah;
mod node;
mod traverse;
mod validate;

use crate::Executor;
use crate::instance::PlacedInstance;
use crate::primitive;
use crate::scene_geometry::{Geometry, Shape};
use binned_sah::Reference;
use kirkas_geometry::Bounds3;
use node::{Child, Node, Record, RecordKind};

/// No inner node lies deeper than this many levels; it is the size of the traversal stack. Room for 2^28 primitives by
/// halving, and 36 levels of freedom for the heuristic.
const MAX_DEPTH: usize = 64;

/// The geometry field of a reference to an instance.
const IS_INSTANCE: u32 = binned_sah::MAX_ID;

/// A tree over one level: the world with its instances, or one aggregate.
#[derive(Default)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    /// `None` when nothing bounded is there.
    root: Option<Child>,
    /// The leaves' runs.
    records: Vec<Record>,
    /// What no box holds; tested by every ray.
    unbounded: Vec<Record>,
    bounds: Option<Bounds3>,
}

impl Tree {
    /// Build over a level.
    pub fn build(geometries: &[Geometry], instances: &[PlacedInstance], executor: &dyn Executor) -> Self {
        // Gather the boxes; set aside what is empty or unbounded.
        let count = geometries.iter().map(|g| g.shape.len()).sum::<usize>() + instances.len();
        let mut references = Vec::with_capacity(count);
        let mut unbounded = Vec::new();
        for (bounds, geometry, index) in all_references(geometries, instances) {
            if bounds.is_finite() {
                references.push(Reference::new(&bounds, geometry, index));
            } else if !bounds.is_empty() {
                unbounded.push(record(geometries, geometry, index));
            }
        }

        let (nodes, root) = binned_sah::build(&mut references, executor);

        // Put the primitives' data where the leaves look for it.
        let gather = |r: &Reference| record(geometries, r.ids().0, r.ids().1);
        let records: Vec<Record> = references.iter().map(gather).collect();
        let bounds = references.iter().map(Reference::bounds).reduce(Bounds3::union);
        Tree { nodes, root, records, unbounded, bounds }
    }

    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.records) + size_of_val(&*self.unbounded)
    }
}

/// Every primitive and instance of a level with its bounds.
fn all_references<'a>(
    geometries: &'a [Geometry],
    instances: &'a [PlacedInstance],
) -> impl Iterator<Item = (Bounds3, u32, u32)> + 'a {
    let primitives = geometries.iter().enumerate().flat_map(|(g, geometry)| {
        (0..geometry.shape.len() as u32).map(move |p| (primitive::bounds(&geometry.shape, p), g as u32, p))
    });
    primitives.chain(instances.iter().enumerate().map(|(i, instance)| (instance.bounds, IS_INSTANCE, i as u32)))
}

fn record(geometries: &[Geometry], geometry: u32, primitive: u32) -> Record {
    let (kind, corners) = match geometries.get(geometry as usize).map(|g| &g.shape) {
        None => (RecordKind::Instance, [[0.0; 3]; 3]),
        Some(Shape::Triangles { positions, indices }) => {
            (RecordKind::Triangle, primitive::corners(positions, indices[primitive as usize]))
        }
        Some(Shape::Spheres(spheres)) => {
            let s = &spheres[primitive as usize];
            (RecordKind::Sphere, [s.center.to_array(), [s.radius, 0.0, 0.0], [0.0; 3]])
        }
        Some(Shape::User(_)) => (RecordKind::User, [[0.0; 3]; 3]),
    };
    Record { corners, geometry, primitive, kind }
}
