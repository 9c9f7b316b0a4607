//! What the box test of a node needs of a ray.
//!
//! The test is quicker than [`Bounds3::intersect`](kirkas_geometry::Bounds3::intersect), which defines hits, and lets through a
//! little more: a plane's distance is one multiplication and one addition, `plane * inverse + offset`, with offsets that are lowered
//! where a ray enters and raised where it leaves by more than all roundings of both tests together.

use super::node::WIDTH;
use crate::prepared_ray::PreparedRay;
use core::mem::MaybeUninit;
use kirkas_geometry::Vec4;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// A ray as the box test sees it.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct BoxRay {
    /// The last lane of these is idle.
    pub inverse: [f32; 4],
    /// Added to the distances of the planes through which it enters.
    pub enter: [f32; 4],
    /// Added to the distances of the planes through which it leaves.
    pub leave: [f32; 4],
    /// Where in a node the planes lie through which it enters, in bytes.
    pub enter_row: [u32; 3],
    pub t_min: f32,
}

/// Bytes of a row of planes in a node.
pub(super) const ROW: u32 = size_of::<[f32; WIDTH]>() as u32;
/// The roundings of both tests: 2 and the 21 of the padding in `Bounds3::intersect`, 4 here; and some more.
pub(super) const SLACK: f32 = 32.0 * UNIT_ROUNDOFF;
/// How far it takes a ray that does not move along an axis to cross what boxes and origin span there.
const FAR: f32 = 0.25 * f32::MAX;
/// Distances beyond this say nothing, since they might overflow.
pub(super) const SOUND: f32 = 0.5 * f32::MAX;

impl BoxRay {
    /// For boxes of which no coordinate is larger than `reach`. Written where it is to stay.
    #[inline(always)]
    pub fn prepare(place: &mut MaybeUninit<Self>, ray: &PreparedRay, reach: f32) {
        let (origin, inverse) = (ray.clipped.origin.extend(0.0), Vec4::from_array(ray.inverse));
        // Every box lies before this. The idle lane is that of no axis.
        let farthest = (Vec4::splat(reach) + origin.abs()) * inverse.abs();
        let (offset, slack) = (-(origin * inverse), SLACK * farthest);
        let b = place.write(BoxRay {
            inverse: ray.inverse,
            enter: (offset - slack).to_array(),
            leave: (offset + slack).to_array(),
            enter_row: [0, 1, 2].map(|k| ROW * (2 * k as u32 + ray.is_negative[k])),
            t_min: ray.clipped.t_min,
        });
        if farthest.cmplt(Vec4::splat(SOUND)).bitmask() & 0b111 != 0b111 {
            b.mend(origin.to_array(), reach);
        }
    }

    /// For a ray of which some distances overflow, because it does not move along an axis or is very far away.
    #[cold]
    fn mend(&mut self, origin: [f32; 4], reach: f32) {
        let size = [0, 1, 2].map(|k: usize| reach + origin[k].abs());
        let mut farthest = f32::INFINITY;
        for k in 0..3 {
            let reached = size[k] * self.inverse[k].abs();
            farthest = if reached < farthest { reached } else { farthest };
        }
        for k in 0..3 {
            let inverse = self.inverse[k];
            if size[k] * inverse.abs() < SOUND {
                continue;
            }
            if inverse.is_finite() || farthest >= 1e31 {
                (self.inverse[k], self.enter[k], self.leave[k]) = (0.0, f32::NEG_INFINITY, f32::INFINITY);
            } else {
                // The ray stays where it is along this axis: what it is not within, by the slack, which it takes 1e32 to
                // cross, lies too far away.
                let inverse = (FAR / size[k]).min(f32::MAX).copysign(inverse);
                let offset = -(origin[k] * inverse);
                (self.inverse[k], self.enter[k], self.leave[k]) = (inverse, offset - SLACK * FAR, offset + SLACK * FAR);
            }
        }
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
            let mut lanes = MaybeUninit::uninit();
            BoxRay::prepare(&mut lanes, &ray, reach);
            // SAFETY: prepared above.
            let lanes = unsafe { lanes.assume_init() };
            // SAFETY: portable code needs nothing, and the node is valid.
            let keys = |limit| unsafe { Portable::boxes::<false>(&node, &lanes, limit) };
            let Keys(found) = keys(near.max(0.0));
            assert!(found[5] != NO_KEY, "{ray:?} misses {b:?}");
            assert!((0..WIDTH).all(|i| i == 5 || found[i] == NO_KEY));
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
                // SAFETY: detected above.
                let Keys(found) = unsafe { super::super::avx2::Avx2::boxes::<false>(&node, &lanes, near.max(0.0)) };
                assert!(found[5] != NO_KEY, "{ray:?} misses {b:?}");
            }
        }
        assert!(entered > 10_000, "{entered}");
    }
}
