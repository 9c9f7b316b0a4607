//! The main path, on one page: for every pass, tile, pixel and sample, a camera ray; then flocks until all is added up.

use crate::camera::CameraSample;
use crate::film::adaptive::ErrorTarget;
use crate::film::filter::Filter;
use crate::film::{AovSample, Film, SpectralBins, Tile};
use crate::flock::Flock;
use crate::integrators::{Integrator, Pass, PathState, RayKind};
use crate::observe::{Observer, SampleId};
use crate::sampler::{Sampler, SamplerKind};
use crate::scene::{PRIMARY, Scene, SurfaceHit};
use crate::statistics::Statistics;
use crate::textures::RayCone;
use kirkas_geometry::hash::of_name;
use rayon::prelude::*;
use std::ops::Range;

/// Everything that a sample depends on.
pub struct Renderer<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How light is found.
    pub integrator: &'a dyn Integrator,
    /// Pixel filter.
    pub filter: &'a Filter,
    /// Which sample points.
    pub sampler: SamplerKind,
    /// Which of all pictures.
    pub seed: u64,
    /// When blocks of pixels have samples enough; `None` = never.
    pub target: Option<ErrorTarget>,
    /// The most that a channel of one contribution brings; 0 = no clamp.
    pub clamp: f32,
    /// Moves every sample on the film, in pixels, x right, y down.
    pub shift: [f64; 2],
    /// The whole image, in pixels.
    pub resolution: (u32, u32),
    /// Light groups that are kept apart; 1 = all in one.
    pub planes: usize,
    /// Light by wavelength is kept as well.
    pub bins: Option<SpectralBins>,
    /// Whether first hits are recorded.
    pub keeps_aovs: bool,
    /// Rays that travel together.
    pub flock: usize,
}

/// The caller's say in a render.
pub trait Control: Sync {
    /// Called when `samples` more samples of pixels are done.
    fn progress(&self, _samples: u64) {}
    /// Called now and then between tiles with a consistent film: a chance to save it. `false` stops at once.
    fn between(&self, _film: &Film) -> bool {
        true
    }
    /// Called after each pass over the image, all pixels that go on having equally many samples. `false` stops.
    fn after_pass(&self, _film: &Film) -> bool {
        true
    }
}

/// Never interrupts.
pub struct Undisturbed;
impl Control for Undisturbed {}

/// A camera ray and what comes with it.
pub(crate) struct Start {
    pub path: PathState,
    pub weight: f32,
    pub uses_lens: bool,
    pub uses_time: bool,
}

/// Samples per pass at most; the first passes are shorter, so that a picture appears soon.
const LONGEST_PASS: u32 = 16;

/// Tiles for each thread between two calls of `Control::between`.
const TILES_PER_THREAD: usize = 16;

