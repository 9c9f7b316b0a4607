//! # emitter
//!
//! The surface of a lamp: it shines, and may reflect diffusely as well. The renderer makes an area light of every object that wears it.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `radiance` | colour or texture | | 1 | colour of the light, times `intensity` |
//! | `intensity` | number | `unit` | 1 | how much |
//! | `unit` | `plain`, `W/m2/sr`, `nit`, `W`, `lm` | | `plain` | what `intensity` counts: radiance (`plain`, `W/m2/sr`), luminance, or what the whole lamp gives off |
//! | `two_sided` | true or false | | false | shines from its back as well |
//! | `reflectance` | colour or texture, 0..1 | | 0 | part of the arriving light that is reflected, as `lambert` does |
//! | `samples` | whole number | | 4 | shadow rays to it per hit, stratified |
//! | `group` | text | | the object's name | light group its light is filed under |
//!
//! ## Example
//!
//! ```toml
//! [materials.lamp]
//! type = "emitter"
//! radiance = [1.0, 0.9, 0.7]
//! intensity = 8
//! ```
//!
//! ## Limits
//!
//! Equal radiance in every direction (a Lambertian lamp); no beams.
//!
//! ## References
//!
//! Units: IES, "Nomenclature and Definitions for Illuminating Engineering", LS-1-20.

use super::{Interface, Prepare, slot};
use crate::{Lanes, Light, Palette};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// What is left of it at a point once it has shone.
pub use super::lambert::Lambert as Emitter;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "emitter",
    doc: "The surface of a lamp: it shines, and may reflect diffusely as well.",
    params: &[
        ParamSpec::reflectance("radiance", [1.0; 3], "colour of the light, times `intensity`").range(NOT_NEGATIVE),
        ParamSpec::number("intensity", 1.0, "how much light, in `unit`").range(NOT_NEGATIVE),
        ParamSpec::choice("unit", &["plain", "W/m2/sr", "nit", "W", "lm"], "what `intensity` counts"),
        ParamSpec::bool("two_sided", false, "shines from its back as well"),
        ParamSpec::reflectance("reflectance", [0.0; 3], "part of the arriving light that is reflected diffusely"),
        ParamSpec::integer("samples", 4, (1.0, 65536.0), "shadow rays to it per hit, stratified"),
        ParamSpec::new("group", ParamType::Text, Fallback::Absent, "light group; absent = the object's name"),
    ],
};

const REFLECTANCE: usize = slot(SPEC.params, "reflectance");

/// Nothing is fixed; what shines the renderer reads from the table itself.
#[derive(Clone, Debug)]
pub struct Prepared;

impl Prepare for Prepared {
    type At = Emitter;
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> Emitter {
        Emitter::new(slots[REFLECTANCE])
    }
}
