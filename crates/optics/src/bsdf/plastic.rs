//! # plastic
//!
//! A smooth clear coat over a diffuse base: polished plastic, billiard balls, glazed tiles, varnish. Light enters through the coat, is
//! scattered by the base, and goes back and forth between them until it leaves; what leaves has lost colour each time.
//!
//! `f = rho (1 - F(v)) (1 - F(l)) / (pi eta^2 (1 - rho F_in))` beside a mirror `F(v)`, where `F_in` is the coat's mean reflectance for
//! diffuse light from below.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 0.5 | rho of the base |
//! | `specular` | colour or texture, 0..1 | | 1 | tints the mirror; 1 is physical |
//! | `ior` | number, at least 0.01 | | 1.5 | refractive index of the coat |
//! | `saturates` | true or false | | true | bounces under the coat deepen the colour; false: they are as if white (`F_in` in place of `rho F_in`), as textures painted for the look want it |
//!
//! ## Example
//!
//! ```toml
//! [materials.billiard_ball]
//! type = "plastic"
//! reflectance = [0.6, 0.05, 0.03]
//! ior = 1.5
//! ```
//!
//! ## Limits
//!
//! The base scatters diffusely whatever the direction under the coat. It gives back exactly what it gets where `reflectance` is 1.
//!
//! ## References
//!
//! W. Jakob, "Mitsuba renderer", 2010 and later (`plastic`); S. C. Foo, Lafortune et al. 1997 for layered diffusion; S. Q. Duntley 1942 for F_in.

use super::boundary::pick;
use super::coat::Coat;
use super::opaque::upper;
use super::{Branches, BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "plastic",
    doc: "A smooth clear coat over a diffuse base.",
    params: &[REFLECTANCE_ROW, SPECULAR_ROW, IOR, SATURATES],
};
pub(super) const REFLECTANCE_ROW: ParamSpec = ParamSpec::reflectance("reflectance", [0.5; 3], "rho of the base");
pub(super) const SPECULAR_ROW: ParamSpec = ParamSpec::reflectance("specular", [1.0; 3], "tints the coat's reflection");
pub(super) const IOR: ParamSpec =
    ParamSpec::number("ior", 1.5, "refractive index of the coat").range((0.01, f64::INFINITY));
pub(super) const SATURATES: ParamSpec =
    ParamSpec::bool("saturates", true, "bounces under the coat deepen the base's colour");
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");
const SPECULAR: usize = slot(SPEC.params, "specular");
const BASE: Lobe = Lobe::DiffuseReflection;
const MIRROR: Lobe = Lobe::DeltaReflection;

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    coat: Coat,
    saturates: bool,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct Plastic {
    /// What lies on the two transmittances: `rho / (pi eta^2 (1 - rho F_in))`.
    base: Light,
    reflectance: Light,
    specular: Light,
    coat: Coat,
}

impl Prepare for Prepared {
    type At = Plastic;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        let ior = palette.index(params, "ior").at_d_line();
        Prepared { coat: Coat::new(1.0, ior), saturates: params.bool("saturates") }
    }
    fn at(&self, _: &Lanes, slots: &[Light], interface: Interface) -> Plastic {
        let coat = self.coat.under(interface.eta_above);
        let reflectance = slots[REFLECTANCE];
        let base = coat.after_bounces(reflectance, self.saturates) * (coat.thinning() / PI);
        Plastic { base, reflectance, specular: slots[SPECULAR], coat }
    }
}

impl Plastic {
    fn reflected(&self, wo: Vec3, pdf: f32) -> BsdfSample {
        let f = self.specular * self.coat.reflectance(wo.z.abs());
        BsdfSample { wi: Vec3::new(-wo.x, -wo.y, wo.z), f, pdf, lobe: MIRROR, eta: 1.0, disperses: false }
    }

    /// The chances of base and mirror.
    fn chances(&self, wo: Vec3, lobes: LobeSet) -> [f32; 2] {
        let lobes = lobes & self.lobes();
        let f = self.coat.reflectance(wo.z.abs());
        let base = if lobes.contains(BASE) { (self.reflectance.max_component() * (1.0 - f)).max(1e-4) } else { 0.0 };
        let mirror = if lobes.contains(MIRROR) { self.specular.max_component() * f } else { 0.0 };
        let sum = base + mirror;
        if sum > 0.0 { [base / sum, mirror / sum] } else { [0.0, 0.0] }
    }
}

impl Scatter for Plastic {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(BASE).when(!self.reflectance.is_black()) | LobeSet::of(MIRROR).when(!self.specular.is_black())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> Light {
        if !lobes.contains(BASE) || !(wo.z * wi.z > 0.0) {
            return Light::BLACK;
        }
        let passes = |w: Vec3| 1.0 - self.coat.reflectance(w.z.abs());
        self.base * (passes(wo) * passes(wi))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        if !(wo.z * wi.z > 0.0) {
            return 0.0;
        }
        self.chances(wo, lobes)[0] * square_to_cosine_hemisphere_pdf(upper(wi, wo))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (which, chance) = pick(self.chances(wo, lobes), u_lobe)?;
        if which == 1 {
            return Some(self.reflected(wo, chance));
        }
        let wi = upper(square_to_cosine_hemisphere(u), wo);
        let (f, pdf) = (self.eval(wo, wi, lobes, mode), self.pdf(wo, wi, lobes, mode));
        (pdf > 0.0).then_some(BsdfSample { wi, f, pdf, lobe: BASE, eta: 1.0, disperses: false })
    }

    fn delta_branches(&self, wo: Vec3, _: Mode) -> Branches {
        let mut all = Branches::default();
        if wo.z != 0.0 && !self.specular.is_black() {
            all.push(self.reflected(wo, 1.0));
        }
        all
    }

    fn ambient(&self) -> Light {
        self.reflectance
    }
}
