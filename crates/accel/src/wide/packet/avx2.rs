//! The arithmetic of packets in AVX2: eight children, or eight rays, at a time. The box tests have slack and may differ from others;
//! the triangle test is in `avx2_block`.

use super::super::avx2::Avx2;
use super::super::backend::Keys;
use super::super::node::{Block, Node};
use super::PACKET;
use super::avx2_block;
use super::backend::{Crossings, PacketBackend};
use super::found::Found;
use super::rays::{Frustum, Rays, Row};
use core::arch::x86_64::*;
use core::mem::offset_of;
use kirkas_geometry::Ray;

impl PacketBackend for Avx2 {
    #[inline(always)]
    unsafe fn load_rows(rows: &mut Rays, rays: &[Ray; PACKET]) {
        // SAFETY: the caller promises AVX2 and FMA.
        unsafe { load_rows(rows, rays) }
    }

    #[inline(always)]
    unsafe fn packet_boxes(node: *const Node, frustum: &Frustum, limit: f32) -> Keys {
        // SAFETY: the caller promises AVX2 and FMA and a valid node.
        unsafe { packet_boxes(node, frustum, limit) }
    }

    #[inline(always)]
    unsafe fn rays_in_box(node: *const Node, child: usize, rays: &Rays, limit: &Row, among: u64) -> u64 {
        // SAFETY: the caller promises AVX2 and FMA and a valid node.
        unsafe { rays_in_box(node, child, rays, limit, among) }
    }

    #[inline(always)]
    unsafe fn cross_block(
        block: *const Block,
        count: usize,
        rays: &Rays,
        among: u64,
        visit: impl FnMut(usize, usize, u32, &Crossings),
    ) {
        // SAFETY: the caller promises AVX2 and FMA and a valid block.
        unsafe {
            if rays.has_one_origin {
                avx2_block::cross_block::<true>(block, count, rays, among, visit);
            } else {
                avx2_block::cross_block::<false>(block, count, rays, among, visit);
            }
        }
    }

    #[inline(always)]
    unsafe fn keep(found: &mut Found, eight: usize, bits: u32, crossings: &Crossings, number: u32) -> bool {
        // SAFETY: the caller promises AVX2 and FMA.
        unsafe { keep(found, eight, bits, crossings, number) }
    }
}

/// The numbers of eight rays.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn load(row: &Row, eight: usize) -> __m256 {
    // SAFETY: rows have 8 times 8 numbers, aligned to 32 bytes within the packet.
    unsafe { _mm256_load_ps(row.as_ptr().add(8 * (eight & 7))) }
}

/// Origin, direction and interval are the first 8 numbers of a ray.
const _: () = assert!(
    offset_of!(Ray, origin) == 0
        && offset_of!(Ray, direction) == 12
        && offset_of!(Ray, t_min) == 24
        && offset_of!(Ray, t_max) == 28
);

/// Eight rays' eight numbers at a time are turned from columns to rows.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn load_rows(rows: &mut Rays, rays: &[Ray; PACKET]) {
    let ([ox, oy, oz], [dx, dy, dz]) = (&mut rows.origin, &mut rows.direction);
    for (eight, rays) in rays.as_chunks::<8>().0.iter().enumerate() {
        // SAFETY: rays begin with 8 numbers, of which these are the first or the last 4.
        let four = |r: usize, half: usize| unsafe { _mm_loadu_ps((&raw const rays[r]).cast::<f32>().add(4 * half)) };
        let both = |r: usize, half: usize| _mm256_set_m128(four(r + 4, half), four(r, half));
        let turned = |half: usize| {
            let [a, b, c, d] = [both(0, half), both(1, half), both(2, half), both(3, half)];
            let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
            let (ab2, cd2) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
            [
                _mm256_shuffle_ps::<0b01_00_01_00>(ab, cd),
                _mm256_shuffle_ps::<0b11_10_11_10>(ab, cd),
                _mm256_shuffle_ps::<0b01_00_01_00>(ab2, cd2),
                _mm256_shuffle_ps::<0b11_10_11_10>(ab2, cd2),
            ]
        };
        store([ox, oy, oz, dx], eight, turned(0));
        store([dy, dz, &mut rows.t_min, &mut rows.t_max], eight, turned(1));
    }
}

