//! Path tracing written as plainly as can be: one ray at a time, in one loop. The readable twin of `path`, and its test.
//!
//! # Parameters
//! `max_depth` bounces, as for `path`; `next_event`: ask a light at every surface (else only those that no ray can hit).
//!
//! # Example
//! ```toml
//! [integrator]
//! type = "path_simple"
//! next_event = false
//! ```
//!
//! # Limits
//! Slow and noisy: lights are chosen evenly, nothing is weighted, and rays do not travel in flocks.
//!
//! # References
//! Kajiya 1986, "The Rendering Equation".

use super::path::MAX_DEPTH;
use super::{Integrator, PathState, ShadowRay, StepOutput, crossing};
use crate::media::random::Stream;
use crate::media::{Volume, Way, shares};
use crate::sampler::Sampler;
use crate::scene::{AlphaFilter, SECONDARY, Scene, SurfaceHit, ray_to_light};
use kirkas_accel::Query;
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::{DVec3, Ray};
use kirkas_optics::{Light, LobeSet, Mode};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Integrator,
    name: "path_simple",
    doc: "Path tracing, as plain as can be: the test of `path`.",
    params: &[
        MAX_DEPTH,
        ParamSpec::bool("next_event", true, "Ask a light at every surface, not only those that no ray can hit."),
    ],
};

/// The integrator.
#[derive(Clone, Debug)]
pub struct PathSimple {
    max_depth: u32,
    next_event: bool,
}

impl PathSimple {
    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        PathSimple { max_depth: p.integer("max_depth") as u32, next_event: p.bool("next_event") }
    }
}

/// From this bounce on a path survives with [`SURVIVAL`].
const ROULETTE_DEPTH: u32 = 6;
const SURVIVAL: f32 = 0.9;

impl Integrator for PathSimple {
    fn step(&self, scene: &Scene, path: &PathState, sampler: &Sampler, hit: Option<&SurfaceHit>, out: &mut StepOutput) {
        let mut path = *path;
        let mut hit = hit.copied();
        let mut was_asked = false; // whether the last surface has asked lights already
        loop {
            // Drift through the medium, and scatter there or come out.
            if let Some(volume) = scene.volume_of(&path.media) {
                let way = Way::of_ray(&path.ray, hit.as_ref().map_or(f32::INFINITY, |h| h.t));
                if let Some(distance) = drift(volume, &mut path, &way, sampler, out) {
                    path.throughput *= scene.clearness(&path.lanes, &path.media, distance);
                    if path.depth >= self.max_depth {
                        return;
                    }
                    let position = way.at(distance);
                    self.ask_light_from_within(scene, &path, sampler, volume, position, out);
                    let (u_lane, u) =
                        (sampler.one(combine(path.branch, LOBE)), sampler.pair(combine(path.branch, DIRECTION)));
                    let wo = -path.ray.direction.normalize();
                    let Some(s) = volume.phase.sample(&path.lanes, even(&path), wo, u_lane, u) else { return };
                    path.cone = path.cone.after(distance as f32).scattered(s.pdf);
                    path.throughput *= s.value / s.pdf;
                    path.depth += 1;
                    path.branch = combine(path.branch, BOUNCE);
                    path.ray = Ray {
                        origin: position.as_vec3(),
                        direction: s.wi,
                        t_max: f32::INFINITY,
                        mask: SECONDARY,
                        ..path.ray
                    };
                    path.passed = 0;
                    was_asked = true;
                    if !survives(&mut path, sampler) {
                        return;
                    }
                    hit = closest(scene, &path, sampler, out);
                    continue;
                }
            }

            // Add what shines at the ray's end, unless it was asked for.
            let Some(surface) = &hit else {
                if !(was_asked && self.next_event) {
                    let sky = scene.background.radiance(&path.lanes, path.ray.direction);
                    let clear = scene.clearness(&path.lanes, &path.media, f64::INFINITY);
                    out.contributions.push((path.throughput * sky * clear, scene.background_group));
                }
                return;
            };
            path.throughput *=
                scene.clearness(&path.lanes, &path.media, f64::from(surface.t * path.ray.direction.length()));
            if crossing::is_covered(scene, &path, surface) {
                let Some(behind) = crossing::passed(&path, surface) else { return };
                path = behind;
                hit = closest(scene, &path, sampler, out);
                continue;
            }
            if !(was_asked && self.next_event && scene.light_of(surface).is_some()) {
                let emitted = match was_asked {
                    true => scene.emitted_at_point(&path.lanes, surface),
                    false => scene.emitted(&path.lanes, surface),
                };
                out.contributions.push((path.throughput * emitted, surface.emission_group));
            }
            if path.depth >= self.max_depth {
                return;
            }

            // Ask one light, each as likely as any other.
            let bsdf = crossing::bsdf(scene, &path, surface);
            let wo = surface.frame.to_local(-path.ray.direction.normalize());
            self.ask_light(scene, &path, sampler, surface, &bsdf, wo, out);

            // Go on in a random direction.
            let u = sampler.pair(combine(path.branch, DIRECTION));
            let u_lobe = sampler.one(combine(path.branch, LOBE));
            let Some(s) = bsdf.sample(wo, u_lobe, u, LobeSet::ALL, Mode::Radiance) else { return };
            let direction = surface.frame.to_world(s.wi).as_dvec3().normalize();
            if !crossing::keeps_side(surface, direction, s.lobe) {
                return;
            }
            path.cone = crossing::cone_after(scene, &path, surface, &s);
            path.throughput *= s.weight();
            path.lanes = s.lanes(path.lanes);
            path.depth += 1;
            path.branch = combine(path.branch, BOUNCE);
            path.media = crossing::media_towards(scene, &path.media, surface, direction);
            path.ray = surface.ray_towards(direction, &path.ray);
            path.passed = 0;
            was_asked = !s.lobe.is_delta();

            if !survives(&mut path, sampler) {
                return;
            }
            hit = closest(scene, &path, sampler, out);
        }
    }
}

