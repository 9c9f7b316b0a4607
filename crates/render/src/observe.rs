//! Observers watch a render through its one path of code: `()` when rendering, a recorder when explaining.

use crate::integrators::{PathState, ShadowRay};
use crate::scene::SurfaceHit;
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::{BsdfSample, Light, Lobe};

/// Which sample of which pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SampleId {
    /// Column, from the left of the whole image.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Sample number.
    pub sample: u32,
}

/// Why a path went no further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// It left the scene.
    Escaped,
    /// The surface sends nothing on.
    Absorbed,
    /// It reached the greatest depth.
    Depth,
    /// What it could still bring is below the least contribution.
    Contribution,
    /// Chance ended it, and lets the others count more.
    Roulette,
}

/// What a step of an integrator decided, and by which numbers.
#[derive(Clone, Copy, Debug)]
pub enum Note {
    /// Light that the ray found by itself. Every contribution of a step has one of these, in the same order.
    Saw(Saw),
    /// A light that was asked. Every shadow ray of a step has one of these that says [`Answer::Waits`], in the same order.
    Asked(Asked),
    /// How the path goes on. Every ray that a step sends has one of these that says [`Fate::Goes`], in the same order.
    Sent(Sent),
}

/// What shone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shone {
    /// The surface that was hit.
    Surface,
    /// The background.
    Background,
    /// The medium on the way.
    Medium,
    /// Ambient light, which comes from everywhere.
    Ambient,
    /// Photons that had landed around.
    Photons,
    /// A light that casts no shadows here.
    Light,
}

/// Light that a ray found.
#[derive(Clone, Copy, Debug)]
pub struct Saw {
    /// What shone.
    pub what: Shone,
    /// What reaches the ray's end: radiance towards it, W/(m2 sr), before the path's throughput.
    pub radiance: Light,
    /// The share that counts, since asking lights could have found it too (multiple importance sampling).
    pub weight: f32,
}

/// A light that was asked from a surface or from within a medium.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Its number among the scene's lights; `None` where no light was chosen.
    pub lamp: Option<u32>,
    /// The probability of its choice.
    pub chance: f32,
    /// Unit, towards the place on it that was chosen.
    pub direction: DVec3,
    /// How far that is, scene units.
    pub distance: f64,
    /// Radiance over the density, or irradiance of a light that no ray can hit.
    pub light: Light,
    /// Density per solid angle with which the light chose the direction; 0 for lights that no ray can hit.
    pub pdf: f32,
    /// Of the surface, without the cosine; of a medium, its phase function.
    pub bsdf: Light,
    /// Between the direction and the shading normal, its size; 1 within a medium.
    pub cosine: f32,
    /// The share that counts, since a ray could have found it too.
    pub weight: f32,
    /// What came of it.
    pub answer: Answer,
}

impl Asked {
    /// Of which nothing is known yet but this.
    pub fn of(lamp: Option<u32>, chance: f32, answer: Answer) -> Self {
        let (light, bsdf) = (Light::BLACK, Light::BLACK);
        let direction = DVec3::ZERO;
        Asked { lamp, chance, direction, distance: 0.0, light, pdf: 0.0, bsdf, cosine: 0.0, weight: 1.0, answer }
    }
}

/// What came of asking a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// A shadow ray is on its way.
    Waits,
    /// No light could be chosen.
    NoLight,
    /// The light sends nothing here.
    Dark,
    /// The light is behind the surface.
    Behind,
    /// The surface sends nothing from there to the viewer, or what fills the way lets nothing through.
    Black,
}

impl Answer {
    /// Where the surface has the value `f` for light from `wi` to `wo`, and nothing comes of it.
    pub(crate) fn of_black(f: Light, wo: Vec3, wi: Vec3) -> Self {
        match f.is_black() {
            true if wo.z * wi.z <= 0.0 => Answer::Behind,
            true => Answer::Black,
            false => Answer::Dark,
        }
    }
}

