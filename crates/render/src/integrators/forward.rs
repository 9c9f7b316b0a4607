//! Light followed forwards: particles leave the lights and go from surface to surface and through media, and a [`Receiver`] is
//! told of every arrival.
//!
//! Particle number i of all passes together is a pure function of i and the seed; a pass takes a stretch of them, in ranges that
//! threads share out, put together in order.

use super::particle::{self, Particle};
use super::{MediumStack, PathState, RayKind, Shared, crossing};
use crate::frames::bodies_around;
use crate::lights::LightEntry;
use crate::lights::emit::{BoundingSphere, share_at};
use crate::media::{FlightEnd, Volume, Way};
use crate::observe::Notes;
use crate::sampler::{Sampler, SamplerKind};
use crate::scene::{AlphaFilter, Scene, SurfaceHit};
use crate::statistics::Statistics;
use crate::textures::RayCone;
use kirkas_accel::{Hit, Query};
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::{DVec3, Ray};
use kirkas_optics::{Bsdf, LobeSet, Mode};
use rayon::prelude::*;
use std::ops::Range;

/// What all particles of a pass have in common.
pub struct Tracer<'a> {
    scene: &'a Scene,
    seed: u64,
    /// The moment and the lanes; `None` = each has its own.
    shared: Option<Shared>,
    most_bounces: u32,
    bounds: BoundingSphere,
    /// Shares of the lights' power, summed up; empty if there is none.
    sums: Vec<f64>,
    /// Per light: bodies that it stands in.
    media: Vec<MediumStack>,
}

/// Is told of light that arrives somewhere. What one range of particles leaves behind is kept together.
pub trait Receiver: Sync {
    /// See above.
    type Kept: Default + Send;

    /// Light arrives.
    fn receive(&self, arrival: &Arrival, kept: &mut Self::Kept);

    /// Every particle of the range has arrived once more: the time for rays that were put off to be many.
    fn end_round(&self, _kept: &mut Self::Kept, _counted: &mut Statistics) {}
}

/// Light that arrives.
pub struct Arrival<'a> {
    /// The ray that brings it; its throughput is the particle's power (W per lane).
    pub path: &'a PathState,
    /// The particle's numbers.
    pub sampler: &'a Sampler,
    /// Light group.
    pub group: u32,
    /// At what.
    pub place: Place<'a>,
}

/// Where light arrives.
pub enum Place<'a> {
    /// At a surface, which scatters like this.
    Surface(&'a SurfaceHit, &'a Bsdf),
    /// Within a medium.
    Medium(&'a Volume, DVec3),
}

/// A particle that may arrive somewhere yet.
struct Flying {
    path: PathState,
    sampler: Sampler,
    group: u32,
    attenuation: Option<[f64; 3]>,
}

/// Particles that travel together.
pub const RANGE: u64 = 2048;

/// Of every choice by power, the part that is spread evenly: an estimate of power may be wrong.
const EVEN_SHARE: f64 = 0.02;

/// Even where nothing is absorbed every particle ends.
const MOST_CHANCE: f32 = 0.98;

/// As many particles as pixels, but enough for a picture of few.
pub fn usual_count((width, height): (u32, u32)) -> u64 {
    (u64::from(width) * u64::from(height)).clamp(1 << 15, 1 << 21)
}

impl<'a> Tracer<'a> {
    /// For particles that are scattered at most `most_bounces` times before they arrive. What they do not share, each draws.
    pub fn new(scene: &'a Scene, seed: u64, shared: Option<Shared>, most_bounces: u32) -> Self {
        let bounds = scene.bounding_sphere(shared.map_or(scene.camera.shutter(), |s| {
            let time = scene.camera.time_at(s.moment);
            (time, time)
        }));
        let power = |l: &LightEntry| l.lamp.power(&scene.materials, &scene.textures, bounds.radius);
        let powers = scene.lights.iter().map(power).map(|p| if p.is_finite() { p.max(0.0) } else { 0.0 });
        let powers: Vec<f64> = powers.collect();
        let total: f64 = powers.iter().sum();
        let even = 1.0 / powers.len().max(1) as f64;
        let share = |p: f64| if total > 0.0 { EVEN_SHARE * even + (1.0 - EVEN_SHARE) * p / total } else { even };
        let mut sum = 0.0;
        let sums = powers.iter().map(|&p| (sum += share(p), sum).1).collect();
        let mut tracer = Tracer { scene, seed, shared, most_bounces, bounds, sums, media: Vec::new() };
        tracer.media = scene.lights.iter().map(|l| tracer.bodies_of(l)).collect();
        tracer
    }

