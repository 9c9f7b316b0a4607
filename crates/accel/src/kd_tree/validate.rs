//! The tree's invariants, callable, and its measures.

use super::build::{MAX_DEPTH, NODE_COST};
use super::node::Node;
use super::{Primitives, Tree};
use crate::Serial;
use crate::build::reference::Reference;
use crate::cells::growth;
use crate::gather::gather;
use crate::instance::PlacedInstance;
use crate::record::check_complete;
use crate::scene_geometry::Geometry;
use kirkas_geometry::Bounds3;

impl Tree {
    /// Each primitive in each leaf where it can be hit, each node reached once, cells nested, indices in range.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        check_complete(self.records.iter().chain(&self.unbounded), geometries, instances)?;
        let references = gather(geometries, instances, &Serial).references;
        let Some(bounds) = self.bounds else { return Ok(()) };
        if !references.iter().all(|r| bounds.union(r.bounds()) == bounds) {
            return Err("the root does not hold every primitive".into());
        }
        let primitives = Primitives { references: &references, records: &self.records, growth: growth(&bounds) };
        let mut lists_seen = 0;
        let mut listed = vec![false; references.len()];
        // What must be listed below each node, cut from scratch.
        let whole = references.iter().map(Reference::bounds).enumerate().map(|(i, b)| (i as u32, b)).collect();
        let mut needed: Vec<Vec<(u32, Bounds3)>> = vec![whole];
        let depth = self.try_walk(|node, cell, _| {
            let here = needed.pop().ok_or("a node without a parent")?;
            if !node.is_leaf() {
                let (axis, position) = (node.axis(), node.position());
                let cells = node.halves(cell);
                let mut below = [Vec::new(), Vec::new()];
                for (i, b) in here {
                    let cut = match b.min[axis] < position && b.max[axis] > position {
                        true => primitives.cut(i, &cells),
                        false if b.max[axis] > position => [Bounds3::EMPTY, b],
                        false if b.min[axis] < position => [b, Bounds3::EMPTY],
                        // Within the plane: on either side.
                        false => [Bounds3::EMPTY; 2],
                    };
                    for (below, part) in below.iter_mut().zip(cut) {
                        if !part.is_empty() {
                            below.push((i, part));
                        }
                    }
                }
                let [left, right] = below;
                needed.extend([right, left]);
                return Ok(());
            }
            let (first, count) = node.run();
            let list = self.lists.get(first..first + count).ok_or("a leaf's run ends beyond the list")?;
            lists_seen += count;
            for &i in list {
                *listed.get_mut(i as usize).ok_or("a list names a primitive that is not there")? = true;
            }
            match here.iter().find(|(i, _)| !list.contains(i)) {
                Some((i, _)) => Err(format!("primitive {i} is missing in a leaf")),
                None => Ok(()),
            }
        })?;
        if depth > MAX_DEPTH {
            return Err(format!("{depth} levels of nodes; the stack holds {MAX_DEPTH}"));
        }
        if lists_seen != self.lists.len() || listed.contains(&false) {
            return Err("the leaves do not share out the list, or miss a primitive".into());
        }
        Ok(())
    }

    /// Levels of inner nodes.
    pub fn depth(&self) -> usize {
        self.try_walk(|_, _, _| Ok(())).unwrap_or(0)
    }

    /// Expected cost of a ray that meets the root: node visits times their cost (0.75) plus primitive tests.
    pub fn sah_cost(&self) -> f64 {
        let area = |b: &Bounds3| {
            let [x, y, z] = (b.max.as_dvec3() - b.min.as_dvec3()).to_array();
            x * y + (x + y) * z
        };
        let Some(root_area) = self.bounds.as_ref().map(area).filter(|a| *a > 0.0) else { return 0.0 };
        let mut cost = 0.0;
        let _ = self.try_walk(|node, cell, _| {
            cost += area(cell) / root_area * if node.is_leaf() { node.run().1 as f64 } else { NODE_COST };
            Ok(())
        });
        cost
    }

    /// Visit every node, depth first and left first, with its cell and depth; returns the levels of inner nodes.
    fn try_walk(&self, mut visit: impl FnMut(Node, &Bounds3, usize) -> Result<(), String>) -> Result<usize, String> {
        let Some(bounds) = self.bounds else { return Ok(0) };
        let mut todo = vec![(0, bounds, 0)];
        let (mut depth, mut seen) = (0, 0);
        while let Some((index, cell, level)) = todo.pop() {
            if index != seen {
                return Err("the nodes are not in depth-first order".into());
            }
            seen += 1;
            let node = *self.nodes.get(index).ok_or("a child points beyond the nodes")?;
            visit(node, &cell, level)?;
            if node.is_leaf() {
                continue;
            }
            depth = depth.max(level + 1);
            let (axis, position) = (node.axis(), node.position());
            if !(position > cell.min[axis] && position < cell.max[axis]) {
                return Err(format!("the plane of node {index} is not within its cell"));
            }
            let [left, right] = node.halves(&cell);
            todo.extend([(node.right(), right, level + 1), (index + 1, left, level + 1)]);
        }
        if seen == self.nodes.len() { Ok(depth) } else { Err("a node is never reached".into()) }
    }
}
