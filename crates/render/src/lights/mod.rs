//! Lights: from where, and how much of it, light arrives at a point.
//!
//! Contract: a sample's `light` is what the cosine and the BSDF are multiplied by: for points, spots and directions the
//! irradiance on a surface facing the light; for areas and backgrounds the radiance over the density per solid angle. That density
//! is the sample's `pdf`; [`Scene::light_pdf`] and [`Background::seen`] give the same one for a ray that finds the light by
//! itself, so that both ways can be weighted against each other. Neither knows of the choice among lights: that is [`pick`].
//!
//! [`Scene::light_pdf`]: crate::Scene::light_pdf

mod ambient;
mod area;
pub(crate) mod collect;
mod cone;
mod directional;
pub mod emit;
pub mod pick;
pub mod pieces;
mod point;
mod spot;
mod table;
pub mod tree;
mod tree_and_far;
mod tree_build;
mod tree_node;
pub mod units;

pub use area::{AreaLight, area_growth};
pub use cone::Cone;

use crate::background::Background;
use crate::materials::Material;
use crate::observe::Asked;
use crate::textures::Textures;
use kirkas_geometry::DVec3;
use kirkas_geometry::hash::of_name;
use kirkas_optics::{Lanes, Light, Palette};
use kirkas_scene::{Fallback, ParamSpec, ParamType, Params, TypeSpec};
use pick::Reach;
use std::sync::Arc;

/// Every light type.
pub const LIGHTS: &[&TypeSpec] = &[&point::SPEC, &spot::SPEC, &directional::SPEC, &ambient::SPEC];

/// What every light takes.
pub const COMMON: &[ParamSpec] =
    &[ParamSpec::new("group", ParamType::Text, Fallback::Absent, "Light group; absent = the light's own name.")];

/// A light's place as a shadow ray aims at it.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The point.
    pub position: DVec3,
    /// Absolute error bound per axis.
    pub error: DVec3,
    /// Unit normal; zero for points.
    pub normal: DVec3,
}

/// One way in which light arrives.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit, towards the light.
    pub direction: DVec3,
    /// Where the shadow ray ends; `None` = never.
    pub target: Option<Target>,
    /// See the contract.
    pub light: Light,
    /// Density per solid angle with which this light's sampling finds the direction; 0 for lights that no ray can hit.
    pub pdf: f32,
}

impl LightSample {
    /// `asked`, with what the sample says.
    pub fn noted(&self, from: DVec3, asked: Asked) -> Asked {
        let (direction, distance) = (self.direction, self.distance(from));
        Asked { direction, distance, light: self.light, pdf: self.pdf, ..asked }
    }

    /// How far away the light is; infinite without a target.
    pub fn distance(&self, from: DVec3) -> f64 {
        self.target.as_ref().map_or(f64::INFINITY, |t| (t.position - from).length())
    }
}

/// A light that is sampled.
#[derive(Clone)]
pub enum Lamp {
    /// A point.
    Point(point::PointLight),
    /// A spot.
    Spot(spot::SpotLight),
    /// From infinitely far.
    Directional(directional::DirectionalLight),
    /// A shining surface.
    Area(Box<AreaLight>),
    /// What lies behind everything.
    Background(Arc<Background>),
}

/// A light in a scene.
#[derive(Clone)]
pub struct LightEntry {
    /// Its name.
    pub name: String,
    /// Hash of the name: its own dimensions.
    pub hash: u64,
    /// Light group, by number.
    pub group: u32,
    /// Shadow rays per camera-visible point.
    pub samples: u32,
    /// How it shines.
    pub lamp: Lamp,
}

impl LightEntry {
    /// A light of this name.
    pub fn new(name: &str, group: u32, samples: u32, lamp: Lamp) -> Self {
        LightEntry { name: name.into(), hash: of_name(name), group, samples, lamp }
    }
}

impl Lamp {
    /// From a light's parameters; `None` for ambient light, which has no place.
    pub fn new(params: &Params, palette: &Palette) -> Option<Lamp> {
        match params.spec().name {
            "point" => Some(Lamp::Point(point::PointLight::new(params, palette))),
            "spot" => Some(Lamp::Spot(spot::SpotLight::new(params, palette))),
            "directional" => Some(Lamp::Directional(directional::DirectionalLight::new(params, palette))),
            _ => None,
        }
    }

    /// A way in which its light reaches `from`, at `time`.
    pub fn sample(
        &self,
        lanes: &Lanes,
        materials: &[Material],
        textures: &Textures,
        from: DVec3,
        time: f64,
        u: (f32, f32),
    ) -> Option<LightSample> {
        match self {
            Lamp::Point(l) => l.sample(lanes, from),
            Lamp::Spot(l) => l.sample(lanes, from),
            Lamp::Directional(l) => l.sample(lanes),
            Lamp::Area(l) => l.sample(lanes, materials, textures, from, time, u),
            Lamp::Background(l) => l.sample(lanes, u),
        }
    }

    /// From where, and about how much, given its power.
    pub fn reach(&self, materials: &[Material], power: f64) -> Reach {
        match self {
            Lamp::Point(l) => Reach::Near(l.reach(power)),
            Lamp::Spot(l) => Reach::Near(l.reach(power)),
            Lamp::Directional(l) => l.reach(),
            Lamp::Area(l) => {
                let emission = materials[l.material as usize].emission.as_ref();
                Reach::Near(l.reach(power, emission.is_some_and(|e| e.two_sided)))
            }
            // Half of it comes from below; some of the rest from straight above.
            Lamp::Background(l) => Reach::Far { irradiance: 0.5 * l.total_radiance(), towards: None },
        }
    }

    /// About how much light it sends into a scene of this radius, all lanes together, W: what lights are picked by.
    pub fn power(&self, materials: &[Material], textures: &Textures, radius: f64) -> f64 {
        match self {
            Lamp::Point(l) => l.power(),
            Lamp::Spot(l) => l.power(),
            Lamp::Directional(l) => l.power(radius),
            Lamp::Area(l) => l.power(materials, textures),
            Lamp::Background(l) => l.power(radius),
        }
    }
}

pub use ambient::radiance as ambient_radiance;
