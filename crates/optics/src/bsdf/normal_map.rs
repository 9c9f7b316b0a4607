//! # normal_map
//!
//! A material whose normals come from a picture: relief without geometry.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `material` | name of a material | | required | what the relief is made of |
//! | `normals` | vector or texture, 0..1 | | [0.5, 0.5, 1] | the normal: twice this minus 1 is its part along the texture's u, along v, and outwards |
//! | `strength` | number or texture, -100..100 | | 1 | multiplies the slope; below 0 dents become bumps |
//!
//! ## Example
//!
//! ```toml
//! [materials.bricks]
//! type = "normal_map"
//! material = "clay"
//! normals = [0.6, 0.5, 0.95]
//!
//! [materials.clay]
//! type = "oren_nayar"
//! reflectance = [0.5, 0.2, 0.1]
//! ```
//!
//! ## Limits
//!
//! Pictures must be linear: give their texture `encoding = "linear"`. Green rises with v (OpenGL's way; for the other one turn the
//! green channel over). Shadows and outlines stay those of the flat surface. Light that meets three facets or more is lost: steep
//! normals darken grazing views. Normals flatter than 3 degrees are raised to it.
//!
//! ## References
//!
//! V. Schuessler, E. Heitz, J. Hanika & C. Dachsbacher, "Microfacet-Based Normal Mapping for Robust Monte Carlo Path Tracing",
//! SIGGRAPH Asia 2017.

use super::parts::{FIRST, Parts, Shares};
use super::tilt::tilted;
use super::{Bsdf, Compose, slot};
use crate::{Light, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::spec::UNIT;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

pub(super) const MATERIAL: ParamSpec =
    ParamSpec::new("material", ParamType::Reference(Kind::Material), Fallback::Required, "what the relief is made of");
pub(super) const STRENGTH: ParamSpec =
    ParamSpec::number_texture("strength", 1.0, (-100.0, 100.0), "multiplies the slope");

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "normal_map",
    doc: "A material with normals from a picture.",
    params: &[
        MATERIAL,
        ParamSpec::new(
            "normals",
            ParamType::VectorTexture,
            Fallback::Vector([0.5, 0.5, 1.0]),
            "the normal along u, v and outwards, 0..1 for -1..1",
        )
        .range(UNIT),
        STRENGTH,
    ],
};
const NORMALS: usize = slot(SPEC.params, "normals");
const STRENGTH_ROW: usize = slot(SPEC.params, "strength");

/// Nothing is fixed.
#[derive(Clone, Debug)]
pub struct Prepared;

impl Compose for Prepared {
    fn prepare(_: &Params, _: &Palette) -> Self {
        Prepared
    }

    fn shares(&self, _: &[Light]) -> Shares {
        FIRST
    }

    fn at(&self, slots: &[Light], parts: &dyn Parts) -> Bsdf {
        let (n, strength) = (slots[NORMALS], slots[STRENGTH_ROW][0]);
        let along = |x: f32| (2.0 * x - 1.0) * strength;
        tilted(parts.part(0), Vec3::new(along(n[0]), along(n[1]), 2.0 * n[2] - 1.0))
    }
}
