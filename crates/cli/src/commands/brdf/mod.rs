//! `kirkas brdf`: what materials do with light, as numbers and as pictures.
//!
//! **Frame.** z is the surface's normal, x its texture's u. `theta` is the angle from z, `phi` that around it, from x towards y, both in
//! degrees; both directions point away from the surface. Light arrives along i and leaves along o, so a mirror sends
//! (theta, phi) to (theta, phi + 180). A theta above 90 is below the surface.

use crate::problem::{Outcome, Problem};

mod compare;
mod eval;
mod plot;

mod factors;
mod lobes;
mod maps;
mod rows;
mod slices;

mod difference;
mod studio;

mod albedo;
mod angles;
mod look;
mod material;
mod numbers;
mod sheet;

const FRAME: &str =
    "Angles are in degrees: theta from the surface's normal, phi around it from the texture's u. Both directions point
away from the surface; light arrives along i and leaves along o, so a mirror sends (theta, phi) to
(theta, phi + 180). Lists of angles: 45, or 0,30,60, or 0..90:15 (from, to, step).

A MATERIAL is a type with parameters, `ward:roughness=0.2,anisotropy=0.5`; a material of a scene, `scene.toml#paint`,
also with other parameters, `scene.toml#paint:roughness=0.1`; or a file of measurements, `gold.binary`, `silk.bsdf`.";

/// What materials do with light, as numbers and as plots
#[derive(Debug, clap::Args)]
pub struct Brdf {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Eval(Box<eval::Eval>),
    Plot(Box<plot::Plot>),
    Compare(Box<compare::Compare>),
}

/// Do it.
pub fn run(args: &Brdf) -> Result<Outcome, Problem> {
    match &args.command {
        Command::Eval(args) => eval::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Compare(args) => compare::run(args),
    }
}
