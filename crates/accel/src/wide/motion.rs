//! Nodes of what moves: boxes that change linearly in time, so that a ray meets those of its own moment instead of all that is
//! swept. Only nodes with moving triangles below are of this type. (Boxes of this kind: Gruenschloss, Stich, Nawaz & Keller
//! 2011, "MSBVH: An Efficient Acceleration Data Structure for Ray Traced Motion Blur".)
//!
//! The corners of moving triangles and the planes of boxes are interpolated by the same roundings, which are monotone, within the
//! slack of [`moving::linear_bounds`].

use super::Tree;
use super::arena::{Item, Line, put, read};
use super::node::{MotionNode, Node, Place, WIDTH};
use crate::build::reference::Reference;
use crate::instance::PlacedInstance;
use crate::scene_geometry::{Geometry, Shape};
use crate::{moving, primitive};
use kirkas_geometry::Bounds3;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// A box when the shutter opens and when it closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Swept {
    pub open: Bounds3,
    pub close: Bounds3,
    /// False for a box that holds what rests and has no room for interpolation.
    pub is_moving: bool,
}

impl Swept {
    /// Of what rests.
    pub fn still(b: Bounds3) -> Self {
        Swept { open: b, close: b, is_moving: false }
    }

    pub fn moving([open, close]: [Bounds3; 2]) -> Self {
        Swept { open, close, is_moving: true }
    }

    /// As a box to be interpolated: what rests gets room for the roundings.
    fn as_moving(self) -> Self {
        if self.is_moving {
            return self;
        }
        let slack = |b: Bounds3| Bounds3 {
            min: b.min - b.min.abs() * (4.0 * UNIT_ROUNDOFF),
            max: b.max + b.max.abs() * (4.0 * UNIT_ROUNDOFF),
        };
        Swept::moving([slack(self.open), slack(self.close)])
    }

    /// Around both, at every moment.
    pub fn union(self, other: Self) -> Self {
        if !self.is_moving && !other.is_moving {
            return Swept::still(self.open.union(other.open));
        }
        let (a, b) = (self.as_moving(), other.as_moving());
        Swept::moving([a.open.union(b.open), a.close.union(b.close)])
    }

    /// True when `other` is within this at every moment.
    pub fn holds(&self, other: &Swept) -> bool {
        let inner = if self.is_moving { other.as_moving() } else { *other };
        self.open.union(inner.open) == self.open && self.close.union(inner.close) == self.close
    }

    /// In the middle of the shutter.
    pub fn middle(&self) -> Bounds3 {
        let between = |a, b| (a + b) * 0.5;
        Bounds3 { min: between(self.open.min, self.close.min), max: between(self.open.max, self.close.max) }
    }
}

/// Whether anything here moves but instances.
pub(super) fn is_moving(geometries: &[Geometry]) -> bool {
    geometries.iter().any(|g| matches!(g.shape, Shape::MovingTriangles { .. }))
}

/// Put the boxes of what moves where it is in the middle of the shutter: what is close together then is put together.
pub(super) fn take_middles(references: &mut [Reference], geometries: &[Geometry]) {
    for r in references {
        let (geometry, index) = r.ids();
        if let Some(Shape::MovingTriangles { keys, indices }) = geometries.get(geometry as usize).map(|g| &g.shape) {
            *r = Reference::new(&moving::bounds_at(keys, indices[index as usize], 0.5), geometry, index);
        }
    }
}

impl Tree {
    /// Give the nodes of a tree that was built over middles boxes that move, where something moves below them.
    pub(super) fn set_in_motion(&mut self, geometries: &[Geometry], instances: &[PlacedInstance]) {
        if !self.root.is_node() {
            return;
        }
        let mut moves = vec![false; self.lines.len()];
        self.mark_moving(self.root, geometries, &mut moves);
        let mut copy = Copying { old: self, lines: Vec::new(), moves: &moves, geometries, instances };
        let (root, _) = copy.place(self.root, &self.bounds);
        self.lines = copy.lines;
        self.root = root;
    }

    /// Whether something moves below a place; the lines of such nodes are marked.
    fn mark_moving(&self, place: Place, geometries: &[Geometry], moves: &mut [bool]) -> bool {
        let Some(node) = self.node(place) else {
            let shape = |n: u32| geometries.get(self.numbers.ids(n).0 as usize).map(|g| &g.shape);
            let mut held = self.leaf(place).into_iter().flatten();
            return held.any(|n| matches!(shape(n), Some(Shape::MovingTriangles { .. })));
        };
        let mut is_moving = false;
        for &child in node.children.iter().filter(|c| !c.is_end()) {
            is_moving |= self.mark_moving(child, geometries, moves);
        }
        moves[place.line()] = is_moving;
        is_moving
    }

