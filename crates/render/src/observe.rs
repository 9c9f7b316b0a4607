//! Observers watch a render through its one path of code: `()` when rendering, a recorder when explaining.

use crate::integrators::{PathState, ShadowRay};
use crate::scene::SurfaceHit;
use kirkas_optics::Light;

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

/// Is told everything that happens. Every method does nothing unless overridden, and none can change the picture.
pub trait Observer {
    /// A ray is about to be traced.
    fn ray(&mut self, _id: SampleId, _path: &PathState) {}
    /// It hit a surface.
    fn hit(&mut self, _id: SampleId, _path: &PathState, _hit: &SurfaceHit) {}
    /// A shadow ray was answered.
    fn shadow(&mut self, _id: SampleId, _ray: &ShadowRay, _blocked: bool) {}
    /// Film colour (fully weighted, as the integer that is added, unit 2^-64) reached a pixel.
    fn contribution(&mut self, _id: SampleId, _branch: u64, _group: u32, _light: Light, _fixed: [i128; 3]) {}
    /// Particles of the pass have put film colour (as the integer that is added, unit 2^-64) on the pixel.
    fn landed(&mut self, _id: SampleId, _group: u32, _fixed: [i128; 3]) {}
    /// A path ended.
    fn end(&mut self, _id: SampleId, _branch: u64, _why: PathEnd) {}
}

impl Observer for () {}
