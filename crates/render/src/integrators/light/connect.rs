//! From where a particle arrived to the camera: how bright that place is for it, and whether it sees it.
//!
//! A particle of power P (W) that a surface scatters with f towards the camera gives pixels `P f c a h`: `c` is the cosine of
//! the surface there with shading normals corrected (Veach 1997, equation 5.19), `a` the film area (pixels squared) per area that
//! faces the camera, [`Sight::density`](crate::camera::Sight::density), and `h` the filter. Within a medium the phase function stands for f,
//! and c is 1.

use super::splats::Splat;
use crate::flock::within;
use crate::integrators::forward::{Arrival, Place, Receiver};
use crate::integrators::{PathState, crossing};
use crate::media::Way;
use crate::render::Renderer;
use crate::scene::{AlphaFilter, PRIMARY, Scene, SurfaceHit};
use crate::statistics::Statistics;
use kirkas_accel::Query;
use kirkas_geometry::Ray;
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::rounding::{gamma, offset_origin};
use kirkas_optics::{Bsdf, LobeSet, Mode};

/// Connects particles to the camera.
pub struct Connector<'a> {
    pub renderer: &'a Renderer<'a>,
}

/// What a range of particles leaves.
#[derive(Default)]
pub struct Connections {
    /// Not answered yet.
    waiting: Vec<Connection>,
    /// What reached the film.
    pub splats: Vec<Splat>,
}

/// Light on its way to the camera.
struct Connection {
    /// Its ray ends at the camera, at parameter 1; its throughput is the light.
    path: PathState,
    film: (f64, f64),
    group: u32,
    /// Names its random numbers.
    key: u64,
}

impl Receiver for Connector<'_> {
    type Kept = Connections;

    fn receive(&self, arrival: &Arrival, kept: &mut Connections) {
        kept.waiting.extend(self.connect(arrival));
    }

    fn end_round(&self, kept: &mut Connections, counted: &mut Statistics) {
        let scene = self.renderer.scene;
        let has_bodies = scene.has_hulls || scene.materials.iter().any(|m| m.medium.is_some());
        if has_bodies {
            self.walk(kept, counted);
        } else {
            self.look(kept, counted);
        }
    }
}

