//! Parts leaves that hold some of what is tested in blocks and some of what is tested one by one, so that each leaf is of one sort.

use super::binary::{BinaryTree, Child, MAX_DEPTH, Node};
use super::reference::Reference;
use kirkas_geometry::Bounds3;

/// The tree with no leaf of both sorts but those for which it has no level left.
pub(crate) fn part(mut tree: BinaryTree, is_blocked: &dyn Fn(&Reference) -> bool) -> BinaryTree {
    let Some(root) = tree.root else { return tree };
    let nodes = core::mem::take(&mut tree.nodes);
    let mut parting = Parting { nodes, is_blocked, references: tree.references, parted: Vec::new() };
    tree.root = Some(parting.subtree(root, 0));
    BinaryTree { nodes: parting.parted, references: parting.references, ..tree }
}

struct Parting<'a> {
    nodes: Vec<Node>,
    is_blocked: &'a dyn Fn(&Reference) -> bool,
    references: Vec<Reference>,
    parted: Vec<Node>,
}

impl Parting<'_> {
    /// A child of a node on this level, the first level being 1.
    fn subtree(&mut self, child: Child, levels_above: usize) -> Child {
        if child.is_leaf() {
            return self.leaf(child, levels_above);
        }
        let at = self.parted.len();
        let node = self.nodes[child.index()];
        self.parted.push(node);
        for side in 0..2 {
            self.parted[at].children[side] = self.subtree(node.children[side], levels_above + 1);
        }
        Child::node(at)
    }

    fn leaf(&mut self, leaf: Child, levels_above: usize) -> Child {
        let (first, count) = leaf.run();
        let run = &mut self.references[first..first + count];
        run.sort_by_key(|r| !(self.is_blocked)(r));
        let blocked = run.partition_point(|r| (self.is_blocked)(r));
        if blocked == 0 || blocked == count || levels_above == MAX_DEPTH {
            return leaf;
        }
        let around = |part: &[Reference]| part.iter().map(Reference::bounds).fold(Bounds3::EMPTY, Bounds3::union);
        let boxes = [around(&run[..blocked]), around(&run[blocked..])];
        let children = [Child::leaf(first, blocked), Child::leaf(first + blocked, count - blocked)];
        self.parted.push(Node::new([&boxes[0], &boxes[1]], children));
        Child::node(self.parted.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::binned_sah;
    use crate::build::costs::Costs;
    use crate::build::testing::random_boxes;

    #[test]
    fn each_leaf_is_of_one_sort_and_holds_what_it_held() {
        let is_blocked = |r: &Reference| !r.ids().1.is_multiple_of(3);
        let tree = binned_sah::build(random_boxes(5000, 1), &Costs::WIDE, &Serial);
        let before: Vec<_> = tree.references.iter().map(Reference::ids).collect();
        let parted = part(tree, &is_blocked);
        let leaves = || parted.nodes.iter().flat_map(|n| n.children).filter(|c| c.is_leaf());
        let run = |c: Child| &parted.references[c.run().0..c.run().0 + c.run().1];
        assert!(leaves().all(|c| run(c).iter().all(is_blocked) || !run(c).iter().any(is_blocked)));
        assert_eq!(leaves().map(|c| c.run().1).sum::<usize>(), 5000);
        // Nodes come before what is below them.
        assert!(parted.nodes.iter().enumerate().all(|(i, n)| n.children.iter().all(|c| c.is_leaf() || c.index() > i)));
        let mut after: Vec<_> = parted.references.iter().map(Reference::ids).collect();
        assert_ne!(before, after);
        let mut before = before;
        before.sort_unstable();
        after.sort_unstable();
        assert_eq!(before, after);
        for node in &parted.nodes {
            for (side, child) in node.children.iter().enumerate().filter(|(_, c)| c.is_leaf()) {
                let b = node.child_bounds(side);
                assert!(run(*child).iter().all(|r| b.union(r.bounds()) == b));
            }
        }
    }
}
