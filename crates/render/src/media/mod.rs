//! Media: what fills space and scatters, swallows and emits light on its way. One file each; this file holds what they share.
//!
//! A medium is told by three coefficients (1 / scene unit): per unit of way, light is scattered with `scattering`, swallowed with
//! `absorption`, and `emission` is added to it. A medium that is not the same everywhere multiplies all three by its density.
//! Which directions light is scattered into, the phase function says.
//!
//! **Lanes.** Where lanes see different coefficients, distances are drawn with the mean of the lanes' densities, each lane
//! weighing as much as it still carries light, and the draw is divided by that mean: a one-sample balance heuristic (Wilkie et al.
//! 2014, "Hero Wavelength Spectral Sampling"; Miller, Georgiev & Jarosz 2019, "A Null-Scattering Path Integral Formulation of
//! Light Transport"). Where nothing is swallowed, the sum over the lanes keeps its value through any number of scatterings.
//!
//! To add a type: write `NAME.rs` beside this file with its `SPEC`, and add it to `MEDIA` and to `Volume::new`.

pub mod cloud;
pub mod grid;
pub mod homogeneous;

pub(crate) mod random;

mod majorants;
mod tracking;
mod volume_file;
mod voxels;

use grid::Grid;
use kirkas_geometry::elementary::{exp, exp_f32};
use kirkas_geometry::{Bounds3, DVec3, Ray};
use kirkas_optics::{Lanes, Light, Palette, PhaseFunction, Spectrum};
use kirkas_scene::{Assets, Catalog, Description, Diagnostic, Entity, Fallback, Kind, Map, ParamSpec, ParamType};
use kirkas_scene::{Params, TypeSpec};
use std::sync::Arc;

/// Every type of medium.
pub const MEDIA: &[&TypeSpec] = &[&homogeneous::SPEC, &grid::SPEC, &cloud::SPEC];

/// What every medium takes.
pub const COMMON: &[ParamSpec] = &[
    ParamSpec::color("scattering", [0.0; 3], "Light that is scattered, per scene unit of way.").unit("1/scene unit"),
    ParamSpec::color("absorption", [0.0; 3], "Light that is swallowed, per scene unit of way.").unit("1/scene unit"),
    ParamSpec::color("emission", [0.0; 3], "Radiance that is added, per scene unit of way.")
        .unit("W/m2/sr per scene unit"),
    ParamSpec::new(
        "phase",
        ParamType::Reference(Kind::Phase),
        Fallback::Absent,
        "Phase function: into which directions light is scattered; without it evenly into all.",
    ),
];

/// A compiled medium.
#[derive(Clone)]
pub struct Volume {
    scattering: Spectrum,
    absorption: Spectrum,
    emission: Spectrum,
    /// How it scatters.
    pub phase: PhaseFunction,
    density: Density,
    /// Light group of what it emits.
    pub group: u32,
}

/// Where it is how dense.
#[derive(Clone)]
enum Density {
    /// 1 everywhere.
    Even,
    /// Samples on a grid.
    Grid(Arc<Grid>),
}

/// The coefficients at density 1, as the lanes of a path see them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients {
    /// Scattered.
    pub scattering: Light,
    /// Scattered or swallowed.
    pub extinction: Light,
    /// Added.
    pub emission: Light,
}

/// How a flight through a medium ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlightEnd {
    /// It comes to the end of the way; the path's light is multiplied by this.
    Passed(Light),
    /// It meets a particle.
    Scattered {
        /// Distance from the ray's origin, scene units.
        distance: f64,
        /// What the path's light is multiplied by; the phase function comes on top.
        weight: Light,
    },
}

/// A flight through a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Light that the medium adds to the way, yet to be multiplied by what the path carried at its start.
    pub emitted: Light,
    /// How it ends.
    pub end: FlightEnd,
}

/// A way through a medium: a ray's, in world units.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Where it starts.
    pub origin: DVec3,
    /// Whereto, unit.
    pub direction: DVec3,
    /// How far, infinite where nothing is met.
    pub length: f64,
}

impl Way {
    /// Along a ray up to its parameter `t`.
    pub fn of_ray(ray: &Ray, t: f32) -> Self {
        let direction = ray.direction.as_dvec3();
        let length = direction.length();
        Way { origin: ray.origin.as_dvec3(), direction: direction / length, length: f64::from(t) * length }
    }

    /// The point at this distance.
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }
}

impl Volume {
    /// All media of a description, in its order.
    pub fn compile_all(
        d: &Description,
        catalog: &Catalog,
        palette: &Palette,
        assets: &dyn Assets,
    ) -> Result<Vec<Volume>, Diagnostic> {
        d.all(Kind::Medium).iter().map(|e| Self::new(d, e, catalog, palette, assets)).collect()
    }

