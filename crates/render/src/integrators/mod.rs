//! Integrators: how light is found. An integrator is a *step*: given a path and what it hit, which light reaches the pixel,
//! and which rays go on. One driver moves the rays in flocks, so that the kernel always has many in flight.

pub mod crossing;
mod forward;
pub mod light;
mod particle;
pub mod path;
pub mod path_simple;
pub mod photon;
pub mod whitted;

use crate::observe::Notes;
use crate::render::Renderer;
use crate::sampler::Sampler;
use crate::scene::{Scene, SurfaceHit};
use crate::statistics::Statistics;
use crate::textures::RayCone;
use kirkas_geometry::{DVec3, Ray};
use kirkas_optics::{Lanes, Light};
use kirkas_scene::{Diagnostic, Params, TypeSpec};

/// Every integrator type.
pub const INTEGRATORS: &[IntegratorType] = &[
    IntegratorType {
        spec: &light::SPEC,
        build: |p| Box::new(light::LightTracing::new(p)),
        knows_ambient: false,
        knows_media: true,
        knows_bins: false,
    },
    IntegratorType {
        spec: &path::SPEC,
        build: |p| Box::new(path::Path::new(p)),
        knows_ambient: false,
        knows_media: true,
        knows_bins: true,
    },
    IntegratorType {
        spec: &path_simple::SPEC,
        build: |p| Box::new(path_simple::PathSimple::new(p)),
        knows_ambient: false,
        knows_media: true,
        knows_bins: true,
    },
    IntegratorType {
        spec: &photon::SPEC,
        build: |p| Box::new(photon::Photon::new(p)),
        knows_ambient: false,
        knows_media: false,
        knows_bins: true,
    },
    IntegratorType {
        spec: &whitted::SPEC,
        build: |p| Box::new(whitted::Whitted::new(p)),
        knows_ambient: true,
        knows_media: false,
        knows_bins: true,
    },
];

/// One entry of the list of integrators.
pub struct IntegratorType {
    /// Its table.
    pub spec: &'static TypeSpec,
    /// Makes it from its parameters.
    pub build: fn(&Params) -> Box<dyn Integrator>,
    /// It adds ambient lights.
    pub knows_ambient: bool,
    /// It follows light through media that scatter.
    pub knows_media: bool,
    /// All light of a sample is of the wavelengths of its camera path.
    pub knows_bins: bool,
}

/// Closed bodies that a path is inside of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumStack {
    materials: [u32; MediumStack::MOST],
    len: u8,
}

impl MediumStack {
    /// Bodies that may overlap at one point; more are not told apart.
    pub const MOST: usize = 12;
    /// In none.
    pub const EMPTY: Self = MediumStack { materials: [0; Self::MOST], len: 0 };

    /// Materials of the bodies, in the order in which they were entered.
    pub fn materials(&self) -> &[u32] {
        &self.materials[..usize::from(self.len)]
    }

    /// This with one more body.
    pub fn entered(mut self, material: u32) -> Self {
        if usize::from(self.len) < Self::MOST {
            self.materials[usize::from(self.len)] = material;
            self.len += 1;
        }
        self
    }

    /// This without the body of `material` that was entered last; unchanged if there is none.
    pub fn left(mut self, material: u32) -> Self {
        if let Some(i) = self.materials().iter().rposition(|&m| m == material) {
            self.materials.copy_within(i + 1..usize::from(self.len), i);
            self.len -= 1;
        }
        self
    }
}

/// What a ray of the tree is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera.
    Camera,
    /// Mirrored.
    Reflected,
    /// Refracted.
    Refracted,
    /// One of several around a mirrored or refracted direction.
    Glossy,
    /// From a matte surface, or from within a medium.
    Diffuse,
}

/// A path under way: one ray of the tree.
#[derive(Clone, Copy, Debug)]
pub struct PathState {
    /// The ray to trace next.
    pub ray: Ray,
    /// What its lanes of light are.
    pub lanes: Lanes,
    /// What light found at its end is multiplied by.
    pub throughput: Light,
    /// Bounces so far.
    pub depth: u32,
    /// What the ray is.
    pub kind: RayKind,
    /// Names the place in the ray tree: a hash of all choices since the camera.
    pub branch: u64,
    /// Bodies it is inside of.
    pub media: MediumStack,
    /// What it stands for around its ray.
    pub cone: RayCone,
    /// Surfaces passed without an event (an overlapped boundary) since the last bounce.
    pub passed: u32,
    /// Distance travelled through them.
    pub travelled: f32,
    /// Where the ray was sent from, if lights could have been asked there for what it finds.
    pub last: Option<LastVertex>,
}

