//! A tree of lights: a hierarchy of boxes, cones of normals and powers, from which one light is drawn in a walk from the
//! root down, at every fork by how much each side could send to the point that asks (Conty Estevez & Kulla 2018,
//! "Importance Sampling of Many Lights with Adaptive Tree Splitting").
//!
//! The walk ends at one light; trees are not split into several walks. Importance takes lights as spread through the spheres
//! around their boxes, as the cost of the builder does. A light that can send anything to a point never has probability 0 there: all tests for
//! "cannot" are widened by more than rounding.

use super::tree_build::build;
use super::tree_node::{Link, Node};
use kirkas_geometry::hash::mix64;
use kirkas_geometry::{DVec3, Vec3};

pub use super::tree_node::LightBounds;

/// The tree.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The root is the first.
    nodes: Vec<Node>,
    /// Per light: the way from the root, one bit a fork, the first fork lowest; `None` for lights that are not in it.
    ways: Vec<Option<u64>>,
}

/// More forks than any way has.
pub(super) const MOST_FORKS: u32 = 60;

impl LightTree {
    /// Of all lights that are bounded and send anything; the others are told by `None`. `None` if there is no such light.
    pub fn new(lights: &[Option<LightBounds>]) -> Option<Self> {
        let usable =
            |b: &LightBounds| b.power > 0.0 && b.power.is_finite() && b.bounds.is_finite() && !b.bounds.is_empty();
        let mut items: Vec<(u32, LightBounds)> =
            lights.iter().enumerate().filter_map(|(i, b)| Some((i as u32, b.filter(usable)?))).collect();
        let mut tree = LightTree { nodes: Vec::new(), ways: vec![None; lights.len()] };
        if items.is_empty() {
            return None;
        }
        build(&mut items, &mut tree.nodes);
        tree.note_ways(0, 0, 0);
        Some(tree)
    }

    fn note_ways(&mut self, node: u32, way: u64, forks: u32) {
        match self.nodes[node as usize].link {
            Link::Light(light) => self.ways[light as usize] = Some(way),
            Link::Children(first) => {
                self.note_ways(first, way, forks + 1);
                self.note_ways(first + 1, way | 1 << forks, forks + 1);
            }
        }
    }

    /// The light of a tree that holds no other.
    pub fn only(&self) -> Option<u32> {
        match self.nodes[0].link {
            Link::Light(light) => Some(light),
            Link::Children(_) => None,
        }
    }

    /// How much all lights together could send to a point, W per square unit; above 0 if any can send anything.
    pub fn importance(&self, point: DVec3, normal: DVec3) -> f32 {
        self.nodes[0].importance(point.as_vec3(), normal.as_vec3())
    }

    /// True for the lights of the tree.
    pub fn holds(&self, light: u32) -> bool {
        self.ways.get(light as usize).is_some_and(Option::is_some)
    }

    /// A light and its probability. `u` in `[0, 1)`.
    pub fn pick(&self, point: DVec3, normal: DVec3, u: f64) -> (u32, f32) {
        let (point, normal) = (point.as_vec3(), normal.as_vec3());
        let (mut node, mut probability, mut u) = (&self.nodes[0], 1.0, u);
        loop {
            match node.link {
                Link::Light(light) => return (light, probability),
                Link::Children(first) => {
                    let p = self.first_share(first, point, normal);
                    let wide = f64::from(p);
                    if u < wide {
                        (node, probability, u) = (&self.nodes[first as usize], probability * p, u / wide);
                    } else {
                        let rest = 1.0 - p;
                        u = ((u - wide) / f64::from(rest)).min(1.0 - f64::EPSILON);
                        (node, probability) = (&self.nodes[first as usize + 1], probability * rest);
                    }
                }
            }
        }
    }

    /// The probability with which `pick` draws a light: the same products in the same order.
    pub fn probability(&self, point: DVec3, normal: DVec3, light: u32) -> f32 {
        let Some(Some(mut way)) = self.ways.get(light as usize).copied() else { return 0.0 };
        let (point, normal) = (point.as_vec3(), normal.as_vec3());
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        while let Link::Children(first) = node.link {
            let p = self.first_share(first, point, normal);
            let second = way & 1;
            probability *= if second == 0 { p } else { 1.0 - p };
            node = &self.nodes[first as usize + second as usize];
            way >>= 1;
        }
        probability
    }

