//! The arithmetic of a step in AVX2: the edge test operation for operation that of [`Portable`](super::backend::Portable), the box
//! tests with fused operations, within the slack that they have.

use super::backend::{Backend, Keys, Weights};
use super::box_ray::{BoxRay, ROW};
use super::node::{Block, Node};
use crate::prepared_ray::PreparedRay;
use crate::prepared_ray::clamp;
use crate::triangle::{self, HEIGHT_ERROR};
use core::arch::x86_64::*;
use core::mem::MaybeUninit;
use kirkas_geometry::bounds::pad_far;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// Code for CPUs with AVX2 and FMA.
pub(super) struct Avx2;

impl Backend for Avx2 {
    #[inline(always)]
    unsafe fn boxes<const ANY: bool>(node: *const Node, ray: &BoxRay, limit: f32) -> Keys {
        // SAFETY: the caller promises AVX2 and FMA and a valid node.
        unsafe { boxes::<ANY>(node, ray, limit) }
    }

    #[inline(always)]
    unsafe fn edges(block: *const Block, ray: &PreparedRay, weights: &mut MaybeUninit<Weights>) -> u32 {
        // SAFETY: the caller promises AVX2 and FMA and a valid block.
        unsafe { edges(block, ray, weights) }
    }

    #[inline(always)]
    unsafe fn crossing(
        block: *const Block,
        lane: usize,
        ray: &PreparedRay,
        weights: &Weights,
    ) -> Option<(f32, f32, f32)> {
        // SAFETY: the caller promises AVX2 and FMA, a valid block and a lane of it.
        let t = unsafe { distance(block, lane, ray) }?;
        let weights = weights.of(lane);
        // SAFETY: as above.
        let corners = || unsafe { (*block).triangle(lane) };
        let (u, v) = triangle::barycentric(weights, || (corners(), *ray))?;
        Some((t, u, v))
    }

    #[inline(always)]
    unsafe fn least(keys: &Keys) -> (u16, usize) {
        // SAFETY: the caller promises AVX2 and FMA.
        unsafe { least(keys) }
    }

    #[inline(always)]
    unsafe fn without(keys: &Keys, place: usize) -> (Keys, bool) {
        // SAFETY: the caller promises AVX2 and FMA.
        unsafe { without(keys, place) }
    }

