//! Light as it leaves: rays out of lights, for those who follow it forwards.
//!
//! Contract: `power` is the flux (W per lane) of the whole light as this one ray estimates it: what leaves there, over the density
//! by area and solid angle with which the ray was drawn. The mean over all rays is the light's power.

use super::{Lamp, units};
use crate::materials::Material;
use crate::scene::SECONDARY;
use crate::textures::Textures;
use core::f64::consts::PI;
use kirkas_geometry::warp::{square_to_uniform_disk, square_to_uniform_sphere};
use kirkas_geometry::{DVec3, Frame, Ray, Vec3};
use kirkas_optics::{Lanes, Light};

/// One ray of a light.
#[derive(Clone, Copy, Debug)]
pub struct EmittedRay {
    /// From the light, clear of it; its direction is unit.
    pub ray: Ray,
    /// See the contract.
    pub power: Light,
    /// Fades unlike `1/r^2`, as [`PointLight`](super::point::PointLight) has it.
    pub attenuation: Option<[f64; 3]>,
}

impl EmittedRay {
    /// A ray along `direction` (unit) that does not fade by itself.
    pub(super) fn new(origin: Vec3, direction: DVec3, time: f64, power: Light) -> Self {
        let mut ray = Ray::new(origin, direction.as_vec3()).at_time(time as f32);
        ray.mask = SECONDARY;
        EmittedRay { ray, power, attenuation: None }
    }
}

/// What is left of a ray's power at `distance`: 1 but for lights that do not fade by `1/r^2`.
pub fn share_at(attenuation: Option<[f64; 3]>, distance: f64) -> f32 {
    match attenuation {
        None => 1.0,
        odd => (units::falloff(odd, distance) * distance * distance) as f32,
    }
}

/// What bounds a scene: light from far away enters through it.
#[derive(Clone, Copy, Debug)]
pub struct BoundingSphere {
    /// Its centre.
    pub center: DVec3,
    /// Its radius, scene units.
    pub radius: f64,
}

impl BoundingSphere {
    /// A ray from far away, out of the direction `towards` (unit), that meets the sphere. `irradiance` is what crosses it; `u`
    /// chooses where.
    pub(super) fn beam(&self, towards: DVec3, irradiance: Light, time: f64, u: (f32, f32)) -> EmittedRay {
        let disk = square_to_uniform_disk(u);
        let aside = Frame::from_z(towards.as_vec3()).to_world(Vec3::new(disk.x, disk.y, 0.0));
        let origin = self.center + (aside.as_dvec3() + towards) * self.radius;
        let area = PI * self.radius * self.radius;
        EmittedRay::new(origin.as_vec3(), -towards, time, irradiance * area as f32)
    }
}

impl Lamp {
    /// A ray that leaves the light, into a scene bounded by `bounds`, at `time`. `u` chooses where it starts, `v` where it goes.
    pub fn emit(
        &self,
        lanes: &Lanes,
        (materials, textures): (&[Material], &Textures),
        bounds: &BoundingSphere,
        time: f64,
        (u, v): ((f32, f32), (f32, f32)),
    ) -> Option<EmittedRay> {
        match self {
            Lamp::Point(l) => Some(l.emit(lanes, time, v)),
            Lamp::Spot(l) => Some(l.emit(lanes, time, v)),
            Lamp::Directional(l) => {
                let s = l.sample(lanes)?;
                Some(bounds.beam(s.direction, s.light, time, u))
            }
            Lamp::Area(l) => l.emit(lanes, materials, textures, time, (u, v)),
            Lamp::Background(l) => {
                let s = l.sample(lanes, v)?;
                Some(bounds.beam(s.direction, s.light, time, u))
            }
        }
    }

    /// True when its light enters the scene from far away.
    pub fn is_far(&self) -> bool {
        matches!(self, Lamp::Directional(_) | Lamp::Background(_))
    }
}

/// A direction of the whole sphere, with the solid angle that it stands for.
pub(super) fn any_direction(u: (f32, f32)) -> (DVec3, f64) {
    (square_to_uniform_sphere(u).as_dvec3().normalize(), 4.0 * PI)
}