    fn new(
        d: &Description,
        entity: &Entity,
        catalog: &Catalog,
        palette: &Palette,
        assets: &dyn Assets,
    ) -> Result<Volume, Diagnostic> {
        let p = Params::new(entity, Kind::Medium, catalog).expect("the description was validated");
        let rgb = |name| p.color(name).map(|x| x as f32);
        let even = Entity::new("", "isotropic", Map::default());
        let phase = p.text("phase").and_then(|name| d.find(Kind::Phase, name)).unwrap_or(&even);
        let phase = Params::new(phase, Kind::Phase, catalog).expect("the description was validated");
        Ok(Volume {
            scattering: palette.unbounded(rgb("scattering")),
            absorption: palette.unbounded(rgb("absorption")),
            emission: palette.illuminant(rgb("emission")),
            phase: PhaseFunction::prepare(&phase, palette).expect("the description was validated"),
            density: match p.spec().name {
                "grid" => Density::Grid(Arc::new(grid::read(&p, assets)?)),
                "cloud" => Density::Grid(Arc::new(cloud::make(&p)?)),
                _ => Density::Even,
            },
            group: 0,
        })
    }

    /// True when it emits light.
    pub fn shines(&self) -> bool {
        !self.emission.is_black()
    }

    pub(crate) fn coefficients(&self, lanes: &Lanes) -> Coefficients {
        let scattering = self.scattering.at(lanes);
        Coefficients {
            scattering,
            extinction: scattering + self.absorption.at(lanes),
            emission: self.emission.at(lanes),
        }
    }

    /// Density at a point; the most there is anywhere.
    pub(crate) fn density(&self, point: DVec3) -> (f32, f32) {
        match &self.density {
            Density::Even => (1.0, 1.0),
            Density::Grid(grid) => (grid.density(point), grid.most()),
        }
    }

    /// Where a way has left the medium behind, at the latest.
    pub(crate) fn end_of(&self, way: &Way) -> f64 {
        match &self.density {
            Density::Even => way.length,
            Density::Grid(grid) => grid.crossing(way).walk().last().map_or(0.0, |s| s.to),
        }
    }

    /// Around what is not empty of it; `None` if it is the same everywhere.
    pub(crate) fn bounds(&self) -> Option<Bounds3> {
        match &self.density {
            Density::Even => None,
            Density::Grid(grid) => Some(grid.bounds()),
        }
    }

    /// Send a path that carries `throughput` on its way. `u` in the unit square; `key` names all further random numbers.
    pub fn fly(&self, lanes: &Lanes, throughput: Light, way: &Way, u: (f32, f32), key: u64) -> Flight {
        let c = self.coefficients(lanes);
        match &self.density {
            Density::Even => homogeneous::fly(&c, throughput, way.length, u),
            Density::Grid(grid) => tracking::fly(grid, &c, throughput, way, u, key),
        }
    }

    /// What is left of light on this way: exactly, or on average over `key`.
    pub fn transmittance(&self, lanes: &Lanes, way: &Way, key: u64) -> Light {
        let c = self.coefficients(lanes);
        match &self.density {
            Density::Even => fade(c.extinction, way.length),
            Density::Grid(grid) => tracking::transmittance(grid, &c, way, key),
        }
    }
}

/// The lanes' shares of what a path carries; evenly if it carries nothing.
pub fn shares(throughput: Light) -> Light {
    let sum = throughput.0[0] + throughput.0[1] + throughput.0[2] + throughput.0[3];
    if sum > 0.0 && sum.is_finite() { throughput / sum } else { Light::splat(0.25) }
}

/// `exp(-extinction distance)`, and 1 where nothing is lost however far.
fn fade(extinction: Light, distance: f64) -> Light {
    extinction.map(|t| if t > 0.0 { exp_f32((-f64::from(t) * distance) as f32) } else { 1.0 })
}

/// The mean way of light that is lost with this extinction before it has come so far: `(1 - exp(-t d)) / t`.
fn mean_way(t: f32, distance: f64) -> f32 {
    let depth = f64::from(t) * distance;
    let way = if depth < 1e-4 { distance * (1.0 - 0.5 * depth) } else { (1.0 - exp(-depth)) / f64::from(t) };
    if way.is_finite() { way as f32 } else { 0.0 }
}

/// Sum over lanes of a product.
fn dot(a: Light, b: Light) -> f32 {
    let Light([x, y, z, w]) = a * b;
    (x + y) + (z + w)
}
