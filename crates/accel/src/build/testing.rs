//! What the tests of the builders share.

use super::binary::{BinaryTree, Child, MAX_DEPTH};
use super::reference::Reference;
use crate::Executor;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Bounds3, Vec3};

/// Boxes of many sizes in a cube; the primitive's id is the index.
pub(crate) fn random_boxes(count: usize, seed: u64) -> Vec<Reference> {
    let at = |i: usize, k: u64| unit_f32(combine(combine(seed, i as u64), k) as u32);
    let of = |i: usize| {
        let low = Vec3::new(at(i, 0), at(i, 1), at(i, 2));
        let size = Vec3::new(at(i, 3), at(i, 4), at(i, 5)) * at(i, 6) * at(i, 6) * 0.1;
        Reference::new(&Bounds3 { min: low, max: low + size }, 0, i as u32)
    };
    (0..count).map(of).collect()
}

/// The second of each two jobs first. (Backwards are tried in `tests/it`.)
pub(crate) struct Backwards;

impl Executor for Backwards {
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        b();
        a();
    }
}

/// What is wrong with a tree that shall hold these references, each once: order, boxes, runs, depth.
pub(crate) fn assert_sound(tree: &BinaryTree, expected: &[Reference]) {
    let sorted = |references: &[Reference]| {
        let mut all: Vec<_> = references.iter().map(|r| (r.ids(), format!("{:?}", r.bounds()))).collect();
        all.sort();
        all
    };
    assert!(sorted(&tree.references) == sorted(expected), "not the same references");
    let mut next = (0, 0);
    let levels = tree.root.map_or(0, |root| walk(tree, root, Bounds3::EVERYTHING, &mut next));
    assert_eq!(next, (tree.nodes.len(), tree.references.len()));
    assert!(levels <= MAX_DEPTH, "{levels} levels");
}

/// Checks order and boxes below; returns the levels of inner nodes. `next` node and reference are those to come.
fn walk(tree: &BinaryTree, child: Child, bounds: Bounds3, next: &mut (usize, usize)) -> usize {
    let inside = |inner: Bounds3| assert_eq!(bounds.union(inner), bounds);
    if child.is_leaf() {
        let (first, count) = child.run();
        assert_eq!(first, next.1);
        tree.references[first..first + count].iter().for_each(|r| inside(r.bounds()));
        next.1 += count;
        return 0;
    }
    assert_eq!(child.index(), next.0);
    next.0 += 1;
    let node = tree.nodes[child.index()];
    let below = [0, 1].map(|side| {
        inside(node.child_bounds(side));
        walk(tree, node.children[side], node.child_bounds(side), next)
    });
    1 + below[0].max(below[1])
}

/// Everything of the nodes that can differ.
pub(crate) fn bits(tree: &BinaryTree) -> Vec<String> {
    let ids = tree.references.iter().map(|r| format!("{:?}", r.ids()));
    tree.nodes.iter().map(|n| format!("{n:?}")).chain(ids).collect()
}
