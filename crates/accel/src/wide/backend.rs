//! The arithmetic of a step, once for any CPU. A twin for AVX2 is in `avx2`; both give the same bits.

use super::box_ray::{BoxRay, ROW};
use super::node::{Block, Node, WIDTH};
use crate::prepared_ray::PreparedRay;
use crate::triangle;
use core::mem::MaybeUninit;

/// Eight 16-bit keys, the least of which comes next; [`NO_KEY`] for what is not to be visited.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub(super) struct Keys(pub [u16; WIDTH]);

/// The key of what is not to be visited.
pub(super) const NO_KEY: u16 = u16::MAX;

impl Keys {
    pub const NONE: Keys = Keys([NO_KEY; WIDTH]);
}

/// The upper half of a distance. Truncation is monotone, so comparing keys never culls what comparing distances would not.
#[inline(always)]
pub(super) fn key(distance: f32) -> u16 {
    let d = if distance > 0.0 { distance } else { 0.0 };
    (d.to_bits() >> 16) as u16
}

/// The values of the edges' functions: `[edge][triangle]`. Only those of triangles that pass mean anything.
#[repr(C, align(32))]
pub(super) struct Weights(pub [[f32; WIDTH]; 3]);

impl Weights {
    /// Those of one triangle.
    #[inline(always)]
    pub fn of(&self, lane: usize) -> [f32; 3] {
        [self.0[0][lane & 7], self.0[1][lane & 7], self.0[2][lane & 7]]
    }
}

/// The arithmetic of a step.
pub(super) trait Backend {
    /// The box test of all children: keys of those that the ray may enter before `limit`, by entry distance or (`ANY`) by the
    /// node's order.
    ///
    /// # Safety
    /// The CPU has what the backend needs; `node` is valid.
    unsafe fn boxes<const ANY: bool>(node: *const Node, ray: &BoxRay, limit: f32) -> Keys;

    /// The edge test of all triangles ([`triangle::intersect`]): a bit for each of which the edges do not rule a hit out, and
    /// what weighs their corners.
    ///
    /// # Safety
    /// The CPU has what the backend needs; `block` is valid.
    unsafe fn edges(block: *const Block, ray: &PreparedRay, weights: &mut MaybeUninit<Weights>) -> u32;

    /// [`triangle::crossing`] of one triangle.
    ///
    /// # Safety
    /// The CPU has what the backend needs; `block` is valid, and `lane` below 8.
    unsafe fn crossing(
        block: *const Block,
        lane: usize,
        ray: &PreparedRay,
        weights: &Weights,
    ) -> Option<(f32, f32, f32)>;

    /// The least key, and the first place where it is.
    ///
    /// # Safety
    /// The CPU has what the backend needs.
    unsafe fn least(keys: &Keys) -> (u16, usize);

    /// The keys without that of one place, and whether none is left.
    ///
    /// # Safety
    /// The CPU has what the backend needs.
    unsafe fn without(keys: &Keys, place: usize) -> (Keys, bool);

    /// True when nothing is to be visited.
    ///
    /// # Safety
    /// The CPU has what the backend needs.
    unsafe fn is_empty(keys: &Keys) -> bool;
}

/// Code for any CPU.
pub(super) struct Portable;

impl Backend for Portable {
    #[inline(always)]
    unsafe fn boxes<const ANY: bool>(node: *const Node, ray: &BoxRay, limit: f32) -> Keys {
        // SAFETY: the caller promises that the node is valid.
        let node = unsafe { &*node };
        let mut near = [ray.t_min; WIDTH];
        let mut far = [f32::INFINITY; WIDTH];
        for k in 0..3 {
            let first = (ray.enter_row[k] / ROW) as usize;
            let (enter, leave) = (&node.planes[first], &node.planes[first ^ 1]);
            for c in 0..WIDTH {
                let e = enter[c] * ray.inverse[k] + ray.enter[k];
                let l = leave[c] * ray.inverse[k] + ray.leave[k];
                near[c] = if e > near[c] { e } else { near[c] };
                far[c] = if l < far[c] { l } else { far[c] };
            }
        }
        let mut keys = Keys::NONE;
        for c in 0..WIDTH {
            let far = if limit < far[c] { limit } else { far[c] };
            if near[c] <= far {
                keys.0[c] = if ANY { node.order[c] } else { key(near[c]) | node.empty[c] };
            }
        }
        keys
    }

    #[inline(always)]
    unsafe fn edges(block: *const Block, ray: &PreparedRay, weights: &mut MaybeUninit<Weights>) -> u32 {
        // SAFETY: the caller promises that the block is valid.
        let block = unsafe { &*block };
        let weights = weights.write(Weights([[0.0; WIDTH]; 3]));
        let mut passing = 0;
        for lane in 0..WIDTH {
            let sheared = |corner: usize| {
                let [x, y, z] = ray.axes.map(|k| block.corners[3 * corner + k as usize][lane]);
                let z = z - ray.sheared_origin[2];
                (x - ray.sheared_origin[0] - ray.shear[0] * z, y - ray.sheared_origin[1] - ray.shear[1] * z)
            };
            let (a, b, c) = (sheared(0), sheared(1), sheared(2));
            let w = [c.0 * b.1 - c.1 * b.0, a.0 * c.1 - a.1 * c.0, b.0 * a.1 - b.1 * a.0];
            let (negative, positive) = (w.iter().any(|w| *w < 0.0), w.iter().any(|w| *w > 0.0));
            for edge in 0..3 {
                weights.0[edge][lane] = w[edge];
            }
            passing |= u32::from(!(negative && positive)) << lane;
        }
        passing
    }

    #[inline(always)]
    unsafe fn crossing(
        block: *const Block,
        lane: usize,
        ray: &PreparedRay,
        weights: &Weights,
    ) -> Option<(f32, f32, f32)> {
        // SAFETY: the caller promises that the block is valid.
        let corners = unsafe { (*block).triangle(lane) };
        triangle::crossing(&corners, ray, weights.of(lane))
    }

    #[inline(always)]
    unsafe fn least(keys: &Keys) -> (u16, usize) {
        let mut least = (keys.0[0], 0);
        for (place, &key) in keys.0.iter().enumerate() {
            if key < least.0 {
                least = (key, place);
            }
        }
        least
    }

    #[inline(always)]
    unsafe fn without(keys: &Keys, place: usize) -> (Keys, bool) {
        let mut rest = *keys;
        rest.0[place & (WIDTH - 1)] = NO_KEY;
        // SAFETY: portable code needs nothing.
        (rest, unsafe { Self::is_empty(&rest) })
    }

    #[inline(always)]
    unsafe fn is_empty(keys: &Keys) -> bool {
        keys.0.iter().all(|k| *k == NO_KEY)
    }
}
