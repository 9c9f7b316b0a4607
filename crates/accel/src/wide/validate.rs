//! The tree's invariants, callable, and its measures.

use super::arena::read;
use super::node::{Block, List, Node, Place, WIDTH};
use super::{MAX_LEVELS, Tree};
use crate::build::costs::Costs;
use crate::instance::PlacedInstance;
use crate::primitive;
use crate::record::{IS_INSTANCE, all_references};
use crate::scene_geometry::Geometry;
use kirkas_geometry::Bounds3;

/// Something on the way through the tree: a place, its box, its level.
struct Seen {
    place: Place,
    bounds: Bounds3,
    level: usize,
}

impl Tree {
    /// Each primitive in the leaves, once unless split; each box around all below it; depth within the stack.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        let own_bounds = |number: u32| {
            let (geometry, index) = self.numbers.ids(number);
            match geometry == IS_INSTANCE {
                true => instances[index as usize].bounds,
                false => primitive::bounds(&geometries[geometry as usize].shape, index),
            }
        };
        let mut held: Vec<u32> = Vec::new();
        let depth = self.try_walk(|seen| {
            if seen.place.is_node() {
                return Ok(());
            }
            for number in self.leaf(seen.place)? {
                let own = own_bounds(number);
                if !self.is_split && seen.bounds.union(own) != seen.bounds {
                    return Err(format!("a box does not hold primitive {number}"));
                }
                held.push(number);
            }
            Ok(())
        })?;
        if depth > MAX_LEVELS {
            return Err(format!("{depth} levels of nodes; the stack holds {MAX_LEVELS}"));
        }
        held.extend(self.unbounded.iter().map(|r| self.numbers.of(r.geometry, r.primitive)));
        held.sort_unstable();
        if self.is_split {
            held.dedup();
        }
        let bounded = all_references(geometries, instances).filter(|(b, ..)| !b.is_empty());
        let mut wanted: Vec<u32> = bounded.map(|(_, g, p)| self.numbers.of(g, p)).collect();
        wanted.sort_unstable();
        if held != wanted {
            return Err("the leaves do not hold each primitive once".into());
        }
        Ok(())
    }

    /// Inner nodes.
    pub fn node_count(&self) -> usize {
        let mut count = 0;
        let _ = self.try_walk(|seen| {
            count += usize::from(seen.place.is_node());
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
        let root_area = area(self.bounds);
        if root_area <= 0.0 {
            return 0.0;
        }
        let mut cost = 0.0;
        let _ = self.try_walk(|seen| {
            let each =
                if seen.place.is_node() { f64::from(Costs::BVH2.node) } else { self.leaf(seen.place)?.count() as f64 };
            cost += each * area(seen.bounds) / root_area;
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
        let mut todo = vec![Seen { place: self.root, bounds: self.bounds, level: 0 }];
        let (mut depth, mut nodes) = (0, 0);
        while let Some(seen) = todo.pop() {
            visit(&seen)?;
            if !seen.place.is_node() {
                continue;
            }
            nodes += 1;
            if nodes > self.lines.len() {
                return Err("a node is reached twice".into());
            }
            let node = read::<Node>(&self.lines, seen.place.line()).ok_or("a child lies beyond the arena")?;
            depth = depth.max(seen.level + 1);
            for slot in 0..WIDTH {
                let (place, inner) = (node.children[slot], node.bounds(slot));
                if place.is_end() {
                    continue;
                }
                if seen.bounds.union(inner) != seen.bounds {
                    return Err(format!("the box of the node at line {} does not hold its child", seen.place.line()));
                }
                todo.push(Seen { place, bounds: inner, level: seen.level + 1 });
            }
        }
        Ok(depth)
    }
}
