//! Lays a binary tree out as a wide one.

use super::arena::{Item, Line, put};
use super::node::{Block, List, MAX_LINES, Node, Place, WIDTH};
use super::numbers::Numbers;
use crate::build::binary::{BinaryTree, Child};
use crate::build::collapse::{Collapse, Costs};
use crate::build::reference::Reference;
use crate::scene_geometry::{Geometry, Shape};
use crate::{Executor, primitive};
use kirkas_geometry::Bounds3;

/// What is known of a subtree once it is laid out: it decides in which order a search for any hit looks at it.
#[derive(Clone, Copy)]
struct Promise {
    /// Estimated probability that a ray through the box hits something in it.
    probability: f32,
    /// Estimated cost of finding out.
    cost: f32,
}

struct Emitter<'a> {
    tree: &'a BinaryTree,
    collapse: Collapse,
    geometries: &'a [Geometry],
    numbers: &'a Numbers,
    is_compact: bool,
    lines: Vec<Line>,
}

/// The arena and where its root is.
pub(super) fn emit(
    tree: &BinaryTree,
    bounds: &Bounds3,
    geometries: &[Geometry],
    numbers: &Numbers,
    is_compact: bool,
    executor: &dyn Executor,
) -> (Vec<Line>, Place) {
    let collapse = Collapse::new(tree, Costs { node: 1.0, leaf: 1.0 }, executor);
    let Some(root) = collapse.root(tree) else { return (Vec::new(), Place::END) };
    // Room for one leaf of each binary one, and a wide node for two binary ones; what is not used is never touched.
    let room = (tree.nodes.len() + 1) * Block::LINES.max(List::LINES) + tree.nodes.len() / 2 * Node::LINES;
    let mut e = Emitter { tree, collapse, geometries, numbers, is_compact, lines: Vec::with_capacity(room) };
    let (place, _) = if root.is_leaf() { e.leaf(root, bounds) } else { e.node(root) };
    assert!(e.lines.len() <= MAX_LINES, "a tree of more than 16 GB");
    e.lines.shrink_to_fit();
    (e.lines, place)
}

impl Emitter<'_> {
    fn reserve<T: Item>(&mut self) -> usize {
        let line = self.lines.len();
        self.lines.resize(line + T::LINES, Line([0; 16]));
        line
    }

    fn node(&mut self, child: Child) -> (Place, Promise) {
        let line = self.reserve::<Node>();
        let mut children = Vec::with_capacity(WIDTH);
        self.collapse.children(self.tree, child, &mut children);
        let count = children.len();
        let whole = children.iter().fold(Bounds3::EMPTY, |b, c| b.union(c.1));
        let area = whole.surface_area().max(f32::MIN_POSITIVE);
        let mut node = Node::EMPTY;
        let mut promises = [(0.0_f32, 0_u16); WIDTH];
        let mut all = Promise { probability: 1.0, cost: 1.0 };
        for (slot, (child, bounds)) in children.iter().enumerate() {
            let (place, promise) = if child.is_leaf() { self.leaf(*child, bounds) } else { self.node(*child) };
            node.set_bounds(slot, bounds);
            node.children[slot] = place;
            promises[slot] = (promise.probability / promise.cost, slot as u16);
            let entered = (bounds.surface_area() / area).min(1.0);
            all.probability *= 1.0 - entered * promise.probability;
            all.cost += entered * promise.cost;
        }
        all.probability = 1.0 - all.probability;
        promises[..count].sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (rank, (_, slot)) in promises[..count].iter().enumerate() {
            node.order[*slot as usize] = rank as u16;
        }
        put(&mut self.lines[line..], &node);
        (Place::node(line), all)
    }

    fn leaf(&mut self, child: Child, bounds: &Bounds3) -> (Place, Promise) {
        let (first, count) = child.run();
        let tree = self.tree;
        let run = &tree.references[first..first + count];
        match self.block(run) {
            Some((block, area)) => {
                let line = self.reserve::<Block>();
                put(&mut self.lines[line..], &block);
                // A flat shape of one-sided area A is met by A/2 of the lines of which a convex box of surface S meets S/4.
                let covered = (2.0 * area / bounds.surface_area().max(f32::MIN_POSITIVE)).min(1.0);
                (Place::block(line, count), Promise { probability: covered, cost: 1.0 })
            }
            None => {
                let mut list = List::EMPTY;
                for (slot, r) in list.numbers.iter_mut().zip(run) {
                    *slot = self.number(r);
                }
                let line = self.reserve::<List>();
                put(&mut self.lines[line..], &list);
                (Place::list(line), Promise { probability: 0.5, cost: count as f32 })
            }
        }
    }

    fn number(&self, r: &Reference) -> u32 {
        let (geometry, index) = r.ids();
        self.numbers.of(geometry, index)
    }

    /// The references as a block with the area of its triangles, when all are triangles.
    fn block(&self, run: &[Reference]) -> Option<(Block, f32)> {
        if self.is_compact {
            return None;
        }
        let mut block = Block::EMPTY;
        let mut area = 0.0;
        for (lane, r) in run.iter().enumerate() {
            let (geometry, index) = r.ids();
            let Shape::Triangles { positions, indices } = &self.geometries.get(geometry as usize)?.shape else {
                return None;
            };
            let corners = primitive::corners(positions, indices[index as usize]);
            for c in 0..3 {
                for k in 0..3 {
                    block.corners[3 * c + k][lane] = corners[c][k];
                }
            }
            block.numbers[lane] = self.numbers.of(geometry, index);
            let [a, b, c] = corners.map(kirkas_geometry::Vec3::from_array);
            area += 0.5 * (b - a).cross(c - a).length();
        }
        Some((block, area))
    }
}
