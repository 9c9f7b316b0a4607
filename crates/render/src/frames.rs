//! Films: one prepared scene, frame after frame.
//!
//! Only what depends on the moment is made anew: when the shutter opens, the bodies that the camera is inside of, and, where
//! something moves, the accelerator: a quickly built one, unless the scene names another. Meshes, textures, materials, lights
//! and places stay. A frame is the same to the bit whichever frames came before it.

use crate::camera::CameraSample;
use crate::compile_scene::{Prepared, Threads};
use crate::integrators::MediumStack;
use crate::scene::Scene;
use kirkas_accel::{Accel, AccelError, Counters, Query, SceneGeometry};
use kirkas_geometry::{DVec3, Ray};
use kirkas_scene::Diagnostic;

/// When the shutter opens for frame `frame`, in seconds.
pub fn frame_time(frame: u32, frames_per_second: f64) -> f64 {
    f64::from(frame) / frames_per_second
}

impl Prepared {
    /// The same scene at frame `frame`.
    pub fn at_frame(self, frame: u32) -> Result<Prepared, Vec<Diagnostic>> {
        let camera = self.scene.camera.opened_at(frame_time(frame, self.frames_per_second));
        let accel = accel_for_shutter(self.scene.accel, camera.shutter()).map_err(bad_geometry)?;
        let scene = Scene { accel, camera, ..self.scene }.with_camera_media(self.film.size);
        Ok(Prepared { scene, frame: Some(frame), ..self })
    }
}

/// The accelerator for another shutter: as it is where nothing moves, else built anew, the old one gone first.
fn accel_for_shutter(accel: Accel, shutter: (f64, f64)) -> Result<Accel, AccelError> {
    if !is_moving(accel.scene_geometry()) {
        return Ok(accel);
    }
    let (kind, scene) = (accel.kind(), SceneGeometry { shutter, ..accel.scene_geometry().clone() });
    drop(accel);
    Accel::build(kind, scene, &Threads)
}

/// True when what rays hit depends on the moment.
pub(crate) fn is_moving(scene: &SceneGeometry) -> bool {
    let mut instances = scene.instances.iter().chain(scene.aggregates.iter().flat_map(|a| &a.instances));
    instances.any(|i| i.outer_from_object.is_moving())
}

/// What the user is told of geometry that cannot be searched.
pub(crate) fn bad_geometry(e: AccelError) -> Vec<Diagnostic> {
    vec![Diagnostic::error("bad-geometry", e.to_string()).help("mend the mesh or the object that it names")]
}

impl Scene {
    /// With the bodies that the camera is inside of when the shutter opens, for an image of `resolution` pixels.
    pub(crate) fn with_camera_media(mut self, resolution: (u32, u32)) -> Scene {
        let middle = (f64::from(resolution.0) / 2.0, f64::from(resolution.1) / 2.0);
        let sample = CameraSample { film: middle, lens: (0.5, 0.5), time: self.camera.shutter().0 };
        self.camera_media = bodies_around(&self, &self.camera.ray(&sample, resolution));
        self
    }
}

/// Bodies that a point is inside of: those whose boundary a ray from there first meets from within, in some direction.
pub(crate) fn bodies_around(scene: &Scene, start: &Ray) -> MediumStack {
    let mut media = MediumStack::EMPTY;
    if scene.materials.iter().all(|m| m.medium.is_none()) {
        return media;
    }
    let ways =
        [DVec3::new(0.2917, 0.8713, 0.3947), DVec3::new(0.5113, -0.6139, 0.6015), DVec3::new(-0.8291, 0.2171, -0.5153)];
    for way in ways {
        let mut met = Vec::new();
        let mut ray = Ray { direction: way.as_vec3(), mask: u32::MAX, ..*start };
        const MOST: usize = 10_000;
        for _ in 0..MOST {
            let Some(hit) = scene.accel.closest_hit(&ray, Query::ALL, 0, &mut Counters::default()) else { break };
            let s = scene.surface(&ray, &hit);
            if scene.material(&s).medium.is_some() && !met.contains(&s.material) {
                met.push(s.material);
                if !s.is_front && !media.materials().contains(&s.material) {
                    media = media.entered(s.material);
                }
            }
            ray = Ray { mask: u32::MAX, ..s.ray_towards(way, &ray) };
        }
    }
    media
}