    /// The node at a place, with its boxes when the shutter opens; `None` for leaves.
    pub(super) fn node(&self, place: Place) -> Option<&Node> {
        match place.is_motion() {
            true => Some(&read::<MotionNode>(&self.lines, place.line())?.node),
            false if place.is_node() => read::<Node>(&self.lines, place.line()),
            false => None,
        }
    }

    /// The node at a place as it is at a moment; `None` for leaves.
    pub(super) fn node_at(&self, place: Place, moment: f32) -> Option<Node> {
        match place.is_motion() {
            true => Some(read::<MotionNode>(&self.lines, place.line())?.at(moment)),
            false => self.node(place).copied(),
        }
    }

    /// The box in a slot of a node.
    pub(super) fn slot_bounds(&self, place: Place, slot: usize) -> Option<Swept> {
        match place.is_motion() {
            true => Some(read::<MotionNode>(&self.lines, place.line())?.bounds(slot)),
            false => Some(Swept::still(self.node(place)?.bounds(slot))),
        }
    }

    /// Around all that is in the tree.
    pub(super) fn root_bounds(&self) -> Swept {
        let all = (0..WIDTH).filter_map(|slot| self.slot_bounds(self.root, slot)).reduce(Swept::union);
        match all {
            Some(all) if all.is_moving => all,
            _ => Swept::still(self.bounds),
        }
    }

    /// The bounds of a primitive or instance.
    pub(super) fn bounds_of(&self, number: u32, geometries: &[Geometry], instances: &[PlacedInstance]) -> Swept {
        let (geometry, index) = self.numbers.ids(number);
        match geometries.get(geometry as usize).map(|g| &g.shape) {
            None => Swept::still(instances[index as usize].bounds),
            Some(Shape::MovingTriangles { keys, indices }) => {
                Swept::moving(moving::linear_bounds(keys, indices[index as usize]))
            }
            Some(shape) => Swept::still(primitive::bounds(shape, index)),
        }
    }
}

/// A tree on its way into another arena.
struct Copying<'a> {
    old: &'a Tree,
    lines: Vec<Line>,
    /// By line of the old arena: whether something moves below the node there.
    moves: &'a [bool],
    geometries: &'a [Geometry],
    instances: &'a [PlacedInstance],
}

impl Copying<'_> {
    /// Copy what is at a place, and tell its box; `known` is right for what rests.
    fn place(&mut self, place: Place, known: &Bounds3) -> (Place, Swept) {
        let start = self.lines.len();
        let Some(node) = self.old.node(place) else {
            self.lines.extend_from_slice(&self.old.lines[place.line()..][..place.leaf_lines()]);
            let held = self.old.leaf(place).into_iter().flatten();
            let bounds = held.map(|n| self.old.bounds_of(n, self.geometries, self.instances)).reduce(Swept::union);
            let bounds = bounds.filter(|b| b.is_moving).unwrap_or(Swept::still(*known));
            return (place.moved_to(start), bounds);
        };
        let is_moving = self.moves[place.line()];
        self.lines.resize(start + if is_moving { MotionNode::LINES } else { Node::LINES }, Line([0; 16]));
        let mut new = MotionNode { node: *node, close: Node::EMPTY.planes };
        let mut all: Option<Swept> = None;
        for slot in (0..WIDTH).filter(|&slot| !node.children[slot].is_end()) {
            let (child, bounds) = self.place(node.children[slot], &node.bounds(slot));
            new.node.children[slot] = child;
            if is_moving {
                new.set_bounds(slot, bounds);
            }
            all = Some(all.map_or(bounds, |a| a.union(bounds)));
        }
        if is_moving {
            put(&mut self.lines[start..], &new);
            (Place::motion(start), all.unwrap_or(Swept::still(*known)))
        } else {
            put(&mut self.lines[start..], &new.node);
            (Place::node(start), Swept::still(*known))
        }
    }
}

impl MotionNode {
    /// Put a box into a slot.
    pub fn set_bounds(&mut self, slot: usize, b: Swept) {
        let b = b.as_moving();
        self.node.set_bounds(slot, &b.open);
        for k in 0..3 {
            self.close[2 * k][slot] = b.close.min[k];
            self.close[2 * k + 1][slot] = b.close.max[k];
        }
    }

    /// The box in a slot.
    pub fn bounds(&self, slot: usize) -> Swept {
        let close = Node { planes: self.close, ..Node::EMPTY };
        Swept::moving([self.node.bounds(slot), close.bounds(slot)])
    }

    /// The node as it is at a moment between 0 and 1. Empty slots may get boxes that are no numbers.
    #[inline(always)]
    pub fn at(&self, moment: f32) -> Node {
        let mut node = self.node;
        for (open, close) in node.planes.iter_mut().zip(&self.close) {
            for (open, close) in open.iter_mut().zip(close) {
                *open = *open * (1.0 - moment) + close * moment;
            }
        }
        node
    }
}
