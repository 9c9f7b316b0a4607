//! The GGX distribution of microfacets with Smith's masking: what rough mirrors and rough glass are made of.
//!
//! Symbols as in the papers: `h` a facet's normal, `D` density of facets per solid angle (1/sr), `G` the part of them that is
//! visible, `alpha` the roughness (0 smooth, 1 very rough). All on the +z side; `h.z > 0`.
//!
//! B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (equations 33, 34); E. Heitz,
//! "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014 (equations 72, 99); E. Heitz, "Sampling the GGX Distribution
//! of Visible Normals", JCGT 7(4), 2018 (equations 3, 17 and listing 1).

use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::sin_cos_f32;

/// A distribution with one roughness in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha: f32,
}

/// Below this, f32 no longer resolves the lobe (0.1 degrees wide); smaller roughness is raised to it.
pub const LEAST_ALPHA: f32 = 1e-3;

impl Ggx {
    /// Of roughness `alpha`, raised to [`LEAST_ALPHA`].
    pub fn new(alpha: f32) -> Self {
        Ggx { alpha: alpha.max(LEAST_ALPHA) }
    }

    /// Facets per solid angle (1/sr): `D`, normalised so that their projected areas add up to 1.
    pub fn d(&self, h: Vec3) -> f32 {
        let a2 = self.alpha * self.alpha;
        // x^2 + y^2 in place of 1 - z^2: exact where the lobe is narrow.
        let s = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
        a2 / (PI * s * s)
    }

    /// Smith's Lambda: masked facets per visible one, seen from `w`.
    pub fn lambda(&self, w: Vec3) -> f32 {
        let tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
        0.5 * ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0)
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

    /// Density per solid angle of `h` with which [`Ggx::sample_visible_normal`] gives `h`: `G1 D (wo.h)+ / wo.z`.
    pub fn visible_normal_pdf(&self, wo: Vec3, h: Vec3) -> f32 {
        self.g1(wo) * self.d(h) * wo.dot(h).max(0.0) / wo.z
    }

    /// A facet as seen from `wo`.
    pub fn sample_visible_normal(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        // Stretch the view so that the facets become a hemisphere.
        let v = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let length2 = v.x * v.x + v.y * v.y;
        let t1 = if length2 > 0.0 { Vec3::new(-v.y, v.x, 0.0) / length2.sqrt() } else { Vec3::X };
        let t2 = v.cross(t1);
        // Draw a point of the hemisphere's projection: a disk, its lower half squeezed.
        let r = u.0.sqrt();
        let (sin, cos) = sin_cos_f32(2.0 * PI * u.1);
        let p1 = r * cos;
        let s = 0.5 * (1.0 + v.z);
        let p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * (r * sin);
        let n = t1 * p1 + t2 * p2 + v * (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
        // Undo the stretch.
        Vec3::new(self.alpha * n.x, self.alpha * n.y, n.z.max(1e-6)).normalize()
    }
}
