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
        for k in 0..3 {
            let size = reach + origin[k].abs();
            let inverse = if ray.inverse[k].is_finite() {
                ray.inverse[k]
            } else {
                // The ray stays where it is: what it is not within, it is too far from to reach.
                (0.25 * f32::MAX / size.max(1.0)).copysign(ray.inverse[k])
            };
            let slack = SLACK * size * inverse.abs();
            let offset = -(origin[k] * inverse);
            // Where distances overflow they say nothing; NaN neither.
            let is_sound = size * inverse.abs() < 0.5 * f32::MAX;
            b.inverse[k] = inverse;
            b.enter[k] = if is_sound { offset - slack } else { f32::NEG_INFINITY };
            b.leave[k] = if is_sound { offset + slack } else { f32::INFINITY };
        }
        b
    }
}
