//! The driver: moves many paths at once through a tile, one step each per round, so that the kernel always gets batches.
//!
//! Nothing here changes what a sample is: flocks of any size give the same bits, because every sample adds integers.

use crate::film::spectral::LaneSums;
use crate::film::{AovSample, FinishedSample, Tile, fixed};
use crate::integrators::crossing;
use crate::integrators::{Blocker, PathState, RayKind, ShadowRay, StepOutput};
use crate::observe::{Observer, SampleId, Step};
use crate::render::Renderer;
use crate::sampler::Sampler;
use crate::scene::{AlphaFilter, SurfaceHit};
use crate::statistics::Statistics;
use kirkas_accel::{Hit, Query};
use kirkas_geometry::Ray;
use kirkas_geometry::hash::combine;
use kirkas_optics::{FilmWeights, Light};

/// One sample under way.
struct Slot {
    id: SampleId,
    pixel: usize,
    sampler: Sampler,
    film_weights: FilmWeights,
    /// The filter's weight.
    weight: f32,
    /// Rays that may still bring light.
    pending: u32,
    sums: Vec<[i128; 3]>,
    lanes: Option<LaneSums>,
    is_invalid: bool,
    aov: Option<AovSample>,
}

/// The working state of one thread.
pub(crate) struct Flock<'a, O: Observer> {
    renderer: &'a Renderer<'a>,
    observer: &'a mut O,
    size: usize,
    slots: Vec<Slot>,
    free: Vec<usize>,
    /// Paths under way.
    active: Vec<PathState>,
    /// The sample of each, by slot.
    active_slots: Vec<usize>,
    /// From here on, `active` are new camera rays.
    first_from_camera: Option<usize>,
    /// The samples of the paths that wait in `out`, the youngest on top: memory stays bounded by depth and branching.
    waiting_slots: Vec<usize>,
    /// The samples of the shadow rays that wait in `out`.
    shadow_slots: Vec<usize>,
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    blocked: Vec<bool>,
    out: StepOutput,
    statistics: Statistics,
}

impl<'a, O: Observer> Flock<'a, O> {
    pub(crate) fn new(renderer: &'a Renderer<'a>, size: usize, observer: &'a mut O) -> Self {
        let mut out = StepOutput::default();
        out.notes.are_wanted = observer.wants_steps();
        Flock {
            renderer,
            observer,
            size: size.max(1),
            slots: Vec::new(),
            free: Vec::new(),
            active: Vec::new(),
            active_slots: Vec::new(),
            first_from_camera: None,
            waiting_slots: Vec::new(),
            shadow_slots: Vec::new(),
            rays: Vec::new(),
            hits: Vec::new(),
            blocked: Vec::new(),
            out,
            statistics: Statistics::default(),
        }
    }

    /// Take the given samples of the tile.
    pub(crate) fn run(mut self, tile: &mut Tile, samples: impl Iterator<Item = (usize, SampleId)>) -> Statistics {
        let mut samples = samples;
        loop {
            // Gather a flock: branches first, then new camera rays.
            self.take_waiting();
            self.first_from_camera = None;
            while self.active.len() < self.size {
                let Some((pixel, id)) = samples.next() else { break };
                self.first_from_camera.get_or_insert(self.active.len());
                self.launch(pixel, id);
            }
            if self.active.is_empty() {
                return self.statistics.plus(&self.out.counted);
            }

            // Find what they hit.
            self.trace_active();

            // Step each path.
            let (active, hits) = (std::mem::take(&mut self.active), std::mem::take(&mut self.hits));
            for (i, (path, hit)) in active.iter().zip(&hits).enumerate() {
                self.step(path, self.active_slots[i], *hit);
                if self.shadow_slots.len() >= MOST_SHADOWS {
                    self.trace_shadows();
                }
            }
            (self.active, self.hits) = (active, hits);

            // Ask whether the lights are seen.
            self.trace_shadows();

            // Put finished samples on the film.
            for i in 0..self.active.len() {
                self.finish(self.active_slots[i], tile);
            }
        }
    }

    /// Let the youngest paths that wait go on.
    fn take_waiting(&mut self) {
        self.active.clear();
        self.active_slots.clear();
        let waiting = &mut self.out.paths;
        if waiting.len() <= self.size {
            std::mem::swap(&mut self.active, waiting);
            std::mem::swap(&mut self.active_slots, &mut self.waiting_slots);
        } else {
            let first = waiting.len() - self.size;
            self.active.extend(waiting.drain(first..));
            self.active_slots.extend(self.waiting_slots.drain(first..));
        }
    }

