//! Distributions of microfacets with Smith's masking: what rough mirrors, metals and glass are made of.
//!
//! Symbols as in the papers: `h` a facet's normal, `D` density of facets per solid angle (1/sr), `G` the part of them that is
//! visible, `alpha` the roughness (0 smooth, 1 very rough) along x and along y. All on the +z side; `h.z > 0`.
//!
//! B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (equations 25, 33, 34); E. Heitz,
//! "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014 (equations 66, 72, 79, 80, 85, 99); E. Heitz, "Sampling the GGX
//! Distribution of Visible Normals", JCGT 7(4), 2018 (equations 3, 17 and listing 1); E. Heitz & E. d'Eon, "Importance Sampling
//! Microfacet-Based BSDFs using the Distribution of Visible Normals", EGSR 2014 (section 5, stretching; Beckmann's slopes).

pub mod albedo;
mod losses;
pub mod tabulated;

use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{erf, erf_inverse, exp, exp_f32, sin_cos_f32};

/// How slopes are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distribution {
    /// Trowbridge & Reitz: long tails.
    #[default]
    Ggx,
    /// Gaussian slopes: no tails.
    Beckmann,
}

/// A distribution with its roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    distribution: Distribution,
    alpha: (f32, f32),
    /// `alpha_u alpha_v`, and how much more x and y count than with equal roughness: `alpha_v / alpha_u` and its inverse.
    area: f32,
    stretch: (f32, f32),
}

/// Below this, f32 no longer resolves the lobe (0.1 degrees wide); smaller roughness is raised to it.
pub const LEAST_ALPHA: f32 = 1e-3;

impl Facets {
    /// GGX of the same roughness in all directions, raised to [`LEAST_ALPHA`].
    pub fn ggx(alpha: f32) -> Self {
        Self::new(Distribution::Ggx, (alpha, alpha))
    }

    /// Of roughness `alpha` along x and along y, each raised to [`LEAST_ALPHA`].
    pub fn new(distribution: Distribution, alpha: (f32, f32)) -> Self {
        let alpha = (alpha.0.max(LEAST_ALPHA), alpha.1.max(LEAST_ALPHA));
        Facets { distribution, alpha, area: alpha.0 * alpha.1, stretch: (alpha.1 / alpha.0, alpha.0 / alpha.1) }
    }

    /// One roughness that loses about as much light: the root of the mean square.
    pub fn mean_alpha(&self) -> f32 {
        if self.alpha.0 == self.alpha.1 {
            return self.alpha.0;
        }
        (0.5 * (self.alpha.0 * self.alpha.0 + self.alpha.1 * self.alpha.1)).sqrt()
    }

    /// How slopes are spread.
    pub fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Facets per solid angle (1/sr): `D`, normalised so that their projected areas add up to 1.
    #[inline]
    pub fn d(&self, h: Vec3) -> f32 {
        // Sums of squares in place of 1 - z^2: exact where the lobe is narrow.
        let aside = h.x * h.x * self.stretch.0 + h.y * h.y * self.stretch.1;
        let z2 = h.z * h.z;
        match self.distribution {
            Distribution::Ggx => {
                let s = aside + self.area * z2;
                self.area / (PI * s * s)
            }
            Distribution::Beckmann => exp_f32(-aside / (self.area * z2)) / (PI * self.area * z2 * z2),
        }
    }

    /// Smith's Lambda: masked facets per visible one, seen from `w`.
    #[inline]
    pub fn lambda(&self, w: Vec3) -> f32 {
        let tan2 = (w.x * w.x * self.stretch.1 + w.y * w.y * self.stretch.0) / (w.z * w.z);
        match self.distribution {
            Distribution::Ggx => 0.5 * ((1.0 + self.area * tan2).sqrt() - 1.0),
            Distribution::Beckmann => {
                let a = 1.0 / f64::from(self.area * tan2).sqrt();
                // Beyond this nothing is masked in f32.
                if a > 4.0 {
                    return 0.0;
                }
                const TWO_ROOT_PI: f64 = 3.544_907_701_811_032;
                (0.5 * (erf(a) - 1.0) + exp(-a * a) / (TWO_ROOT_PI * a)) as f32
            }
        }
    }

