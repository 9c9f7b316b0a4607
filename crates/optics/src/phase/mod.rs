//! Phase functions, one file each: into which directions a particle of a medium scatters light.
//!
//! **Frame.** Directions are in the world. As for a BSDF, `wo` says where the light goes (or where importance comes from) and
//! `wi` where it comes from; both are unit vectors that point away from the particle. The angle of scattering, 0 where light
//! goes straight on, is the one between `-wo` and `wi`.
//!
//! **Measures.** `value` is per lane and per solid angle (1/sr) and integrates to 1 over the sphere; every phase function
//! here is reciprocal. `pdf` is per solid angle of `wi`: the mean of the lanes' values with the weights `shares`, which the
//! caller chooses, none negative, with sum 1. A path that takes its lanes' throughput for shares scatters without loss in
//! their sum (a one-sample balance heuristic over lanes, Wilkie et al. 2014, "Hero Wavelength Spectral Sampling").
//!
//! To add one: write `NAME.rs` beside this file (start from `isotropic.rs`), and add `pub mod NAME;` and its row in
//! `functions!` below.

use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::elementary::sin_cos_f32;
use kirkas_geometry::{Frame, Vec3};
use kirkas_scene::{Params, TypeSpec};

pub mod droplet;
pub mod henyey_greenstein;
pub mod isotropic;
pub mod rayleigh;

pub mod scattering_table;

functions! {
    isotropic Isotropic,
    henyey_greenstein HenyeyGreenstein,
    rayleigh Rayleigh,
    droplet Droplet,
}

/// One sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseSample {
    /// Where light comes from, unit.
    pub wi: Vec3,
    /// The phase function there, 1/sr.
    pub value: Light,
    /// Density per solid angle. Above 0, finite.
    pub pdf: f32,
}

/// An angle of scattering between 0 and pi.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    cos: f32,
    sin: f32,
}

impl Turn {
    fn from_cos(cos: f32) -> Self {
        Turn { cos, sin: ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt() }
    }
}

/// What each phase function answers. The contract stands at the head of this file.
trait Scatter {
    /// From validated parameters.
    fn prepare(params: &Params, palette: &Palette) -> Self;
    /// The value.
    fn value(&self, lanes: &Lanes, wo: Vec3, wi: Vec3) -> Light;
    /// An angle drawn as `lane` scatters; `u` in `[0, 1)`.
    fn turn(&self, lanes: &Lanes, lane: usize, u: f32) -> Turn;
}

impl PhaseFunction {
    /// The density per solid angle with which [`PhaseFunction::sample`] with the same shares gives `wi`.
    pub fn pdf(&self, lanes: &Lanes, shares: Light, wo: Vec3, wi: Vec3) -> f32 {
        mean(self.value(lanes, wo, wi), shares)
    }

    /// A direction; `u_lane` picks the lane by `shares`, `u` the direction, all in `[0, 1)`. `None`: shares without sense.
    pub fn sample(&self, lanes: &Lanes, shares: Light, wo: Vec3, u_lane: f32, u: (f32, f32)) -> Option<PhaseSample> {
        let turn = self.turn(lanes, pick(shares, u_lane), u.0);
        let (s, c) = sin_cos_f32(2.0 * PI * u.1);
        let wi = Frame::from_z(-wo).to_world(Vec3::new(turn.sin * c, turn.sin * s, turn.cos));
        let value = self.value(lanes, wo, wi);
        let pdf = mean(value, shares);
        (pdf > 0.0 && pdf.is_finite()).then_some(PhaseSample { wi, value, pdf })
    }
}

fn mean(value: Light, shares: Light) -> f32 {
    let Light([a, b, c, d]) = value * shares;
    (a + b) + (c + d)
}

/// The lane that `u` stands for; rounding never gives one without share.
fn pick(shares: Light, u: f32) -> usize {
    let mut below = 0.0;
    let mut last = 0;
    for (lane, &share) in shares.0.iter().enumerate() {
        if share > 0.0 {
            last = lane;
            below += share;
            if u < below {
                break;
            }
        }
    }
    last
}

macro_rules! functions {
    ($($module:ident $Name:ident),* $(,)?) => {
        /// The tables of all phase functions, in listed order.
        pub const SPECS: &[TypeSpec] = &[$($module::SPEC),*];

        /// A phase function with its parameters read: once per medium.
        #[derive(Clone, Debug)]
        #[allow(missing_docs)]
        pub enum PhaseFunction {
            $($Name($module::$Name)),*
        }

        impl PhaseFunction {
            /// From validated parameters; `None` if the type is not a phase function's.
            pub fn prepare(params: &Params, palette: &Palette) -> Option<Self> {
                $(if params.spec().name == $module::SPEC.name {
                    return Some(PhaseFunction::$Name(Scatter::prepare(params, palette)));
                })*
                None
            }

            /// Its table.
            pub fn spec(&self) -> &'static TypeSpec {
                match self {
                    $(PhaseFunction::$Name(_) => &$module::SPEC),*
                }
            }

            /// Its value per lane, 1/sr.
            #[inline]
            pub fn value(&self, lanes: &Lanes, wo: Vec3, wi: Vec3) -> Light {
                match self {
                    $(PhaseFunction::$Name(f) => f.value(lanes, wo, wi)),*
                }
            }

            fn turn(&self, lanes: &Lanes, lane: usize, u: f32) -> Turn {
                match self {
                    $(PhaseFunction::$Name(f) => f.turn(lanes, lane, u)),*
                }
            }
        }
    };
}
use functions;