    fn launch(&mut self, pixel: usize, id: SampleId) {
        let sampler = self.renderer.sampler(id);
        let start = self.renderer.camera_path(&sampler, id);
        let film_weights = start.path.lanes.film_weights();
        let planes = self.renderer.planes;
        let lanes = self.renderer.bins.map(|b| LaneSums::new(&b, &start.path.lanes));
        let landed = self.renderer.integrator.landed(id.x, id.y);
        if let Some(landed) = landed {
            landed.sums.iter().enumerate().for_each(|(group, &sum)| self.observer.landed(id, group as u32, sum));
        }
        let new = |mut sums: Vec<[i128; 3]>| {
            sums.clear();
            match landed {
                Some(landed) => sums.extend(landed.sums),
                None => sums.resize(planes, [0; 3]),
            }
            Slot {
                id,
                pixel,
                sampler,
                film_weights,
                weight: start.weight,
                pending: 1,
                sums,
                lanes,
                is_invalid: landed.is_some_and(|l| l.is_invalid),
                aov: None,
            }
        };
        let index = match self.free.pop() {
            Some(i) => {
                let sums = std::mem::take(&mut self.slots[i].sums);
                self.slots[i] = new(sums);
                i
            }
            None => {
                self.slots.push(new(Vec::new()));
                self.slots.len() - 1
            }
        };
        self.statistics.samples += 1;
        self.statistics.lens_samples += u64::from(start.uses_lens);
        self.statistics.time_samples += u64::from(start.uses_time);
        self.active.push(start.path);
        self.active_slots.push(index);
    }

    fn trace_active(&mut self) {
        self.rays.clear();
        for (path, &slot) in self.active.iter().zip(&self.active_slots) {
            self.observer.ray(self.slots[slot].id, path);
            self.rays.push(path.ray);
            match path.kind {
                RayKind::Camera => self.statistics.camera_rays += 1,
                RayKind::Reflected => self.statistics.reflected_rays += 1,
                RayKind::Refracted => self.statistics.refracted_rays += 1,
                RayKind::Glossy => self.statistics.glossy_rays += 1,
                RayKind::Diffuse => self.statistics.diffuse_rays += 1,
            }
        }
        let (scene, search) = (self.renderer.scene, &mut self.statistics.search);
        let (slots, active, active_slots) = (&self.slots, &self.active, &self.active_slots);
        let key = |i: usize| combine(slots[active_slots[i]].sampler.key(), active[i].branch);
        // Camera rays run close together.
        let first_coherent = self.first_from_camera.unwrap_or(active.len());
        let (strewn, together) = self.rays.split_at(first_coherent);
        self.hits.clear();
        self.hits.resize(self.rays.len(), None);
        let (strewn_hits, together_hits) = self.hits.split_at_mut(first_coherent);
        let filter = AlphaFilter { scene, key };
        scene.accel.closest_hits(strewn, Query::filtered(&filter), strewn_hits, search);
        let filter = AlphaFilter { scene, key: |i| key(first_coherent + i) };
        scene.accel.closest_hits_coherent(together, Query::filtered(&filter), together_hits, search);
        self.statistics.hits += self.hits.iter().flatten().count() as u64;
    }

    fn step(&mut self, path: &PathState, slot_index: usize, hit: Option<Hit>) {
        let scene = self.renderer.scene;
        // Where it is made it stays.
        let found;
        let surface = match &hit {
            Some(hit) => {
                found = scene.surface_seen(&path.ray, hit, path.cone);
                Some(&found)
            }
            None => None,
        };
        let slot = &mut self.slots[slot_index];
        if let Some(s) = surface {
            self.observer.hit(slot.id, path, s);
        }
        let is_seen = |s: &SurfaceHit| !crossing::is_covered(scene, path, s);
        let looks = self.renderer.keeps_aovs && path.kind == RayKind::Camera && slot.aov.is_none();
        if looks && surface.is_none_or(is_seen) {
            slot.aov = Some(surface.map_or_else(AovSample::default, |s| self.renderer.aov(path, s)));
        }
        self.renderer.integrator.step(scene, path, &slot.sampler, surface, &mut self.out);
        if self.out.notes.are_wanted {
            let step = Step {
                notes: &self.out.notes.list,
                paths: &self.out.paths[self.waiting_slots.len()..],
                shadow_rays: &self.out.shadow_rays[self.shadow_slots.len()..],
            };
            self.observer.step(slot.id, path, &step);
            self.out.notes.list.clear();
        }
        for (light, group) in self.out.contributions.drain(..) {
            add(self.renderer, slot, self.observer, path.branch, light, group);
        }
        if let Some(why) = self.out.end.take() {
            self.observer.end(slot.id, path.branch, why);
        }
        let (paths, shadow_rays) = (self.out.paths.len(), self.out.shadow_rays.len());
        slot.pending += (paths - self.waiting_slots.len() + shadow_rays - self.shadow_slots.len()) as u32;
        slot.pending -= 1;
        self.waiting_slots.resize(paths, slot_index);
        self.shadow_slots.resize(shadow_rays, slot_index);
    }