    /// The bodies around a light; a lamp stands in them as a whole.
    fn bodies_of(&self, light: &LightEntry) -> MediumStack {
        let things = (&self.scene.materials[..], &self.scene.textures);
        let middle = ((0.5, 0.5), (0.3, 0.5));
        let common = self.shared.unwrap_or_else(|| Shared { moment: 0.5, lanes: self.scene.lanes(|| 0.5) });
        let time = self.scene.camera.time_at(common.moment);
        match light.lamp.emit(&common.lanes, things, &self.bounds, time, middle) {
            Some(e) if !light.lamp.is_far() => bodies_around(self.scene, &e.ray),
            _ => MediumStack::EMPTY,
        }
    }

    /// Send out particles `all`, each with this share of the power that it estimates; what each range of them leaves, in order.
    pub fn trace<R: Receiver>(&self, all: Range<u64>, share: f32, receiver: &R) -> (Vec<R::Kept>, Statistics) {
        let ranges: Vec<Range<u64>> = (0..all.end.saturating_sub(all.start).div_ceil(RANGE))
            .map(|n| all.start + n * RANGE..(all.start + (n + 1) * RANGE).min(all.end))
            .collect();
        let parts: Vec<_> = ranges.into_par_iter().map(|range| self.trace_range(range, share, receiver)).collect();
        let counted = parts.iter().fold(Statistics::default(), |all, p| all.plus(&p.1));
        (parts.into_iter().map(|p| p.0).collect(), counted)
    }

    fn trace_range<R: Receiver>(&self, range: Range<u64>, share: f32, receiver: &R) -> (R::Kept, Statistics) {
        let (mut kept, mut counted) = (R::Kept::default(), Statistics::default());
        let mut flying: Vec<Flying> = range.filter_map(|i| self.launch(i, share)).collect();
        while !flying.is_empty() {
            let hits = self.find_hits(&flying, &mut counted);
            let pairs = flying.iter().zip(hits);
            flying = pairs.filter_map(|(f, hit)| self.step(f, hit.as_ref(), receiver, &mut kept)).collect();
            receiver.end_round(&mut kept, &mut counted);
        }
        (kept, counted)
    }

    fn find_hits(&self, flying: &[Flying], counted: &mut Statistics) -> Vec<Option<Hit>> {
        let rays: Vec<Ray> = flying.iter().map(|f| f.path.ray).collect();
        let mut hits = vec![None; rays.len()];
        let key = |i: usize| combine(flying[i].sampler.key(), flying[i].path.branch);
        let filter = AlphaFilter { scene: self.scene, key };
        self.scene.accel.closest_hits(&rays, Query::filtered(&filter), &mut hits, &mut counted.search);
        counted.photon_rays += rays.len() as u64;
        counted.hits += hits.iter().flatten().count() as u64;
        hits
    }

    /// Particle number `index` as it leaves its light.
    fn launch(&self, index: u64, share: f32) -> Option<Flying> {
        let scene = self.scene;
        let seed = combine(combine(self.seed, PHOTON), index >> 32);
        let sampler = Sampler::new(SamplerKind::Sobol, seed, 0, 0, index as u32);
        let u = f64::from(sampler.one(PICK)) * self.sums.last()?;
        let number = self.sums.partition_point(|&s| s <= u).min(self.sums.len() - 1);
        let before = number.checked_sub(1).map_or(0.0, |n| self.sums[n]);
        let chance = (self.sums[number] - before) / self.sums.last()?;
        let light = &scene.lights[number];
        let own = || Shared { moment: sampler.one(TIME), lanes: scene.lanes(|| sampler.one(WAVELENGTH)) };
        let Shared { moment, lanes } = self.shared.unwrap_or_else(own);
        let things = (&scene.materials[..], &scene.textures);
        let places = (sampler.pair(PLACE), sampler.pair(DIRECTION));
        let e = light.lamp.emit(&lanes, things, &self.bounds, scene.camera.time_at(moment), places)?;
        let mut power = e.power * (share / chance as f32);
        if light.lamp.is_far() && scene.space.is_some() {
            // It has come through the medium that fills all space.
            let way = Way { direction: -e.ray.direction.as_dvec3(), ..Way::of_ray(&e.ray, f32::INFINITY) };
            power *= scene.transmittance(&lanes, &MediumStack::EMPTY, &way, combine(sampler.key(), PLACE));
        }
        let path = PathState {
            ray: e.ray,
            lanes,
            throughput: power,
            depth: 0,
            kind: RayKind::Camera,
            branch: 0,
            media: self.media[number],
            cone: RayCone::POINT,
            passed: 0,
            travelled: 0.0,
            last: None,
        };
        (!power.is_black() && power.is_finite()).then_some(Flying {
            path,
            sampler,
            group: light.group,
            attenuation: e.attenuation,
        })
    }

