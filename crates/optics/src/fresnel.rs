//! Reflection and refraction at a smooth boundary: directions and how much goes each way.
//!
//! `eta_o` is the refractive index on the side of `wo`, `eta_i` the one beyond the boundary. Cosines are between a
//! direction on its own side and the normal there, so never negative. Reflectances are of power, 0..1.
//!
//! Born & Wolf, "Principles of Optics" (7th ed., 1999), section 1.5.

use kirkas_geometry::Vec3;

/// `w` mirrored about the unit vector `n`; both point away from the surface.
pub fn reflect(w: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * w.dot(n)) - w
}

/// The direction, pointing away from the surface on its far side, into which light along `wo` refracts at a boundary with
/// unit normal `n` on `wo`'s side (Snell & Descartes). `None` is total internal reflection.
pub fn refract(wo: Vec3, n: Vec3, eta_o: f32, eta_i: f32) -> Option<Vec3> {
    let cos_o = wo.dot(n);
    let cos_i = refracted_cosine(cos_o, eta_o, eta_i)?;
    let ratio = eta_o / eta_i;
    let wi = n * (ratio * cos_o - cos_i) - wo * ratio;
    Some(wi / wi.length())
}

/// Cosine of the angle of refraction; `None` is total internal reflection.
pub fn refracted_cosine(cos_o: f32, eta_o: f32, eta_i: f32) -> Option<f32> {
    let ratio = eta_o / eta_i;
    // (1 - c)(1 + c) keeps near grazing what 1 - c^2 loses.
    let sin2_i = ratio * ratio * ((1.0 - cos_o) * (1.0 + cos_o)).max(0.0);
    (sin2_i < 1.0).then(|| (1.0 - sin2_i).sqrt())
}

/// Reflectances `(R_s, R_p)` of a dielectric for light polarised across and along the plane of incidence; 1 under total
/// internal reflection.
pub fn dielectric_polarised(cos_o: f32, eta_o: f32, eta_i: f32) -> (f32, f32) {
    let Some(cos_i) = refracted_cosine(cos_o, eta_o, eta_i) else { return (1.0, 1.0) };
    let s = (eta_o * cos_o - eta_i * cos_i) / (eta_o * cos_o + eta_i * cos_i);
    let p = (eta_i * cos_o - eta_o * cos_i) / (eta_i * cos_o + eta_o * cos_i);
    (s * s, p * p)
}

/// Reflectance of a dielectric for unpolarised light.
pub fn dielectric(cos_o: f32, eta_o: f32, eta_i: f32) -> f32 {
    let (s, p) = dielectric_polarised(cos_o, eta_o, eta_i);
    0.5 * (s + p)
}

/// Reflectance of a metal for unpolarised light from vacuum, for its complex index `n + i k` (Born & Wolf, section 14.2); with
/// `k = 0` that of a dielectric.
pub fn conductor(cos_o: f32, n: f32, k: f32) -> f32 {
    let (n, k, cos) = (f64::from(n), f64::from(k), f64::from(cos_o));
    let (cos2, sin2) = (cos * cos, (1.0 - cos) * (1.0 + cos));
    // a + i b is the root of (n + i k)^2 - sin^2.
    let real = n * n - k * k - sin2;
    let size = (real * real + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (size + real)).max(0.0).sqrt();
    let s = (size + cos2 - 2.0 * a * cos) / (size + cos2 + 2.0 * a * cos);
    let turned = size * cos2 + sin2 * sin2;
    let mixed = 2.0 * a * cos * sin2;
    let p = s * (turned - mixed) / (turned + mixed);
    (0.5 * (s + p)) as f32
}

/// Schlick's approximation of [`dielectric`]: the cosine is the one on the thinner side, so that it stays continuous up to
/// total internal reflection; matched indices reflect nothing.
///
/// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", equation 15.
pub fn dielectric_schlick(cos_o: f32, eta_o: f32, eta_i: f32) -> f32 {
    if eta_o == eta_i {
        return 0.0;
    }
    let Some(cos_i) = refracted_cosine(cos_o, eta_o, eta_i) else { return 1.0 };
    let root = (eta_o - eta_i) / (eta_o + eta_i);
    schlick(root * root, if eta_o > eta_i { cos_i } else { cos_o })
}

/// Schlick's curve from `r0` at normal incidence to 1 at grazing.
pub fn schlick(r0: f32, cos: f32) -> f32 {
    let m = (1.0 - cos).max(0.0);
    let m2 = m * m;
    r0 + (1.0 - r0) * (m2 * m2 * m)
}
