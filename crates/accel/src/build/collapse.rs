//! From a binary tree to one of eight children per node, at the least cost there is (Ylitie, Karras & Laine 2017, "Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3). Bottom up, each binary node learns what its
//! subtree costs when at most 1, 2, ... 7 wide children stand for it; top down, the choices are read off those costs.

use super::binary::{BinaryTree, Child, MAX_LEAF, Node};
use super::reference::Reference;
use crate::{Executor, memory};
use kirkas_geometry::Bounds3;

/// Children of a wide node.
pub(crate) const WIDTH: usize = 8;
/// Subtrees of more nodes than this are handed to the executor in two halves.
const FORK_ABOVE: usize = 1 << 11;

/// What a visit costs, per area of the box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Costs {
    /// A wide node.
    pub node: f32,
    /// A leaf that is a block of up to [`MAX_LEAF`] references.
    pub block: f32,
    /// Each reference of a leaf that is a list; with 0 every leaf is priced as a block.
    pub listed: f32,
}

impl Costs {
    #[inline(always)]
    fn leaf(&self, references: u32, is_list: bool) -> f32 {
        if is_list { self.listed * references as f32 } else { self.block }
    }
}

/// The least costs of a binary tree's nodes.
pub(crate) struct Collapse {
    entries: Vec<Entry>,
}

/// What the subtree of one inner node can be.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct Entry {
    /// `cost[i]`: the least cost as at most `i + 1` wide children.
    cost: [f32; WIDTH - 1],
    /// References below; the top bits say [`IS_LEAF`] and [`IS_LIST`].
    below: u32,
}

/// As one child, a leaf serves better than a wide node.
const IS_LEAF: u32 = 1 << 31;
/// As a leaf, a list.
const IS_LIST: u32 = 1 << 30;

impl Entry {
    #[inline(always)]
    fn references(&self) -> u32 {
        self.below & (IS_LIST - 1)
    }

    #[inline(always)]
    fn is_leaf(&self) -> bool {
        self.below & IS_LEAF != 0
    }
}

/// Which runs of references make a list; one that has a part that does, does.
pub(crate) type IsList<'a> = &'a (dyn Fn(&[Reference]) -> bool + Sync);

/// The wide children of a node.
#[derive(Clone, Copy)]
pub(crate) struct Children {
    items: [(Child, Bounds3); WIDTH],
    len: usize,
}

impl Children {
    fn push(&mut self, child: Child, bounds: Bounds3) {
        self.items[self.len] = (child, bounds);
        self.len += 1;
    }
}

impl core::ops::Deref for Children {
    type Target = [(Child, Bounds3)];

    fn deref(&self) -> &Self::Target {
        &self.items[..self.len]
    }
}

impl Collapse {
    /// Weigh all nodes. The result does not depend on the executor.
    pub fn new(tree: &BinaryTree, costs: Costs, is_list: IsList, executor: &dyn Executor) -> Self {
        let mut entries = memory::filled(Entry::default(), tree.nodes.len());
        let weighing = Weighing { references: &tree.references, costs, is_list, executor };
        weighing.subtree(&tree.nodes, 0, &mut entries);
        Collapse { entries }
    }

    /// References below a node.
    pub fn references(&self, node: Child) -> usize {
        self.entries[node.index()].references() as usize
    }

    /// Cost of the whole wide tree, times half the area of boxes; for tests to compare trees by.
    #[cfg(test)]
    pub fn cost(&self) -> f32 {
        self.entries.first().map_or(0.0, |e| e.cost[0])
    }

    /// What the wide tree begins with: a leaf, or a binary node to ask the children of.
    pub fn root(&self, tree: &BinaryTree) -> Option<Child> {
        tree.root.map(|root| self.as_one(tree, root))
    }

    /// The wide children of an inner binary node, in the order of their references: each a leaf, or an inner binary node
    /// that becomes a wide one. At least 2, at most [`WIDTH`].
    pub fn children(&self, tree: &BinaryTree, node: Child) -> Children {
        let mut out = Children { items: [(Child::node(0), Bounds3::EMPTY); WIDTH], len: 0 };
        self.open(tree, node, WIDTH, &mut out);
        out
    }