impl PathSimple {
    fn ask_light(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        surface: &SurfaceHit,
        bsdf: &kirkas_optics::Bsdf,
        wo: kirkas_geometry::Vec3,
        out: &mut StepOutput,
    ) {
        let count = scene.lights.len();
        let number = (sampler.one(combine(path.branch, PICK)) * count as f32) as usize;
        let Some(light) = scene.lights.get(number) else { return };
        let u = sampler.pair(combine(path.branch, LIGHT));
        let sample = scene.sample_light(&path.lanes, light, surface.position, f64::from(path.ray.time), u);
        let Some(s) = sample.filter(|s| self.next_event || s.pdf == 0.0) else { return };
        let wi = surface.frame.to_local(s.direction.as_vec3());
        let f = bsdf.eval(wo, wi, LobeSet::NON_DELTA, Mode::Radiance);
        if f.is_black() || !crossing::agrees(surface, s.direction, wi.z) {
            return;
        }
        let media = crossing::media_towards(scene, &path.media, surface, s.direction);
        let light = path.throughput * f * s.light * (wi.z.abs() * count as f32);
        let ray = surface.shadow_ray(&s, &path.ray);
        arrive(scene, crossing::ask(scene, path, sampler, ray, media, light, number as u32), sampler, out);
    }

    fn ask_light_from_within(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        volume: &Volume,
        position: DVec3,
        out: &mut StepOutput,
    ) {
        let count = scene.lights.len();
        let number = (sampler.one(combine(path.branch, PICK)) * count as f32) as usize;
        let Some(light) = scene.lights.get(number) else { return };
        let u = sampler.pair(combine(path.branch, LIGHT));
        let sample = scene.sample_light(&path.lanes, light, position, f64::from(path.ray.time), u);
        let Some(s) = sample.filter(|s| self.next_event || s.pdf == 0.0) else { return };
        let wo = -path.ray.direction.normalize();
        let value = volume.phase.value(&path.lanes, wo, s.direction.as_vec3());
        let light = path.throughput * value * s.light * count as f32;
        let ray = ray_to_light(position.as_vec3(), &s, &path.ray);
        arrive(scene, crossing::ask(scene, path, sampler, ray, path.media, light, number as u32), sampler, out);
    }
}

