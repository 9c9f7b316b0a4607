//! The arithmetic of packets, once for any CPU. A twin for AVX2 is in `avx2`; both give the same bits.

use super::super::backend::{Backend, Keys, Portable, key};
use super::super::node::{Block, Node, WIDTH};
use super::PACKET;
use super::found::Found;
use super::rays::{Frustum, Rays, Row};
use crate::prepared_ray::PreparedRay;
use crate::triangle;
use kirkas_geometry::{Ray, Vec3};

/// Where eight rays cross a triangle.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Crossings {
    pub t: [f32; 8],
    pub u: [f32; 8],
    pub v: [f32; 8],
}

impl Crossings {
    pub const NONE: Crossings = Crossings { t: [0.0; 8], u: [0.0; 8], v: [0.0; 8] };
}

/// The arithmetic of packets. Eight rays that stand together are named by their place among the eights, 0 to 7.
pub(super) trait PacketBackend: Backend {
    /// Write the rays' origins, directions and intervals to rows.
    ///
    /// # Safety
    /// The CPU has what the backend needs.
    unsafe fn load_rows(rows: &mut Rays, rays: &[Ray; PACKET]);

    /// Keys of the children that some ray of the packet may enter before `limit`.
    ///
    /// # Safety
    /// The CPU has what the backend needs; `node` is valid.
    unsafe fn packet_boxes(node: *const Node, frustum: &Frustum, limit: f32) -> Keys;

    /// The box test of one child: a bit for each ray `among` these that enters it before its limit.
    ///
    /// # Safety
    /// As for [`PacketBackend::packet_boxes`].
    unsafe fn rays_in_box(node: *const Node, child: usize, rays: &Rays, limit: &Row, among: u64) -> u64;

    /// Test the first `count` triangles of a block, with the rays `among` these, which have one axis. `visit` is told lane, eight, which of
    /// the eight rays cross the triangle, and where.
    ///
    /// # Safety
    /// The CPU has what the backend needs; `block` is valid.
    unsafe fn cross_block(
        block: *const Block,
        count: usize,
        rays: &Rays,
        among: u64,
        visit: impl FnMut(usize, usize, u32, &Crossings),
    );

    /// Keep, of the crossings of eight rays with a triangle of the world, those that win; true if any does.
    ///
    /// # Safety
    /// The CPU has what the backend needs.
    unsafe fn keep(found: &mut Found, eight: usize, bits: u32, crossings: &Crossings, number: u32) -> bool;
}

/// The ray that a place in the packet holds.
pub(super) fn prepared(rays: &Rays, r: usize) -> Option<PreparedRay> {
    let vector = |rows: &[Row; 3]| Vec3::from([rows[0][r], rows[1][r], rows[2][r]]);
    let mut ray = Ray::new(vector(&rays.origin), vector(&rays.direction));
    (ray.t_min, ray.t_max) = (rays.t_min[r], rays.t_max[r]);
    PreparedRay::new(&ray)
}

impl PacketBackend for Portable {
    #[inline(always)]
    unsafe fn load_rows(rows: &mut Rays, rays: &[Ray; PACKET]) {
        for (r, ray) in rays.iter().enumerate() {
            for k in 0..3 {
                (rows.origin[k][r], rows.direction[k][r]) = (ray.origin[k], ray.direction[k]);
            }
            (rows.t_min[r], rows.t_max[r]) = (ray.t_min, ray.t_max);
        }
    }

    #[inline(always)]
    unsafe fn packet_boxes(node: *const Node, f: &Frustum, limit: f32) -> Keys {
        // SAFETY: the caller promises that the node is valid.
        let node = unsafe { &*node };
        let mut keys = Keys::NONE;
        for c in 0..WIDTH {
            let (mut near, mut far) = (f.t_min, limit);
            for k in 0..3 {
                let (enter, leave) = (node.planes[f.enter_row[k]][c], node.planes[f.enter_row[k] ^ 1][c]);
                let at = |plane: f32, offset: [f32; 2]| [0, 1].map(|s| plane * f.inverse[k][s] + offset[s]);
                let ([e, e2], [l, l2]) = (at(enter, f.enter[k]), at(leave, f.leave[k]));
                let (e, l) = (if e < e2 { e } else { e2 }, if l > l2 { l } else { l2 });
                near = if e > near { e } else { near };
                far = if l < far { l } else { far };
            }
            if near <= far {
                keys.0[c] = key(near) | node.empty[c];
            }
        }
        keys
    }

    #[inline(always)]
    unsafe fn rays_in_box(node: *const Node, child: usize, rays: &Rays, limit: &Row, among: u64) -> u64 {
        // SAFETY: the caller promises that the node is valid.
        let node = unsafe { &*node };
        let mut inside = 0;
        for r in (0..PACKET).filter(|r| among >> r & 1 != 0) {
            let (mut near, mut far) = (rays.t_min[r], limit[r]);
            for k in 0..3 {
                let row = rays.frustum.enter_row[k];
                let e = node.planes[row][child & 7] * rays.inverse[k][r] + rays.enter[k][r];
                let l = node.planes[row ^ 1][child & 7] * rays.inverse[k][r] + rays.leave[k][r];
                near = if e > near { e } else { near };
                far = if l < far { l } else { far };
            }
            inside |= u64::from(near <= far) << r;
        }
        inside
    }

    #[inline(always)]
    unsafe fn cross_block(
        block: *const Block,
        count: usize,
        rays: &Rays,
        among: u64,
        mut visit: impl FnMut(usize, usize, u32, &Crossings),
    ) {
        // SAFETY: the caller promises that the block is valid.
        let block = unsafe { &*block };
        for lane in 0..count {
            for eight in 0..PACKET / 8 {
                let (mut bits, mut crossings) = (0, Crossings::NONE);
                for l in (0..8).filter(|l| among >> (8 * eight + l) & 1 != 0) {
                    let Some(ray) = prepared(rays, 8 * eight + l) else { continue };
                    if let Some((t, u, v)) = triangle::intersect(&block.triangle(lane), &ray) {
                        (crossings.t[l], crossings.u[l], crossings.v[l]) = (t, u, v);
                        bits |= 1 << l;
                    }
                }
                if bits != 0 {
                    visit(lane, eight, bits, &crossings);
                }
            }
        }
    }

    #[inline(always)]
    unsafe fn keep(found: &mut Found, eight: usize, bits: u32, crossings: &Crossings, number: u32) -> bool {
        let mut any = false;
        for l in (0..8).filter(|l| bits >> l & 1 != 0) {
            let (r, t) = (8 * eight + l, crossings.t[l]);
            if found.would_keep(r, t, number) {
                found.keep(r, (t, crossings.u[l], crossings.v[l]), number);
                any = true;
            }
        }
        any
    }
}