    /// The part of the facets that is visible from `w`: `G1`.
    pub fn g1(&self, w: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// The part visible from both `wo` and `wi` above the surface, correlated by height: `G2`.
    pub fn g2_reflection(&self, wo: Vec3, wi: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(wo) + self.lambda(wi))
    }

    /// The part visible from `wo` above and `wi` below (uncorrelated, as Walter et al. have it).
    pub fn g2_transmission(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.g1(wo) * self.g1(wi)
    }

    /// Density per solid angle of `h` with which [`Facets::sample_visible_normal`] gives `h`: `G1 D (wo.h)+ / wo.z`.
    pub fn visible_normal_pdf(&self, wo: Vec3, h: Vec3) -> f32 {
        self.g1(wo) * self.d(h) * wo.dot(h).max(0.0) / wo.z
    }

    /// A facet as seen from `wo`.
    #[inline]
    pub fn sample_visible_normal(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        // Stretch the view so that the roughness becomes 1.
        let v = Vec3::new(self.alpha.0 * wo.x, self.alpha.1 * wo.y, wo.z).normalize();
        let n = match self.distribution {
            Distribution::Ggx => ggx_normal(v, u),
            Distribution::Beckmann => beckmann_normal(v, u),
        };
        // Undo the stretch.
        Vec3::new(self.alpha.0 * n.x, self.alpha.1 * n.y, n.z.max(1e-6)).normalize()
    }
}

/// A visible facet of roughness 1: a point of a hemisphere.
fn ggx_normal(v: Vec3, u: (f32, f32)) -> Vec3 {
    let length2 = v.x * v.x + v.y * v.y;
    let t1 = if length2 > 0.0 { Vec3::new(-v.y, v.x, 0.0) / length2.sqrt() } else { Vec3::X };
    let t2 = v.cross(t1);
    // Draw a point of the hemisphere's projection: a disk, its lower half squeezed.
    let r = u.0.sqrt();
    let (sin, cos) = sin_cos_f32(2.0 * PI * u.1);
    let p1 = r * cos;
    let s = 0.5 * (1.0 + v.z);
    let p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * (r * sin);
    t1 * p1 + t2 * p2 + v * (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt()
}

/// A visible facet of roughness 1, not normalised: the slope along the view by inverting its distribution, the other one is
/// Gaussian.
fn beckmann_normal(v: Vec3, u: (f32, f32)) -> Vec3 {
    let sin = (v.x * v.x + v.y * v.y).sqrt();
    let (cos_phi, sin_phi) = if sin > 0.0 { (v.x / sin, v.y / sin) } else { (1.0, 0.0) };
    let along = beckmann_slope(f64::from(v.z), f64::from(sin), f64::from(u.0)) as f32;
    let across = erf_inverse((2.0 * u.1 - 1.0).clamp(-1.0 + 1e-7, 1.0 - 1e-7));
    Vec3::new(-(cos_phi * along - sin_phi * across), -(sin_phi * along + cos_phi * across), 1.0)
}

/// The slope `x < cot(theta)` with density in proportion to `(cos - x sin) exp(-x^2)`, where its distribution function is `u`: by
/// Newton's steps, halving where one would leave the bracket.
fn beckmann_slope(cos: f64, sin: f64, u: f64) -> f64 {
    const ROOT_PI: f64 = 1.772_453_850_905_516;
    let below = |x: f64| cos * 0.5 * (1.0 + erf(x)) + sin * exp(-x * x) / (2.0 * ROOT_PI);
    let (mut low, mut high) = (-6.0, if sin > 0.0 { (cos / sin).min(6.0) } else { 6.0 });
    let wanted = u * below(high);
    let mut x = f64::from(erf_inverse((2.0 * u - 1.0).clamp(-0.999_999, 0.999_999) as f32)).min(high - 1e-3);
    for _ in 0..12 {
        let off = below(x) - wanted;
        if off > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let density = (cos - x * sin) * exp(-x * x) / ROOT_PI;
        let newton = x - off / density;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        x = next;
        if step < 1e-7 {
            break;
        }
    }
    x
}
