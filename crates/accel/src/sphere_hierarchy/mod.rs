//! `sphere_hierarchy`: a binary tree of bounding spheres (Rubin & Whitted 1980, "A 3-Dimensional Representation for Fast
//! Rendering of Complex Scenes"). Spheres are simple and turn well, but fit badly around what is flat: the comparison that
//! speaks for boxes. The topology is that of `bvh2`.
//!
//! No hit is lost: `t` lies in the box test's interval of the primitive's own bounds, so the hit lies within `20 u D` of
//! them (as in `cells`); a ball itself is hit within `4 u D`. A sphere holds all bounds and balls below it, and is tested in
//! f64 with a radius that is `128 u D` too large, `D` being the distance from the ray's origin to its far side: the ray is
//! inside well before the hit. Rays beyond the range in which that holds see every sphere.

mod closest;
mod traverse;
mod validate;

use crate::build::binary::{BinaryTree, Child};
use crate::build::binned_sah;
use crate::build::costs::Costs;
use crate::build::reference::Reference;
use crate::gather::{Gathered, gather};
use crate::instance::PlacedInstance;
use crate::record::{Record, RecordKind};
use crate::scene_geometry::{Geometry, Sphere};
use crate::{Executor, primitive};
use kirkas_geometry::{Bounds3, Vec3};

/// A tree over one level: the world with its instances, or one aggregate.
#[derive(Default)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    root: Option<(Child, Sphere)>,
    /// The leaves' runs.
    records: Vec<Record>,
    /// What no box holds; tested by every ray.
    unbounded: Vec<Record>,
    bounds: Option<Bounds3>,
}

/// An inner node: spheres around the primitives below each child.
struct Node {
    spheres: [Sphere; 2],
    children: [Child; 2],
}

impl Tree {
    /// Build over a level.
    pub fn build(geometries: &[Geometry], instances: &[PlacedInstance], executor: &dyn Executor) -> Self {
        let Gathered { references, unbounded, .. } = gather(geometries, instances, executor);
        let tree = binned_sah::build(references, &Costs::BVH2, executor);
        let record = |r: &Reference| Record::new(geometries, r.ids().0, r.ids().1);
        let records: Vec<Record> = tree.references.iter().map(record).collect();
        let BinaryTree { nodes: boxes, root, references } = tree;
        let bounds = references.iter().map(Reference::bounds).reduce(Bounds3::union);

        // Around the center of a child's box, as large as what is below it needs. Children come after their parents.
        let mut runs = vec![(0, 0); boxes.len()];
        let around = |b: &Bounds3, (first, end): (usize, usize)| {
            let center = b.center();
            let below = records[first..end].iter().zip(&references[first..end]);
            let radius = below.map(|(record, r)| reach(center, record, &r.bounds())).fold(0.0, f64::max);
            Sphere { center, radius: (radius as f32).next_up() }
        };
        let mut nodes: Vec<Node> = Vec::with_capacity(boxes.len());
        for (i, node) in boxes.iter().enumerate().rev() {
            let [left, right] = node.children.map(|c| run_of(c, &runs));
            runs[i] = (left.0, right.1);
            let spheres = [around(&node.child_bounds(0), left), around(&node.child_bounds(1), right)];
            nodes.push(Node { spheres, children: node.children });
        }
        nodes.reverse();
        let root = root.zip(bounds).map(|(root, b)| (root, around(&b, (0, records.len()))));
        Tree { nodes, root, records, unbounded, bounds }
    }

    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.records) + size_of_val(&*self.unbounded)
    }
}

/// First record below a child, and the end.
fn run_of(child: Child, runs: &[(usize, usize)]) -> (usize, usize) {
    if child.is_leaf() {
        let (first, count) = child.run();
        (first, first + count)
    } else {
        runs[child.index()]
    }
}

/// How far a primitive reaches from a point, in f64 that is exact to some roundings.
fn reach(from: Vec3, record: &Record, bounds: &Bounds3) -> f64 {
    let from = from.as_dvec3();
    if record.kind == RecordKind::Sphere {
        let ball = record.sphere();
        return (ball.center.as_dvec3() - from).length() + f64::from(ball.radius);
    }
    (from - bounds.min.as_dvec3()).abs().max((bounds.max.as_dvec3() - from).abs()).length()
}

/// The bounds of what a record stands for.
fn own_bounds(record: &Record, geometries: &[Geometry], instances: &[PlacedInstance]) -> Bounds3 {
    match record.kind {
        RecordKind::Instance => instances[record.primitive as usize].bounds,
        _ => primitive::bounds(&geometries[record.geometry as usize].shape, record.primitive),
    }
}