    /// The probability of the first of two children: by importance; where neither can send anything, by power.
    fn first_share(&self, first: u32, point: Vec3, normal: Vec3) -> f32 {
        let (a, b) = (&self.nodes[first as usize], &self.nodes[first as usize + 1]);
        let (ia, ib) = (a.importance(point, normal), b.importance(point, normal));
        if ia == 0.0 && ib == 0.0 {
            return a.power / (a.power + b.power);
        }
        // Kept clear of 0 and 1 where both can send something, however little.
        const LEAST: f32 = 1e-6;
        let p = ia / (ia + ib);
        if ia == 0.0 || ib == 0.0 { p } else { p.clamp(LEAST, 1.0 - LEAST) }
    }
}

/// `u` with more digits than an `f32` has, which depend on where they are used: with 24 digits alone the rarest of many
/// lights would never be drawn.
pub fn more_digits(u: f32, point: DVec3) -> f64 {
    let key = point.to_array().into_iter().fold(u64::from(u.to_bits()), |h, x| mix64(h ^ x.to_bits()));
    const STEP: f64 = 1.0 / 16_777_216.0;
    f64::from(u) + (key >> 40) as f64 * STEP * STEP
}

#[cfg(test)]
mod tests {
    use super::super::cone::Cone;
    use super::*;
    use core::f64::consts::FRAC_PI_2;
    use kirkas_geometry::Bounds3;
    use kirkas_geometry::warp::square_to_uniform_sphere;
    use kirkas_testkit::Random;

    /// Lights of all kinds, in heaps and alone.
    fn lights(n: u32) -> Vec<Option<LightBounds>> {
        let mut r = Random::new(9);
        let mut number = || f64::from(r.number());
        (0..n)
            .map(|i| {
                let heap = f64::from(i % 5) * 10.0;
                let p = DVec3::new(heap + number(), number() * 3.0, number() - 0.5);
                let size = if i % 3 == 0 { 0.0 } else { number() * 0.3 };
                let axis = DVec3::new(number() - 0.5, number() - 0.5, number() - 0.5).normalize();
                let normals = if i % 2 == 0 { Cone::ALL } else { Cone { axis, angle: number() } };
                let bounds = Bounds3::around_f64(p - DVec3::splat(size), p + DVec3::splat(size));
                let spread = if i % 4 == 3 { 0.3 } else { FRAC_PI_2 };
                (i % 11 != 10).then(|| LightBounds { bounds, normals, spread, power: number() * number() + 1e-3 })
            })
            .collect()
    }

    fn places() -> impl Iterator<Item = (DVec3, DVec3)> {
        let mut r = Random::new(2);
        (0..200).map(move |i| {
            let p = DVec3::new(
                f64::from(r.number()) * 45.0 - 2.0,
                f64::from(r.number()) * 4.0,
                f64::from(r.number()) - 0.5,
            );
            let n = square_to_uniform_sphere(r.pair()).as_dvec3();
            (p, if i % 5 == 0 { DVec3::ZERO } else { n })
        })
    }

    #[test]
    fn probabilities_sum_to_one_everywhere() {
        for count in [1, 2, 3, 500] {
            let lights = lights(count);
            let tree = LightTree::new(&lights).unwrap();
            for (p, n) in places() {
                let sum: f64 = (0..count).map(|i| f64::from(tree.probability(p, n, i))).sum();
                assert!((sum - 1.0).abs() < 1e-4, "{sum}");
            }
            assert!((0..count).all(|i| tree.holds(i) == lights[i as usize].is_some()));
            assert!(!tree.holds(count));
        }
    }

