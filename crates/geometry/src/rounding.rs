//! Rounding error bounds: how far a computed point may lie from the true one, and how a ray starts clear of it.
//!
//! After Pharr, Jakob & Humphreys, "Physically Based Rendering" (2023), section 6.8.

use crate::{DVec3, Vec3};

/// Half the distance from 1 to the next f32: the relative error of one rounding.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// Bound on the relative error of `n` successive roundings: `n u / (1 - n u)` (Higham 2002).
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

/// Move `point` off a surface along its geometric `normal`, to the side that `direction` goes to, by at least `error`
/// (absolute, per axis): the result lies clear of the surface, whatever the rounding was.
#[inline]
pub fn offset_origin(point: DVec3, error: DVec3, normal: DVec3, direction: DVec3) -> Vec3 {
    let distance = normal.abs().dot(error);
    let offset = if direction.dot(normal) < 0.0 { normal * -distance } else { normal * distance };
    let (moved, offset) = ((point + offset).to_array(), offset.to_array());
    Vec3::from_array(core::array::from_fn(|axis| away(moved[axis], offset[axis])))
}

/// `x` rounded to f32 and one further towards the side that `offset` goes to: away from the surface, never towards it. Without
/// branches, which no one could predict.
#[inline(always)]
fn away(x: f64, offset: f64) -> f32 {
    let f = x as f32;
    let bits = f.to_bits();
    // Away from zero the next number has the next bits, for either sign; from zero it is the least of its sign.
    let is_down = (offset.to_bits() >> 32) as i32 >> 31;
    let step = (is_down ^ bits as i32 >> 31) | 1;
    let least = is_down as u32 & 0x8000_0000 | 1;
    let next = if bits << 1 == 0 { least } else { bits.wrapping_add_signed(step) };
    let stays = (offset == 0.0) | (bits & 0x7f80_0000 == 0x7f80_0000);
    f32::from_bits(if stays { bits } else { next })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_origin_is_clear_of_the_plane_on_the_right_side() {
        let n = DVec3::new(0.6, 0.8, 0.0);
        let p = DVec3::new(1e6, 2e6, -3e6);
        let e = p.abs() * f64::from(gamma(3));
        let above = offset_origin(p, e, n, n).as_dvec3();
        let below = offset_origin(p, e, n, -n).as_dvec3();
        assert!((above - p).dot(n) >= n.abs().dot(e) * 0.999);
        assert!((below - p).dot(n) <= -n.abs().dot(e) * 0.999);
    }

    #[test]
    fn away_is_the_next_number_on_that_side() {
        for x in [0.0, -0.0, 1.0, -1.0, 0.1, -0.1, 1e-45, -1e-45, 1e30, -1e30, 65_536.0] {
            let f = x as f32;
            assert_eq!(away(x, 1.0), f.next_up(), "{x}");
            assert_eq!(away(x, -1.0), f.next_down(), "{x}");
            assert_eq!(away(x, 0.0).to_bits(), f.to_bits());
        }
        assert_eq!(away(f64::INFINITY, -1.0), f32::INFINITY);
        assert!(away(f64::NAN, 1.0).is_nan());
    }
}