    fn trace_shadows(&mut self) {
        let scene = self.renderer.scene;
        let mut shadows = std::mem::take(&mut self.out.shadow_rays);
        let mut slots = std::mem::take(&mut self.shadow_slots);
        while !shadows.is_empty() {
            self.rays.clear();
            self.rays.extend(shadows.iter().map(|s| s.ray));
            self.statistics.shadow_rays += shadows.len() as u64;
            let (samples, search) = (&self.slots, &mut self.statistics.search);
            let key = |i: usize| AlphaFilter::shadow_key(&samples[slots[i]].sampler, shadows[i].branch);
            let filter = AlphaFilter { scene, key };

            // Plain ones want a yes or no; filtered ones walk from surface to surface.
            if shadows.iter().any(|s| s.blocked_by != Blocker::Anything) {
                self.hits.clear();
                self.hits.resize(self.rays.len(), None);
                scene.accel.closest_hits(&self.rays, Query::filtered(&filter), &mut self.hits, search);
                let keys: Vec<u64> = (0..shadows.len()).map(key).collect();
                let (mut on, mut on_slots) = (Vec::new(), Vec::new());
                for (i, s) in shadows.iter().enumerate() {
                    match self.hits[i] {
                        None => self.answer(&ShadowRay { light: scene.arrived(s, keys[i]), ..*s }, slots[i], false),
                        Some(hit) => match scene.weakened(s, &hit, keys[i]) {
                            Some(weaker) => {
                                on.push(weaker);
                                on_slots.push(slots[i]);
                            }
                            None => self.answer(s, slots[i], true),
                        },
                    }
                }
                (shadows, slots) = (on, on_slots);
            } else {
                self.blocked.clear();
                self.blocked.resize(self.rays.len(), false);
                scene.accel.any_hits(&self.rays, Query::filtered(&filter), &mut self.blocked, search);
                for (i, s) in shadows.iter().enumerate() {
                    self.answer(s, slots[i], self.blocked[i]);
                }
                shadows.clear();
                slots.clear();
            }
        }
        (self.out.shadow_rays, self.shadow_slots) = (shadows, slots);
    }

    fn answer(&mut self, s: &ShadowRay, slot: usize, blocked: bool) {
        let slot = &mut self.slots[slot];
        slot.pending -= 1;
        self.observer.shadow(slot.id, s, blocked);
        if !blocked {
            add(self.renderer, slot, self.observer, s.branch, s.light, s.group);
        }
    }

    fn finish(&mut self, slot_index: usize, tile: &mut Tile) {
        let slot = &mut self.slots[slot_index];
        if slot.pending > 0 || slot.pixel == DONE {
            return;
        }
        let aov = slot.aov.unwrap_or_default();
        let sample = FinishedSample { sums: &slot.sums, lanes: slot.lanes.as_ref(), is_invalid: slot.is_invalid, aov };
        tile.add(slot.pixel, slot.id, &sample);
        slot.pixel = DONE;
        self.free.push(slot_index);
    }
}

/// Shadow rays that wait at most (but for those of one step): memory stays bounded with any number of lights.
const MOST_SHADOWS: usize = 4096;

/// `Slot::pixel` of a slot whose sample is on the film already.
const DONE: usize = usize::MAX;

/// Round a contribution once and add it to its sample.
fn add(r: &Renderer, slot: &mut Slot, observer: &mut impl Observer, branch: u64, light: Light, group: u32) {
    let rgb = slot.film_weights.apply(light);
    let share = within(rgb, r.clamp);
    let rgb = rgb.map(|c| c * share);
    let parts = rgb.map(|c| fixed::from_f64(f64::from(c) * f64::from(slot.weight)));
    let (Some(red), Some(green), Some(blue)) = (parts[0], parts[1], parts[2]) else {
        observer.invalid(slot.id, branch, group, light);
        slot.is_invalid = true;
        return;
    };
    let factor = f64::from(share) * f64::from(slot.weight);
    if slot.lanes.as_mut().is_some_and(|lanes| !lanes.add(light, factor)) {
        observer.invalid(slot.id, branch, group, light);
        slot.is_invalid = true;
        return;
    }
    let sum = &mut slot.sums[if r.planes > 1 { group as usize } else { 0 }];
    *sum = [sum[0] + red, sum[1] + green, sum[2] + blue];
    observer.contribution(slot.id, branch, group, light, [red, green, blue]);
}

/// The share of a colour that has no channel beyond `most`; 0 = all of it.
pub(crate) fn within(rgb: [f32; 3], most: f32) -> f32 {
    let greatest = rgb[0].abs().max(rgb[1].abs()).max(rgb[2].abs());
    if most > 0.0 && greatest > most { most / greatest } else { 1.0 }
}