impl Renderer<'_> {
    /// Bring every pixel of `film` to samples `samples`, but for those that adaptive sampling stops. Pixels that have some
    /// already (resumed, stopped) get the rest: a tile that has taken n of them goes on with `samples.start + n`.
    pub fn render(&self, film: &mut Film, samples: Range<u32>, control: &dyn Control) -> Statistics {
        let mut statistics = Statistics::default();
        while let Some(taken) = self.going_on(film) {
            let done = samples.start.saturating_add(taken);
            if done >= samples.end {
                break;
            }
            let prepared = self.integrator.prepare_pass(self, done);
            let longest = if prepared.is_some() { 1 } else { LONGEST_PASS };
            let renderer = self.with_pass(prepared.as_ref());
            statistics = prepared.as_ref().map_or(statistics, |p| statistics.plus(&p.counted));
            let to_round = self.target.map_or(u32::MAX, |t| t.next_round(taken) - taken);
            let pass_end = done + taken.clamp(1, longest).min(samples.end - done).min(to_round);
            let (tiles, at_once) = (film.tiles.len(), TILES_PER_THREAD * rayon::current_num_threads());
            for first in (0..tiles).step_by(at_once) {
                let chunk = &mut film.tiles[first..(first + at_once).min(tiles)];
                let counted = chunk
                    .par_iter_mut()
                    .map(|tile| {
                        let s = renderer.render_tile(tile, samples.start, pass_end, &mut ());
                        control.progress(s.samples);
                        s
                    })
                    .reduce(Statistics::default, |a, b| a.plus(&b));
                statistics = statistics.plus(&counted);
                if !control.between(film) {
                    return statistics;
                }
            }
            if !control.after_pass(film) {
                break;
            }
        }
        statistics
    }

    /// The same with what its integrator prepared for one sample index.
    fn with_pass<'b>(&'b self, pass: Option<&'b Pass>) -> Renderer<'b> {
        Renderer { integrator: pass.map_or(self.integrator, |p| &*p.integrator), ..*self }
    }

    /// Stop what has samples enough; the fewest that a pixel which goes on has, if any does.
    fn going_on(&self, film: &mut Film) -> Option<u32> {
        let (least, most) = film.going_on()?;
        match self.target.filter(|t| least == most && t.is_round(least)) {
            Some(target) => {
                film.judge(&target);
                film.going_on().map(|g| g.0)
            }
            None => Some(least),
        }
    }

    /// Take the samples of a tile that are missing up to (not including) sample `end`.
    fn render_tile<O: Observer>(&self, tile: &mut Tile, start: u32, end: u32, observer: &mut O) -> Statistics {
        let rect = tile.rect;
        let Some(taken) = tile.counts.iter().find(|c| !c.is_stopped).map(|c| c.taken) else {
            return Statistics::default();
        };
        let first = start + taken;
        let is_stopped: Vec<bool> = tile.counts.iter().map(|c| c.is_stopped).collect();
        let samples = near_to_near(rect.width(), rect.height()).flat_map(move |(x, y)| {
            let pixel = y as usize * rect.width() as usize + x as usize;
            let end = if is_stopped[pixel] { first } else { end };
            (first..end).map(move |sample| (pixel, SampleId { x: rect.x0 + x, y: rect.y0 + y, sample }))
        });
        Flock::new(self, self.flock, observer).run(tile, samples)
    }

    /// Replay samples of one pixel before an observer; the film's tile for that pixel alone.
    pub fn replay<O: Observer>(&self, x: u32, y: u32, samples: Range<u32>, observer: &mut O) -> Tile {
        let rect = crate::film::Rect { x0: x, y0: y, x1: x + 1, y1: y + 1 };
        let layout = crate::film::FilmLayout {
            size: self.resolution,
            crop: rect,
            groups: vec![String::new(); if self.planes > 1 { self.planes } else { 0 }],
            aovs: Default::default(),
            bins: self.bins,
        };
        let mut film = Film::new(layout);
        for sample in samples.clone() {
            let prepared = self.integrator.prepare_pass(self, sample);
            let tile = &mut film.tiles[0];
            self.with_pass(prepared.as_ref()).render_tile(tile, samples.start, sample + 1, observer);
        }
        film.tiles.swap_remove(0)
    }

    /// The numbers of a sample.
    pub fn sampler(&self, id: SampleId) -> Sampler {
        Sampler::new(self.sampler, self.seed, id.x, id.y, id.sample)
    }

    /// The camera ray of a sample.
    pub(crate) fn camera_path(&self, sampler: &Sampler, id: SampleId) -> Start {
        let camera = &self.scene.camera;
        let place = self.filter.sample(sampler.pair(FILTER));
        let (open, close) = camera.shutter();
        let (uses_lens, uses_time) = (camera.uses_lens(), close > open);
        let shared = self.integrator.shared();
        let moment = || shared.map_or_else(|| sampler.one(TIME), |s| s.moment);
        let sample = CameraSample {
            film: (
                f64::from(id.x) + 0.5 + f64::from(place.offset.0) + self.shift[0],
                f64::from(id.y) + 0.5 + f64::from(place.offset.1) + self.shift[1],
            ),
            lens: if uses_lens { sampler.pair(LENS) } else { (0.5, 0.5) },
            time: if uses_time { camera.time_at(moment()) } else { open },
        };
        let mut ray = camera.ray(&sample, self.resolution);
        ray.mask = PRIMARY;
        let cone = match self.scene.texture_footprint {
            0.0 => RayCone::POINT,
            pixels => camera.cone(&sample, self.resolution).times(pixels),
        };
        let lanes = shared.map_or_else(|| self.scene.lanes(|| sampler.one(WAVELENGTH)), |s| s.lanes);
        let path = PathState {
            ray,
            lanes,
            throughput: lanes.one() * self.scene.camera_gain(&lanes),
            depth: 0,
            kind: RayKind::Camera,
            branch: 0,
            media: self.scene.camera_media,
            cone,
            passed: 0,
            travelled: 0.0,
            last: None,
        };
        Start { path, weight: place.weight, uses_lens, uses_time }
    }

    /// What the AOVs keep of a first hit.
    pub(crate) fn aov(&self, path: &PathState, hit: &SurfaceHit) -> AovSample {
        let n = hit.frame.z;
        let p = hit.position.as_vec3();
        AovSample {
            is_hit: true,
            depth: path.travelled + hit.t * path.ray.direction.length(),
            normal: n.to_array(),
            albedo: self.scene.material(hit).albedo(&self.scene.textures, &hit.texture),
            position: p.to_array(),
            object: hit.object + 1,
            material: hit.material + 1,
        }
    }
}

/// The places of a rectangle along a Z-curve (Morton 1966): what is near in the walk is near in the picture.
fn near_to_near(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    let edge = u64::from(width.max(height).next_power_of_two());
    (0..edge * edge).map(|n| (even_bits(n), even_bits(n >> 1))).filter(move |&(x, y)| x < width && y < height)
}

/// Every other bit of `n`, the lowest first, moved together.
fn even_bits(n: u64) -> u32 {
    let mut x = n & 0x5555_5555_5555_5555;
    for (shift, mask) in [
        (1, 0x3333_3333_3333_3333),
        (2, 0x0f0f_0f0f_0f0f_0f0f),
        (4, 0x00ff_00ff_00ff_00ff),
        (8, 0x0000_ffff_0000_ffff),
        (16, 0xffff_ffff),
    ] {
        x = (x | x >> shift) & mask;
    }
    x as u32
}

const FILTER: u64 = of_name("filter");
const LENS: u64 = of_name("lens");
const TIME: u64 = of_name("time");
const WAVELENGTH: u64 = of_name("wavelength");

#[cfg(test)]
mod tests {
    use super::near_to_near;

    #[test]
    fn a_walk_over_a_tile_takes_every_pixel_once_in_blocks() {
        for (width, height) in [(1, 1), (32, 32), (5, 3), (32, 7)] {
            let mut walk: Vec<_> = near_to_near(width, height).collect();
            walk.sort_unstable();
            let all: Vec<_> = (0..width).flat_map(|x| (0..height).map(move |y| (x, y))).collect();
            assert_eq!(walk, all);
        }
        let walk: Vec<_> = near_to_near(32, 32).collect();
        for block in walk.chunks(64) {
            assert!(block.iter().all(|&(x, y)| (x / 8, y / 8) == (block[0].0 / 8, block[0].1 / 8)));
        }
    }
}
