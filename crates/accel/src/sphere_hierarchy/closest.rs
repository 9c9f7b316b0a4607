//! The tree's search for the closest point, depth first, the nearer sphere first.

use super::Tree;
use crate::build::binary::{Child, MAX_DEPTH};
use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::search::Level;

impl Tree {
    /// Look at all that may be closest; `enter` looks into an instance.
    pub fn closest_point(&self, level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
        for record in &self.unbounded {
            record.consider(level, space, search, enter);
        }
        let Some((root, _)) = self.root else { return };
        // Each level leaves one child behind.
        let mut stack = [(0.0, Child::node(0)); MAX_DEPTH + 1];
        let mut waiting = 1;
        stack[0] = (f64::NEG_INFINITY, root);
        while waiting > 0 {
            waiting -= 1;
            let (distance, child) = stack[waiting];
            if !search.is_near(distance) {
                continue;
            }
            if child.is_leaf() {
                let (first, count) = child.run();
                for record in &self.records[first..first + count] {
                    record.consider(level, space, search, enter);
                }
                continue;
            }
            let node = &self.nodes[child.index()];
            let mut children = [0, 1].map(|side| (space.ball_distance(&node.spheres[side]), node.children[side]));
            if children[0].0 < children[1].0 {
                children.swap(0, 1);
            }
            stack[waiting..waiting + 2].copy_from_slice(&children);
            waiting += 2;
        }
    }
}