    /// Add at most `count` wide children that stand for what is below `node`.
    fn open(&self, tree: &BinaryTree, node: Child, count: usize, out: &mut Children) {
        let node = &tree.nodes[node.index()];
        let [left, right] = node.children;
        let cost = |child: Child, count: usize| match child.is_leaf() {
            true => 0.0,
            false => self.entries[child.index()].cost[count - 1],
        };
        let mut best = (f32::INFINITY, 1);
        for on_left in 1..count {
            let sum = cost(left, on_left) + cost(right, count - on_left);
            if sum < best.0 {
                best = (sum, on_left);
            }
        }
        for (side, child, count) in [(0, left, best.1), (1, right, count - best.1)] {
            match self.fewest(child, count) {
                1 => out.push(self.as_one(tree, child), node.child_bounds(side)),
                fewest => self.open(tree, child, fewest, out),
            }
        }
    }

    /// The least number of wide children that is as good as `count`.
    fn fewest(&self, child: Child, count: usize) -> usize {
        if child.is_leaf() {
            return 1;
        }
        let cost = &self.entries[child.index()].cost;
        (1..count).find(|i| cost[i - 1] == cost[count - 1]).unwrap_or(count)
    }

    fn as_one(&self, tree: &BinaryTree, child: Child) -> Child {
        if child.is_leaf() || !self.entries[child.index()].is_leaf() {
            return child;
        }
        // The runs of a subtree follow one another.
        let count = self.references(child);
        let mut first = child;
        while !first.is_leaf() {
            first = tree.nodes[first.index()].children[0];
        }
        Child::leaf(first.run().0, count)
    }
}

struct Weighing<'a> {
    references: &'a [Reference],
    costs: Costs,
    is_list: IsList<'a>,
    executor: &'a dyn Executor,
}

impl Weighing<'_> {
    /// Weigh the nodes of one subtree, which is all of `nodes`; the first is node `base` of the tree.
    fn subtree(&self, nodes: &[Node], base: usize, entries: &mut [Entry]) {
        if nodes.len() > FORK_ABOVE {
            let [left, right] = nodes[0].children;
            // Depth first: the left subtree follows its parent, the right one ends with it.
            let middle = if right.is_leaf() { nodes.len() } else { right.index() - base };
            debug_assert!(left.is_leaf() || left.index() == base + 1);
            let (own, below) = entries.split_at_mut(1);
            let (on_left, on_right) = below.split_at_mut(middle - 1);
            self.executor.join(&mut || self.subtree(&nodes[1..middle], base + 1, on_left), &mut || {
                self.subtree(&nodes[middle..], base + middle, on_right)
            });
            own[0] = self.weigh(&nodes[0], base + 1, below);
            return;
        }
        for i in (0..nodes.len()).rev() {
            entries[i] = self.weigh(&nodes[i], base, entries);
        }
    }

    /// The entry of a node whose children have theirs; the first of `entries` is that of node `base`.
    #[inline(always)]
    fn weigh(&self, node: &Node, base: usize, entries: &[Entry]) -> Entry {
        let costs = &self.costs;
        let [left, right] = [0, 1].map(|side| match node.children[side] {
            leaf if leaf.is_leaf() => {
                let (first, count) = leaf.run();
                let is_list = (self.is_list)(&self.references[first..first + count]);
                let cost = [half_area(node, side) * costs.leaf(count as u32, is_list); WIDTH - 1];
                Entry { cost, below: count as u32 | IS_LEAF | if is_list { IS_LIST } else { 0 } }
            }
            inner => entries[inner.index() - base],
        });
        // `sums[i]`: as exactly two groups that share `i + 2` children.
        let mut sums = [f32::INFINITY; WIDTH - 1];
        for (i, sum) in sums.iter_mut().enumerate() {
            for k in 0..=i {
                *sum = least(*sum, left.cost[k] + right.cost[i - k]);
            }
        }
        let area = half_area_around(node);
        let (references, list) = (left.references() + right.references(), (left.below | right.below) & IS_LIST);
        let fits = references as usize <= MAX_LEAF;
        let as_node = area * costs.node + sums[WIDTH - 2];
        let as_leaf = if fits { area * costs.leaf(references, list != 0) } else { f32::INFINITY };
        let mut cost = [least(as_leaf, as_node); WIDTH - 1];
        for i in 1..WIDTH - 1 {
            cost[i] = least(sums[i - 1], cost[i - 1]);
        }
        Entry { cost, below: references | list | if fits && as_leaf <= as_node { IS_LEAF } else { 0 } }
    }
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn half_area(node: &Node, side: usize) -> f32 {
    product_sum([0, 1, 2].map(|k| node.planes[k][1][side] - node.planes[k][0][side]))
}

