//! The tree's search for the closest point, depth first, the nearest child first.

use super::Tree;
use super::arena::read;
use super::node::{Block, WIDTH};
use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::record::IS_INSTANCE;
use crate::search::Level;
use kirkas_geometry::{Bounds3, Vec3};

impl Tree {
    /// Look at all that may be closest; `enter` looks into an instance.
    pub fn closest_point(&self, level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
        for record in &self.unbounded {
            record.consider(level, space, search, enter);
        }
        let mut stack = vec![(f64::NEG_INFINITY, self.root)];
        while let Some((distance, place)) = stack.pop() {
            if place.is_end() || !search.is_near(distance) {
                continue;
            }
            if let Some(node) = self.node_at(place, search.moment(level)) {
                let first = stack.len();
                for slot in (0..WIDTH).filter(|&slot| !node.children[slot].is_end()) {
                    let distance = search.box_distance(space, &node.bounds(slot));
                    stack.extend(distance.map(|distance| (distance, node.children[slot])));
                }
                stack[first..].sort_by(|a, b| b.0.total_cmp(&a.0));
                continue;
            }
            let block = if place.is_block() { read::<Block>(&self.lines, place.line()) } else { None };
            for (lane, number) in self.leaf(place).into_iter().flatten().enumerate() {
                let box_of = |block: &Block| Bounds3::around(block.triangle(lane).map(Vec3::from_array));
                if block.is_some_and(|block| search.box_distance(space, &box_of(block)).is_none()) {
                    continue;
                }
                match self.numbers.ids(number) {
                    (IS_INSTANCE, index) => enter(search, index),
                    (geometry, index) => search.consider(level, space, geometry, index),
                }
            }
        }
    }
}
