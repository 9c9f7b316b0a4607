//! Betters a tree: the largest subtrees are taken out and put back where the boxes grow least (Meister & Bittner 2018,
//! "Parallel Reinsertion for Bounding Volume Hierarchy Optimization"). Places are searched at once; the moves are made one
//! after the other, each only if by then it still lessens the area of all boxes, so that the tree never gets worse.

use super::binary::{BinaryTree, Child, MAX_DEPTH};
use super::layout::{Cluster, Grove, Part, lay_out};
use super::parallel::for_each;
use super::reference::{Box4, Reference};
use crate::Executor;

/// How much work is put in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Times that all is searched and moved, unless nothing moves any more.
    pub rounds: usize,
    /// So many of the boxes, the largest, are searched a better place for,
    pub at_least: usize,
    /// and of each this many one more.
    pub one_in: usize,
}

impl Effort {
    /// For a tree to be kept: about 0.2 microseconds per primitive.
    pub const BEST: Effort = Effort { rounds: 4, at_least: 2000, one_in: 20 };
    /// For a tree that will be gone by the next picture.
    pub const QUICK: Effort = Effort { rounds: 2, at_least: 1000, one_in: 100 };
}

/// Boxes that a search for one place may look at.
const MAX_LOOKS: usize = 1000;
/// Searches that a job makes.
const CHUNK: usize = 256;

/// A tree over the same leaves with boxes of less area. The result does not depend on the executor.
pub(crate) fn improve(tree: BinaryTree, effort: Effort, executor: &dyn Executor) -> BinaryTree {
    let Some(root) = tree.root.filter(|root| !root.is_leaf()) else { return tree };
    let mut links = Links::new(&tree, root);
    let mut has_moved = false;
    for _ in 0..effort.rounds {
        let mut jobs: Vec<(Vec<u32>, Vec<Move>)> =
            links.largest(effort).chunks(CHUNK).map(|c| (c.to_vec(), Vec::new())).collect();
        for_each(&mut jobs, executor, &|(taken, moves)| {
            let mut todo = Vec::new();
            moves.extend(taken.iter().filter_map(|&taken| links.search(taken, &mut todo)));
        });
        let mut moves: Vec<Move> = jobs.into_iter().flat_map(|job| job.1).collect();
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.taken.cmp(&b.taken)));
        if moves.into_iter().filter(|m| links.make(m)).count() == 0 {
            break;
        }
        has_moved = true;
    }
    if has_moved { links.into_tree(&tree.references, executor) } else { tree }
}

/// A binary tree that can be walked upwards. Inner nodes come first, with the root as number 0; then the leaves.
struct Links {
    boxes: Vec<Box4>,
    /// Of inner nodes.
    children: Vec<[u32; 2]>,
    /// The root is its own.
    parents: Vec<u32>,
    /// Levels of inner nodes at and below.
    levels: Vec<u8>,
    /// Of leaves: first reference and how many.
    runs: Vec<(u32, u32)>,
}

/// A subtree put beside another.
struct Move {
    taken: u32,
    beside: u32,
    gain: f32,
}

impl Links {
    fn new(tree: &BinaryTree, root: Child) -> Self {
        let (inner, all) = (tree.nodes.len(), 2 * tree.nodes.len() + 1);
        assert_eq!(root.index(), 0);
        let mut links = Links {
            boxes: vec![Box4::EMPTY; all],
            children: Vec::with_capacity(inner),
            parents: vec![0; all],
            levels: vec![0; all],
            runs: Vec::with_capacity(inner + 1),
        };
        for (i, node) in tree.nodes.iter().enumerate() {
            let children = [0, 1].map(|side| {
                let child = node.children[side];
                let number = if child.is_leaf() { inner + links.runs.len() } else { child.index() };
                if child.is_leaf() {
                    let (first, count) = child.run();
                    links.runs.push((first as u32, count as u32));
                }
                links.boxes[number] = Reference::new(&node.child_bounds(side), 0, 0).0;
                links.parents[number] = i as u32;
                number as u32
            });
            links.children.push(children);
        }
        for i in (0..inner).rev() {
            links.refit_one(i);
        }
        links
    }