/// Write the numbers of eight rays.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn store<const N: usize>(rows: [&mut Row; N], eight: usize, values: [__m256; N]) {
    for (row, value) in rows.into_iter().zip(values) {
        // SAFETY: rows have 8 times 8 numbers, aligned to 32 bytes within the packet.
        unsafe { _mm256_store_ps(row.as_mut_ptr().add(8 * (eight & 7)), value) };
    }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn packet_boxes(node: *const Node, f: &Frustum, limit: f32) -> Keys {
    let planes = node.cast::<f32>();
    let at = |plane: __m256, inverse: f32, offset: f32| {
        _mm256_fmadd_ps(plane, _mm256_set1_ps(inverse), _mm256_set1_ps(offset))
    };
    // SAFETY: the node begins with 6 rows of 8 planes.
    let slab = |k: usize| unsafe {
        let first = 8 * f.enter_row[k];
        let (enter, leave) = (_mm256_load_ps(planes.add(first)), _mm256_load_ps(planes.add(first ^ 8)));
        let [i, j] = f.inverse[k];
        (
            _mm256_min_ps(at(enter, i, f.enter[k][0]), at(enter, j, f.enter[k][1])),
            _mm256_max_ps(at(leave, i, f.leave[k][0]), at(leave, j, f.leave[k][1])),
        )
    };
    let (x, y, z) = (slab(0), slab(1), slab(2));
    let near = _mm256_max_ps(_mm256_max_ps(x.0, _mm256_set1_ps(f.t_min)), _mm256_max_ps(y.0, z.0));
    let far = _mm256_min_ps(_mm256_min_ps(x.1, _mm256_set1_ps(limit)), _mm256_min_ps(y.1, z.1));
    let missed = _mm256_srli_epi32::<16>(_mm256_castps_si256(_mm256_cmp_ps::<_CMP_NLE_UQ>(near, far)));
    let near = _mm256_castps_si256(_mm256_max_ps(near, _mm256_setzero_ps()));
    let keys = _mm256_or_si256(_mm256_srli_epi32::<16>(near), missed);
    let keys = _mm_packus_epi32(_mm256_castsi256_si128(keys), _mm256_extracti128_si256::<1>(keys));
    let mut packed = Keys::NONE;
    // SAFETY: the node is valid; keys are 16 bytes, and both are aligned to 16.
    unsafe {
        let empty = _mm_load_si128((&raw const (*node).empty).cast());
        _mm_store_si128(packed.0.as_mut_ptr().cast(), _mm_or_si128(keys, empty));
    }
    packed
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn rays_in_box(node: *const Node, child: usize, rays: &Rays, limit: &Row, among: u64) -> u64 {
    let rows = rays.frustum.enter_row;
    // SAFETY: the node is valid, and the index below 6 and 8.
    let plane = |row: usize| unsafe { _mm256_set1_ps(*node.cast::<f32>().add(8 * row + (child & 7))) };
    let enter = [plane(rows[0]), plane(rows[1]), plane(rows[2])];
    let leave = [plane(rows[0] ^ 1), plane(rows[1] ^ 1), plane(rows[2] ^ 1)];
    let mut inside = 0;
    let mut left = among;
    while left != 0 {
        let shift = left.trailing_zeros() & 56;
        left &= !(0xff << shift);
        let eight = shift as usize / 8;
        let slab = |k: usize| {
            let i = load(&rays.inverse[k], eight);
            (
                _mm256_fmadd_ps(enter[k], i, load(&rays.enter[k], eight)),
                _mm256_fmadd_ps(leave[k], i, load(&rays.leave[k], eight)),
            )
        };
        let (x, y, z) = (slab(0), slab(1), slab(2));
        let near = _mm256_max_ps(_mm256_max_ps(x.0, load(&rays.t_min, eight)), _mm256_max_ps(y.0, z.0));
        let far = _mm256_min_ps(_mm256_min_ps(x.1, load(limit, eight)), _mm256_min_ps(y.1, z.1));
        let bits = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far)) as u32;
        inside |= u64::from(bits) << shift;
    }
    inside & among
}

#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn keep(found: &mut Found, eight: usize, bits: u32, crossings: &Crossings, number: u32) -> bool {
    // SAFETY: 8 numbers each, aligned to 32 bytes.
    let eight_of = |row: &[f32; 8]| unsafe { _mm256_load_ps(row.as_ptr()) };
    let (t, u, v) = (eight_of(&crossings.t), eight_of(&crossings.u), eight_of(&crossings.v));
    let at = 8 * (eight & 7);
    let best = load(&found.t, eight);
    // SAFETY: rows have 8 times 8 numbers.
    let rank = unsafe { _mm256_load_si256(found.rank.as_ptr().add(at).cast()) };
    let number = _mm256_set1_epi32(number as i32);
    let own = _mm256_add_epi32(number, _mm256_set1_epi32(1));
    let is_first = _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_min_epu32(own, rank), own));
    let is_level = _mm256_cmp_ps::<_CMP_EQ_OQ>(t, best);
    let wins = _mm256_or_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(t, best), _mm256_and_ps(is_level, is_first));
    let each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    let asked = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(bits as i32), each), each);
    let wins = _mm256_and_ps(wins, _mm256_castsi256_ps(asked));
    if _mm256_movemask_ps(wins) == 0 {
        return false;
    }
    let t = _mm256_blendv_ps(best, t, wins);
    let limit =
        _mm256_max_ps(_mm256_mul_ps(t, _mm256_set1_ps(found.pads[0])), _mm256_mul_ps(t, _mm256_set1_ps(found.pads[1])));
    let blend = |row: &Row, new: __m256| _mm256_blendv_ps(load(row, eight), new, wins);
    let (u, v) = (blend(&found.u, u), blend(&found.v, v));
    store([&mut found.t, &mut found.u, &mut found.v, &mut found.limit], eight, [t, u, v, limit]);
    let rank = _mm256_blendv_ps(_mm256_castsi256_ps(rank), _mm256_castsi256_ps(own), wins);
    // SAFETY: as in `store`.
    unsafe { _mm256_store_ps(found.rank.as_mut_ptr().add(at).cast(), rank) };
    true
}
