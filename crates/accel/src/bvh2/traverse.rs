//! Takes a ray through the tree, the nearer child first.

use super::node::{NodeRay, Record, RecordKind};
use super::{MAX_DEPTH, Tree};
use crate::prepared_ray::PreparedRay;
use crate::primitive;
use crate::scene_geometry::{Shape, Sphere};
use crate::search::{Level, Search};
use crate::{sphere, triangle};
use kirkas_geometry::Vec3;

impl Tree {
    /// Search all that the tree holds; `enter` searches an instance.
    pub fn search<const ANY: bool>(
        &self,
        level: Level,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        mut enter: impl FnMut(&mut Search<ANY>, u32),
    ) {
        for record in &self.unbounded {
            test(record, level, ray, search, &mut enter);
        }
        let Some(mut current) = self.root else { return };
        let node_ray = NodeRay::new(ray);
        // Each inner node on the way down leaves at most one child behind, so the depth bounds the stack.
        let mut stack = [(0.0_f32, current); MAX_DEPTH];
        let mut top = 0;
        loop {
            if search.is_done() {
                return;
            }
            if current.is_leaf() {
                let (first, count) = current.run();
                for record in &self.records[first..first + count] {
                    test(record, level, ray, search, &mut enter);
                }
            } else {
                search.counters.nodes_visited += 1;
                let node = &self.nodes[current.index()];
                let limit = if search.limit < ray.clipped.t_max { search.limit } else { ray.clipped.t_max };
                let (near, hit) = node.intersect(&node_ray, limit);
                let [a, b] = node.children;
                match hit {
                    [true, true] => {
                        let (nearer, farther) = if near[1] < near[0] { (b, (near[0], a)) } else { (a, (near[1], b)) };
                        stack[top] = farther;
                        top += 1;
                        current = nearer;
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
                if top == 0 {
                    return;
                }
                top -= 1;
                let (near, child) = stack[top];
                if near <= search.limit {
                    current = child;
                    break;
                }
            }
        }
    }
}

impl NodeRay {
    fn new(ray: &PreparedRay) -> Self {
        let inverse = ray.inverse.to_array();
        NodeRay {
            origin: ray.clipped.origin.to_array(),
            inverse,
            first: inverse.map(|i| usize::from(i.is_sign_negative())),
            t_min: ray.clipped.t_min,
        }
    }
}

#[inline(always)]
fn test<const ANY: bool>(
    record: &Record,
    level: Level,
    ray: &PreparedRay,
    search: &mut Search<ANY>,
    enter: &mut impl FnMut(&mut Search<ANY>, u32),
) {
    let (geometry, index) = (record.geometry, record.primitive);
    match record.kind {
        RecordKind::Triangle => {
            search.counters.primitives_tested += 1;
            if let Some(crossing) = triangle::intersect(&record.corners, ray) {
                search.offer(level, geometry, index, crossing);
            }
        }
        RecordKind::Sphere => {
            search.counters.primitives_tested += 1;
            sphere::intersect(&record.sphere(), ray, |t| search.offer(level, geometry, index, (t, 0.0, 0.0)));
        }
        RecordKind::User => {
            search.counters.primitives_tested += 1;
            if let Shape::User(user) = &level.geometries[geometry as usize].shape {
                let mut offer = |t, u, v| search.offer(level, geometry, index, (t, u, v));
                primitive::intersect_user(&**user, index, ray, &mut offer);
            }
        }
        RecordKind::Instance => enter(search, index),
    }
}

impl Record {
    #[inline]
    pub fn sphere(&self) -> Sphere {
        Sphere { center: Vec3::from_array(self.corners[0]), radius: self.corners[1][0] }
    }
}
