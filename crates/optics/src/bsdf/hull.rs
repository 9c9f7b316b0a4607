//! # hull
//!
//! A surface that is not there: rays go straight through. It says how far a medium reaches: a cloud in a box, a beam's haze.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `interior` | medium | | none | what fills the closed surface |
//! | `priority` | whole number | | -1 | among overlapping insides the highest wins |
//!
//! ## Example
//!
//! ```toml
//! [materials.haze_box]
//! type = "hull"
//! interior = "haze"
//!
//! [media.haze]
//! type = "homogeneous"
//! scattering = 0.2
//! ```
//!
//! ## Limits
//!
//! `whitted` sees hulls as little as any other integrator does, but no medium either.
//!
//! ## References
//!
//! M. Pharr, W. Jakob & G. Humphreys, "Physically Based Rendering", 4th ed., 2023, section 11.4 (interface materials).

use super::{BsdfSample, Interface, LobeSet, Mode, Prepare, Scatter};
use crate::{Lanes, Light, Medium, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "hull",
    doc: "A surface that is not there, filled with a medium.",
    params: &[INTERIOR, ParamSpec::integer("priority", -1, (-1e6, 1e6), "among overlapping insides the highest wins")],
};
pub(super) const INTERIOR: ParamSpec = ParamSpec::new(
    "interior",
    ParamType::Reference(Kind::Medium),
    Fallback::Absent,
    "medium that fills the closed surface: scatters, swallows and emits",
);

/// What fills it.
#[derive(Clone, Debug)]
pub struct Prepared {
    medium: Medium,
}

/// Nothing.
#[derive(Clone, Debug)]
pub struct Hull;

impl Prepare for Prepared {
    type At = Hull;
    fn prepare(params: &Params, _: &Palette) -> Self {
        Prepared { medium: Medium { priority: params.integer("priority") as i32, ..Medium::VACUUM } }
    }
    fn at(&self, _: &Lanes, _: &[Light], _: Interface) -> Hull {
        Hull
    }
    fn medium(&self) -> Option<&Medium> {
        Some(&self.medium)
    }
}

impl Scatter for Hull {
    fn lobes(&self) -> LobeSet {
        LobeSet::NONE
    }
    fn eval(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> Light {
        Light::BLACK
    }
    fn pdf(&self, _: Vec3, _: Vec3, _: LobeSet, _: Mode) -> f32 {
        0.0
    }
    fn sample(&self, _: Vec3, _: f32, _: (f32, f32), _: LobeSet, _: Mode) -> Option<BsdfSample> {
        None
    }
}
