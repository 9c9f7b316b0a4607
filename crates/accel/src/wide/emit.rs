//! Lays a binary tree out as a wide one: depth first, each node before what is below it. Lines are counted first; then every
//! subtree has its own room, and large ones are filled at once.

use super::arena::{Item, Line, fill};
use super::node::{Block, List, MAX_LINES, Node, Place, WIDTH};
use super::numbers::Numbers;
use crate::build::binary::{BinaryTree, Child};
use crate::build::collapse::{Collapse, Costs};
use crate::build::parallel::for_each;
use crate::build::reference::Reference;
use crate::instance::PlacedInstance;
use crate::scene_geometry::{Geometry, Shape};
use crate::{Executor, memory, primitive};
use kirkas_geometry::Bounds3;
use std::mem::MaybeUninit;

/// Subtrees of more references than this are handed to the executor child by child.
const FORK_ABOVE: usize = 1 << 12;

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
    leaves: Leaves<'a>,
    executor: &'a dyn Executor,
}

/// The arena and where its root is. `listed` is what it costs to test a primitive that is in no block; a block costs 1.
pub(super) fn emit(
    tree: &BinaryTree,
    bounds: &Bounds3,
    (geometries, instances): (&[Geometry], &[PlacedInstance]),
    numbers: &Numbers,
    is_compact: bool,
    listed: f32,
    executor: &dyn Executor,
) -> (Vec<Line>, Place) {
    let leaves = Leaves::new(geometries, !instances.is_empty());
    // Compact trees have lists for blocks, but are to have as few.
    let costs = Costs { node: 1.0, block: 1.0, listed };
    let collapse = Collapse::new(tree, costs, &|run| !leaves.is_block(run), executor);
    let leaves = if is_compact { Leaves::Lists } else { leaves };
    let Some(root) = collapse.root(tree) else { return (Vec::new(), Place::END) };
    let e = Emitter { tree, collapse, geometries, numbers, leaves, executor };
    let plan = e.plan(root);
    assert!(plan.lines <= MAX_LINES, "a tree of more than 16 GB");
    let mut lines = memory::with_capacity(plan.lines);
    let mut room = Room { lines: &mut lines.spare_capacity_mut()[..plan.lines], first: 0 };
    let (place, _) = e.child(root, bounds, &plan, &mut room);
    room.finish();
    // SAFETY: whoever takes lines from a room fills them, and each room was left with none (asserted by `finish`).
    unsafe { lines.set_len(plan.lines) };
    (lines, place)
}

/// Which leaves are blocks.
#[derive(Clone, Copy)]
enum Leaves<'a> {
    Blocks,
    Lists,
    Mixed(&'a [Geometry]),
}

impl<'a> Leaves<'a> {
    fn new(geometries: &'a [Geometry], has_instances: bool) -> Self {
        match geometries.iter().filter(|g| is_triangles(&g.shape)).count() {
            0 => Leaves::Lists,
            n if n == geometries.len() && !has_instances => Leaves::Blocks,
            _ => Leaves::Mixed(geometries),
        }
    }

    fn is_block(self, run: &[Reference]) -> bool {
        let Leaves::Mixed(geometries) = self else { return matches!(self, Leaves::Blocks) };
        run.iter().all(|r| geometries.get(r.ids().0 as usize).is_some_and(|g| is_triangles(&g.shape)))
    }
}

fn is_triangles(shape: &Shape) -> bool {
    matches!(shape, Shape::Triangles { .. })
}

/// How many lines a subtree takes, and those of the children of a large one.
struct Plan {
    lines: usize,
    below: Vec<Plan>,
}

/// Lines still to be filled, and the number of the first.
struct Room<'a> {
    lines: &'a mut [MaybeUninit<Line>],
    first: usize,
}

impl<'a> Room<'a> {
    /// The next lines, and the number of the first.
    fn take(&mut self, count: usize) -> (usize, &'a mut [MaybeUninit<Line>]) {
        let (own, rest) = core::mem::take(&mut self.lines).split_at_mut(count);
        self.lines = rest;
        self.first += count;
        (self.first - count, own)
    }

    fn finish(self) {
        assert!(self.lines.is_empty(), "as many lines as were counted");
    }
}

