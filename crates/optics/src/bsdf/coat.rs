//! The clear coat of plastics: what passes through it, and what it throws back at the light from below.

use crate::Light;
use crate::fresnel::dielectric;
use kirkas_geometry::elementary::ln;

/// Reflectance of a smooth dielectric boundary for diffuse light from the side whose index is 1, `n` beyond (S. Q. Duntley, "The Optical
/// Properties of Diffusing Materials", JOSA 32, 1942, equation 47).
pub(super) fn diffuse_reflectance(n: f64) -> f64 {
    if (n - 1.0).abs() < 1e-3 {
        return 0.0;
    }
    if n < 1.0 {
        // Light from the denser side: both directions pass the same, over n^2.
        return 1.0 - (1.0 - diffuse_reflectance(1.0 / n)) * n * n;
    }
    let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
    let (plus, minus) = (n2 + 1.0, n4 - 1.0);
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (n2 - 1.0) * (n2 - 1.0) / (plus * plus * plus) * ln((n - 1.0) / (n + 1.0))
        - 2.0 * n3 * (n2 + 2.0 * n - 1.0) / (plus * minus)
        + 8.0 * n4 * (n4 + 1.0) / (plus * minus * minus) * ln(n)
}

/// A smooth coat of an opaque body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coat {
    outside: f32,
    ior: f32,
    /// What it lets out of diffuse light from below: `1 - F_in`.
    pub(super) escape: f32,
}

impl Coat {
    /// With index `ior`, under `outside`.
    pub(super) fn new(outside: f32, ior: f32) -> Self {
        let n = f64::from(ior) / f64::from(outside);
        Coat { outside, ior, escape: ((1.0 - diffuse_reflectance(n)) / (n * n)) as f32 }
    }

    /// The same, letting out this much of diffuse light from below.
    pub(super) fn letting_out(self, escape: f32) -> Self {
        Coat { escape, ..self }
    }

    /// The same under another medium.
    pub(super) fn under(self, outside: f32) -> Self {
        if outside == self.outside { self } else { Coat::new(outside, self.ior) }
    }

    pub(super) fn is_under_vacuum(&self) -> bool {
        self.outside == 1.0
    }

    /// What is reflected from outside at this cosine.
    pub(super) fn reflectance(&self, cos: f32) -> f32 {
        dielectric(cos.min(1.0), self.outside, self.ior)
    }

    /// What becomes of the base's colour when light bounces under the coat: `rho / (1 - rho F_in)`, or `rho / (1 - F_in)` if bounces
    /// do not deepen it.
    pub(super) fn after_bounces(&self, rho: Light, saturates: bool) -> Light {
        let e = self.escape;
        rho.map(|rho| if saturates { rho / ((1.0 - rho) + rho * e) } else { rho / e })
    }

    /// `(outside / ior)^2`: how radiance thins out on its way to the base and back.
    pub(super) fn thinning(&self) -> f32 {
        let ratio = self.outside / self.ior;
        ratio * ratio
    }
}
