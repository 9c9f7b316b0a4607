//! The tree's invariants, callable, and its measures.

use super::{Tree, own_bounds, reach};
use crate::build::binary::{Child, MAX_DEPTH};
use crate::build::costs::Costs;
use crate::instance::PlacedInstance;
use crate::record::{Record, check_complete};
use crate::scene_geometry::{Geometry, Sphere};

impl Tree {
    /// Each primitive in exactly one leaf and within each sphere above it, depth within the stack.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        let mut held: Vec<&Record> = Vec::new();
        let depth = self.try_walk(|child, above| {
            if !child.is_leaf() {
                return Ok(());
            }
            let (first, count) = child.run();
            for r in self.records.get(first..first + count).ok_or("a leaf's run ends beyond the records")? {
                let bounds = own_bounds(r, geometries, instances);
                let holds = |s: &Sphere| reach(s.center, r, &bounds) <= f64::from(s.radius);
                if !above.iter().all(holds) {
                    return Err(format!("a sphere does not hold primitive {} of geometry {}", r.primitive, r.geometry));
                }
                held.push(r);
            }
            Ok(())
        })?;
        if depth > MAX_DEPTH {
            return Err(format!("{depth} levels of nodes; the stack holds {MAX_DEPTH}"));
        }
        check_complete(held.into_iter().chain(&self.unbounded), geometries, instances)
    }

    /// Levels of inner nodes.
    pub fn depth(&self) -> usize {
        self.try_walk(|_, _| Ok(())).unwrap_or(0)
    }

    /// Expected cost of a ray that meets the root's sphere: node visits times their cost (2) plus primitive tests. The
    /// chance to meet a sphere inside another is the ratio of their areas.
    pub fn sah_cost(&self) -> f64 {
        let area = |s: &Sphere| f64::from(s.radius) * f64::from(s.radius);
        let mut cost = 0.0;
        let _ = self.try_walk(|child, above| {
            let chance = above.last().map_or(0.0, area) / above.first().map_or(1.0, area);
            let each = if child.is_leaf() { child.run().1 as f64 } else { f64::from(Costs::BVH2.node) };
            cost += each * chance.min(1.0);
            Ok(())
        });
        cost
    }

    /// Visit every child with the spheres around it, outermost first; returns the levels of inner nodes.
    fn try_walk(&self, mut visit: impl FnMut(Child, &[Sphere]) -> Result<(), String>) -> Result<usize, String> {
        let Some((root, sphere)) = self.root else { return Ok(0) };
        let mut todo = vec![(root, sphere, 0)];
        let mut above: Vec<Sphere> = Vec::new();
        let (mut depth, mut seen) = (0, 0);
        while let Some((child, sphere, level)) = todo.pop() {
            above.truncate(level);
            above.push(sphere);
            visit(child, &above)?;
            if child.is_leaf() {
                continue;
            }
            seen += 1;
            if seen > self.nodes.len() {
                return Err("a node is reached twice".into());
            }
            let node = self.nodes.get(child.index()).ok_or("a child points beyond the nodes")?;
            depth = depth.max(level + 1);
            todo.extend([0, 1].map(|side| (node.children[side], node.spheres[side], level + 1)));
        }
        Ok(depth)
    }
}
