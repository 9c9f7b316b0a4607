//! A pair of directions by its half vector: Rusinkiewicz's angles.
//!
//! S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", 1998, section 3. `theta_h` is the half
//! vector's angle from the normal, `theta_d` the angle between it and either direction, and `phi_d` the longitude of `wi` about
//! it, from the plane in which the half vector leaves the normal. Swapping the directions turns `phi_d` by pi.

use core::f64::consts::{FRAC_PI_2, PI};
use kirkas_geometry::elementary::{atan2_f32, sin_cos};
use kirkas_geometry::{DVec3, Vec3};

/// The three angles that isotropic reflectance depends on, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfAngles {
    /// 0..pi/2.
    pub theta_h: f32,
    /// 0..pi/2.
    pub theta_d: f32,
    /// -pi..pi.
    pub phi_d: f32,
}

impl HalfAngles {
    /// Of two unit vectors above the surface.
    pub fn of(wo: Vec3, wi: Vec3) -> Self {
        let (sum, difference) = (wi + wo, wi - wo);
        let across = (sum.x * sum.x + sum.y * sum.y).sqrt();
        // The difference seen along the half vector: along the longitude and along the parallel through it.
        let (x, y) = if across > 0.0 {
            let along = (difference.x * sum.x + difference.y * sum.y) / across;
            let size = (across * across + sum.z * sum.z).sqrt();
            ((along * sum.z - difference.z * across) / size, (difference.y * sum.x - difference.x * sum.y) / across)
        } else {
            (difference.x, difference.y)
        };
        HalfAngles {
            theta_h: atan2_f32(across, sum.z),
            theta_d: atan2_f32(difference.length(), sum.length()),
            phi_d: atan2_f32(y, x),
        }
    }

    /// The pair `(wo, wi)` with these angles (radians), its half vector above the x axis.
    pub fn directions(theta_h: f64, theta_d: f64, phi_d: f64) -> (DVec3, DVec3) {
        debug_assert!((0.0..=FRAC_PI_2).contains(&theta_h) && phi_d.abs() <= 2.0 * PI);
        let ((sin_h, cos_h), (sin_d, cos_d), (sin_p, cos_p)) = (sin_cos(theta_h), sin_cos(theta_d), sin_cos(phi_d));
        let half = DVec3::new(sin_h, 0.0, cos_h);
        let (along, across) = (DVec3::new(cos_h, 0.0, -sin_h), DVec3::Y);
        let aside = (along * cos_p + across * sin_p) * sin_d;
        (half * cos_d - aside, half * cos_d + aside)
    }
}
