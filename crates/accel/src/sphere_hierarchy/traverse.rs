//! Takes a ray through the tree, the nearer sphere first.

use super::Tree;
use crate::build::binary::{Child, MAX_DEPTH};
use crate::cells::thickness;
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Sphere;
use crate::search::{Enter, Level, Search};
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use kirkas_geometry::{Bounds3, DVec3};

/// What spheres grow by, in units of the distance from the ray's origin to their far side.
const PAD: f64 = 128.0 * UNIT_ROUNDOFF as f64;

/// What the test of a sphere needs of a ray.
struct SphereRay {
    origin: DVec3,
    direction: DVec3,
    per_length2: f64,
    t_min: f64,
    t_max: f64,
    /// The ray is beyond the range in which the test is safe.
    sees_all: bool,
}

impl SphereRay {
    fn new(ray: &PreparedRay, root: &Bounds3) -> Self {
        let direction = ray.clipped.direction.as_dvec3();
        SphereRay {
            origin: ray.clipped.origin.as_dvec3(),
            direction,
            per_length2: 1.0 / direction.dot(direction),
            t_min: ray.clipped.t_min.into(),
            t_max: ray.clipped.t_max.into(),
            sees_all: thickness(&ray.clipped, root) == f32::INFINITY,
        }
    }

    /// When the ray enters the sphere, if it does before `limit`.
    #[inline(always)]
    fn enters(&self, sphere: &Sphere, limit: f64) -> Option<f64> {
        if self.sees_all {
            return Some(f64::NEG_INFINITY);
        }
        let to_center = sphere.center.as_dvec3() - self.origin;
        let radius = f64::from(sphere.radius);
        let far_side = to_center.x.abs() + to_center.y.abs() + to_center.z.abs() + radius;
        let radius = radius + PAD * far_side;
        let middle = to_center.dot(self.direction) * self.per_length2;
        let nearest = to_center - self.direction * middle;
        let half2 = (radius * radius - nearest.dot(nearest)) * self.per_length2;
        if half2 < 0.0 {
            return None;
        }
        let half = half2.sqrt();
        let near = middle - half;
        (near <= limit && near <= self.t_max && middle + half >= self.t_min).then_some(near)
    }
}

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
        let (Some((mut current, sphere)), Some(bounds)) = (self.root, self.bounds) else { return };
        let spheres = SphereRay::new(ray, &bounds);
        if spheres.enters(&sphere, search.limit.into()).is_none() {
            return;
        }
        // Each level leaves at most one child behind.
        let mut stack = [(0.0_f64, Child::node(0)); MAX_DEPTH];
        let mut waiting = 0;
        while !search.is_done() {
            if current.is_leaf() {
                let (first, count) = current.run();
                for record in &self.records[first..first + count] {
                    record.test(level, ray, search, enter);
                }
            } else {
                search.counters.nodes_visited += 1;
                let node = &self.nodes[current.index()];
                let [a, b] = node.children;
                let near = node.spheres.each_ref().map(|s| spheres.enters(s, search.limit.into()));
                let (nearer, behind) = match near {
                    [Some(x), Some(y)] if y < x => (Some(b), Some((x, a))),
                    [Some(_), Some(y)] => (Some(a), Some((y, b))),
                    [Some(_), None] => (Some(a), None),
                    [None, Some(_)] => (Some(b), None),
                    [None, None] => (None, None),
                };
                if let Some(left_behind) = behind {
                    stack[waiting] = left_behind;
                    waiting += 1;
                }
                if let Some(child) = nearer {
                    current = child;
                    continue;
                }
            }
            // Take up what is not yet ruled out.
            loop {
                if waiting == 0 {
                    return;
                }
                waiting -= 1;
                let (near, child) = stack[waiting];
                if near <= f64::from(search.limit) {
                    current = child;
                    break;
                }
            }
        }
    }
}
