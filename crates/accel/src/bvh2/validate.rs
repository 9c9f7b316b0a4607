//! The tree's invariants, callable, and its measures.

use super::Tree;
use crate::build::binary::{Child, MAX_DEPTH};
use crate::build::costs::Costs;
use crate::instance::PlacedInstance;
use crate::primitive;
use crate::record::{IS_INSTANCE, Record, check_complete};
use crate::scene_geometry::Geometry;
use kirkas_geometry::Bounds3;

impl Tree {
    /// Each primitive in exactly one place, each box around all below it, depth within the stack.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        let mut held: Vec<&Record> = Vec::new();
        let depth = self.try_walk(|child, bounds, _| {
            if !child.is_leaf() {
                return Ok(());
            }
            let (first, count) = child.run();
            for r in self.records.get(first..first + count).ok_or("a leaf's run ends beyond the records")? {
                let is_instance = r.geometry == IS_INSTANCE;
                let own = match is_instance {
                    true => instances[r.primitive as usize].bounds,
                    false => primitive::bounds(&geometries[r.geometry as usize].shape, r.primitive),
                };
                if bounds.union(own) != bounds {
                    return Err(format!("a box does not hold primitive {} of geometry {}", r.primitive, r.geometry));
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
        self.try_walk(|_, _, _| Ok(())).unwrap_or(0)
    }

    /// Expected cost of a ray that meets the root's box: node visits times their cost plus primitive tests.
    pub fn sah_cost(&self) -> f64 {
        let area = |b: Bounds3| f64::from(b.surface_area());
        let Some(root_area) = self.bounds.map(area).filter(|a| *a > 0.0) else { return 0.0 };
        let mut cost = 0.0;
        let _ = self.try_walk(|child, bounds, _| {
            let each = if child.is_leaf() { child.run().1 as f64 } else { f64::from(Costs::BVH2.node) };
            cost += each * area(bounds) / root_area;
            Ok(())
        });
        cost
    }

    /// Visit every child with its box and depth, checking that boxes nest; returns the levels of inner nodes.
    fn try_walk(&self, mut visit: impl FnMut(Child, Bounds3, usize) -> Result<(), String>) -> Result<usize, String> {
        let (Some(root), Some(bounds)) = (self.root, self.bounds) else { return Ok(0) };
        let mut todo = vec![(root, bounds, 0)];
        let (mut depth, mut seen) = (0, 0);
        while let Some((child, bounds, level)) = todo.pop() {
            visit(child, bounds, level)?;
            if child.is_leaf() {
                continue;
            }
            seen += 1;
            if seen > self.nodes.len() {
                return Err("a node is reached twice".into());
            }
            let node = self.nodes.get(child.index()).ok_or("a child points beyond the nodes")?;
            depth = depth.max(level + 1);
            for side in 0..2 {
                let inner = node.child_bounds(side);
                if bounds.union(inner) != bounds {
                    return Err(format!("the box of node {} does not hold its child", child.index()));
                }
                todo.push((node.children[side], inner, level + 1));
            }
        }
        Ok(depth)
    }
}
