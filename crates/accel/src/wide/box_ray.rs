//! What the box test of a node needs of a ray.
//!
//! The test is quicker than [`Bounds3::intersect`](kirkas_geometry::Bounds3::intersect), which defines hits, and lets through a
//! little more: a plane's distance is one multiplication and one addition, `plane * inverse + offset`, with offsets that are lowered
//! where a ray enters and raised where it leaves by more than all roundings of both tests together.

use crate::prepared_ray::PreparedRay;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// A ray as the box test sees it.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct BoxRay {
    pub inverse: [f32; 3],
    /// Added to the distances of the planes through which it enters.
    pub enter: [f32; 3],
    /// Added to the distances of the planes through which it leaves.
    pub leave: [f32; 3],
    pub t_min: f32,
    /// 1 where the direction is negative, so that the high plane is met first.
    pub is_negative: [u32; 3],
}

/// The roundings of both tests: 2 and the 21 of the padding in `Bounds3::intersect`, 4 here; and some more.
const SLACK: f32 = 32.0 * UNIT_ROUNDOFF;

/// How far it takes a ray that does not move along an axis to cross what boxes and origin span there.
const FAR: f32 = 0.25 * f32::MAX;

impl BoxRay {
    /// For boxes of which no coordinate is larger than `reach`.
    #[inline(always)]
    pub fn new(ray: &PreparedRay, reach: f32) -> Self {
        let origin = ray.clipped.origin.to_array();
        let mut b = BoxRay {
            inverse: ray.inverse,
            enter: [0.0; 3],
            leave: [0.0; 3],
            t_min: ray.clipped.t_min,
            is_negative: ray.is_negative,
        };
        let size = [0, 1, 2].map(|k| reach + origin[k].abs());
        // Every box lies before this, as far as an axis along which the ray moves can tell.
        let mut farthest = f32::INFINITY;
        for k in 0..3 {
            let reached = size[k] * ray.inverse[k].abs();
            farthest = if reached < farthest { reached } else { farthest };
        }
        for k in 0..3 {
            let mut inverse = ray.inverse[k];
            let mut limit = 0.5 * f32::MAX;
            let mut slack = SLACK * size[k] * inverse.abs();
            if !inverse.is_finite() {
                // The ray stays where it is along this axis: what it is not within (by the slack, which it takes 1e32 to cross) lies
                // too far away.
                inverse = (FAR / size[k]).min(f32::MAX).copysign(inverse);
                slack = SLACK * FAR;
                limit = if farthest < 1e31 { limit } else { 0.0 };
            }
            let offset = -(origin[k] * inverse);
            // Where distances overflow they say nothing.
            let is_sound = size[k] * inverse.abs() < limit;
            b.inverse[k] = inverse;
            b.enter[k] = if is_sound { offset - slack } else { f32::NEG_INFINITY };
            b.leave[k] = if is_sound { offset + slack } else { f32::INFINITY };
        }
        b
    }
}

#[cfg(test)]
mod tests {
    use super::super::backend::{Backend, Keys, NO_KEY, Portable};
    use super::super::node::{Node, WIDTH};
    use super::*;
    use kirkas_geometry::hash::{combine, unit_f32};
    use kirkas_geometry::{Bounds3, Ray, Vec3};

    /// Numbers of all sizes, small whole ones and 0 among them.
    fn number(seed: u64) -> f32 {
        let unit = unit_f32(combine(seed, 1) as u32) * 2.0 - 1.0;
        match combine(seed, 2) % 8 {
            0 => 0.0,
            1 => unit * 1e30,
            2 => unit * 1e-30,
            3 => (unit * 3.0).round(),
            _ => unit,
        }
    }

    fn vector(seed: u64) -> Vec3 {
        Vec3::new(number(3 * seed), number(3 * seed + 1), number(3 * seed + 2))
    }

    #[test]
    fn what_enters_a_box_by_definition_enters_it_here() {
        let mut entered = 0;
        for seed in 0..400_000 {
            let ray = Ray::new(vector(4 * seed), vector(4 * seed + 1)).until(f32::INFINITY);
            let Some(ray) = PreparedRay::new(&ray) else { continue };
            let b = Bounds3::from_corners(vector(4 * seed + 2), vector(4 * seed + 3));
            let Some((near, _)) = b.intersect(&ray.clipped, ray.inverse()) else { continue };
            if near == f32::INFINITY {
                continue;
            }
            entered += 1;
            let reach = b.min.abs().max(b.max.abs()).max_element();
            let mut node = Node::EMPTY;
            node.set_bounds(5, &b);
            // SAFETY: portable code needs nothing, and the node is valid.
            let keys = |limit| unsafe { Portable::boxes::<false>(&node, &BoxRay::new(&ray, reach), limit) };
            let Keys(found) = keys(near.max(0.0));
            assert!(found[5] != NO_KEY, "{ray:?} misses {b:?}");
            assert!((0..WIDTH).all(|i| i == 5 || found[i] == NO_KEY));
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
                // SAFETY: detected above.
                let Keys(found) = unsafe {
                    super::super::avx2::Avx2::boxes::<false>(&node, &BoxRay::new(&ray, reach), near.max(0.0))
                };
                assert!(found[5] != NO_KEY, "{ray:?} misses {b:?}");
            }
        }
        assert!(entered > 10_000, "{entered}");
    }
}
