//! # bump_map
//!
//! A material whose normals are those of a surface raised by a texture: dimples, hammered metal, ripples.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `material` | name of a material | | required | what the relief is made of |
//! | `height` | number or texture | scene unit | 0 | how far the surface is raised, times `strength`; only its slope counts |
//! | `strength` | number or texture, -100..100 | | 1 | multiplies the slope |
//!
//! ## Example
//!
//! ```toml
//! [materials.hammered]
//! type = "bump_map"
//! material = "copper"
//! height = "dents"
//! strength = 0.05
//!
//! [materials.copper]
//! type = "rough_conductor"
//! ior = { material = "copper" }
//!
//! [textures.dents]
//! type = "noise"
//! ```
//!
//! ## Limits
//!
//! Shadows and outlines stay those of the flat surface, and light that meets three facets or more is lost, as in `normal_map`. Slopes are
//! differences over a small step: what is finer than it is not seen.
//!
//! ## References
//!
//! J. F. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978. V. Schuessler et al., SIGGRAPH Asia 2017 (see `normal_map`).

use super::normal_map::{MATERIAL, STRENGTH};
use super::parts::{FIRST, Parts, Shares};
use super::tilt::tilted;
use super::{Bsdf, Compose, slot};
use crate::{Light, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::spec::ANY;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "bump_map",
    doc: "A material with the normals of a surface that a texture raises.",
    params: &[
        MATERIAL,
        ParamSpec::number_texture("height", 0.0, ANY, "how far the surface is raised, times `strength`")
            .unit("scene unit"),
        STRENGTH,
    ],
};
const HEIGHT: usize = slot(SPEC.params, "height");
const STRENGTH_ROW: usize = slot(SPEC.params, "strength");

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

impl Compose for Prepared {
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }

    fn shares(&self, _: &[Light], _: bool) -> Shares {
        FIRST
    }

    fn at(&self, slots: &[Light], parts: &dyn Parts) -> Bsdf {
        let ((x, y), strength) = (parts.slopes(HEIGHT), slots[STRENGTH_ROW][0]);
        tilted(parts.part(0), Vec3::new(-x * strength, -y * strength, 1.0))
    }
}
