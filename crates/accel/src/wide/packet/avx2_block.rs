//! The triangle test of packets in AVX2, eight rays at a time: operation for operation that of [`triangle`](crate::triangle).

use super::super::node::Block;
use super::avx2::load;
use super::backend::{Crossings, prepared};
use super::rays::{Rays, Row};
use crate::triangle::{self, HEIGHT_ERROR};
use core::arch::x86_64::*;
use kirkas_geometry::bounds::FAR_PAD;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// Test a block's triangles with rays that have one axis.
///
/// # Safety
/// The block is valid, and `count` at most 8.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) unsafe fn cross_block<const ONE_ORIGIN: bool>(
    block: *const Block,
    count: usize,
    rays: &Rays,
    among: u64,
    mut visit: impl FnMut(usize, usize, u32, &Crossings),
) {
    let corners = block.cast::<f32>();
    // The corners along the rays' axes; if the rays start at one point, as seen from there.
    let mut seen = [[_mm256_setzero_ps(); 3]; 3];
    for (c, corner) in seen.iter_mut().enumerate() {
        for (k, row) in corner.iter_mut().enumerate() {
            let axis = rays.axes[k];
            // SAFETY: the block begins with 3 rows of 8 numbers for each corner.
            *row = unsafe { _mm256_load_ps(corners.add(24 * c + 8 * (axis & 3))) };
            if ONE_ORIGIN {
                *row = _mm256_sub_ps(*row, _mm256_set1_ps(rays.origin[axis][0]));
            }
        }
    }
    let mut lanes = (1u32 << count) - 1;
    if ONE_ORIGIN {
        lanes &= !unreached(&seen, rays);
    }
    let seen = (&raw const seen).cast::<f32>();
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        // SAFETY: 9 rows of 8 numbers.
        let number = |c: usize, k: usize| unsafe { _mm256_broadcast_ss(&*seen.add(24 * c + 8 * k + lane)) };
        let corner = |c: usize| [number(c, 0), number(c, 1), number(c, 2)];
        let triangle = [corner(0), corner(1), corner(2)];
        let mut plane = None;
        let mut left = among;
        while left != 0 {
            let shift = left.trailing_zeros() & 56;
            let among = (left >> shift) as u32 & 0xff;
            left &= !(0xff << shift);
            let eight = shift as usize / 8;
            let (passing, weights) = edges::<ONE_ORIGIN>(&triangle, rays, eight);
            let passing = passing & among;
            if passing == 0 {
                continue;
            }
            // SAFETY: the block is valid.
            let plane = plane.get_or_insert_with(|| unsafe { Plane::new::<ONE_ORIGIN>(block, lane, rays) });
            let mut crossings = Crossings::NONE;
            let (bits, odd) = plane.cross::<ONE_ORIGIN>(rays, eight, passing, weights, &mut crossings);
            let bits = if odd == 0 {
                bits
            } else {
                // SAFETY: the block is valid.
                bits & !odd | decide(unsafe { &*block }, lane, rays, eight, odd, &mut crossings)
            };
            if bits != 0 {
                visit(lane, eight, bits, &crossings);
            }
        }
    }
}

/// More than what products lose that are too small for f32.
const UNDERFLOW: f32 = 1e-36;