    fn is_inner(&self, i: usize) -> bool {
        i < self.children.len()
    }

    fn parent(&self, i: usize) -> usize {
        self.parents[i] as usize
    }

    fn sibling(&self, i: usize) -> usize {
        let [a, b] = self.children[self.parent(i)];
        if a as usize == i { b as usize } else { a as usize }
    }

    fn refit_one(&mut self, i: usize) {
        let [a, b] = self.children[i].map(|c| c as usize);
        self.boxes[i] = self.boxes[a].union(self.boxes[b]);
        self.levels[i] = 1 + self.levels[a].max(self.levels[b]);
    }

    /// The largest of all boxes that have a grandparent.
    fn largest(&self, effort: Effort) -> Vec<u32> {
        let has_grandparent = |i: &usize| self.parents[*i] != 0;
        let key = |i: usize| (!self.boxes[i].half_area().to_bits(), i as u32);
        let mut sized: Vec<(u32, u32)> = (1..self.boxes.len()).filter(has_grandparent).map(key).collect();
        let count = effort.at_least + sized.len() / effort.one_in;
        if count < sized.len() {
            sized.select_nth_unstable(count);
            sized.truncate(count);
        }
        sized.sort_unstable();
        sized.into_iter().map(|s| s.1).collect()
    }

    /// The best place for the subtree at `taken`, if there is a better one. Walks up from where it is and, on the way, down
    /// into each other branch as far as that can pay.
    fn search(&self, taken: u32, todo: &mut Vec<(f32, u32)>) -> Option<Move> {
        let own = self.boxes[taken as usize];
        let own_area = own.half_area();
        let parent = self.parent(taken as usize);
        let mut best = Move { taken, beside: 0, gain: 0.0 };
        // What the boxes up to the one that holds `taken` and the branch lose when `taken` is taken out.
        let mut saved = self.boxes[parent].half_area();
        let mut left_behind = Box4::EMPTY;
        let mut from = taken as usize;
        let mut looks = 0;
        loop {
            let (up, branch) = (self.parent(from), self.sibling(from));
            todo.clear();
            todo.push((saved, branch as u32));
            while let Some((saved, at)) = todo.pop() {
                // At best nothing grows but the new box, which is no smaller than what is in it.
                if saved - own_area <= best.gain || looks == MAX_LOOKS {
                    break;
                }
                looks += 1;
                let here = self.boxes[at as usize];
                let gain = saved - here.union(own).half_area();
                if gain > best.gain {
                    best = Move { taken, beside: at, gain };
                }
                let saved = gain + here.half_area();
                if self.is_inner(at as usize) && saved - own_area > best.gain {
                    todo.extend(self.children[at as usize].map(|child| (saved, child)));
                }
            }
            if up == 0 || looks == MAX_LOOKS {
                break;
            }
            left_behind = left_behind.union(self.boxes[branch]);
            if up != parent {
                let before = self.boxes[up].half_area();
                saved += before - left_behind.half_area();
                if saved - before > best.gain {
                    best = Move { taken, beside: up as u32, gain: saved - before };
                }
            }
            from = up;
        }
        (best.gain > 0.0).then_some(best)
    }

    /// Make a move if it is still possible and worth it.
    fn make(&mut self, m: &Move) -> bool {
        let (taken, beside) = (m.taken as usize, m.beside as usize);
        let (parent, sibling) = (self.parent(taken), self.sibling(taken));
        if parent == 0 || beside == 0 || beside == parent || beside == sibling || self.is_within(beside, taken) {
            return false;
        }
        let change = self.take_out(taken) + self.put_beside(taken, beside);
        if change < 0.0 && usize::from(self.levels[0]) <= MAX_DEPTH {
            return true;
        }
        self.take_out(taken);
        self.put_beside(taken, sibling);
        false
    }

    fn is_within(&self, mut i: usize, subtree: usize) -> bool {
        while i != 0 && i != subtree {
            i = self.parent(i);
        }
        i == subtree
    }

    /// Take a subtree and its parent out, which leaves its sibling in their place; returns by how much the boxes grow.
    fn take_out(&mut self, taken: usize) -> f64 {
        let (parent, sibling) = (self.parent(taken), self.sibling(taken));
        let above = self.parent(parent);
        self.replace(above, parent, sibling);
        self.refit(above) - f64::from(self.boxes[parent].half_area())
    }

