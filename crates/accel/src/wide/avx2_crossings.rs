//! [`triangle::crossing`] of four candidates at once, operation for operation: each lane is a candidate, with a ray and a triangle of its
//! own. Nothing branches until all four are through.

use super::backend::{CROSSINGS, Candidate, Crossings};
use crate::prepared_ray::PreparedRay;
use crate::triangle::{self, HEIGHT_ERROR};
use core::arch::x86_64::*;
use kirkas_geometry::Vec3;
use kirkas_geometry::bounds::FAR_PAD;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;

/// Three coordinates of four candidates.
type Rows = [__m128; 3];
/// The same in f64.
type WideRows = [__m256d; 3];

/// # Safety
/// The CPU has AVX2 and FMA; what the candidates point to is valid.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) unsafe fn crossings(candidates: &[Candidate; CROSSINGS]) -> Crossings {
    let [a, b, c, d] = candidates;
    // SAFETY: the block begins with 9 rows of 8 numbers.
    let corner = |corner: usize| unsafe {
        let at = |x: &Candidate, k: usize| *x.block.cast::<f32>().add(24 * corner + 8 * k + x.lane);
        let row = |k: usize| _mm_setr_ps(at(a, k), at(b, k), at(c, k), at(d, k));
        [row(0), row(1), row(2)]
    };
    let (p, q, r) = (corner(0), corner(1), corner(2));
    // SAFETY: the caller promises valid rays; each of these is followed by at least 4 bytes of it.
    let (origin, direction, inverse) = unsafe {
        let rays = [&*a.ray, &*b.ray, &*c.ray, &*d.ray];
        let [a, b, c, d] = rays;
        let at = |v: &Vec3| (&raw const *v).cast::<f32>();
        (
            transposed(at(&a.clipped.origin), at(&b.clipped.origin), at(&c.clipped.origin), at(&d.clipped.origin)),
            transposed(
                at(&a.clipped.direction),
                at(&b.clipped.direction),
                at(&c.clipped.direction),
                at(&d.clipped.direction),
            ),
            transposed(a.inverse.as_ptr(), b.inverse.as_ptr(), c.inverse.as_ptr(), d.inverse.as_ptr()),
        )
    };

    // The plane, in f64.
    let (p64, e1, e2) = (wide(p), minus(wide(q), wide(p)), minus(wide(r), wide(p)));
    let to_plane = minus(p64, wide(origin));
    let normal_part = |i: usize, j: usize| _mm256_sub_pd(_mm256_mul_pd(e1[i], e2[j]), _mm256_mul_pd(e2[i], e1[j]));
    let normal = [normal_part(1, 2), normal_part(2, 0), normal_part(0, 1)];
    let (height, speed) = (dot(normal, to_plane), dot(normal, wide(direction)));
    let t = _mm256_div_pd(height, speed);
    // SAFETY: the caller promises valid rays.
    let number =
        |of: fn(&PreparedRay) -> f32| unsafe { _mm_setr_ps(of(&*a.ray), of(&*b.ray), of(&*c.ray), of(&*d.ray)) };
    let (t_min, t_max) = (number(|r| r.t_min), number(|r| r.t_max));
    let is_after = _mm256_cmp_pd::<_CMP_GT_OQ>(t, _mm256_cvtps_pd(t_min));
    let is_before = _mm256_cmp_pd::<_CMP_LT_OQ>(t, _mm256_cvtps_pd(t_max));

    // Rays that start on the plane, as far as f64 can tell, do not meet it.
    let error = _mm256_mul_pd(_mm256_set1_pd(HEIGHT_ERROR), sum_of_sizes(to_plane));
    let error = _mm256_mul_pd(_mm256_mul_pd(error, sum_of_sizes(e1)), sum_of_sizes(e2));
    let is_off = _mm256_cmp_pd::<_CMP_NLE_UQ>(size(height), error);
    let found = _mm256_movemask_pd(_mm256_and_pd(_mm256_and_pd(is_after, is_before), is_off));

    // The bounds.
    let low = |k: usize| _mm_min_ps(_mm_min_ps(p[k], q[k]), r[k]);
    let high = |k: usize| _mm_max_ps(_mm_max_ps(p[k], q[k]), r[k]);
    let (low, high) = ([low(0), low(1), low(2)], [high(0), high(1), high(2)]);
    let span = |k: usize| _mm_sub_ps(high[k], low[k]);
    let grow = _mm_mul_ps(_mm_max_ps(_mm_max_ps(span(0), span(1)), span(2)), _mm_set1_ps(8.0 * UNIT_ROUNDOFF));
    let more = |x: __m128| {
        let x = _mm_andnot_ps(_mm_set1_ps(-0.0), x);
        _mm_add_ps(grow, _mm_mul_ps(x, _mm_set1_ps(2.0 * UNIT_ROUNDOFF)))
    };

    // When the ray is within them. NaN, a ray within a face, is always the first operand, and so says nothing.
    let (mut near, mut far) = (number(|r| r.clipped.t_min), _mm_set1_ps(f32::INFINITY));
    for k in 0..3 {
        let to_low = _mm_mul_ps(_mm_sub_ps(_mm_sub_ps(low[k], more(low[k])), origin[k]), inverse[k]);
        let to_high = _mm_mul_ps(_mm_sub_ps(_mm_add_ps(high[k], more(high[k])), origin[k]), inverse[k]);
        near = _mm_max_ps(_mm_blendv_ps(to_low, to_high, inverse[k]), near);
        far = _mm_min_ps(_mm_blendv_ps(to_high, to_low, inverse[k]), far);
    }
    let far = _mm_max_ps(_mm_mul_ps(far, _mm_set1_ps(FAR_PAD)), _mm_mul_ps(far, _mm_set1_ps(2.0 - FAR_PAD)));
    let far = _mm_min_ps(number(|r| r.clipped.t_max), far);
    let is_within = _mm_cmp_ps::<_CMP_LE_OQ>(near, far);

    // Clamped into them.
    let t = _mm256_cvtpd_ps(t);
    let (early, late) = (_mm_cmp_ps::<_CMP_LT_OQ>(t, near), _mm_cmp_ps::<_CMP_GT_OQ>(t, far));
    let t = _mm_add_ps(_mm_blendv_ps(_mm_blendv_ps(t, far, late), near, early), _mm_setzero_ps());
    let is_admitted = _mm_and_ps(_mm_cmp_ps::<_CMP_GT_OQ>(t, t_min), _mm_cmp_ps::<_CMP_LT_OQ>(t, t_max));
    let found = found & _mm_movemask_ps(_mm_and_ps(is_within, is_admitted));

    // What weighs the corners.
    // SAFETY: the caller promises the weights of the block.
    let weight = |edge: usize| unsafe {
        let at = |x: &Candidate| *x.weights.cast::<f32>().add(8 * edge + x.lane);
        _mm_setr_ps(at(a), at(b), at(c), at(d))
    };
    let w = [weight(0), weight(1), weight(2)];
    let total = _mm_add_ps(_mm_add_ps(w[0], w[1]), w[2]);
    let mut all = Crossings { t: [0.0; CROSSINGS], u: [0.0; CROSSINGS], v: [0.0; CROSSINGS], found: found as u32 };
    // SAFETY: 16 bytes each.
    unsafe {
        _mm_storeu_ps(all.t.as_mut_ptr(), t);
        _mm_storeu_ps(all.u.as_mut_ptr(), _mm_div_ps(w[1], total));
        _mm_storeu_ps(all.v.as_mut_ptr(), _mm_div_ps(w[2], total));
    }
    let magnitude = _mm_andnot_ps(_mm_set1_ps(-0.0), total);
    let is_normal = _mm_and_ps(
        _mm_cmp_ps::<_CMP_GE_OQ>(magnitude, _mm_set1_ps(f32::MIN_POSITIVE)),
        _mm_cmp_ps::<_CMP_LT_OQ>(magnitude, _mm_set1_ps(f32::INFINITY)),
    );
    let extreme = found & !_mm_movemask_ps(is_normal);
    if extreme != 0 {
        // SAFETY: as above.
        unsafe { decide(candidates, extreme as u32, &mut all) };
    }
    all
}