/// A surface that sent a ray which competes with asking lights.
#[derive(Clone, Copy, Debug)]
pub struct LastVertex {
    /// Where it is.
    pub position: DVec3,
    /// The side that light must come from, as for [`LightPicker`](crate::lights::pick::LightPicker).
    pub normal: DVec3,
    /// Density per solid angle with which the ray was sent.
    pub pdf: f32,
}

/// What stops a ray that asks whether light arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocker {
    /// Any surface: its light is already weakened by all that fills its way.
    Anything,
    /// Any surface but hulls: its light is weakened as it goes.
    AllButHulls,
    /// What is not clear: clear surfaces tint its light, without bending it, and it is weakened as it goes.
    Opaque,
}

/// A ray that asks whether light arrives.
#[derive(Clone, Copy, Debug)]
pub struct ShadowRay {
    /// From the surface to the light.
    pub ray: Ray,
    /// What its lanes of light are.
    pub lanes: Lanes,
    /// What is added to the pixel if nothing blocks it.
    pub light: Light,
    /// Light group.
    pub group: u32,
    /// Branch of the path that asks.
    pub branch: u64,
    /// The light, by number.
    pub lamp: u32,
    /// What blocks it.
    pub blocked_by: Blocker,
    /// Bodies it is inside of.
    pub media: MediumStack,
    /// Surfaces it has been weakened by.
    pub passed: u32,
}

/// Where steps put what they found, each behind what others have put there.
#[derive(Default)]
pub struct StepOutput {
    /// Light that reaches the pixel for certain: `(light, group)`.
    pub contributions: Vec<(Light, u32)>,
    /// Light that reaches it unless something is in the way.
    pub shadow_rays: Vec<ShadowRay>,
    /// Continuations of paths.
    pub paths: Vec<PathState>,
    /// Set when the path goes no further.
    pub end: Option<crate::observe::PathEnd>,
    /// Rays that steps traced by themselves, all together.
    pub counted: Statistics,
    /// Why all this, for observers.
    pub notes: Notes,
}

/// An integrator for one pass: one sample index of all pixels.
pub struct Pass<'a> {
    /// It takes the samples.
    pub integrator: Box<dyn Integrator + 'a>,
    /// Rays that were traced to make it.
    pub counted: Statistics,
}

/// What all camera paths of a pass have in common, so that what was prepared for one of them fits all.
#[derive(Clone, Copy, Debug)]
pub struct Shared {
    /// When, from 0 (the shutter opens) to 1 (it closes).
    pub moment: f32,
    /// The lanes that they start with.
    pub lanes: Lanes,
}

/// What particles of a pass brought to one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landed<'a> {
    /// Per plane: red, green, blue, unit 2^-64.
    pub sums: &'a [[i128; 3]],
    /// Some of it was not finite or absurd.
    pub is_invalid: bool,
}

/// One step of an integrator. Pure: the same arguments give the same output.
pub trait Integrator: Sync {
    /// What it does not show of a scene.
    fn warnings(&self, _: &Scene) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// For integrators that look at the whole scene before each pass: the one that takes sample number `pass` of every pixel.
    fn prepare_pass<'a>(&self, _: &Renderer<'a>, _pass: u32) -> Option<Pass<'a>> {
        None
    }

    /// What its camera paths have in common, if it is made for one pass.
    fn shared(&self) -> Option<Shared> {
        None
    }

    /// What the pass has put on a pixel without its camera paths, if it puts anything.
    fn landed(&self, _x: u32, _y: u32) -> Option<Landed<'_>> {
        None
    }

    /// `hit` is `None` where the ray left the scene.
    fn step(&self, scene: &Scene, path: &PathState, sampler: &Sampler, hit: Option<&SurfaceHit>, out: &mut StepOutput);
}
