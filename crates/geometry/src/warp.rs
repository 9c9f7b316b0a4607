//! Maps from the unit square to the domains that rays are drawn from, each with its density.

use crate::elementary::{cos, sin, sin_cos_f32};
use crate::{Vec2, Vec3};
use core::f32::consts::PI;

/// The unit disk, uniform by area (Shirley & Chiu 1997, concentric).
pub fn square_to_uniform_disk(u: (f32, f32)) -> Vec2 {
    let (a, b) = (2.0 * u.0 - 1.0, 2.0 * u.1 - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    let (r, theta) = if a.abs() > b.abs() { (a, PI / 4.0 * (b / a)) } else { (b, PI / 2.0 - PI / 4.0 * (a / b)) };
    let (s, c) = sin_cos_f32(theta);
    Vec2::new(r * c, r * s)
}

/// The hemisphere about +z, density [`square_to_cosine_hemisphere_pdf`].
pub fn square_to_cosine_hemisphere(u: (f32, f32)) -> Vec3 {
    let d = square_to_uniform_disk(u);
    Vec3::new(d.x, d.y, (1.0 - d.length_squared()).max(0.0).sqrt())
}

/// `cos(theta) / pi` per solid angle.
pub fn square_to_cosine_hemisphere_pdf(v: Vec3) -> f32 {
    v.z.max(0.0) / PI
}

/// The whole sphere, density `1 / (4 pi)` per solid angle.
pub fn square_to_uniform_sphere(u: (f32, f32)) -> Vec3 {
    let z = 1.0 - 2.0 * u.0;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (s, c) = sin_cos_f32(2.0 * PI * u.1);
    Vec3::new(r * c, r * s, z)
}

/// Directions within a cone about +z, uniform by solid angle; `one_minus_cos` is 1 - cos of its half angle
/// (passed so, since it is what stays exact for narrow cones). Density `1 / (2 pi one_minus_cos)`.
pub fn square_to_uniform_cone(u: (f32, f32), one_minus_cos: f32) -> Vec3 {
    let h = one_minus_cos * u.0;
    let z = 1.0 - h;
    let r = (h * (2.0 - h)).max(0.0).sqrt();
    let (s, c) = sin_cos_f32(2.0 * PI * u.1);
    Vec3::new(r * c, r * s, z)
}

/// Barycentric `(b1, b2)` of a triangle, uniform by area (Osada et al. 2002).
pub fn square_to_uniform_triangle(u: (f32, f32)) -> (f32, f32) {
    let s = u.0.sqrt();
    (s * (1.0 - u.1), s * u.1)
}

/// A regular polygon of circumradius 1, first vertex at angle `rotation` (radians), uniform by area.
pub fn square_to_uniform_polygon(u: (f32, f32), sides: u32, rotation: f32) -> Vec2 {
    let scaled = u.0 * sides as f32;
    let k = scaled.min(sides as f32 - 0.5).floor();
    let (b1, b2) = square_to_uniform_triangle((scaled - k, u.1));
    let corner = |i: f32| {
        let a = f64::from(rotation) + 2.0 * core::f64::consts::PI * f64::from(i) / f64::from(sides);
        Vec2::new(cos(a) as f32, sin(a) as f32)
    };
    corner(k) * b1 + corner(k + 1.0) * b2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::low_discrepancy::owen_sobol_2d;

    fn mean(n: u32, f: impl Fn((f32, f32)) -> f32) -> f32 {
        (0..n).map(|i| f(owen_sobol_2d(i, 9))).sum::<f32>() / n as f32
    }

    #[test]
    fn moments_match_the_densities() {
        assert!((mean(4096, |u| square_to_uniform_disk(u).length_squared()) - 0.5).abs() < 1e-3);
        assert!((mean(4096, |u| square_to_cosine_hemisphere(u).z) - 2.0 / 3.0).abs() < 1e-3);
        assert!(mean(4096, |u| square_to_uniform_sphere(u).y).abs() < 1e-3);
        assert!((mean(4096, |u| square_to_uniform_cone(u, 0.2).z) - 0.9).abs() < 1e-3);
        assert!(mean(4096, |u| square_to_uniform_polygon(u, 5, 0.3).x).abs() < 2e-3);
        // A square of circumradius 1 has second moment 1/3.
        assert!((mean(4096, |u| square_to_uniform_polygon(u, 4, 0.0).length_squared()) - 1.0 / 3.0).abs() < 2e-3);
    }
}