/// Of the box around both children.
#[inline(always)]
fn half_area_around(node: &Node) -> f32 {
    product_sum([0, 1, 2].map(|k| {
        let [[low_a, low_b], [high_a, high_b]] = node.planes[k];
        let low = if low_a < low_b { low_a } else { low_b };
        let high = if high_a > high_b { high_a } else { high_b };
        high - low
    }))
}

/// Sizes are capped so that the product stays finite.
#[inline(always)]
fn product_sum(size: [f32; 3]) -> f32 {
    let [x, y, z] = size.map(|s| least(s, 1e18));
    x * y + (y + x) * z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::binned_sah;
    use crate::build::costs::Costs as SplitCosts;
    use crate::build::reference::Reference;
    use crate::build::testing::{Backwards, random_boxes};

    const COSTS: Costs = Costs { node: 1.0, block: 0.7, listed: 0.2 };

    /// Every other run of references, by its first.
    fn is_list(run: &[Reference]) -> bool {
        run.iter().any(|r| r.ids().1 % 8 == 0)
    }

    fn leaf_cost(tree: &BinaryTree, costs: Costs, (first, count): (usize, usize)) -> f64 {
        let is_list = is_list(&tree.references[first..first + count]);
        f64::from(if is_list { costs.listed * count as f32 } else { costs.block })
    }

    fn tree(count: usize, seed: u64) -> BinaryTree {
        binned_sah::build(random_boxes(count, seed), &SplitCosts::BVH2, &Serial)
    }

    fn area(b: Bounds3) -> f64 {
        f64::from(b.surface_area())
    }

    fn whole(tree: &BinaryTree) -> Bounds3 {
        tree.references.iter().map(Reference::bounds).reduce(Bounds3::union).unwrap()
    }

    type Below<'a> = &'a dyn Fn(Child) -> Vec<(Child, Bounds3)>;

    /// The cost of the wide tree that `children` describes, and the references in its order.
    fn walk(tree: &BinaryTree, root: Child, bounds: Bounds3, costs: Costs, children: Below) -> (f64, Vec<usize>) {
        if root.is_leaf() {
            let (first, count) = root.run();
            return (area(bounds) * leaf_cost(tree, costs, root.run()), (first..first + count).collect());
        }
        let below = children(root);
        assert!((2..=WIDTH).contains(&below.len()));
        let mut sum = (area(bounds) * f64::from(costs.node), Vec::new());
        for (child, inner) in below {
            assert_eq!(bounds.union(inner), bounds);
            let (cost, references) = walk(tree, child, inner, costs, children);
            sum.0 += cost;
            sum.1.extend(references);
        }
        sum
    }

    fn collapsed(tree: &BinaryTree, costs: Costs) -> (f64, Vec<usize>) {
        let collapse = Collapse::new(tree, costs, &is_list, &Serial);
        let children = |node: Child| collapse.children(tree, node).to_vec();
        walk(tree, collapse.root(tree).unwrap(), whole(tree), costs, &children)
    }

    /// The simple twin: what fits a leaf is one; the child of the largest box is opened while there is room.
    fn greedy(tree: &BinaryTree, costs: Costs) -> (f64, Vec<usize>) {
        let as_one = |child: Child| match runs(tree, child) {
            (first, count) if count <= MAX_LEAF => Child::leaf(first, count),
            _ => child,
        };
        let opened = |child: Child| {
            let node = tree.nodes[child.index()];
            [0, 1].map(|side| (as_one(node.children[side]), node.child_bounds(side)))
        };
        let children = |node: Child| {
            let mut out = opened(node).to_vec();
            while out.len() < WIDTH {
                let inner = (0..out.len()).filter(|i| !out[*i].0.is_leaf());
                let Some(largest) = inner.max_by(|a, b| area(out[*a].1).total_cmp(&area(out[*b].1))) else { break };
                let two = opened(out[largest].0);
                out.splice(largest..=largest, two);
            }
            out
        };
        walk(tree, as_one(tree.root.unwrap()), whole(tree), costs, &children)
    }

    /// First reference below, and how many there are.
    fn runs(tree: &BinaryTree, child: Child) -> (usize, usize) {
        if child.is_leaf() {
            return child.run();
        }
        let [a, b] = tree.nodes[child.index()].children.map(|c| runs(tree, c));
        assert_eq!(a.0 + a.1, b.0);
        (a.0, a.1 + b.1)
    }

    /// The least cost of all ways to make each inner node a wide one, a part of the one above, or a leaf.
    fn least_of_all(tree: &BinaryTree, costs: Costs) -> f64 {
        let count = tree.nodes.len() as u32;
        (0..3_usize.pow(count)).filter_map(|way| cost_of_way(tree, costs, way)).fold(f64::INFINITY, f64::min)
    }

    fn cost_of_way(tree: &BinaryTree, costs: Costs, way: usize) -> Option<f64> {
        let role = |child: Child| way / 3_usize.pow(child.index() as u32) % 3;
        // Adds to the children of the wide node above; returns the cost.
        fn visit(
            tree: &BinaryTree,
            child: Child,
            bounds: Bounds3,
            costs: Costs,
            role: &dyn Fn(Child) -> usize,
            above: &mut usize,
        ) -> Option<f64> {
            let as_leaf = child.is_leaf() || role(child) == 2;
            if as_leaf {
                *above += 1;
                let run = runs(tree, child);
                return (run.1 <= MAX_LEAF).then(|| area(bounds) * leaf_cost(tree, costs, run));
            }
            let node = tree.nodes[child.index()];
            let below = |count: &mut usize| {
                let a = visit(tree, node.children[0], node.child_bounds(0), costs, role, count)?;
                Some(a + visit(tree, node.children[1], node.child_bounds(1), costs, role, count)?)
            };
            if role(child) == 1 {
                return below(above);
            }
            *above += 1;
            let mut count = 0;
            let cost = below(&mut count)? + area(bounds) * f64::from(costs.node);
            (count <= WIDTH).then_some(cost)
        }
        let mut roots = 0;
        let cost = visit(tree, tree.root?, whole(tree), costs, &role, &mut roots)?;
        (roots == 1).then_some(cost)
    }

    #[test]
    fn no_way_to_collapse_a_small_tree_costs_less() {
        let mut tried = 0;
        for seed in 0..60 {
            let tree = tree(3 + seed as usize / 2, seed);
            if tree.nodes.len() > 10 {
                continue;
            }
            let few_lists = Costs { node: 0.3, block: 1.0, listed: 1.0 };
            for costs in [COSTS, few_lists, Costs { node: 1.0, block: 0.1, listed: 0.1 }] {
                let (least, found) = (least_of_all(&tree, costs), collapsed(&tree, costs).0);
                assert!((found - least).abs() < 1e-5 * least, "{found} against {least} with {costs:?}");
                tried += 1;
            }
        }
        assert!(tried > 60);
    }

    #[test]
    fn each_reference_is_kept_once_and_greed_costs_more() {
        for count in [1, 2, 8, 9, 70, 3000] {
            let tree = tree(count, 7);
            let ((cost, references), (greedy, all)) = (collapsed(&tree, COSTS), greedy(&tree, COSTS));
            assert_eq!(references, (0..count).collect::<Vec<_>>());
            assert_eq!(all, references);
            assert!(cost <= greedy * (1.0 + 1e-5), "{cost} against {greedy}");
            assert!(count < 3000 || cost < greedy * 0.97, "{cost} against {greedy}");
        }
    }

    #[test]
    fn boxes_without_area_or_of_absurd_size_collapse() {
        for scale in [0.0, 1e-30, 1e37] {
            let mut references = random_boxes(500, 3);
            for r in &mut references {
                let b = r.bounds();
                *r = Reference::new(&Bounds3 { min: b.min * scale, max: b.max * scale }, r.ids().0, r.ids().1);
            }
            let (_, references) = collapsed(&binned_sah::build(references, &SplitCosts::BVH2, &Serial), COSTS);
            assert_eq!(references, (0..500).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_executor_does_not_show() {
        let tree = tree(60_000, 11);
        assert!(tree.nodes.len() > 2 * FORK_ABOVE);
        let [a, b]: [&dyn Executor; 2] = [&Serial, &Backwards];
        let [a, b] = [a, b].map(|e| Collapse::new(&tree, COSTS, &is_list, e).entries);
        let bits = |e: &Entry| (e.cost.map(f32::to_bits), e.below);
        assert!(a.iter().map(bits).eq(b.iter().map(bits)));
    }

    #[test]
    fn nothing_collapses_to_nothing() {
        let tree = binned_sah::build(Vec::new(), &SplitCosts::BVH2, &Serial);
        assert!(Collapse::new(&tree, COSTS, &is_list, &Serial).root(&tree).is_none());
    }
}
