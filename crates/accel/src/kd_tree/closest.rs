//! The tree's search for the closest point, depth first, the nearer half first. A primitive is listed in the cell that holds
//! its closest point, so that what is in cells too far away can be left out.

use super::Tree;
use super::build::MAX_DEPTH;
use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::search::Level;
use kirkas_geometry::Bounds3;

impl Tree {
    /// Look at all that may be closest; `enter` looks into an instance.
    pub fn closest_point(&self, level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
        for record in &self.unbounded {
            record.consider(level, space, search, enter);
        }
        let Some(bounds) = self.bounds else { return };
        // Each level leaves one half behind.
        let mut stack = [(0.0, 0, Bounds3::EMPTY); MAX_DEPTH + 1];
        let mut waiting = 1;
        stack[0] = (f64::NEG_INFINITY, 0, bounds);
        while waiting > 0 {
            waiting -= 1;
            let (distance, index, cell) = stack[waiting];
            if !search.is_near(distance) {
                continue;
            }
            let node = self.nodes[index];
            if node.is_leaf() {
                let (first, count) = node.run();
                for &i in &self.lists[first..first + count] {
                    self.records[i as usize].consider(level, space, search, enter);
                }
                continue;
            }
            let [left, right] = node.halves(&cell);
            let mut halves = [(index + 1, left), (node.right(), right)]
                .map(|(index, cell)| (space.box_distance(&cell), index, cell));
            if halves[0].0 < halves[1].0 {
                halves.swap(0, 1);
            }
            stack[waiting..waiting + 2].copy_from_slice(&halves);
            waiting += 2;
        }
    }
}