    /// Put a subtree back, with its parent, which becomes that of `beside` as well; returns by how much the boxes grow.
    fn put_beside(&mut self, taken: usize, beside: usize) -> f64 {
        let (parent, above) = (self.parent(taken), self.parent(beside));
        self.replace(above, beside, parent);
        self.children[parent] = [beside as u32, taken as u32];
        self.parents[beside] = parent as u32;
        self.refit_one(parent);
        self.refit(above) + f64::from(self.boxes[parent].half_area())
    }

    fn replace(&mut self, parent: usize, child: usize, by: usize) {
        let slot = usize::from(self.children[parent][1] as usize == child);
        self.children[parent][slot] = by as u32;
        self.parents[by] = parent as u32;
    }

    /// Refit a node and those above; returns by how much their boxes grow.
    fn refit(&mut self, mut i: usize) -> f64 {
        let mut change = 0.0;
        loop {
            let before = self.boxes[i].half_area();
            self.refit_one(i);
            let after = self.boxes[i].half_area();
            change += f64::from(after) - f64::from(before);
            if i == 0 {
                return change;
            }
            i = self.parent(i);
        }
    }

    fn into_tree(self, references: &[Reference], executor: &dyn Executor) -> BinaryTree {
        let inner = self.children.len();
        let mut clusters = Vec::with_capacity(self.boxes.len());
        for (i, &around) in self.boxes.iter().enumerate() {
            clusters.push(match i.checked_sub(inner) {
                None => Cluster { around, parts: self.children[i], references: 0, leaves: 0 },
                Some(leaf) => {
                    let (first, count) = self.runs[leaf];
                    Cluster { around, parts: [first, first + count], references: count, leaves: 1 }
                }
            });
        }
        // Count from below: in a list of all inner nodes with parents first, backwards.
        let mut list = vec![0_u32];
        let mut at = 0;
        while at < list.len() {
            list.extend(self.children[list[at] as usize].iter().filter(|&&c| self.is_inner(c as usize)));
            at += 1;
        }
        for &i in list.iter().rev() {
            let [a, b] = self.children[i as usize].map(|c| clusters[c as usize]);
            let c = &mut clusters[i as usize];
            (c.references, c.leaves) = (a.references + b.references, a.leaves + b.leaves);
        }
        let groves = [Grove { order: (0..references.len() as u32).collect(), clusters }];
        lay_out(references, &groves, &Part::cluster(&groves, 0, 0), executor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::costs::Costs;
    use crate::build::testing::{Backwards, assert_sound, bits, random_boxes};
    use crate::build::{binned_sah, morton};
    use kirkas_geometry::{Bounds3, Vec3};

    /// Halved by order: a poor tree.
    fn halved(references: Vec<Reference>) -> BinaryTree {
        fn visit(references: &[Reference], first: usize, nodes: &mut Vec<crate::build::binary::Node>) -> Child {
            if references.len() == 1 {
                return Child::leaf(first, 1);
            }
            let (a, b) = references.split_at(references.len() / 2);
            let around = |r: &[Reference]| r.iter().map(Reference::bounds).fold(Bounds3::EMPTY, Bounds3::union);
            let (at, boxes) = (nodes.len(), [around(a), around(b)]);
            nodes.push(crate::build::binary::Node::new([&boxes[0], &boxes[1]], [Child::node(0); 2]));
            let children = [visit(a, first, nodes), visit(b, first + a.len(), nodes)];
            nodes[at].children = children;
            Child::node(at)
        }
        let mut nodes = Vec::new();
        let root = Some(visit(&references, 0, &mut nodes));
        BinaryTree { nodes, root, references }
    }

    fn area(tree: &BinaryTree) -> f64 {
        let of = |n: &crate::build::binary::Node| [0, 1].map(|side| f64::from(n.child_bounds(side).surface_area()));
        tree.nodes.iter().flat_map(of).sum()
    }

    const ALL: Effort = Effort { rounds: 8, at_least: 0, one_in: 1 };

    #[test]
    fn trees_stay_sound_and_never_get_worse() {
        let sorted = |references, kind: usize| match kind {
            0 => halved(references),
            1 => binned_sah::build(references, &Costs::BVH2, &Serial),
            _ => morton::build(references, &Serial),
        };
        for (kind, gain) in [(0, 0.5), (1, 0.999), (2, 0.999)] {
            for count in [1, 2, 3, 9, 40, 5000] {
                let references = random_boxes(count, 6);
                let tree = sorted(references.clone(), kind);
                let before = area(&tree);
                let after = improve(tree, ALL, &Serial);
                assert_sound(&after, &references);
                assert!(area(&after) <= before);
                assert!(count < 5000 || area(&after) < gain * before, "{} of {before}", area(&after));
            }
        }
    }

    #[test]
    fn a_search_finds_the_best_of_all_places() {
        let tree = halved(random_boxes(40, 12));
        let links = || Links::new(&tree, Child::node(0));
        let total = |l: &Links| l.boxes[..l.children.len()].iter().map(|b| f64::from(b.half_area())).sum::<f64>();
        let before = total(&links());
        let mut found = 0;
        for taken in (1..2 * 39 + 1).filter(|&i| links().parents[i] != 0) {
            let tried = |beside: usize| {
                let mut l = links();
                let is_made = l.make(&Move { taken: taken as u32, beside: beside as u32, gain: 0.0 });
                if is_made { before - total(&l) } else { 0.0 }
            };
            let best = (1..2 * 39 + 1).map(tried).fold(0.0, f64::max);
            let gain = links().search(taken as u32, &mut Vec::new()).map_or(0.0, |m| f64::from(m.gain));
            assert!((gain - best).abs() < 1e-5 * before, "{taken}: {gain} against {best}");
            found += usize::from(gain > 0.0);
        }
        assert!(found > 20);
    }

    #[test]
    fn a_move_that_does_not_pay_is_undone() {
        let tree = binned_sah::build(random_boxes(300, 3), &Costs::BVH2, &Serial);
        let mut links = Links::new(&tree, Child::node(0));
        let shape = |l: &Links| (l.parents.clone(), l.levels.clone(), format!("{:?}", l.boxes));
        let before = shape(&links);
        let mut refused = 0;
        for taken in 1..60 {
            let beside = links.boxes.len() as u32 - taken;
            if !links.make(&Move { taken, beside, gain: 1.0 }) {
                refused += 1;
                assert!(shape(&links) == before);
            } else {
                links = Links::new(&tree, Child::node(0));
            }
        }
        assert!(refused > 40);
    }

    #[test]
    fn the_executor_does_not_show() {
        let tree = || halved(random_boxes(20_000, 1));
        let effort = Effort { rounds: 2, at_least: 1000, one_in: 10 };
        let [serial, threads] = [&Serial as &dyn Executor, &Backwards].map(|e| improve(tree(), effort, e));
        assert!(bits(&serial) == bits(&threads));
    }

    /// Boxes each around the one before, of which the best tree is a chain.
    #[test]
    fn no_move_makes_a_tree_too_deep() {
        let cube = |i: i32| Bounds3 { min: Vec3::splat(-1.1_f32.powi(i)), max: Vec3::splat(1.1_f32.powi(i)) };
        let references: Vec<_> = (0..200).map(|i| Reference::new(&cube((i * 67) % 200), 0, i as u32)).collect();
        let after = improve(halved(references.clone()), Effort { rounds: 100, ..ALL }, &Serial);
        let deep = Links::new(&after, Child::node(0)).levels[0];
        assert!(deep > 30, "{deep}");
        assert_sound(&after, &references);
    }

    #[test]
    fn coincident_and_absurd_boxes_are_left_or_bettered() {
        let of = |b: Bounds3| (0..100).map(|i| Reference::new(&b, 0, i)).collect::<Vec<_>>();
        let point = of(Bounds3 { min: Vec3::ONE, max: Vec3::ONE });
        let huge = of(Bounds3 { min: Vec3::splat(-3e38), max: Vec3::splat(3e38) });
        for references in [point, huge] {
            assert_sound(&improve(halved(references.clone()), ALL, &Serial), &references);
        }
    }
}
