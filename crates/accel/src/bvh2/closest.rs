//! The tree's search for the closest point, depth first, the nearer child first.

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
        let (Some(root), Some(bounds)) = (self.root, self.bounds) else { return };
        let Some(distance) = search.box_distance(space, &bounds) else { return };
        // Each level leaves one child behind.
        let mut stack = [(0.0, Child::node(0)); MAX_DEPTH + 1];
        let mut len = 1;
        stack[0] = (distance, root);
        while len > 0 {
            len -= 1;
            let (distance, child) = stack[len];
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
            let [a, b] = [0, 1].map(|side| {
                search.box_distance(space, &node.child_bounds(side)).map(|distance| (distance, node.children[side]))
            });
            let (far, near) = match (a, b) {
                (Some(a), Some(b)) if a.0 < b.0 => (Some(b), Some(a)),
                both => both,
            };
            for entry in [far, near].into_iter().flatten() {
                stack[len] = entry;
                len += 1;
            }
        }
    }
}
