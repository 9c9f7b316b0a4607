//! Builds trees of lights by the surface-area-orientation heuristic (Conty Estevez & Kulla 2018, section 4.4): halves are
//! chosen so that power, size and spread of normals together are small.
//!
//! Size is the square of a box's diagonal instead of its surface, since the walk bounds by spheres: so that lights in a row
//! or in a plane are told apart as well.

use super::tree::MOST_FORKS;
use super::tree_node::{LightBounds, Link, Node};
use core::f64::consts::PI;
use kirkas_geometry::elementary::{cos, sin};

type Item = (u32, LightBounds);

/// Planes that are tried are the borders of this many slices.
const SLICES: usize = 12;

/// Append the tree of `items` to `nodes`, its root first.
pub(super) fn build(items: &mut [Item], nodes: &mut Vec<Node>) {
    let root = together(items);
    nodes.push(Node::new(&root, Link::Light(items[0].0)));
    divide(items, &root, 0, 0, nodes);
}

/// Make the node at `place` the tree of `items`.
fn divide(items: &mut [Item], all: &LightBounds, place: usize, forks: u32, nodes: &mut Vec<Node>) {
    if items.len() == 1 {
        nodes[place] = Node::new(all, Link::Light(items[0].0));
        return;
    }
    // Halving by number from here on still ends in time, for up to 2^32 lights.
    let middle = if forks + 32 >= MOST_FORKS { None } else { split(items, all) };
    let middle = middle.unwrap_or_else(|| halve(items, all));
    let (left, right) = items.split_at_mut(middle);
    let first = nodes.len();
    nodes[place] = Node::new(all, Link::Children(first as u32));
    let (a, b) = (together(left), together(right));
    nodes.push(Node::new(&a, Link::Light(0)));
    nodes.push(Node::new(&b, Link::Light(0)));
    divide(left, &a, first, forks + 1, nodes);
    divide(right, &b, first + 1, forks + 1, nodes);
}

fn together(items: &[Item]) -> LightBounds {
    items[1..].iter().fold(items[0].1, |all, i| all.union(&i.1))
}

/// Order the items by the best plane and say where it lies; `None` if none divides them.
fn split(items: &mut [Item], all: &LightBounds) -> Option<usize> {
    let centers = items.iter().map(|i| i.1.bounds.center());
    let (low, high) = centers.fold((all.bounds.max, all.bounds.min), |(l, h), c| (l.min(c), h.max(c)));
    let longest = all.bounds.extent().max_element();
    let mut best: Option<(f64, usize, usize)> = None;
    let slice = |b: &LightBounds, axis: usize| {
        let share = (b.bounds.center()[axis] - low[axis]) / (high[axis] - low[axis]);
        ((share * SLICES as f32) as usize).min(SLICES - 1)
    };
    for axis in 0..3 {
        if !(high[axis] > low[axis]) {
            continue;
        }
        let mut slices: [Option<LightBounds>; SLICES] = [None; SLICES];
        for (_, b) in items.iter() {
            let s = &mut slices[slice(b, axis)];
            *s = Some(s.map_or(*b, |s| s.union(b)));
        }
        // Thin boxes are not cut thinner.
        let thinness = f64::from(longest / all.bounds.extent()[axis].max(f32::MIN_POSITIVE)).min(1e6);
        let join = |a: Option<LightBounds>, b: &Option<LightBounds>| match (a, b) {
            (Some(a), Some(b)) => Some(a.union(b)),
            (a, b) => a.or(*b),
        };
        for plane in 1..SLICES {
            let left = slices[..plane].iter().fold(None, join);
            let right = slices[plane..].iter().fold(None, join);
            let (Some(left), Some(right)) = (left, right) else { continue };
            let cost = thinness * (cost(&left) + cost(&right));
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, axis, plane));
            }
        }
    }
    let (_, axis, plane) = best?;
    items.sort_by_key(|i| slice(&i.1, axis) >= plane);
    Some(items.partition_point(|i| slice(&i.1, axis) < plane))
}

/// Order the items along the longest axis, and cut in the middle.
fn halve(items: &mut [Item], all: &LightBounds) -> usize {
    let extent = all.bounds.extent();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    items.sort_by(|a, b| a.1.bounds.center()[axis].total_cmp(&b.1.bounds.center()[axis]));
    items.len() / 2
}

/// Power times size times orientation measure (equation 1 of the paper).
fn cost(b: &LightBounds) -> f64 {
    let diagonal = f64::from(b.bounds.extent().length());
    let (o, w) = (b.normals.angle, (b.normals.angle + b.spread).min(PI));
    let orientation =
        2.0 * PI * (1.0 - cos(o)) + 0.5 * PI * (2.0 * w * sin(o) - cos(o - 2.0 * w) - 2.0 * o * sin(o) + cos(o));
    b.power * diagonal * diagonal * orientation
}
