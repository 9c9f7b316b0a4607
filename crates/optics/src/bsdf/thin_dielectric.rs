//! # thin_dielectric
//!
//! A pane too thin to be modelled as a body: window glass, a soap bubble's skin, cling film. One surface stands for both faces and
//! all echoes between them; light goes straight through.
//!
//! With `R` the reflectance of one face for each polarisation and `tau` what the pane lets pass on one straight way,
//! `reflected = R + tau^2 R (1 - R)^2 / (1 - tau^2 R^2)` and `transmitted = tau (1 - R)^2 / (1 - tau^2 R^2)`, each the mean over both
//! polarisations.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index of the pane |
//! | `transmittance` | colour or texture, 0..1 | | 1 | tau: what passes through the pane's inside straight on |
//! | `reflectance` | colour or texture, 0..1 | | 1 | tints all of the reflection; 1 is physical |
//!
//! ## Example
//!
//! ```toml
//! [materials.window]
//! type = "thin_dielectric"
//! ior = 1.52
//! transmittance = [0.95, 0.98, 0.96]
//! ```
//!
//! ## Limits
//!
//! Light is not shifted sideways, and nothing interferes. The longer way at grazing angles counts only in `tau`, which is taken to
//! the power of one over the cosine inside.
//!
//! ## References
//!
//! M. Born & E. Wolf, "Principles of Optics", 7th ed., section 1.5 for R; the geometric series of echoes for the rest. It is exact for
//! unpolarised light, where taking the series of the mean R, as is common, passes 84 % in place of 85 % at 60 degrees.

use super::boundary::pick;
use super::{Branches, BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::fresnel::{dielectric_polarised, refracted_cosine};
use crate::{Lanes, Light, Palette};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::pow_f32;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "thin_dielectric",
    doc: "A thin pane: both faces and all echoes in one surface.",
    params: &[
        ParamSpec::number("ior", 1.5, "refractive index of the pane").range((0.01, f64::INFINITY)),
        ParamSpec::reflectance("transmittance", [1.0; 3], "what passes through the pane's inside straight on"),
        ParamSpec::reflectance("reflectance", [1.0; 3], "tints the reflection"),
    ],
};
const TRANSMITTANCE: usize = slot(SPEC.params, "transmittance");
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const MIRROR: Lobe = Lobe::DeltaReflection;
const PANE: Lobe = Lobe::DeltaTransmission;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    ior: f32,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct ThinDielectric {
    outside: f32,
    ior: f32,
    transmittance: Light,
    reflectance: Light,
}

impl Prepare for Prepared {
    type At = ThinDielectric;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        Prepared { ior: palette.index(params, "ior").at_d_line() }
    }
    fn at(&self, _: &Lanes, slots: &[Light], interface: Interface) -> ThinDielectric {
        ThinDielectric {
            outside: interface.eta_above,
            ior: self.ior,
            transmittance: slots[TRANSMITTANCE],
            reflectance: slots[REFLECTANCE],
        }
    }
}

impl ThinDielectric {
    /// The reflected and the transmitted part.
    fn parts(&self, cos: f32) -> (Light, Light) {
        let Some(inside) = refracted_cosine(cos, self.outside, self.ior) else {
            return (self.reflectance, Light::BLACK);
        };
        let tau = if self.transmittance == Light::splat(1.0) {
            self.transmittance
        } else {
            self.transmittance.map(|t| pow_f32(t, 1.0 / inside))
        };
        let (s, p) = dielectric_polarised(cos, self.outside, self.ior);
        let series = |r: f32, tau: f32| {
            let passed = (1.0 - r) * (1.0 - r) / (1.0 - tau * tau * r * r).max(f32::MIN_POSITIVE);
            (r + tau * tau * r * passed, tau * passed)
        };
        let mean = |pick: fn((f32, f32)) -> f32| tau.map(|t| 0.5 * (pick(series(s, t)) + pick(series(p, t))));
        (self.reflectance * mean(|x| x.0), mean(|x| x.1))
    }

    fn reflected(&self, wo: Vec3, f: Light, pdf: f32) -> BsdfSample {
        BsdfSample { wi: Vec3::new(-wo.x, -wo.y, wo.z), f, pdf, lobe: MIRROR, eta: 1.0, disperses: false }
    }

    fn transmitted(&self, wo: Vec3, f: Light, pdf: f32) -> BsdfSample {
        BsdfSample { wi: -wo, f, pdf, lobe: PANE, eta: 1.0, disperses: false }
    }
}

impl Scatter for ThinDielectric {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(MIRROR).when(!self.reflectance.is_black()) | LobeSet::of(PANE).when(!self.transmittance.is_black())
    }
    fn eval(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> Light {
        Light::BLACK
    }
    fn pdf(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> f32 {
        0.0
    }
    fn sample(&self, wo: Vec3, u_lobe: f32, _: (f32, f32), lobes: LobeSet, _: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (r, t) = self.parts(wo.z.abs());
        let wanted = |lobe, w: Light| if lobes.contains(lobe) { w.max_component() } else { 0.0 };
        match pick([wanted(MIRROR, r), wanted(PANE, t)], u_lobe)? {
            (0, p) => Some(self.reflected(wo, r, p)),
            (_, p) => Some(self.transmitted(wo, t, p)),
        }
    }
    fn delta_branches(&self, wo: Vec3, _: Mode) -> Branches {
        let mut all = Branches::default();
        if wo.z == 0.0 {
            return all;
        }
        let (r, t) = self.parts(wo.z.abs());
        if !r.is_black() {
            all.push(self.reflected(wo, r, 1.0));
        }
        if !t.is_black() {
            all.push(self.transmitted(wo, t, 1.0));
        }
        all
    }
}