/// End long paths by chance.
fn survives(path: &mut PathState, sampler: &Sampler) -> bool {
    if path.depth < ROULETTE_DEPTH {
        return true;
    }
    path.throughput *= 1.0 / SURVIVAL;
    sampler.one(combine(path.branch, ROULETTE)) < SURVIVAL
}

/// Every lane in use counts the same.
fn even(path: &PathState) -> Light {
    shares(path.lanes.one())
}

/// Delta tracking with one bound for the whole medium: the distance at which the path scatters; `None` if it comes out. (Woodcock
/// et al. 1965; with one coin for all lanes.)
fn drift(volume: &Volume, path: &mut PathState, way: &Way, sampler: &Sampler, out: &mut StepOutput) -> Option<f64> {
    let c = volume.coefficients(&path.lanes);
    let fill = volume.density(way.origin).1 * c.extinction.max_component().max(c.emission.max_component().min(1.0));
    let end = volume.end_of(way);
    if fill == 0.0 || c.extinction.is_black() && end == f64::INFINITY {
        return None;
    }
    let mut random = Stream::new(combine(combine(sampler.key(), path.branch), combine(DRIFT, u64::from(path.passed))));
    let mut distance = 0.0;
    loop {
        distance += f64::from(random.depth() / fill);
        if !(distance < end) || path.throughput.is_black() {
            return None;
        }
        let density = volume.density(way.at(distance)).0;
        let real = c.extinction * (density / fill);
        out.contributions.push((path.throughput * c.emission * (density / fill), volume.group));
        let chance = (real * even(path)).sum() as f32;
        if random.number() < chance {
            path.throughput *= c.scattering * (density / fill / chance);
            return Some(distance);
        }
        path.throughput *= (Light::splat(1.0) - real) / (1.0 - chance);
    }
}

/// What the path's ray hits.
fn closest(scene: &Scene, path: &PathState, sampler: &Sampler, out: &mut StepOutput) -> Option<SurfaceHit> {
    let filter = AlphaFilter { scene, key: |_| combine(sampler.key(), path.branch) };
    out.counted.diffuse_rays += 1;
    let hit = scene.accel.closest_hit(&path.ray, Query::filtered(&filter), 0, &mut out.counted.search)?;
    Some(scene.surface_seen(&path.ray, &hit, path.cone))
}

/// Add the light that a shadow ray asks for, unless something is in its way.
fn arrive(scene: &Scene, asked: Option<ShadowRay>, sampler: &Sampler, out: &mut StepOutput) {
    let Some(mut shadow) = asked else { return };
    let key = AlphaFilter::shadow_key(sampler, shadow.branch);
    let filter = AlphaFilter { scene, key: |_| key };
    loop {
        out.counted.shadow_rays += 1;
        match scene.accel.closest_hit(&shadow.ray, Query::filtered(&filter), 0, &mut out.counted.search) {
            None => {
                out.contributions.push((scene.arrived(&shadow, key), shadow.group));
                return;
            }
            Some(hit) => match scene.weakened(&shadow, &hit, key) {
                Some(behind) => shadow = behind,
                None => return,
            },
        }
    }
}

const PICK: u64 = of_name("pick");
const LIGHT: u64 = of_name("light");
const LOBE: u64 = of_name("lobe");
const DIRECTION: u64 = of_name("direction");
const ROULETTE: u64 = of_name("roulette");
const DRIFT: u64 = of_name("drift");
const BOUNCE: u64 = of_name("bounce");
