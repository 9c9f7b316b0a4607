//! Takes a ray through the tree, the nearer child first.

use super::Tree;
use super::node::NodeRay;
use crate::build::binary::{Child, MAX_DEPTH};
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
        let Some(mut current) = self.root else { return };
        let node_ray = NodeRay::new(ray);
        // Each inner node on the way down leaves at most one child behind, so the depth bounds the stack.
        let mut stack = Stack { entries: [0; MAX_DEPTH], len: 0 };
        let mut nodes_visited = 0;
        'walk: while !search.is_done() {
            if current.is_leaf() {
                let (first, count) = current.run();
                for record in &self.records[first..first + count] {
                    record.test(level, ray, search, enter);
                }
            } else {
                nodes_visited += 1;
                let node = &self.nodes[current.index()];
                let limit = if search.limit < ray.clipped.t_max { search.limit } else { ray.clipped.t_max };
                let (near, hit) = node.intersect(&node_ray, limit);
                let [a, b] = node.children;
                // Branches, not arithmetic: a guessed branch starts to load the child early.
                match hit {
                    [true, true] => {
                        current = if near[1] < near[0] {
                            stack.push(near[0], a);
                            b
                        } else {
                            stack.push(near[1], b);
                            a
                        };
                        continue;
                    }
                    [true, false] => {
                        current = a;
                        continue;
                    }
                    [false, true] => {
                        current = b;
                        continue;
                    }
                    [false, false] => {}
                }
            }
            // Take up what is not yet ruled out; equal `t` is not.
            loop {
                match stack.pop() {
                    None => break 'walk,
                    Some((near, child)) if near <= search.limit => {
                        current = child;
                        break;
                    }
                    Some(_) => {}
                }
            }
        }
        search.counters.nodes_visited += nodes_visited;
    }
}

/// What was left behind: in each entry when the ray enters it (bits of an f32), and the child.
struct Stack {
    entries: [u64; MAX_DEPTH],
    len: usize,
}

impl Stack {
    #[inline(always)]
    fn push(&mut self, near: f32, child: Child) {
        self.entries[self.len] = u64::from(near.to_bits()) << 32 | u64::from(child.bits());
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(f32, Child)> {
        self.len = self.len.checked_sub(1)?;
        let entry = self.entries[self.len];
        Some((f32::from_bits((entry >> 32) as u32), Child::from_bits(entry as u32)))
    }
}
