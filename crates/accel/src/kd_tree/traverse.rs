//! Takes a ray through the tree, the nearer half first.

use super::Tree;
use super::build::MAX_DEPTH;
use crate::cells::{CellRay, Mailbox};
use crate::prepared_ray::PreparedRay;
use crate::search::{Enter, Level, Search};

impl Tree {
    /// Search all that the tree holds; `enter` searches an instance.
    pub fn search<const ANY: bool>(
        &self,
        level: Level,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        enter: Enter<ANY>,
    ) {
        for record in &self.unbounded {
            record.test(level, ray, search, enter);
        }
        let Some(cells) = self.bounds.and_then(|root| CellRay::new(ray, &root)) else { return };
        let mut mailbox = Mailbox::new();
        // Each level leaves at most one half behind.
        let mut stack = [(0_u32, 0.0_f32, 0.0_f32); MAX_DEPTH];
        let mut waiting = 0;
        let (mut index, mut near, mut far) = (0, cells.near, cells.far);
        let mut nodes_visited = 0;
        while !search.is_done() {
            let node = self.nodes[index];
            if !node.is_leaf() {
                nodes_visited += 1;
                let (axis, position) = (node.axis(), node.position());
                let (leaves, enters) = (cells.leaves(axis, position), cells.enters(axis, position));
                // NaN, a ray within the plane, loses both comparisons: it is in both halves.
                let first_far = if leaves < far { leaves } else { far };
                let second_near = if enters > near { enters } else { near };
                let halves = [index + 1, node.right()];
                let [first, second] = if cells.is_backward(axis) { [halves[1], halves[0]] } else { halves };
                if near <= first_far {
                    if second_near <= far {
                        stack[waiting] = (second as u32, second_near, far);
                        waiting += 1;
                    }
                    (index, far) = (first, first_far);
                } else {
                    // What is not in the first half is in the second.
                    (index, near) = (second, second_near);
                }
                continue;
            }
            let (first, count) = node.run();
            for &i in &self.lists[first..first + count] {
                if mailbox.is_new(i) {
                    self.records[i as usize].test(level, ray, search, enter);
                }
            }
            // Take up what is not yet ruled out; equal `t` is not.
            loop {
                if waiting == 0 {
                    search.counters.nodes_visited += nodes_visited;
                    return;
                }
                waiting -= 1;
                let (next, from, to) = stack[waiting];
                if from <= cells.limit(search.limit) {
                    (index, near, far) = (next as usize, from, to);
                    break;
                }
            }
        }
        search.counters.nodes_visited += nodes_visited;
    }
}
