//! Photons on their way: out of the lights, from surface to surface, a record where they land on something matte.
//!
//! Photon number i of all passes together is a pure function of i and the seed; a pass takes a stretch of them, in ranges that
//! threads share out, put together in order.

use super::map::Photon;
use crate::frames::bodies_around;
use crate::integrators::{MediumStack, PathState, RayKind, crossing};
use crate::lights::LightEntry;
use crate::lights::emit::{BoundingSphere, share_at};
use crate::sampler::{Sampler, SamplerKind};
use crate::scene::{AlphaFilter, Scene, SurfaceHit};
use crate::statistics::Statistics;
use kirkas_accel::{Hit, Query};
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::{DVec3, Ray};
use kirkas_optics::{Lanes, Light, LobeSet, Mode};
use rayon::prelude::*;
use std::ops::Range;

/// What all photons of a pass have in common.
pub struct Tracer<'a> {
    scene: &'a Scene,
    seed: u64,
    lanes: Lanes,
    time: f64,
    most_bounces: u32,
    bounds: BoundingSphere,
    /// Shares of the lights' power, summed up; empty if there is none.
    sums: Vec<f64>,
    /// Per light: bodies that it stands in.
    media: Vec<MediumStack>,
}

/// A photon that may land somewhere yet.
struct Flying {
    path: PathState,
    sampler: Sampler,
    group: u32,
    attenuation: Option<[f64; 3]>,
}

/// Photons that travel together.
const RANGE: u64 = 2048;

/// Of every choice by power, the part that is spread evenly: an estimate of power may be wrong.
const EVEN_SHARE: f64 = 0.02;

/// Even where nothing is absorbed every photon ends.
const MOST_CHANCE: f32 = 0.98;

impl<'a> Tracer<'a> {
    /// For photons with `lanes` at `time`, which surfaces scatter at most `most_bounces` times before they land.
    pub fn new(scene: &'a Scene, seed: u64, lanes: Lanes, time: f64, most_bounces: u32) -> Self {
        let bounds = scene.bounding_sphere(time);
        let power = |l: &LightEntry| l.lamp.power(&scene.materials, &scene.textures, bounds.radius);
        let powers = scene.lights.iter().map(power).map(|p| if p.is_finite() { p.max(0.0) } else { 0.0 });
        let powers: Vec<f64> = powers.collect();
        let total: f64 = powers.iter().sum();
        let even = 1.0 / powers.len().max(1) as f64;
        let share = |p: f64| if total > 0.0 { EVEN_SHARE * even + (1.0 - EVEN_SHARE) * p / total } else { even };
        let mut sum = 0.0;
        let sums = powers.iter().map(|&p| (sum += share(p), sum).1).collect();
        let mut tracer = Tracer { scene, seed, lanes, time, most_bounces, bounds, sums, media: Vec::new() };
        tracer.media = scene.lights.iter().map(|l| tracer.bodies_of(l)).collect();
        tracer
    }

    /// The bodies around a light; a lamp stands in them as a whole.
    fn bodies_of(&self, light: &LightEntry) -> MediumStack {
        let things = (&self.scene.materials[..], &self.scene.textures);
        let middle = ((0.5, 0.5), (0.3, 0.5));
        match light.lamp.emit(&self.lanes, things, &self.bounds, self.time, middle) {
            Some(e) if !light.lamp.is_far() => bodies_around(self.scene, &e.ray),
            _ => MediumStack::EMPTY,
        }
    }

    /// Where photons `all` land after at least one bounce, each with its share of the power.
    pub fn trace(&self, all: Range<u64>) -> (Vec<Photon>, Statistics) {
        let count = all.end.saturating_sub(all.start);
        let ranges: Vec<Range<u64>> = (0..count.div_ceil(RANGE))
            .map(|n| all.start + n * RANGE..(all.start + (n + 1) * RANGE).min(all.end))
            .collect();
        let share = 1.0 / count.max(1) as f32;
        let parts: Vec<_> = ranges.into_par_iter().map(|range| self.trace_range(range, share)).collect();
        let counted = parts.iter().fold(Statistics::default(), |all, p| all.plus(&p.1));
        (parts.into_iter().flat_map(|p| p.0).collect(), counted)
    }

    fn trace_range(&self, range: Range<u64>, share: f32) -> (Vec<Photon>, Statistics) {
        let (mut landed, mut counted) = (Vec::new(), Statistics::default());
        let mut flying: Vec<Flying> = range.filter_map(|i| self.launch(i, share)).collect();
        while !flying.is_empty() {
            let hits = self.find_hits(&flying, &mut counted);
            let next = flying.iter().zip(hits).filter_map(|(f, hit)| self.step(f, &hit?, &mut landed)).collect();
            flying = next;
        }
        (landed, counted)
    }

    fn find_hits(&self, flying: &[Flying], counted: &mut Statistics) -> Vec<Option<Hit>> {
        let rays: Vec<Ray> = flying.iter().map(|f| f.path.ray).collect();
        let keys: Vec<u64> = flying.iter().map(|f| combine(f.sampler.key(), f.path.branch)).collect();
        let mut hits = vec![None; rays.len()];
        let filter = AlphaFilter { scene: self.scene, keys: &keys };
        self.scene.accel.closest_hits(&rays, Query::filtered(&filter), &mut hits, &mut counted.search);
        counted.photon_rays += rays.len() as u64;
        counted.hits += hits.iter().flatten().count() as u64;
        hits
    }