impl Emitter<'_> {
    fn run(&self, leaf: Child) -> &[Reference] {
        let (first, count) = leaf.run();
        &self.tree.references[first..first + count]
    }

    fn plan(&self, child: Child) -> Plan {
        if child.is_leaf() || self.collapse.references(child) <= FORK_ABOVE {
            return Plan { lines: self.lines(child), below: Vec::new() };
        }
        let children = self.collapse.children(self.tree, child);
        let mut jobs: Vec<_> = children.iter().map(|c| (c.0, Plan { lines: 0, below: Vec::new() })).collect();
        for_each(&mut jobs, self.executor, &|(child, plan)| *plan = self.plan(*child));
        let below: Vec<Plan> = jobs.into_iter().map(|job| job.1).collect();
        Plan { lines: Node::LINES + below.iter().map(|p| p.lines).sum::<usize>(), below }
    }

    fn lines(&self, child: Child) -> usize {
        if child.is_leaf() {
            return if self.leaves.is_block(self.run(child)) { Block::LINES } else { List::LINES };
        }
        let children = self.collapse.children(self.tree, child);
        Node::LINES + children.iter().map(|c| self.lines(c.0)).sum::<usize>()
    }

    /// Lay out a subtree that was planned.
    fn child(&self, child: Child, bounds: &Bounds3, plan: &Plan, room: &mut Room) -> (Place, Promise) {
        if child.is_leaf() {
            return self.leaf(child, bounds, room);
        }
        if plan.below.is_empty() {
            return self.node(child, room);
        }
        let (line, own) = room.take(Node::LINES);
        let children = self.collapse.children(self.tree, child);
        let mut jobs = Vec::with_capacity(WIDTH);
        for ((child, bounds), plan) in children.iter().zip(&plan.below) {
            let (first, lines) = room.take(plan.lines);
            jobs.push((child, bounds, plan, Some(Room { lines, first }), None));
        }
        for_each(&mut jobs, self.executor, &|(child, bounds, plan, room, done)| {
            let mut room = room.take().expect("each job is run once");
            *done = Some(self.child(**child, bounds, plan, &mut room));
            room.finish();
        });
        let done = jobs.into_iter().map(|job| (*job.1, job.4.expect("executors run all jobs")));
        (Place::node(line), finish_node(own, done))
    }

    fn node(&self, child: Child, room: &mut Room) -> (Place, Promise) {
        let (line, own) = room.take(Node::LINES);
        let children = self.collapse.children(self.tree, child);
        let done = children.iter().map(|(child, bounds)| {
            let done = if child.is_leaf() { self.leaf(*child, bounds, room) } else { self.node(*child, room) };
            (*bounds, done)
        });
        (Place::node(line), finish_node(own, done))
    }

    fn leaf(&self, child: Child, bounds: &Bounds3, room: &mut Room) -> (Place, Promise) {
        let run = self.run(child);
        if self.leaves.is_block(run) {
            let (line, own) = room.take(Block::LINES);
            let (block, area) = self.block(run);
            fill(own, &block);
            // A flat shape of one-sided area A is met by A/2 of the lines of which a convex box of surface S meets S/4.
            let covered = (2.0 * area / bounds.surface_area().max(f32::MIN_POSITIVE)).min(1.0);
            return (Place::block(line, run.len()), Promise { probability: covered, cost: 1.0 });
        }
        let mut list = List::EMPTY;
        for (slot, r) in list.numbers.iter_mut().zip(run) {
            let (geometry, index) = r.ids();
            *slot = self.numbers.of(geometry, index);
        }
        list.set_balls(self.numbers, self.geometries);
        let (line, own) = room.take(List::LINES);
        fill(own, &list);
        (Place::list(line), Promise { probability: 0.5, cost: run.len() as f32 })
    }

    /// A block with the area of its triangles.
    fn block(&self, run: &[Reference]) -> (Block, f32) {
        let mut block = Block::EMPTY;
        let mut area = 0.0;
        for (lane, r) in run.iter().enumerate() {
            let (geometry, index) = r.ids();
            let Shape::Triangles { positions, indices } = &self.geometries[geometry as usize].shape else {
                unreachable!("blocks are of triangles")
            };
            let corners = primitive::corners(positions, indices[index as usize]);
            for (row, value) in block.corners.iter_mut().zip(corners.as_flattened()) {
                row[lane] = *value;
            }
            block.numbers[lane] = self.numbers.of(geometry, index);
            let [a, b, c] = corners.map(kirkas_geometry::Vec3::from_array);
            area += 0.5 * (b - a).cross(c - a).length();
        }
        (block, area)
    }
}

