//! What a render cost, as counted: the factors of the course's cost formula.

use kirkas_accel::Counters;

/// Counts; they add.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Finished samples.
    pub samples: u64,
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Mirrored rays.
    pub reflected_rays: u64,
    /// Refracted rays.
    pub refracted_rays: u64,
    /// Distributed reflected or refracted rays.
    pub glossy_rays: u64,
    /// Rays from matte surfaces.
    pub diffuse_rays: u64,
    /// Rays of light on its way from the lamps.
    pub photon_rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Rays that hit something.
    pub hits: u64,
    /// Samples through a lens.
    pub lens_samples: u64,
    /// Samples at a chosen time.
    pub time_samples: u64,
    /// Nodes visited and primitives tested, by all rays.
    pub search: Counters,
}

impl Statistics {
    /// All rays.
    pub fn rays(&self) -> u64 {
        let bounced = self.reflected_rays + self.refracted_rays + self.glossy_rays + self.diffuse_rays;
        self.camera_rays + bounced + self.photon_rays + self.shadow_rays
    }

    /// Both together.
    pub fn plus(mut self, o: &Statistics) -> Self {
        self.samples += o.samples;
        self.camera_rays += o.camera_rays;
        self.reflected_rays += o.reflected_rays;
        self.refracted_rays += o.refracted_rays;
        self.glossy_rays += o.glossy_rays;
        self.diffuse_rays += o.diffuse_rays;
        self.photon_rays += o.photon_rays;
        self.shadow_rays += o.shadow_rays;
        self.hits += o.hits;
        self.lens_samples += o.lens_samples;
        self.time_samples += o.time_samples;
        self.search += o.search;
        self
    }
}