    /// A particle arrives, and goes on if it can.
    fn step<R: Receiver>(
        &self,
        flying: &Flying,
        hit: Option<&Hit>,
        receiver: &R,
        kept: &mut R::Kept,
    ) -> Option<Flying> {
        let (scene, sampler) = (self.scene, &flying.sampler);
        let mut path = flying.path;
        let hit = hit.map(|h| scene.surface(&path.ray, h));
        let way = Way::of_ray(&path.ray, hit.map_or(f32::INFINITY, |h| h.t));

        // Fly through the medium, and scatter in it or come out.
        if let Some(volume) = scene.volume_of(&path.media) {
            match particle::fly(volume, &path, &way, sampler).end {
                FlightEnd::Passed(weight) => path.throughput *= weight,
                FlightEnd::Scattered { distance, weight } => {
                    path.throughput *= weight * scene.clearness(&path.lanes, &path.media, distance);
                    path.throughput *= flying.share_after(distance);
                    let position = way.at(distance);
                    let place = Place::Medium(volume, position);
                    receiver.receive(&Arrival { path: &path, sampler, group: flying.group, place }, kept);
                    if path.depth >= self.most_bounces {
                        return None;
                    }
                    let next = Particle::new(volume, &path, position).go_on(&path, sampler, &mut Notes::default())?;
                    return flying.survive(next, flying.path.throughput.max_component());
                }
            }
        }

        // Pass boundaries that another body covers.
        let hit = hit?;
        path.throughput *= scene.clearness(&path.lanes, &path.media, way.length);
        if crossing::is_covered(scene, &path, &hit) {
            return Some(Flying { path: crossing::passed(&path, &hit)?, ..*flying });
        }
        path.throughput *= flying.share_after(way.length);
        let bsdf = crossing::bsdf(scene, &path, &hit);
        let place = Place::Surface(&hit, &bsdf);
        receiver.receive(&Arrival { path: &path, sampler, group: flying.group, place }, kept);
        if path.depth >= self.most_bounces {
            return None;
        }

        // Scatter.
        let back = -path.ray.direction.normalize();
        let purpose = |p| combine(path.branch, p);
        let (u_lobe, u) = (sampler.one(purpose(LOBE)), sampler.pair(purpose(BOUNCE)));
        let s = bsdf.sample(hit.frame.to_local(back), u_lobe, u, LobeSet::ALL, Mode::Importance)?;
        let direction = hit.frame.to_world(s.wi).as_dvec3().normalize();
        if !crossing::keeps_side(&hit, direction, s.lobe) {
            return None;
        }
        let next = PathState {
            ray: hit.ray_towards(direction, &path.ray),
            lanes: s.lanes(path.lanes),
            throughput: path.throughput * s.weight() * adjoint(&hit, back.as_dvec3(), direction),
            depth: path.depth + 1,
            branch: purpose(BOUNCE),
            media: crossing::media_towards(scene, &path.media, &hit, direction),
            passed: 0,
            travelled: 0.0,
            ..path
        };
        flying.survive(next, path.throughput.max_component())
    }
}

impl Flying {
    /// What is left of the light at the end of its first way, after `distance` more of it.
    fn share_after(&self, distance: f64) -> f32 {
        match self.path.depth {
            0 => share_at(self.attenuation, f64::from(self.path.travelled) + distance),
            _ => 1.0,
        }
    }

    /// Goes on along `next` as probably as power is left of `before`, so that all particles weigh about the same (Jensen 1996).
    fn survive(&self, mut next: PathState, before: f32) -> Option<Flying> {
        let chance = (next.throughput.max_component() / before).min(MOST_CHANCE);
        if self.sampler.one(combine(next.branch, ROULETTE)) >= chance || !next.throughput.is_finite() {
            return None;
        }
        next.throughput *= 1.0 / chance;
        Some(Flying { path: next, ..*self })
    }
}

/// What a shading normal changes for light that comes from `back` and leaves along `on` (Veach 1997, equation 5.19): the camera's
/// estimate weighs arriving light by its cosine with the shading normal, and so must the particles'.
fn adjoint(hit: &SurfaceHit, back: DVec3, on: DVec3) -> f32 {
    let shading = hit.frame.z.as_dvec3();
    let ratio = |d: DVec3| (d.dot(shading) / d.dot(hit.normal)).abs();
    (ratio(back) / ratio(on)) as f32
}

const PHOTON: u64 = of_name("photon");
const PICK: u64 = of_name("pick");
const PLACE: u64 = of_name("place");
const DIRECTION: u64 = of_name("direction");
const TIME: u64 = of_name("time");
const WAVELENGTH: u64 = of_name("wavelength");
const LOBE: u64 = of_name("lobe");
const BOUNCE: u64 = of_name("bounce");
const ROULETTE: u64 = of_name("roulette");
