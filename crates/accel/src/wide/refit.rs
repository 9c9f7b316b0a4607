//! New boxes and corners for a tree whose primitives have moved, bottom up and in place.

use super::Tree;
use super::arena::{put, read};
use super::motion::Swept;
use super::node::{Block, List, MotionNode, Place, WIDTH};
use crate::gather::gather_unbounded;
use crate::instance::PlacedInstance;
use crate::primitive;
use crate::scene_geometry::{Geometry, Shape};
use kirkas_geometry::Bounds3;

impl Tree {
    /// Fit the tree to what its level now holds: the same primitives, elsewhere, as bounded or unbounded as before. `bounds` is
    /// around all that is bounded. Boxes of parts become those of whole primitives.
    pub fn refit(&mut self, bounds: Bounds3, geometries: &[Geometry], instances: &[PlacedInstance]) {
        if !self.unbounded.is_empty() {
            self.unbounded = gather_unbounded(geometries, instances);
        }
        self.bounds = bounds;
        if !self.root.is_end() {
            self.refit_place(self.root, geometries, instances);
        }
        self.reach = self.find_reach();
    }

    /// The new box of what is at a place.
    fn refit_place(&mut self, place: Place, geometries: &[Geometry], instances: &[PlacedInstance]) -> Swept {
        let Some(mut node) = self.node(place).copied() else {
            self.refit_leaf(place, geometries);
            let held = self.leaf(place).into_iter().flatten();
            let bounds = held.map(|number| self.bounds_of(number, geometries, instances)).reduce(Swept::union);
            return bounds.unwrap_or(Swept::still(Bounds3::EMPTY));
        };
        let mut boxes = [None; WIDTH];
        for slot in (0..WIDTH).filter(|&slot| !node.children[slot].is_end()) {
            boxes[slot] = Some(self.refit_place(node.children[slot], geometries, instances));
        }
        let filled = || boxes.iter().enumerate().filter_map(|(slot, b)| Some((slot, (*b)?)));
        let lines = &mut self.lines[place.line()..];
        if let (true, Some(&old)) = (place.is_motion(), read::<MotionNode>(lines, 0)) {
            let mut node = old;
            filled().for_each(|(slot, b)| node.set_bounds(slot, b));
            put(lines, &node);
        } else {
            filled().for_each(|(slot, b)| node.set_bounds(slot, &b.open));
            put(lines, &node);
        }
        filled().map(|(_, b)| b).reduce(Swept::union).unwrap_or(Swept::still(Bounds3::EMPTY))
    }

    /// New corners for a block, new spheres for a list.
    fn refit_leaf(&mut self, place: Place, geometries: &[Geometry]) {
        let lines = &mut self.lines[place.line()..];
        if let Some(mut list) = read::<List>(lines, 0).copied().filter(|_| place.is_list()) {
            list.set_balls(&self.numbers, geometries);
            return put(lines, &list);
        }
        let Some(mut block) = read::<Block>(lines, 0).copied().filter(|_| place.is_block()) else { return };
        for lane in 0..place.count() {
            let (geometry, index) = self.numbers.ids(block.numbers[lane]);
            if let Shape::Triangles { positions, indices } = &geometries[geometry as usize].shape {
                let corners = primitive::corners(positions, indices[index as usize]);
                for (row, value) in block.corners.iter_mut().zip(corners.as_flattened()) {
                    row[lane] = *value;
                }
            }
        }
        put(lines, &block);
    }
}