    #[inline(always)]
    unsafe fn is_empty(keys: &Keys) -> bool {
        // SAFETY: the caller promises AVX2 and FMA.
        unsafe { is_empty(keys) }
    }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn boxes<const ANY: bool>(node: *const Node, ray: &BoxRay, limit: f32) -> Keys {
    let planes = node.cast::<f32>();
    // SAFETY: the node begins with 6 rows of 8 planes.
    let slab = |k: usize| unsafe {
        let inverse = _mm256_set1_ps(ray.inverse[k]);
        let first = ray.enter_row[k] as usize;
        let enter = _mm256_load_ps(planes.byte_add(first));
        let leave = _mm256_load_ps(planes.byte_add(first ^ ROW as usize));
        (
            _mm256_fmadd_ps(enter, inverse, _mm256_set1_ps(ray.enter[k])),
            _mm256_fmadd_ps(leave, inverse, _mm256_set1_ps(ray.leave[k])),
        )
    };
    let (x, y, z) = (slab(0), slab(1), slab(2));
    // Only an empty slot may give NaN.
    let (t_min, limit) = (_mm256_set1_ps(ray.t_min), _mm256_set1_ps(limit));
    let near = _mm256_max_ps(_mm256_max_ps(x.0, y.0), _mm256_max_ps(z.0, t_min));
    let far = _mm256_min_ps(_mm256_min_ps(x.1, y.1), _mm256_min_ps(z.1, limit));
    let missed = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_NLE_UQ>(near, far));
    let missed = _mm256_srli_epi32::<16>(missed);
    let keys = if ANY {
        missed
    } else {
        let near = _mm256_castps_si256(_mm256_max_ps(near, _mm256_setzero_ps()));
        _mm256_or_si256(_mm256_srli_epi32::<16>(near), missed)
    };
    let mut keys = _mm_packus_epi32(_mm256_castsi256_si128(keys), _mm256_extracti128_si256::<1>(keys));
    // SAFETY: the node is valid, and both rows are aligned like it, at a multiple of 16 bytes.
    let row = unsafe {
        _mm_load_si128(if ANY { (&raw const (*node).order).cast() } else { (&raw const (*node).empty).cast() })
    };
    keys = _mm_or_si128(keys, row);
    from_register(keys)
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn edges(block: *const Block, ray: &PreparedRay, weights: &mut MaybeUninit<Weights>) -> u32 {
    let corners = block.cast::<f32>();
    // SAFETY: the block begins with 3 rows of 8 numbers for each corner.
    let row = |corner: usize, k: usize| unsafe { _mm256_load_ps(corners.add(24 * corner + 8 * ray.axes[k] as usize)) };
    let [ox, oy, oz] = ray.sheared_origin.map(|o| _mm256_set1_ps(o));
    let [sx, sy] = ray.shear.map(|s| _mm256_set1_ps(s));
    let sheared = |corner: usize| {
        let z = _mm256_sub_ps(row(corner, 2), oz);
        let x = _mm256_sub_ps(_mm256_sub_ps(row(corner, 0), ox), _mm256_mul_ps(sx, z));
        let y = _mm256_sub_ps(_mm256_sub_ps(row(corner, 1), oy), _mm256_mul_ps(sy, z));
        (x, y)
    };
    let (a, b, c) = (sheared(0), sheared(1), sheared(2));
    let edge =
        |p: (__m256, __m256), q: (__m256, __m256)| _mm256_sub_ps(_mm256_mul_ps(p.0, q.1), _mm256_mul_ps(p.1, q.0));
    let w = [edge(c, b), edge(a, c), edge(b, a)];
    // NaN is ignored in all but the last place, and there rules nothing out.
    let lowest = _mm256_min_ps(w[2], _mm256_min_ps(w[1], w[0]));
    let highest = _mm256_max_ps(w[2], _mm256_max_ps(w[1], w[0]));
    let zero = _mm256_setzero_ps();
    let negative = _mm256_cmp_ps::<_CMP_LT_OQ>(lowest, zero);
    let positive = _mm256_cmp_ps::<_CMP_GT_OQ>(highest, zero);
    let passing = !(_mm256_movemask_ps(_mm256_and_ps(negative, positive)) as u32) & 0xff;
    let rows = weights.as_mut_ptr().cast::<f32>();
    for (edge, w) in w.into_iter().enumerate() {
        // SAFETY: 3 rows of 8 numbers, aligned to 32 bytes.
        unsafe { _mm256_store_ps(rows.add(8 * edge), w) };
    }
    passing
}

/// [`triangle::distance`], operation for operation. The fourth lanes are idle.
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn distance(block: *const Block, lane: usize, ray: &PreparedRay) -> Option<f32> {
    // SAFETY: the block begins with 9 rows of 8 numbers.
    let corner = |c: usize| unsafe {
        let at = block.cast::<f32>().add(24 * c + lane);
        _mm_setr_ps(*at, *at.add(8), *at.add(16), 0.0)
    };
    // SAFETY: 12 bytes of the vector and 4 of what comes after it in the ray; the blend drops those.
    let vector = |v: *const f32| unsafe { _mm_blend_ps::<0b1000>(_mm_loadu_ps(v), _mm_setzero_ps()) };
    let (p, q, r) = (corner(0), corner(1), corner(2));
    let origin = vector((&raw const ray.clipped.origin).cast());
    let direction = vector((&raw const ray.clipped.direction).cast());

    // The plane, in f64.
    let to_plane = _mm256_sub_pd(_mm256_cvtps_pd(p), _mm256_cvtps_pd(origin));
    let e1 = _mm256_sub_pd(_mm256_cvtps_pd(q), _mm256_cvtps_pd(p));
    let e2 = _mm256_sub_pd(_mm256_cvtps_pd(r), _mm256_cvtps_pd(p));
    let (yzx, zxy) = (_mm256_permute4x64_pd::<0b11_00_10_01>, _mm256_permute4x64_pd::<0b11_01_00_10>);
    let normal = _mm256_sub_pd(_mm256_mul_pd(yzx(e1), zxy(e2)), _mm256_mul_pd(yzx(e2), zxy(e1)));
    let (height, speed) = sums(_mm256_mul_pd(normal, to_plane), _mm256_mul_pd(normal, _mm256_cvtps_pd(direction)));
    let t = height / speed;
    if !(t > f64::from(ray.t_min) && t < f64::from(ray.t_max)) {
        return None;
    }
    let size = |v: __m256d| _mm256_andnot_pd(_mm256_set1_pd(-0.0), v);
    let (sum_to_plane, sum_e1) = sums(size(to_plane), size(e1));
    let (sum_e2, _) = sums(size(e2), size(e2));
    if height.abs() <= HEIGHT_ERROR * sum_to_plane * sum_e1 * sum_e2 {
        return None;
    }

    // The bounds.
    let low = _mm_min_ps(_mm_min_ps(p, q), r);
    let high = _mm_max_ps(_mm_max_ps(p, q), r);
    let span = _mm_sub_ps(high, low);
    let size = _mm_max_ss(_mm_max_ss(span, _mm_movehdup_ps(span)), _mm_movehl_ps(span, span));
    let grow = _mm_mul_ps(_mm_broadcastss_ps(size), _mm_set1_ps(8.0 * UNIT_ROUNDOFF));
    let more = |x: __m128| {
        let x = _mm_andnot_ps(_mm_set1_ps(-0.0), x);
        _mm_add_ps(grow, _mm_mul_ps(x, _mm_set1_ps(2.0 * UNIT_ROUNDOFF)))
    };
    let (low, high) = (_mm_sub_ps(low, more(low)), _mm_add_ps(high, more(high)));

    // When the ray is within them.
    // SAFETY: 16 bytes; the last lane is not looked at.
    let inverse = unsafe { _mm_loadu_ps(ray.inverse.as_ptr()) };
    let to_low = _mm_mul_ps(_mm_sub_ps(low, origin), inverse);
    let to_high = _mm_mul_ps(_mm_sub_ps(high, origin), inverse);
    let (enter, leave) = (_mm_blendv_ps(to_low, to_high, inverse), _mm_blendv_ps(to_high, to_low, inverse));
    let (y, z) = (_mm_movehdup_ps, |v: __m128| _mm_movehl_ps(v, v));
    // NaN, a ray within a face, is always the first operand, and so says nothing.
    let near = _mm_max_ss(enter, _mm_set_ss(ray.clipped.t_min));
    let near = _mm_max_ss(z(enter), _mm_max_ss(y(enter), near));
    let far = _mm_min_ss(leave, _mm_set_ss(f32::INFINITY));
    let far = _mm_min_ss(z(leave), _mm_min_ss(y(leave), far));
    let (near, far) = (_mm_cvtss_f32(near), pad_far(_mm_cvtss_f32(far)));
    let far = if ray.clipped.t_max < far { ray.clipped.t_max } else { far };
    if !(near <= far) {
        return None;
    }
    let t = clamp(t as f32, (near, far));
    ray.admits(t).then_some(t)
}

/// x + y + z of both.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn sums(a: __m256d, b: __m256d) -> (f64, f64) {
    let (x, y) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let sum = _mm_add_pd(_mm256_castpd256_pd128(x), _mm256_castpd256_pd128(y));
    let sum = _mm_add_pd(sum, _mm256_extractf128_pd::<1>(x));
    (_mm_cvtsd_f64(sum), _mm_cvtsd_f64(_mm_unpackhi_pd(sum, sum)))
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn least(keys: &Keys) -> (u16, usize) {
    let found = _mm_cvtsi128_si32(_mm_minpos_epu16(to_register(keys))) as u32;
    (found as u16, (found >> 16) as usize)
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn without(keys: &Keys, place: usize) -> (Keys, bool) {
    static ONE: [Keys; 8] = {
        let mut rows = [Keys([0; 8]); 8];
        let mut i = 0;
        while i < 8 {
            rows[i].0[i] = u16::MAX;
            i += 1;
        }
        rows
    };
    let rest = _mm_or_si128(to_register(keys), to_register(&ONE[place & 7]));
    (from_register(rest), _mm_test_all_ones(rest) != 0)
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn is_empty(keys: &Keys) -> bool {
    _mm_test_all_ones(to_register(keys)) != 0
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn to_register(keys: &Keys) -> __m128i {
    // SAFETY: keys are 16 bytes, aligned to 16.
    unsafe { _mm_load_si128(keys.0.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn from_register(register: __m128i) -> Keys {
    let mut keys = Keys::NONE;
    // SAFETY: keys are 16 bytes, aligned to 16.
    unsafe { _mm_store_si128(keys.0.as_mut_ptr().cast(), register) };
    keys
}
