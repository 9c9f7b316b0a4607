//! The two published fits of analytic models to the 100 MERL materials, for making files of them.
//!
//! SGD: M. M. Bagher, C. Soler, N. Holzschuch, "Accurate Fitting of Measured Reflectances Using a Shifted Gamma Micro-facet
//! Distribution", EGSR 2012, equations 9 to 14. ABC: J. Löw et al., "BRDF Models for Accurate and Efficient Rendering of Glossy
//! Surfaces", TOG 31(1), 2012, section 4 (the microfacet form). Symbols as there; each channel has its own.

use core::f64::consts::PI;
use kirkas_geometry::DVec3;
use kirkas_geometry::elementary::{acos, exp, pow};

/// Shifted gamma distribution: one value per channel each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Sgd {
    pub rho_d: [f64; 3],
    pub rho_s: [f64; 3],
    pub alpha: [f64; 3],
    pub p: [f64; 3],
    pub f0: [f64; 3],
    pub f1: [f64; 3],
    pub kappa: [f64; 3],
    pub lambda: [f64; 3],
    pub c: [f64; 3],
    pub k: [f64; 3],
    pub theta0: [f64; 3],
}

/// The ABC microfacet model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Abc {
    pub k_d: [f64; 3],
    pub a: [f64; 3],
    pub b: f64,
    pub c: f64,
    pub ior: f64,
}

impl Sgd {
    /// From its numbers as the published table has them: red, green and blue of each field in turn.
    pub fn of_numbers(numbers: &[f64]) -> Option<Self> {
        let t = |i: usize| Some([*numbers.get(3 * i)?, *numbers.get(3 * i + 1)?, *numbers.get(3 * i + 2)?]);
        let (rho_d, rho_s, alpha, p, f0, f1) = (t(0)?, t(1)?, t(2)?, t(3)?, t(4)?, t(5)?);
        let (kappa, lambda, c, k, theta0) = (t(6)?, t(7)?, t(8)?, t(9)?, t(10)?);
        Some(Sgd { rho_d, rho_s, alpha, p, f0, f1, kappa, lambda, c, k, theta0 })
    }

    /// Linear Rec.709, 1/sr, without the cosine; both directions above the surface.
    pub fn value(&self, wo: DVec3, wi: DVec3) -> [f64; 3] {
        let h = (wo + wi).normalize();
        let (cos_h, cos_d) = (h.z, h.dot(wi).clamp(0.0, 1.0));
        let tan2 = ((h.x * h.x + h.y * h.y) / (cos_h * cos_h)).max(0.0);
        core::array::from_fn(|i| {
            // Equation 11: the distribution of facets.
            let x = self.alpha[i] + tan2 / self.alpha[i];
            let d = self.kappa[i] * exp(-x) / (PI * pow(x, self.p[i]) * cos_h * cos_h * cos_h * cos_h);
            // Equation 9: Fresnel.
            let m = 1.0 - cos_d;
            let f = (self.f0[i] - cos_d * self.f1[i] + m * m * m * m * m * (1.0 - self.f0[i])).max(0.0);
            let g = self.masking(i, wo.z) * self.masking(i, wi.z);
            ((self.rho_d[i] + self.rho_s[i] * f * d * g / (wo.z * wi.z)) / PI).max(0.0)
        })
    }

    /// Equation 14.
    fn masking(&self, i: usize, cos: f64) -> f64 {
        let past = (acos(cos.min(1.0)) - self.theta0[i]).max(0.0);
        (1.0 + self.lambda[i] * (1.0 - exp(self.c[i] * pow(past, self.k[i])))).clamp(0.0, 1.0)
    }
}

impl Abc {
    /// Linear Rec.709, 1/sr, without the cosine; both directions above the surface.
    pub fn value(&self, wo: DVec3, wi: DVec3) -> [f64; 3] {
        let h = (wo + wi).normalize();
        let cos_d = h.dot(wi).clamp(1e-9, 1.0);
        // 1 - cos theta_h without losing digits.
        let one_minus_cos = (h.x * h.x + h.y * h.y) / (1.0 + h.z);
        let g = (2.0 * h.z * wi.z / cos_d).min(2.0 * h.z * wo.z / cos_d).min(1.0);
        let common = self.fresnel(cos_d) * g / (PI * wo.z * wi.z * pow(1.0 + self.b * one_minus_cos, self.c));
        core::array::from_fn(|i| self.k_d[i] / PI + self.a[i] * common)
    }

    /// Unpolarised dielectric, as a clear function of the cosine (Cook & Torrance 1982, equation for F).
    fn fresnel(&self, cos: f64) -> f64 {
        let g = (self.ior * self.ior - 1.0 + cos * cos).max(0.0).sqrt();
        let (a, b) = ((g - cos) / (g + cos), (cos * (g + cos) - 1.0) / (cos * (g - cos) + 1.0));
        0.5 * a * a * (1.0 + b * b)
    }
}