/// The triangles that no ray of the packet reaches, eight at once: those of which the edge test fails for every shear in the packet's.
///
/// A weight is linear in the shear (in real numbers): what it is in the middle, and how fast it changes from there, give its
/// extremes. A triangle is out of reach if one weight has one sign throughout, and the sum of all three the other.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn unreached(seen: &[[__m256; 3]; 3], rays: &Rays) -> u32 {
    let [(sx, hx), (sy, hy)] = rays.shears;
    let (sx, sy, hx, hy) = (_mm256_set1_ps(sx), _mm256_set1_ps(sy), _mm256_set1_ps(hx), _mm256_set1_ps(hy));
    let size = |v: __m256| _mm256_andnot_ps(_mm256_set1_ps(-0.0), v);
    let (mut far, mut wide) = (_mm256_setzero_ps(), _mm256_setzero_ps());
    let mut shear = |[x, y, z]: [__m256; 3]| {
        let p = (_mm256_fnmadd_ps(sx, z, x), _mm256_fnmadd_ps(sy, z, y), z);
        far = _mm256_max_ps(far, _mm256_add_ps(size(z), _mm256_max_ps(size(x), size(y))));
        wide = _mm256_max_ps(wide, _mm256_max_ps(size(p.0), size(p.1)));
        p
    };
    let [a, b, c] = [shear(seen[0]), shear(seen[1]), shear(seen[2])];
    // All roundings, here and in the edge tests of three edges: less than 128 of the largest product of a coordinate seen along a ray
    // (of `wide`) and what it was computed from (of `far`). Infinite before a product can be.
    let wide = _mm256_fmadd_ps(_mm256_max_ps(hx, hy), far, wide);
    let largest = _mm256_mul_ps(_mm256_mul_ps(_mm256_set1_ps(4.0), wide), far);
    let slack = _mm256_fmadd_ps(largest, _mm256_set1_ps(32.0 * UNIT_ROUNDOFF), _mm256_set1_ps(UNDERFLOW));
    type Weight = (__m256, __m256, __m256);
    let edge = |p: Weight, q: Weight| {
        (
            _mm256_fmsub_ps(p.0, q.1, _mm256_mul_ps(p.1, q.0)),
            _mm256_fmsub_ps(p.2, q.1, _mm256_mul_ps(p.1, q.2)),
            _mm256_fmsub_ps(p.0, q.2, _mm256_mul_ps(p.2, q.0)),
        )
    };
    let extremes = |(middle, dx, dy): Weight| {
        let reach = _mm256_fmadd_ps(size(dx), hx, _mm256_fmadd_ps(size(dy), hy, slack));
        (_mm256_sub_ps(middle, reach), _mm256_add_ps(middle, reach))
    };
    let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
    let add = |p: __m256, q: __m256, r: __m256| _mm256_add_ps(_mm256_add_ps(p, q), r);
    let total = extremes((add(u.0, v.0, w.0), add(u.1, v.1, w.1), add(u.2, v.2, w.2)));
    let (u, v, w) = (extremes(u), extremes(v), extremes(w));
    let zero = _mm256_setzero_ps();
    let lowest = _mm256_min_ps(u.1, _mm256_min_ps(v.1, w.1));
    let highest = _mm256_max_ps(u.0, _mm256_max_ps(v.0, w.0));
    let (below, above) = (_mm256_cmp_ps::<_CMP_LT_OQ>, _mm256_cmp_ps::<_CMP_GT_OQ>);
    let front = _mm256_and_ps(below(lowest, zero), above(total.0, zero));
    let back = _mm256_and_ps(above(highest, zero), below(total.1, zero));
    _mm256_movemask_ps(_mm256_or_ps(front, back)) as u32
}

/// The edge test of eight rays, and the weights of the corners.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn edges<const ONE_ORIGIN: bool>(triangle: &[[__m256; 3]; 3], rays: &Rays, eight: usize) -> (u32, [__m256; 3]) {
    let (sx, sy) = (load(&rays.shear[0], eight), load(&rays.shear[1], eight));
    let sheared = |corner: &[__m256; 3]| {
        let from = |k: usize| {
            if ONE_ORIGIN { corner[k] } else { _mm256_sub_ps(corner[k], load(&rays.origin[rays.axes[k]], eight)) }
        };
        let z = from(2);
        (_mm256_sub_ps(from(0), _mm256_mul_ps(sx, z)), _mm256_sub_ps(from(1), _mm256_mul_ps(sy, z)))
    };
    let [a, b, c] = [sheared(&triangle[0]), sheared(&triangle[1]), sheared(&triangle[2])];
    let edge =
        |p: (__m256, __m256), q: (__m256, __m256)| _mm256_sub_ps(_mm256_mul_ps(p.0, q.1), _mm256_mul_ps(p.1, q.0));
    let w = [edge(c, b), edge(a, c), edge(b, a)];
    // NaN is ignored in all but the last place, and there rules nothing out.
    let lowest = _mm256_min_ps(w[2], _mm256_min_ps(w[1], w[0]));
    let highest = _mm256_max_ps(w[2], _mm256_max_ps(w[1], w[0]));
    let zero = _mm256_setzero_ps();
    let negative = _mm256_cmp_ps::<_CMP_LT_OQ>(lowest, zero);
    let positive = _mm256_cmp_ps::<_CMP_GT_OQ>(highest, zero);
    (!(_mm256_movemask_ps(_mm256_and_ps(negative, positive)) as u32) & 0xff, w)
}

