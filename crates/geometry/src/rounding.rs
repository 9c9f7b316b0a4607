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
    let moved = point + offset;
    // Round away from the surface, never towards it.
    let away = |x: f64, o: f64| {
        let f = x as f32;
        if o > 0.0 {
            f.next_up()
        } else if o < 0.0 {
            f.next_down()
        } else {
            f
        }
    };
    Vec3::new(away(moved.x, offset.x), away(moved.y, offset.y), away(moved.z, offset.z))
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
}