/// The weights of those for which f32 overflows or underflows.
#[cold]
unsafe fn decide(candidates: &[Candidate; CROSSINGS], extreme: u32, all: &mut Crossings) {
    for (i, c) in candidates.iter().enumerate().filter(|(i, _)| extreme >> i & 1 != 0) {
        // SAFETY: the caller promises what the candidates point to.
        let (weights, of) = unsafe { ((*c.weights).of(c.lane), || ((*c.block).triangle(c.lane), *c.ray)) };
        match triangle::barycentric(weights, of) {
            Some((u, v)) => (all.u[i], all.v[i]) = (u, v),
            None => all.found &= !(1 << i),
        }
    }
}

/// The first three rows of four vectors as columns. There must be 4 bytes after each vector.
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn transposed(a: *const f32, b: *const f32, c: *const f32, d: *const f32) -> Rows {
    // SAFETY: the caller promises 16 bytes.
    let (a, b, c, d) = unsafe { (_mm_loadu_ps(a), _mm_loadu_ps(b), _mm_loadu_ps(c), _mm_loadu_ps(d)) };
    let (ab, cd) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
    let z = _mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
    [_mm_movelh_ps(ab, cd), _mm_movehl_ps(cd, ab), z]
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn wide(v: Rows) -> WideRows {
    [_mm256_cvtps_pd(v[0]), _mm256_cvtps_pd(v[1]), _mm256_cvtps_pd(v[2])]
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn minus(a: WideRows, b: WideRows) -> WideRows {
    [_mm256_sub_pd(a[0], b[0]), _mm256_sub_pd(a[1], b[1]), _mm256_sub_pd(a[2], b[2])]
}

/// x + y + z of the products.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn dot(a: WideRows, b: WideRows) -> __m256d {
    let sum = _mm256_add_pd(_mm256_mul_pd(a[0], b[0]), _mm256_mul_pd(a[1], b[1]));
    _mm256_add_pd(sum, _mm256_mul_pd(a[2], b[2]))
}

/// x + y + z without their signs.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn sum_of_sizes(v: WideRows) -> __m256d {
    _mm256_add_pd(_mm256_add_pd(size(v[0]), size(v[1])), size(v[2]))
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn size(x: __m256d) -> __m256d {
    _mm256_andnot_pd(_mm256_set1_pd(-0.0), x)
}
