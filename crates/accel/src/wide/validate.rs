//! The tree's invariants, callable, and its measures.

use super::arena::{Item, read};
use super::motion::Swept;
use super::node::{Block, List, Node, Place, WIDTH};
use super::{MAX_LEVELS, Tree};
use crate::build::costs::Costs;
use crate::instance::PlacedInstance;
use crate::primitive;
use crate::record::all_references;
use crate::scene_geometry::{Geometry, Shape};
use kirkas_geometry::Bounds3;

/// Something on the way through the tree: a place, its box, its level.
struct Seen {
    place: Place,
    bounds: Swept,
    level: usize,
}

impl Tree {
    /// Each primitive in the leaves, once unless split; each box around all below it; depth within the stack. Whatever is in the
    /// arena, this ends and does not panic, and what passes is safe to search.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        let count = geometries.iter().map(|g| g.shape.len()).sum::<usize>() + instances.len();
        let mut held = vec![false; count];
        let depth = self.try_walk(|seen| {
            if self.node(seen.place).is_some() {
                return Ok(());
            }
            self.check_leaf(seen.place, count, geometries)?;
            for number in self.leaf(seen.place)? {
                // A tree that is one leaf has no box.
                let is_boxed = !self.is_split && seen.level > 0;
                if is_boxed && !seen.bounds.holds(&self.bounds_of(number, geometries, instances)) {
                    return Err(format!("a box does not hold primitive {number}"));
                }
                if std::mem::replace(&mut held[number as usize], true) && !self.is_split {
                    return Err(format!("the leaves hold primitive {number} twice"));
                }
            }
            Ok(())
        })?;
        if depth > MAX_LEVELS {
            return Err(format!("{depth} levels of nodes; the stack holds {MAX_LEVELS}"));
        }
        for record in &self.unbounded {
            let (geometry, index) = record.ids();
            held[self.numbers.of(geometry, index) as usize] = true;
        }
        let wanted = all_references(geometries, instances).map(|(bounds, ..)| !bounds.is_empty());
        match held.into_iter().zip(wanted).position(|(held, wanted)| held != wanted) {
            Some(number) => Err(format!("the leaves do not hold what they should of primitive {number}")),
            None => Ok(()),
        }
    }

    /// A leaf is one, of primitives that there are, and a block holds their corners, a list its spheres.
    fn check_leaf(&self, place: Place, count: usize, geometries: &[Geometry]) -> Result<(), String> {
        if !(place.is_block() || place.is_list()) {
            return Err("a place of no type".into());
        }
        let mut numbers = self.leaf(place)?.peekable();
        if numbers.peek().is_none() {
            return Err("an empty leaf".into());
        }
        let block = if place.is_block() { read::<Block>(&self.lines, place.line()) } else { None };
        for (lane, number) in numbers.enumerate() {
            if number as usize >= count {
                return Err(format!("a leaf holds primitive {number} of {count}"));
            }
            let Some(block) = block else { continue };
            let (geometry, index) = self.numbers.ids(number);
            let is_own = match geometries.get(geometry as usize).map(|g| &g.shape) {
                Some(Shape::Triangles { positions, indices }) => {
                    let own = primitive::corners(positions, indices[index as usize]);
                    own.map(|c| c.map(f32::to_bits)) == block.triangle(lane).map(|c| c.map(f32::to_bits))
                }
                _ => false,
            };
            if !is_own {
                return Err(format!("a block holds other corners than those of primitive {number}"));
            }
        }
        match read::<List>(&self.lines, place.line()).filter(|_| place.is_list()) {
            Some(list) => {
                let mut own = *list;
                own.set_balls(&self.numbers, geometries);
                let is_own = own.balls.map(|b| b.map(f32::to_bits)) == list.balls.map(|b| b.map(f32::to_bits));
                if is_own { Ok(()) } else { Err("a list holds other spheres than its own".into()) }
            }
            None => Ok(()),
        }
    }

    /// Inner nodes.
    pub fn node_count(&self) -> usize {
        let mut count = 0;
        let _ = self.try_walk(|seen| {
            count += usize::from(self.node(seen.place).is_some());
            Ok(())
        });
        count
    }

    /// Levels of inner nodes.
    pub fn depth(&self) -> usize {
        self.try_walk(|_| Ok(())).unwrap_or(0)
    }

    /// Expected cost of a ray that meets the root's box: node visits times their cost plus primitive tests.
    pub fn sah_cost(&self) -> f64 {
        let area = |b: Bounds3| f64::from(b.surface_area());
        let root_area = area(self.root_bounds().middle());
        if root_area <= 0.0 {
            return 0.0;
        }
        let mut cost = 0.0;
        let _ = self.try_walk(|seen| {
            let each = if self.node(seen.place).is_some() {
                f64::from(Costs::BVH2.node)
            } else {
                self.leaf(seen.place)?.count() as f64
            };
            cost += each * area(seen.bounds.middle()) / root_area;
            Ok(())
        });
        cost
    }

    /// The numbers in a leaf.
    pub(super) fn leaf(&self, place: Place) -> Result<impl Iterator<Item = u32> + use<>, String> {
        let beyond = "a leaf lies beyond the arena";
        let (numbers, count) = if place.is_block() {
            (read::<Block>(&self.lines, place.line()).ok_or(beyond)?.numbers, place.count())
        } else {
            let numbers = read::<List>(&self.lines, place.line()).ok_or(beyond)?.numbers;
            (numbers, numbers.iter().position(|n| *n == List::NONE).unwrap_or(WIDTH))
        };
        Ok(numbers.into_iter().take(count))
    }

    /// Visit every place, checking that boxes nest; returns the levels of inner nodes.
    fn try_walk(&self, mut visit: impl FnMut(&Seen) -> Result<(), String>) -> Result<usize, String> {
        if self.root.is_end() {
            return Ok(0);
        }
        let mut todo = vec![Seen { place: self.root, bounds: self.root_bounds(), level: 0 }];
        let (mut depth, mut nodes) = (0, 0);
        while let Some(seen) = todo.pop() {
            visit(&seen)?;
            if !(seen.place.is_node() || seen.place.is_motion() && self.is_moving) {
                continue;
            }
            nodes += 1;
            if nodes * Node::LINES > self.lines.len() {
                return Err("a node is reached twice".into());
            }
            let node = self.node(seen.place).ok_or("a child lies beyond the arena")?;
            depth = depth.max(seen.level + 1);
            for slot in 0..WIDTH {
                let (place, inner) = (node.children[slot], self.slot_bounds(seen.place, slot).unwrap_or(seen.bounds));
                node.check_slot(slot)?;
                if place.is_end() {
                    continue;
                }
                if inner.open.is_empty() || inner.close.is_empty() || !seen.bounds.holds(&inner) {
                    return Err(format!("the box of the node at line {} does not hold its child", seen.place.line()));
                }
                todo.push(Seen { place, bounds: inner, level: seen.level + 1 });
            }
        }
        Ok(depth)
    }
}

impl Node {
    /// The rows agree on whether a slot is empty, and ranks are different.
    fn check_slot(&self, slot: usize) -> Result<(), String> {
        let is_empty = self.children[slot].is_end();
        let rank = self.order[slot];
        let is_sound = if is_empty {
            self.bounds(slot) == Node::EMPTY.bounds(slot) && self.empty[slot] == u16::MAX && rank == u16::MAX
        } else {
            let is_unique = self.order.iter().filter(|r| **r == rank).count() == 1;
            self.empty[slot] == 0 && (rank as usize) < WIDTH && is_unique
        };
        if is_sound { Ok(()) } else { Err("the rows of a node do not fit each other".into()) }
    }
}