    #[test]
    fn lights_are_picked_as_often_as_promised() {
        let tree = LightTree::new(&lights(60)).unwrap();
        for (p, n) in places().take(20) {
            const N: u32 = 40_000;
            let mut seen = [0.0; 60];
            for i in 0..N {
                let (light, probability) = tree.pick(p, n, (f64::from(i) + 0.5) / f64::from(N));
                assert_eq!(probability, tree.probability(p, n, light));
                seen[light as usize] += 1.0 / f64::from(N);
            }
            for (i, seen) in seen.iter().enumerate() {
                let promised = f64::from(tree.probability(p, n, i as u32));
                assert!((seen - promised).abs() <= 3.0 / f64::from(N), "{i}: {seen} instead of {promised}");
            }
        }
    }

    /// Points of the box, normals of the cone: whatever can be seen from there must be pickable.
    #[test]
    fn a_light_that_can_send_anything_is_never_forgotten() {
        let lights = lights(300);
        let tree = LightTree::new(&lights).unwrap();
        let mut r = Random::new(7);
        let mut checked = 0;
        for (p, n) in places() {
            for (i, b) in lights.iter().enumerate().filter_map(|(i, b)| Some((i, b.as_ref()?))) {
                let corner = |r: &mut Random| DVec3::from_array(std::array::from_fn(|_| f64::from(r.number())));
                let extent = b.bounds.extent().as_dvec3();
                let from = b.bounds.min.as_dvec3() + corner(&mut r) * extent;
                let to = (p - from).normalize_or_zero();
                let off_axis = kirkas_geometry::elementary::acos(to.dot(b.normals.axis).clamp(-1.0, 1.0));
                let sends = off_axis < b.normals.angle + b.spread && (n == DVec3::ZERO || n.dot(-to) > 0.0);
                if sends && to != DVec3::ZERO {
                    assert!(tree.probability(p, n, i as u32) > 0.0, "{i} at {p} {n}: {b:?}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 10_000);
    }

    #[test]
    fn near_and_facing_lights_are_preferred() {
        let at = |x: f64| Bounds3::around_f64(DVec3::X * x, DVec3::X * x);
        let near_or_far = LightTree::new(&[
            Some(LightBounds::all_around(at(1.0), 1.0)),
            Some(LightBounds::all_around(at(10.0), 1.0)),
        ]);
        let p = near_or_far.unwrap().probability(DVec3::ZERO, DVec3::X, 0);
        assert!((p - 100.0 / 101.0).abs() < 1e-3, "{p}");
        let facing = |x: f64| LightBounds { normals: Cone::of(DVec3::X * x), ..LightBounds::all_around(at(-5.0), 1.0) };
        let tree = LightTree::new(&[Some(facing(1.0)), Some(facing(-1.0))]).unwrap();
        assert_eq!(tree.probability(DVec3::ZERO, DVec3::ZERO, 0), 1.0);
        assert_eq!(tree.probability(DVec3::ZERO, DVec3::ZERO, 1), 0.0);
    }

    #[test]
    fn hostile_lights_make_no_deep_or_broken_tree() {
        let same = vec![Some(LightBounds::all_around(Bounds3::from_corners(Vec3::ONE, Vec3::ONE), 1.0)); 3000];
        let rising = |i: i32| {
            let x = DVec3::X * kirkas_geometry::elementary::pow(1.1, f64::from(i));
            Some(LightBounds::all_around(Bounds3::around_f64(x, x), 1.0))
        };
        let nothing = [
            None,
            Some(LightBounds::all_around(Bounds3::EMPTY, 1.0)),
            rising(3).map(|b| LightBounds { power: 0.0, ..b }),
        ];
        assert!(LightTree::new(&nothing).is_none() && LightTree::new(&[]).is_none());
        for lights in [same, (0..800).map(rising).collect()] {
            let tree = LightTree::new(&lights).unwrap();
            let sum: f64 =
                (0..lights.len() as u32).map(|i| f64::from(tree.probability(DVec3::ONE, DVec3::ZERO, i))).sum();
            assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        }
    }

    #[test]
    fn more_digits_stay_below_one_and_in_their_place() {
        for u in [0.0, 0.25, 1.0_f32.next_down()] {
            let more = more_digits(u, DVec3::ONE);
            assert!(more >= f64::from(u) && more < f64::from(u) + 1.0 / 16_777_216.0 && more < 1.0);
        }
    }
}
