//! # mirror
//!
//! Ideal specular reflection: one direction, angle out equals angle in. A delta, so point lights cannot show in it.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `reflectance` | colour or texture, 0..1 | | 1 | part of the light that is reflected |
//! | `fresnel` | `constant`, `schlick` | | `constant` | the same at every angle, or rising from `reflectance` at normal incidence to 1 at grazing, as metals do |
//!
//! ## Example
//!
//! ```toml
//! [materials.gold_mirror]
//! type = "mirror"
//! reflectance = [1.0, 0.78, 0.34]
//! fresnel = "schlick"
//! ```
//!
//! ## Limits
//!
//! Schlick's curve misses the slight dip that real metals have before grazing.
//!
//! ## References
//!
//! C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, equation 15.

use super::boundary::Fresnel;
use super::mirror_body::{Smooth, Tinted};
use super::{Interface, Prepare, slot};
use crate::{Lanes, Light, Palette};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "mirror",
    doc: "Ideal specular reflection.",
    params: &[
        ParamSpec::reflectance("reflectance", [1.0; 3], "part of the light that is reflected"),
        ParamSpec::choice("fresnel", &["constant", "schlick"], "the same at every angle, or rising to 1 at grazing"),
    ],
};
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared {
    fresnel: Fresnel,
}

/// At a point.
pub type Mirror = Smooth<Tinted>;

impl Prepare for Prepared {
    type At = Mirror;
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { fresnel: Fresnel::of(params.text("fresnel")) }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> Mirror {
        Smooth(Tinted { reflectance: slots[REFLECTANCE], fresnel: self.fresnel })
    }
}
