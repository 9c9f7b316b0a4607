//! `morton`: a tree in a few passes over the primitives, for scenes that move.
//!
//! The centers are sorted along a Morton curve (Lauterbach et al. 2009, "Fast BVH Construction on GPUs"), whose blocks of at
//! most a leafful become leaves. Neighbouring leaves are merged until an eighth is left (Meister & Bittner 2018, "Parallel
//! Locally-Ordered Clustering for Bounding Volume Hierarchy Construction"); over those the surface-area heuristic decides.

mod clusters;
mod codes;
mod leaves;
mod top;

use super::binary::{BinaryTree, MAX_DEPTH};
use super::layout::{self, Grove};
use super::parallel::for_each;
use super::reference::Reference;
use crate::Executor;

/// About how many references a grove spans.
const GROVE: usize = 1 << 13;

/// The tree over `references`.
pub(crate) fn build(references: Vec<Reference>, executor: &dyn Executor) -> BinaryTree {
    if references.is_empty() {
        return BinaryTree { nodes: Vec::new(), root: None, references };
    }
    let (groves, roots) = plant(&references, executor);
    let top = top::over(&groves, &roots, MAX_DEPTH - clusters::MAX_ROUNDS, executor);
    layout::lay_out(&references, &groves, &top, executor)
}

/// Groves over all references, and their roots: grove and cluster.
fn plant(references: &[Reference], executor: &dyn Executor) -> (Vec<Grove>, Vec<(usize, u32)>) {
    let keys = codes::sorted(references, executor);
    let mut grown: Vec<_> = leaves::cuts(&keys, GROVE).into_iter().map(|range| (range, None)).collect();
    for_each(&mut grown, executor, &|(range, grown)| *grown = Some(clusters::grow(&keys, range.clone(), references)));
    let (mut groves, mut all_roots) = (Vec::new(), Vec::new());
    for (i, (grove, roots)) in grown.into_iter().filter_map(|g| g.1).enumerate() {
        groves.push(grove);
        all_roots.extend(roots.into_iter().map(|root| (i, root)));
    }
    (groves, all_roots)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::testing::{Backwards, assert_sound, bits, random_boxes};
    use kirkas_geometry::{Bounds3, Vec3};

    fn boxes(count: usize, of: impl Fn(usize) -> (Vec3, f32)) -> Vec<Reference> {
        let reference = |i: usize| {
            let (low, size) = of(i);
            Reference::new(&Bounds3 { min: low, max: low + size }, 0, i as u32)
        };
        (0..count).map(reference).collect()
    }

    #[test]
    fn every_reference_is_in_one_leaf_and_every_box_around_what_is_below() {
        for count in [0, 1, 2, 8, 9, 17, 1000, 100_000] {
            let references = random_boxes(count, 5);
            assert_sound(&build(references.clone(), &Serial), &references);
        }
    }

    #[test]
    fn the_executor_does_not_show() {
        let references = random_boxes(5 * GROVE, 8);
        let [serial, threads] = [&Serial as &dyn Executor, &Backwards].map(|e| build(references.clone(), e));
        assert!(bits(&serial) == bits(&threads));
    }

    #[test]
    fn coincident_centers_and_absurd_sizes_build() {
        let same = boxes(3000, |_| (Vec3::ONE, 1.0));
        // Around one center, each twice as large as the one before.
        let nested = boxes(200, |i| (-Vec3::splat(2_f32.powi(i as i32 - 100)), 2_f32.powi(i as i32 - 99)));
        // Each twice as far as the one before, all but the last few in one cell, whatever the grid.
        let apart = boxes(240, |i| (Vec3::X * 2_f32.powi(i as i32 - 120), 0.0));
        let huge = boxes(300, |i| (Vec3::splat(if i % 2 == 0 { -3.4e38 } else { 3.3e38 }), i as f32 * 1e35));
        let points = boxes(300, |i| (Vec3::Y * (i / 100) as f32, 0.0));
        for references in [same, nested, apart, huge, points] {
            assert_sound(&build(references.clone(), &Serial), &references);
        }
    }

    /// Of few cells that hold nearly all, each is sorted again.
    #[test]
    fn a_small_dense_thing_in_a_large_scene_is_sorted_finely() {
        let mut references = random_boxes(2000, 2);
        references.push(boxes(1, |_| (Vec3::splat(1e5), 1.0))[0]);
        let tree = build(references.clone(), &Serial);
        assert_sound(&tree, &references);
        let near = build(references[..2000].to_vec(), &Serial);
        let area = |tree: &BinaryTree| {
            let of = |n: &crate::build::binary::Node| [0, 1].map(|side| n.child_bounds(side).surface_area());
            tree.nodes.iter().flat_map(of).filter(|a| *a < 10.0).sum::<f32>()
        };
        assert!(area(&tree) < 1.1 * area(&near), "{} against {}", area(&tree), area(&near));
    }

    #[test]
    fn the_tree_is_nearly_as_good_as_the_binned_one() {
        let references = random_boxes(20_000, 9);
        let cost = |tree: BinaryTree| {
            use crate::build::collapse::{Collapse, Costs};
            let costs = Costs { node: 1.0, block: 1.0, listed: 1.0 };
            Collapse::new(&tree, costs, &|_| false, &Serial).cost()
        };
        let fast = cost(build(references.clone(), &Serial));
        let good = cost(crate::build::binned_sah::build(references, &crate::build::costs::Costs::BVH2, &Serial));
        assert!(fast < 1.2 * good, "{fast} against {good}");
    }
}