/// What the eights share of the work on one triangle.
struct Plane {
    /// The first corner; if the rays start at one point, only `height` tells of it.
    corner: [f64; 3],
    normal: [f64; 3],
    /// Above the point where all rays start; NaN where that is on the plane, as far as f64 can tell.
    height: f64,
    /// The sums of the edges' coordinates, without their signs.
    sums: [f64; 2],
    /// The bounds along each axis; if the rays start at one point, as seen from there.
    low: [f32; 3],
    high: [f32; 3],
}

#[inline(always)]
fn sum(v: [f64; 3]) -> f64 {
    v[0].abs() + v[1].abs() + v[2].abs()
}

impl Plane {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn new<const ONE_ORIGIN: bool>(block: *const Block, lane: usize, rays: &Rays) -> Self {
        // SAFETY: the caller promises that the block is valid.
        let corners = unsafe { (*block).triangle(lane) };
        let [p, q, r] = corners.map(|c| c.map(f64::from));
        let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let (a, b) = (minus(q, p), minus(r, p));
        let normal = [a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]];
        let sums = [sum(a), sum(b)];
        let bounds = triangle::bounds(&corners);
        let (mut low, mut high) = (bounds.min.to_array(), bounds.max.to_array());
        let mut height = 0.0;
        if ONE_ORIGIN {
            let o = [0, 1, 2].map(|k: usize| rays.origin[k][0]);
            let t = minus(p, o.map(f64::from));
            height = normal[0] * t[0] + normal[1] * t[1] + normal[2] * t[2];
            if height.abs() <= HEIGHT_ERROR * sum(t) * sums[0] * sums[1] {
                height = f64::NAN;
            }
            for k in 0..3 {
                (low[k], high[k]) = (low[k] - o[k], high[k] - o[k]);
            }
        }
        Plane { corner: p, normal, height, sums, low, high }
    }

    /// Where the rays that pass the edges cross: a bit for each that does, and for each of which the weights over- or underflow.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn cross<const ONE_ORIGIN: bool>(
        &self,
        rays: &Rays,
        eight: usize,
        passing: u32,
        [w0, w1, w2]: [__m256; 3],
        crossings: &mut Crossings,
    ) -> (u32, u32) {
        let four = |row: &Row, half: usize| {
            // SAFETY: rows have 8 times 8 numbers.
            _mm256_cvtps_pd(unsafe { _mm_load_ps(row.as_ptr().add(8 * (eight & 7) + 4 * half)) })
        };
        let [x, y, z] = self.normal;
        let n = [_mm256_set1_pd(x), _mm256_set1_pd(y), _mm256_set1_pd(z)];
        let dot = |v: [__m256d; 3]| {
            let sum = _mm256_add_pd(_mm256_mul_pd(n[0], v[0]), _mm256_mul_pd(n[1], v[1]));
            _mm256_add_pd(sum, _mm256_mul_pd(n[2], v[2]))
        };
        // The plane, in f64. Rays that start on it do not meet it.
        let half = |h: usize| {
            let [x, y, z] = &rays.direction;
            let speed = dot([four(x, h), four(y, h), four(z, h)]);
            let mut off_plane = -1;
            let height = if ONE_ORIGIN {
                _mm256_set1_pd(self.height)
            } else {
                let to = |k: usize| _mm256_sub_pd(_mm256_set1_pd(self.corner[k]), four(&rays.origin[k], h));
                let to = [to(0), to(1), to(2)];
                let size = |v: __m256d| _mm256_andnot_pd(_mm256_set1_pd(-0.0), v);
                let height = dot(to);
                let sum = _mm256_add_pd(_mm256_add_pd(size(to[0]), size(to[1])), size(to[2]));
                let error = _mm256_mul_pd(_mm256_set1_pd(HEIGHT_ERROR), sum);
                let error = _mm256_mul_pd(error, _mm256_set1_pd(self.sums[0]));
                let error = _mm256_mul_pd(error, _mm256_set1_pd(self.sums[1]));
                off_plane = !_mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(size(height), error));
                height
            };
            let t = _mm256_div_pd(height, speed);
            let after = _mm256_cmp_pd::<_CMP_GT_OQ>(t, four(&rays.t_min, h));
            let before = _mm256_cmp_pd::<_CMP_LT_OQ>(t, four(&rays.t_max, h));
            (_mm256_cvtpd_ps(t), (_mm256_movemask_pd(_mm256_and_pd(after, before)) & off_plane & 15) as u32)
        };
        let ((t0, bits0), (t1, bits1)) = (half(0), half(1));
        let bits = passing & (bits0 | bits1 << 4);
        if bits == 0 {
            return (0, 0);
        }
        let t = _mm256_set_m128(t1, t0);

        // The bounds. NaN, a ray within a face, is always the first operand, and so says nothing.
        let (t_min, t_max) = (load(&rays.t_min, eight), load(&rays.t_max, eight));
        let (mut near, mut far) = (t_min, _mm256_set1_ps(f32::INFINITY));
        for k in 0..3 {
            let inverse = load(&rays.inverse[k], eight);
            let at = |plane: f32| {
                let plane = _mm256_set1_ps(plane);
                let from = if ONE_ORIGIN { plane } else { _mm256_sub_ps(plane, load(&rays.origin[k], eight)) };
                _mm256_mul_ps(from, inverse)
            };
            let (enter, leave) =
                if rays.is_negative[k] != 0 { (self.high[k], self.low[k]) } else { (self.low[k], self.high[k]) };
            near = _mm256_max_ps(at(enter), near);
            far = _mm256_min_ps(at(leave), far);
        }
        let (after, before) = (_mm256_set1_ps(FAR_PAD), _mm256_set1_ps(2.0 - FAR_PAD));
        let far = _mm256_max_ps(_mm256_mul_ps(far, after), _mm256_mul_ps(far, before));
        let far = _mm256_min_ps(t_max, far);
        let t = _mm256_min_ps(far, _mm256_max_ps(near, t));
        let inside = _mm256_and_ps(
            _mm256_cmp_ps::<_CMP_LE_OQ>(near, far),
            _mm256_and_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(t, t_min), _mm256_cmp_ps::<_CMP_LT_OQ>(t, t_max)),
        );
        let bits = bits & _mm256_movemask_ps(inside) as u32;

        // The weights.
        let total = _mm256_add_ps(_mm256_add_ps(w0, w1), w2);
        let size = _mm256_andnot_ps(_mm256_set1_ps(-0.0), total);
        let is_normal = _mm256_and_ps(
            _mm256_cmp_ps::<_CMP_GE_OQ>(size, _mm256_set1_ps(f32::MIN_POSITIVE)),
            _mm256_cmp_ps::<_CMP_LT_OQ>(size, _mm256_set1_ps(f32::INFINITY)),
        );
        // SAFETY: 8 numbers each, aligned to 32 bytes.
        unsafe {
            _mm256_store_ps(crossings.t.as_mut_ptr(), t);
            _mm256_store_ps(crossings.u.as_mut_ptr(), _mm256_div_ps(w1, total));
            _mm256_store_ps(crossings.v.as_mut_ptr(), _mm256_div_ps(w2, total));
        }
        (bits, bits & !_mm256_movemask_ps(is_normal) as u32)
    }
}

/// The crossings of the rays for which f32 does not suffice.
#[cold]
fn decide(block: &Block, lane: usize, rays: &Rays, eight: usize, odd: u32, crossings: &mut Crossings) -> u32 {
    let mut bits = 0;
    for l in (0..8).filter(|l| odd >> l & 1 != 0) {
        let Some(ray) = prepared(rays, 8 * eight + l) else { continue };
        if let Some((t, u, v)) = triangle::intersect(&block.triangle(lane), &ray) {
            (crossings.t[l], crossings.u[l], crossings.v[l]) = (t, u, v);
            bits |= 1 << l;
        }
    }
    bits
}