/// Write the node of these children, which lie where they shall.
fn finish_node(own: &mut [MaybeUninit<Line>], children: impl Iterator<Item = (Bounds3, (Place, Promise))>) -> Promise {
    let mut node = Node::EMPTY;
    let mut promises = [(Bounds3::EMPTY, Promise { probability: 0.0, cost: 1.0 }); WIDTH];
    let (mut whole, mut count) = (Bounds3::EMPTY, 0);
    for (slot, (bounds, (place, promise))) in children.enumerate() {
        node.set_bounds(slot, &bounds);
        node.children[slot] = place;
        promises[slot] = (bounds, promise);
        whole = whole.union(bounds);
        count = slot + 1;
    }
    let area = whole.surface_area().max(f32::MIN_POSITIVE);
    let mut missed = 1.0;
    let mut cost = 1.0;
    let mut ranks = [(0.0_f32, 0_u16); WIDTH];
    for (slot, (bounds, promise)) in promises[..count].iter().enumerate() {
        let entered = (bounds.surface_area() / area).min(1.0);
        missed *= 1.0 - entered * promise.probability;
        cost += entered * promise.cost;
        ranks[slot] = (promise.probability / promise.cost, slot as u16);
    }
    ranks[..count].sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (rank, (_, slot)) in ranks[..count].iter().enumerate() {
        node.order[*slot as usize] = rank as u16;
    }
    fill(own, &node);
    Promise { probability: 1.0 - missed, cost }
}

#[cfg(test)]
mod tests {
    use crate::Executor;
    use crate::build::testing::Backwards;
    use crate::scene_geometry::{Geometry, Shape, Sphere};
    use crate::wide::{Quality, Tree};
    use crate::{Accel, AccelKind, SceneGeometry, Serial};
    use kirkas_geometry::Vec3;
    use kirkas_geometry::hash::{combine, unit_f32};
    use std::sync::Arc;

    fn at(i: usize) -> Vec3 {
        let unit = |k: u64| unit_f32(combine(combine(7, i as u64), k) as u32);
        Vec3::new(unit(0), unit(1), unit(2))
    }

    fn geometry(shape: Shape) -> Geometry {
        Geometry { shape, opaque: true, mask: u32::MAX }
    }

    fn spheres(count: usize) -> Geometry {
        geometry(Shape::Spheres(Arc::new((0..count).map(|i| Sphere { center: at(i), radius: 0.003 }).collect())))
    }

    fn triangles(count: usize) -> Geometry {
        let corners = |i: usize| [at(i), at(i) + at(i + 1) * 0.02, at(i) + at(i + 2) * 0.02];
        let positions = Arc::new((0..count).flat_map(corners).collect());
        let indices = Arc::new((0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect());
        geometry(Shape::Triangles { positions, indices })
    }

    #[test]
    fn the_executor_does_not_show() {
        let level = [triangles(30_000), spheres(10_000)];
        for quality in [Quality::Fast, Quality::Default, Quality::Best, Quality::Compact] {
            let [a, b] = [&Serial as &dyn Executor, &Backwards].map(|e| Tree::build(quality, &level, &[], e));
            assert!(a.lines.iter().map(|l| l.0).eq(b.lines.iter().map(|l| l.0)) && a.root == b.root);
            assert_eq!(a.validate(&level, &[]), Ok(()));
        }
    }

    #[test]
    fn what_is_tested_one_by_one_is_parted_as_in_a_binary_tree() {
        let cost = |kind: AccelKind| {
            let scene = SceneGeometry { world: vec![spheres(20_000)], ..SceneGeometry::default() };
            Accel::build(kind, scene, &Serial).expect("a sound scene").statistics().sah_cost
        };
        let (wide, binary) = (cost(AccelKind::Bvh8), cost(AccelKind::Bvh2));
        assert!(wide < 0.4 * binary, "{wide} against {binary}");
    }
}