/// A ray that a step sends, or would have.
#[derive(Clone, Copy, Debug)]
pub struct Sent {
    /// By which lobe of the surface; `None` within a medium, and where no direction was found.
    pub lobe: Option<Lobe>,
    /// Of the surface, without the cosine; of a mirror or a clear surface its share of the light (Fresnel); of a medium its phase function.
    pub bsdf: Light,
    /// Density per solid angle of the direction; of a mirror or a clear surface the probability of its choice.
    pub pdf: f32,
    /// Between the direction and the shading normal, its size; 1 for a mirror, a clear surface, or a medium.
    pub cosine: f32,
    /// The probability with which the path went on; the survivors count one over it.
    pub survival: f32,
    /// What became of it.
    pub fate: Fate,
}

impl Sent {
    /// No direction was found.
    pub const NOWHERE: Sent =
        Sent { lobe: None, bsdf: Light::BLACK, pdf: 0.0, cosine: 0.0, survival: 1.0, fate: Fate::Swallowed };

    /// As the surface gave it.
    pub fn of(s: &BsdfSample) -> Self {
        let cosine = if s.lobe.is_delta() { 1.0 } else { s.wi.z.abs() };
        Sent { lobe: Some(s.lobe), bsdf: s.f, pdf: s.pdf, cosine, survival: 1.0, fate: Fate::Goes }
    }
}

/// What became of a ray that a step would send.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It goes on.
    Goes,
    /// The surface gave no direction, or let nothing through.
    Swallowed,
    /// A shading normal would bend it to the wrong side of the surface.
    WrongSide,
    /// Chance ended it.
    Roulette,
    /// What it could bring is below the least contribution.
    TooWeak,
}

/// Takes notes where somebody wants them.
#[derive(Debug, Default)]
pub struct Notes {
    pub(crate) are_wanted: bool,
    pub(crate) list: Vec<Note>,
    /// A ray of which it is not yet known what becomes.
    held: Option<Sent>,
}

impl Notes {
    /// A ray that a surface would send; [`Notes::settle`] says what becomes of it.
    #[inline(always)]
    pub(crate) fn hold(&mut self, sent: impl FnOnce() -> Sent) {
        if self.are_wanted {
            self.held = Some(sent());
        }
    }

    /// What became of the ray that was held.
    #[inline(always)]
    pub(crate) fn settle(&mut self, survival: f32, fate: Fate) {
        if let Some(sent) = self.held.take().filter(|_| self.are_wanted) {
            self.list.push(Note::Sent(Sent { survival, fate, ..sent }));
        }
    }

    /// The note is only made where it is wanted.
    #[inline(always)]
    pub fn add(&mut self, note: impl FnOnce() -> Note) {
        if self.are_wanted {
            self.list.push(note());
        }
    }
}

/// All that a step did.
pub struct Step<'a> {
    /// What it decided.
    pub notes: &'a [Note],
    /// The rays that it sends.
    pub paths: &'a [PathState],
    /// The lights that it asks.
    pub shadow_rays: &'a [ShadowRay],
}

/// Is told everything that happens. Every method does nothing unless overridden, and none can change the picture.
pub trait Observer {
    /// True to be told of steps.
    fn wants_steps(&self) -> bool {
        false
    }
    /// A ray is about to be traced.
    fn ray(&mut self, _id: SampleId, _path: &PathState) {}
    /// It hit a surface.
    fn hit(&mut self, _id: SampleId, _path: &PathState, _hit: &SurfaceHit) {}
    /// A path has been stepped; its contributions are told after this.
    fn step(&mut self, _id: SampleId, _path: &PathState, _step: &Step) {}
    /// A shadow ray was answered.
    fn shadow(&mut self, _id: SampleId, _ray: &ShadowRay, _blocked: bool) {}
    /// Film colour (fully weighted, as the integer that is added, unit 2^-64) reached a pixel.
    fn contribution(&mut self, _id: SampleId, _branch: u64, _group: u32, _light: Light, _fixed: [i128; 3]) {}
    /// Light that is not finite, or absurdly bright: its sample is left out.
    fn invalid(&mut self, _id: SampleId, _branch: u64, _group: u32, _light: Light) {}
    /// Particles of the pass have put film colour (as the integer that is added, unit 2^-64) on the pixel.
    fn landed(&mut self, _id: SampleId, _group: u32, _fixed: [i128; 3]) {}
    /// A path ended.
    fn end(&mut self, _id: SampleId, _branch: u64, _why: PathEnd) {}
}

impl Observer for () {}