    /// Photon number `index` as it leaves its light.
    fn launch(&self, index: u64, share: f32) -> Option<Flying> {
        let seed = combine(combine(self.seed, PHOTON), index >> 32);
        let sampler = Sampler::new(SamplerKind::Sobol, seed, 0, 0, index as u32);
        let u = f64::from(sampler.one(PICK)) * self.sums.last()?;
        let number = self.sums.partition_point(|&s| s <= u).min(self.sums.len() - 1);
        let before = number.checked_sub(1).map_or(0.0, |n| self.sums[n]);
        let chance = (self.sums[number] - before) / self.sums.last()?;
        let light = &self.scene.lights[number];
        let things = (&self.scene.materials[..], &self.scene.textures);
        let places = (sampler.pair(PLACE), sampler.pair(DIRECTION));
        let e = light.lamp.emit(&self.lanes, things, &self.bounds, self.time, places)?;
        let power = e.power * (share / chance as f32);
        let path = PathState {
            ray: e.ray,
            lanes: self.lanes,
            throughput: power,
            depth: 0,
            kind: RayKind::Camera,
            branch: 0,
            media: self.media[number],
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

    /// A photon lands, if the surface keeps records, and goes on, if it can.
    fn step(&self, flying: &Flying, hit: &Hit, landed: &mut Vec<Photon>) -> Option<Flying> {
        let (scene, sampler) = (self.scene, &flying.sampler);
        let mut path = flying.path;
        let hit = scene.surface(&path.ray, hit);
        let way = f64::from(hit.t * path.ray.direction.length());
        path.throughput *= scene.clearness(&path.lanes, &path.media, way);
        if crossing::is_covered(scene, &path, &hit) {
            return Some(Flying { path: crossing::passed(&path, &hit)?, ..*flying });
        }
        if path.depth == 0 {
            path.throughput *= share_at(flying.attenuation, f64::from(path.travelled) + way);
        }

        // Keep what has been scattered before: direct light is asked for.
        let back = -path.ray.direction.normalize();
        let bsdf = crossing::bsdf(scene, &path, &hit);
        let wo = hit.frame.to_local(back);
        if path.depth > 0 && bsdf.lobes().intersects(LobeSet::DIFFUSE) {
            let side = if hit.is_front { hit.normal } else { -hit.normal };
            landed.push(Photon {
                position: hit.position.as_vec3(),
                wi: back,
                normal: side.as_vec3(),
                power: path.throughput,
                group: flying.group,
                bounces: path.depth,
                is_alone: path.lanes.is_alone(),
            });
        }
        if path.depth >= self.most_bounces {
            return None;
        }

        // Scatter.
        let purpose = |p| combine(path.branch, p);
        let s =
            bsdf.sample(wo, sampler.one(purpose(LOBE)), sampler.pair(purpose(BOUNCE)), LobeSet::ALL, Mode::Importance)?;
        let direction = hit.frame.to_world(s.wi).as_dvec3().normalize();
        if !crossing::keeps_side(&hit, direction, s.lobe) {
            return None;
        }
        let mut power: Light = path.throughput * s.weight() * adjoint(&hit, back.as_dvec3(), direction);

        // Go on as probably as power is left, so that all photons weigh about the same (Jensen 1996).
        let chance = (power.max_component() / path.throughput.max_component()).min(MOST_CHANCE);
        let branch = purpose(BOUNCE);
        if sampler.one(combine(branch, ROULETTE)) >= chance || !power.is_finite() {
            return None;
        }
        power *= 1.0 / chance;
        let next = PathState {
            ray: hit.ray_towards(direction, &path.ray),
            lanes: s.lanes(path.lanes),
            throughput: power,
            depth: path.depth + 1,
            branch,
            media: crossing::media_towards(scene, &path.media, &hit, direction),
            passed: 0,
            travelled: 0.0,
            ..path
        };
        Some(Flying { path: next, sampler: *sampler, ..*flying })
    }
}

/// What a shading normal changes for light that comes from `back` and leaves along `on` (Veach 1997, equation 5.19): the camera's
/// estimate weighs arriving light by its cosine with the shading normal, and so must the photons'.
pub fn adjoint(hit: &SurfaceHit, back: DVec3, on: DVec3) -> f32 {
    let shading = hit.frame.z.as_dvec3();
    let ratio = |d: DVec3| (d.dot(shading) / d.dot(hit.normal)).abs();
    (ratio(back) / ratio(on)) as f32
}

const PHOTON: u64 = of_name("photon");
const PICK: u64 = of_name("pick");
const PLACE: u64 = of_name("place");
const DIRECTION: u64 = of_name("direction");
const LOBE: u64 = of_name("lobe");
const BOUNCE: u64 = of_name("bounce");
const ROULETTE: u64 = of_name("roulette");
