//! The tree over the roots of all groves.

use crate::Executor;
use crate::build::binary::{BinaryTree, Child};
use crate::build::binned_sah;
use crate::build::costs::Costs;
use crate::build::layout::{Grove, Part};
use crate::build::reference::Reference;
use crate::build::reinsertion::{self, Effort};

/// Each cluster is a leaf.
const CLUSTERS: Costs = Costs { block: 1, leaf: 1.0, node: 1.0, max_leaf: 1 };

/// Split by the surface-area heuristic, or halve along the curve where that takes more than `room` levels.
pub(super) fn over(groves: &[Grove], roots: &[(usize, u32)], room: usize, executor: &dyn Executor) -> Part {
    let part = |&(grove, root): &(usize, u32)| Part::cluster(groves, grove, root);
    let reference = |(i, root): (usize, &(usize, u32))| Reference::new(&part(root).around.to_bounds(), 0, i as u32);
    let tree = binned_sah::build(roots.iter().enumerate().map(reference).collect(), &CLUSTERS, executor);
    let tree = reinsertion::improve(tree, Effort::QUICK, executor);
    let top = of_tree(&tree, tree.root.expect("groves have roots"), &|i| part(&roots[i]));
    if top.levels <= room { top } else { halves(roots, &part) }
}

fn of_tree(tree: &BinaryTree, child: Child, part: &dyn Fn(usize) -> Part) -> Part {
    if child.is_leaf() {
        return part(tree.references[child.run().0].ids().1 as usize);
    }
    let [a, b] = tree.nodes[child.index()].children;
    Part::pair(of_tree(tree, a, part), of_tree(tree, b, part))
}

fn halves(roots: &[(usize, u32)], part: &dyn Fn(&(usize, u32)) -> Part) -> Part {
    match roots {
        [one] => part(one),
        more => {
            let (a, b) = more.split_at(more.len() / 2);
            Part::pair(halves(a, part), halves(b, part))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::morton::plant;
    use crate::build::testing::random_boxes;

    #[test]
    fn where_the_heuristic_runs_too_deep_the_roots_are_halved() {
        let (groves, roots) = plant(&random_boxes(30_000, 4), &Serial);
        let least = roots.len().next_power_of_two().ilog2() as usize;
        let [free, tight] = [100, least].map(|room| over(&groves, &roots, room, &Serial));
        assert!(free.levels > least);
        assert_eq!(tight.levels, least);
        assert_eq!((tight.references, tight.leaves), (free.references, free.leaves));
    }
}