impl Connector<'_> {
    fn connect(&self, arrival: &Arrival) -> Option<Connection> {
        let (r, path) = (self.renderer, arrival.path);
        let camera = &r.scene.camera;
        let from = match &arrival.place {
            Place::Surface(hit, bsdf) if can_send(r.scene, hit, bsdf) => hit.position,
            Place::Surface(..) => return None,
            Place::Medium(_, position) => *position,
        };
        let lens = if camera.uses_lens() { arrival.sampler.pair(combine(path.branch, LENS)) } else { (0.5, 0.5) };
        let sight = camera.see(from, lens, f64::from(path.ray.time), r.resolution)?;
        if !is_near(sight.film, r) {
            return None;
        }
        let back = -path.ray.direction.as_dvec3().normalize();
        let on = (sight.origin - from).normalize();
        let (value, origin, media) = match &arrival.place {
            Place::Medium(volume, _) => {
                let value = volume.phase.value(&path.lanes, back.as_vec3(), on.as_vec3());
                (value, from.as_vec3(), path.media)
            }
            Place::Surface(hit, bsdf) => {
                // As the camera sees it.
                let frame = hit.frame_towards(on);
                let (wo, wi) = (frame.to_local(on.as_vec3()), frame.to_local(back.as_vec3()));
                if !crossing::agrees(hit, on, wo.z) || !crossing::agrees(hit, back, wi.z) {
                    return None;
                }
                let cosine = f64::from(wi.z.abs()) / back.dot(hit.normal).abs() * on.dot(hit.normal).abs();
                let value = bsdf.eval(wo, wi, LobeSet::NON_DELTA, Mode::Radiance) * cosine as f32;
                let media = crossing::media_towards(r.scene, &path.media, hit, on);
                (value, offset_origin(hit.position, hit.error, hit.normal, on), media)
            }
        };
        let light = path.throughput * value * r.scene.camera_gain(&path.lanes) * sight.density as f32;
        let direction = (sight.origin - origin.as_dvec3()).as_vec3();
        let ray = Ray { origin, direction, t_min: 0.0, t_max: 1.0 - gamma(16), mask: PRIMARY, ..path.ray };
        let key = AlphaFilter::shadow_key(arrival.sampler, combine(path.branch, CAMERA));
        let path = PathState { ray, throughput: light, media, passed: 0, ..*path };
        (!light.is_black()).then_some(Connection { path, film: sight.film, group: arrival.group, key })
    }

    /// Answer all where nothing lets light through.
    fn look(&self, kept: &mut Connections, counted: &mut Statistics) {
        let scene = self.renderer.scene;
        let rays: Vec<Ray> = kept.waiting.iter().map(|c| c.path.ray).collect();
        let mut blocked = vec![false; rays.len()];
        let waiting = &kept.waiting;
        let filter = AlphaFilter { scene, key: |i: usize| waiting[i].key };
        scene.accel.any_hits(&rays, Query::filtered(&filter), &mut blocked, &mut counted.search);
        counted.shadow_rays += rays.len() as u64;
        for (mut c, is_blocked) in kept.waiting.drain(..).zip(blocked) {
            if !is_blocked {
                c.weaken(scene, 1.0);
                kept.splats.push(self.splat(&c));
            }
        }
    }

    /// Answer all where boundaries may be covered by others, and hulls are no obstacle.
    fn walk(&self, kept: &mut Connections, counted: &mut Statistics) {
        let scene = self.renderer.scene;
        let mut waiting = std::mem::take(&mut kept.waiting);
        while !waiting.is_empty() {
            let rays: Vec<Ray> = waiting.iter().map(|c| c.path.ray).collect();
            let mut hits = vec![None; rays.len()];
            let filter = AlphaFilter { scene, key: |i: usize| waiting[i].key };
            scene.accel.closest_hits(&rays, Query::filtered(&filter), &mut hits, &mut counted.search);
            counted.shadow_rays += rays.len() as u64;
            let mut behind = Vec::new();
            for (mut c, hit) in waiting.drain(..).zip(hits) {
                let Some(hit) = hit else {
                    c.weaken(scene, 1.0);
                    kept.splats.push(self.splat(&c));
                    continue;
                };
                let surface = scene.surface(&c.path.ray, &hit);
                if crossing::is_covered(scene, &c.path, &surface) {
                    c.weaken(scene, hit.t);
                    behind.extend(c.behind(&surface));
                }
            }
            waiting = behind;
        }
    }

    fn splat(&self, c: &Connection) -> Splat {
        let rgb = c.path.lanes.film_weights().apply(c.path.throughput);
        let share = within(rgb, self.renderer.clamp);
        Splat { film: c.film, rgb: rgb.map(|c| c * share), group: c.group }
    }
}

impl Connection {
    /// Take away what is lost up to the ray's parameter `t`.
    fn weaken(&mut self, scene: &Scene, t: f32) {
        let key = combine(self.key, u64::from(self.path.passed));
        let way = Way::of_ray(&self.path.ray, t);
        self.path.throughput *= scene.transmittance(&self.path.lanes, &self.path.media, &way, key);
    }

    /// The same from the other side of a surface that is not there.
    fn behind(self, surface: &SurfaceHit) -> Option<Connection> {
        let ray = self.path.ray;
        let mut path = crossing::passed(&self.path, surface)?;
        let end = ray.at(1.0).as_dvec3();
        path.ray.direction = (end - path.ray.origin.as_dvec3()).as_vec3();
        path.ray.t_max = if path.ray.direction.dot(ray.direction) > 0.0 { ray.t_max } else { 0.0 };
        path.ray.mask = PRIMARY;
        Some(Connection { path, ..self })
    }
}

/// The camera sees the surface, and it scatters into directions that can be chosen.
fn can_send(scene: &Scene, hit: &SurfaceHit, bsdf: &Bsdf) -> bool {
    bsdf.lobes().intersects(LobeSet::NON_DELTA) && scene.is_visible(&hit.hit)
}

/// Light here may count for a pixel.
fn is_near((x, y): (f64, f64), r: &Renderer) -> bool {
    let most = f64::from(r.filter.radius()) + 1.0;
    let is_within = |place: f64, size: u32| place > -most && place < f64::from(size) + most;
    is_within(x - r.shift[0], r.resolution.0) && is_within(y - r.shift[1], r.resolution.1)
}

const LENS: u64 = of_name("lens");
const CAMERA: u64 = of_name("camera");
