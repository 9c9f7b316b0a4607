//! What must hold of trees with cut triangles.

use super::*;
use crate::Serial;
use crate::build::binary::MAX_DEPTH;
use crate::build::binned_sah;
use crate::build::testing::Backwards;
use crate::triangle;
use kirkas_geometry::elementary::sin_cos_f32;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Bounds3, Vec3};

/// A stream of numbers in `[-1, 1)`.
struct Random(u64, u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.1 += 1;
        unit_f32(combine(self.0, self.1) as u32) * 2.0 - 1.0
    }
    fn cube(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// Slivers, huge and tiny ones.
fn soup(count: usize, seed: u64) -> Vec<Corners> {
    let mut r = Random(seed, 0);
    let mut triangle = |i: usize| {
        let (size, thin) = ([2.0, 0.1, 0.001][i % 3], [1.0, 0.01, 1e-5][i / 3 % 3]);
        let (a, along) = (r.cube() * 4.0, r.cube() * size);
        [a, a + along, a + along * 0.4 + r.cube() * (size * thin)].map(|p| p.to_array())
    };
    (0..count).map(&mut triangle).collect()
}

fn references(triangles: &[Corners]) -> Vec<Reference> {
    let of = |(i, t): (usize, &Corners)| Reference::new(&triangle::bounds(t), 0, i as u32);
    triangles.iter().enumerate().map(of).collect()
}

fn cut(triangles: &[Corners], executor: &dyn Executor) -> BinaryTree {
    build(references(triangles), &|r| Some(triangles[r.ids().1 as usize]), &Costs::WIDE, executor)
}

/// Each leaf as its depth, its box and its references' boxes; the boxes above hold it.
fn leaves(tree: &BinaryTree) -> Vec<(usize, Bounds3, std::ops::Range<usize>)> {
    let mut todo: Vec<_> = tree.root.map(|root| (root, 0, Bounds3::EVERYTHING)).into_iter().collect();
    let (mut found, mut end) = (Vec::new(), 0);
    while let Some((child, depth, bounds)) = todo.pop() {
        if child.is_leaf() {
            let (first, count) = child.run();
            assert_eq!(first, end, "the leaves' runs follow one another");
            end += count;
            found.push((depth, bounds, first..end));
            continue;
        }
        let node = &tree.nodes[child.index()];
        assert!(node.children[0].is_leaf() || node.children[0].index() == child.index() + 1);
        for side in [1, 0] {
            let inner = node.child_bounds(side);
            assert!(bounds.union(inner) == bounds || bounds == Bounds3::EVERYTHING);
            todo.push((node.children[side], depth + 1, inner));
        }
    }
    assert_eq!(end, tree.references.len());
    found
}

/// Blocks and nodes to be visited by a ray that meets the whole.
fn cost(tree: &BinaryTree) -> f64 {
    let whole = tree.references.iter().fold(Bounds3::EMPTY, |b, r| b.union(r.bounds()));
    let nodes: f64 = tree.nodes.iter().flat_map(|n| [0, 1].map(|s| f64::from(n.child_bounds(s).surface_area()))).sum();
    nodes / f64::from(whole.surface_area())
}

#[test]
fn every_point_of_a_triangle_is_in_a_leaf_that_holds_it() {
    let triangles = soup(3000, 1);
    let tree = cut(&triangles, &Serial);
    assert!(tree.references.len() > triangles.len() * 21 / 20, "{} references", tree.references.len());
    let mut boxes = vec![Vec::new(); triangles.len()];
    for (_, bounds, run) in leaves(&tree) {
        for r in &tree.references[run] {
            assert_eq!(bounds.union(r.bounds()), bounds);
            boxes[r.ids().1 as usize].push(r.bounds());
        }
    }
    let mut r = Random(2, 0);
    for i in 0..100_000 {
        let t = &triangles[i % triangles.len()];
        let [a, b, c] = t.map(|c| Vec3::from_array(c).as_dvec3());
        let (u, v) = (f64::from(r.next()).abs(), f64::from(r.next()).abs());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let p = a + (b - a) * u + (c - a) * v;
        let growth = f64::from(triangle::growth(t)) * 0.99;
        let moved = p + r.cube().as_dvec3().signum() * growth;
        let holds = |b: &Bounds3| moved.cmpge(b.min.as_dvec3()).all() && moved.cmple(b.max.as_dvec3()).all();
        let own = &boxes[i % triangles.len()];
        assert!(own.iter().any(holds), "{moved} of {t:?} is in none of {own:?}");
    }
}

#[test]
fn the_executor_does_not_show_and_the_room_suffices() {
    let triangles = soup(3 * FORK_ABOVE, 3);
    let [a, b]: [&dyn Executor; 2] = [&Serial, &Backwards];
    let [a, b] = [a, b].map(|e| cut(&triangles, e));
    let node = |n: &Node| (n.planes.map(|p| p.map(|s| s.map(f32::to_bits))), n.children);
    assert!(a.nodes.iter().map(node).eq(b.nodes.iter().map(node)) && a.root == b.root);
    let reference = |r: &Reference| (r.ids(), r.bounds().min.to_array(), r.bounds().max.to_array());
    assert!(a.references.iter().map(reference).eq(b.references.iter().map(reference)));
    let most = triangles.len() as f32 * (1.0 + ROOM);
    assert!((triangles.len()..=most as usize).contains(&a.references.len()), "{}", a.references.len());
    assert!(leaves(&a).iter().all(|(depth, ..)| *depth <= MAX_DEPTH));
}

#[test]
fn cuts_make_trees_cheaper() {
    let cheaper = |triangles: &[Corners]| {
        let whole = binned_sah::build(references(triangles), &Costs::WIDE, &Serial);
        cost(&whole) / cost(&cut(triangles, &Serial))
    };
    for seed in 0..8 {
        let gain = cheaper(&soup(2000, seed));
        assert!(gain >= 1.0, "soup {seed}: {gain}");
    }
    // The stands of a stadium, and something small in the middle.
    let mut stadium = soup(70_000, 9).into_iter().map(|t| t.map(|c| c.map(|x| x * 0.02))).collect::<Vec<_>>();
    for k in 0..12_000 {
        let at = |k: usize, radius: f32, height: f32| {
            let (s, c) = sin_cos_f32(k as f32 * (core::f32::consts::TAU / 12_000.0));
            [c * radius, height, s * radius]
        };
        stadium.push([at(k, 50.0, 0.0), at(k + 1, 50.0, 0.0), at(k + 80, 100.0, 40.0)]);
    }
    let gain = cheaper(&stadium);
    assert!(gain > 2.5, "stadium: {gain}");
}

#[test]
fn what_coincides_or_shares_its_center_is_built_within_the_depth() {
    let one = soup(1, 5)[0];
    let nested = |i: usize| one.map(|c| c.map(|x| x * f32::from_bits((97 + i as u32 % 60) << 23)));
    let centered = |i: usize| {
        let s = 1.0 + i as f32;
        [[-s, -s, -s], [s, s, s], [-s, s, -s]]
    };
    let point = [[1.0_f32; 3]; 3];
    let sets: [Vec<Corners>; 5] = [
        vec![one; 1000],
        (0..1000).map(nested).collect(),
        (0..1000).map(centered).collect(),
        vec![point; 1000],
        vec![[[0.0; 3], [1e30, 1e30, 0.0], [0.0, 1e30, 1e30]]; 100],
    ];
    for set in sets {
        let tree = cut(&set, &Serial);
        assert!(leaves(&tree).iter().all(|(depth, ..)| *depth <= MAX_DEPTH));
        let mut ids: Vec<u32> = tree.references.iter().map(|r| r.ids().1).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), set.len());
        assert!(tree.references.iter().all(|r| r.bounds().min.cmple(r.bounds().max).all()), "neither NaN nor empty");
    }
}

#[test]
fn what_has_no_corners_is_not_cut() {
    let triangles = soup(500, 6);
    let tree = build(references(&triangles), &|_| None, &Costs::WIDE, &Serial);
    assert_eq!(tree.references.len(), triangles.len());
    assert!(build(Vec::new(), &|_| None, &Costs::WIDE, &Serial).root.is_none());
}
