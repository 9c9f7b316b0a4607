//! Meshes that shine, in pieces: each triangle, or of millions a few neighbours, is a leaf of the light tree, so that of a large or scattered lamp
//! those are asked that matter (Conty Estevez & Kulla 2018 give each triangle its leaf).
//!
//! The picker numbers lights and pieces through: first the lights of the scene, then the pieces. A light in pieces is never picked
//! as a whole. Pieces are sampled evenly by area; powers only guide the choice, so that textures may be guessed.

use super::{AreaLight, Lamp, LightEntry, pick::Reach};
use crate::materials::Material;
use crate::shapes::{AreaSample, Detail, Surface};
use crate::textures::Textures;
use kirkas_geometry::{Bounds3, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A lamp of no more facets stays whole: two make a pane.
const WHOLE: usize = 2;
/// Pieces are of one facet each while all lamps together have no more than this; then of as many more.
const MANY: usize = 1 << 18;

/// The pieces of all lights.
#[derive(Clone)]
pub struct Pieces {
    /// Per light: its pieces, if it has some.
    lights: Vec<Option<InPieces>>,
    /// Per piece its light.
    light_of: Vec<u32>,
}

#[derive(Clone)]
struct InPieces {
    /// Number of its first piece, as pickers count.
    first: u32,
    runs: Arc<Runs>,
}

/// The facets of a surface, parted into runs of neighbours.
struct Runs {
    /// Where each run starts in `facets`; at last their number.
    starts: Vec<u32>,
    facets: Vec<u32>,
    /// Area of a run up to and with each facet, part space.
    sums: Vec<f32>,
    /// Per facet its run.
    run_of: Vec<u32>,
}

impl Pieces {
    /// Of all lights whose surfaces have many facets.
    pub fn new(lights: &[LightEntry]) -> Self {
        let facets = |l: &LightEntry| match &l.lamp {
            Lamp::Area(a) => a.surface.facet_count() as usize,
            _ => 0,
        };
        let size = lights.iter().map(facets).sum::<usize>().div_ceil(MANY).max(1);
        // Looked up, never walked: instances share the runs of their surface.
        let mut known: BTreeMap<usize, Arc<Runs>> = BTreeMap::new();
        let mut pieces = Pieces { lights: Vec::with_capacity(lights.len()), light_of: Vec::new() };
        for (number, light) in lights.iter().enumerate() {
            let own = match &light.lamp {
                Lamp::Area(a) if facets(light) > size.max(WHOLE) => {
                    let key = Arc::as_ptr(&a.surface).cast::<()>() as usize;
                    let runs = known.entry(key).or_insert_with(|| Arc::new(Runs::new(&*a.surface, size))).clone();
                    let first = (lights.len() + pieces.light_of.len()) as u32;
                    pieces.light_of.extend(std::iter::repeat_n(number as u32, runs.starts.len() - 1));
                    Some(InPieces { first, runs })
                }
                _ => None,
            };
            pieces.lights.push(own);
        }
        pieces
    }

    /// None, of so many lights.
    pub fn whole(lights: usize) -> Self {
        Pieces { lights: vec![None; lights], light_of: Vec::new() }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.light_of.len()
    }

    /// True if no light is in pieces.
    pub fn is_empty(&self) -> bool {
        self.light_of.is_empty()
    }

    /// The light of a number as pickers count.
    pub fn light(&self, number: u32) -> u32 {
        let piece = (number as usize).checked_sub(self.lights.len());
        piece.map_or(number, |p| self.light_of[p])
    }

    /// The number by which pickers know facet `facet` of a light.
    pub fn number(&self, light: u32, facet: u32) -> u32 {
        match self.lights.get(light as usize) {
            Some(Some(own)) => own.first + own.runs.run_of[facet as usize],
            _ => light,
        }
    }

    /// A point of a piece, evenly by area, in part space; `None` for whole lights.
    pub fn sample(&self, number: u32, lamp: &AreaLight, u: (f32, f32), detail: Detail) -> Option<AreaSample> {
        let (runs, run) = self.run(number)?;
        let range = runs.range(run);
        let sums = &runs.sums[range.clone()];
        let total = *sums.last()?;
        let target = u.0 * total;
        let i = sums.partition_point(|&s| s <= target).min(sums.len() - 1);
        let before = if i == 0 { 0.0 } else { sums[i - 1] };
        let rest = ((target - before) / (sums[i] - before)).clamp(0.0, 1.0);
        let s = lamp.surface.sample_facet(runs.facets[range.start + i], (rest, u.1), detail)?;
        Some(AreaSample { pdf_area: 1.0 / f64::from(total), ..s })
    }

    /// Area of a piece, part space; `None` for whole lights.
    pub fn area(&self, number: u32) -> Option<f64> {
        let (runs, run) = self.run(number)?;
        runs.sums[runs.range(run)].last().map(|a| f64::from(*a))
    }

    fn run(&self, number: u32) -> Option<(&Runs, usize)> {
        let light = *self.light_of.get((number as usize).checked_sub(self.lights.len())?)?;
        let own = self.lights[light as usize].as_ref()?;
        Some((&own.runs, (number - own.first) as usize))
    }

    /// Lights and pieces as the tree wants them; `powers` are those of the lights.
    pub fn reaches(
        &self,
        lights: &[LightEntry],
        materials: &[Material],
        textures: &Textures,
        powers: &[f64],
    ) -> Vec<Reach> {
        let is_whole = |n: usize| matches!(self.lights.get(n), None | Some(None));
        let power = |n: usize| if is_whole(n) { powers[n] } else { 0.0 };
        let mut all: Vec<Reach> = lights.iter().enumerate().map(|(n, l)| l.lamp.reach(materials, power(n))).collect();
        for (number, own) in self.lights.iter().enumerate() {
            if let (Some(own), Lamp::Area(lamp)) = (own, &lights[number].lamp) {
                all.extend(own.runs.reaches(lamp, materials, textures, powers[number]));
            }
        }
        all
    }
}

impl Runs {
    fn new(surface: &dyn Surface, size: usize) -> Self {
        let mut facets: Vec<u32> = (0..surface.facet_count()).collect();
        let centers: Vec<DVec3> = facets.iter().map(|&f| surface.facet(f).bounds.center().as_dvec3()).collect();
        let mut runs = Runs { starts: Vec::new(), facets: Vec::new(), sums: Vec::new(), run_of: vec![0; facets.len()] };
        part(&mut facets, &centers, size, 0, &mut runs.starts);
        runs.starts.push(facets.len() as u32);
        runs.facets = facets;
        for run in 0..runs.starts.len() - 1 {
            let mut sum = 0.0;
            for i in runs.range(run) {
                let facet = runs.facets[i];
                sum += surface.facet(facet).area;
                runs.sums.push(sum as f32);
                runs.run_of[facet as usize] = run as u32;
            }
        }
        runs
    }

    fn range(&self, run: usize) -> std::ops::Range<usize> {
        self.starts[run] as usize..self.starts[run + 1] as usize
    }

    /// Each run with its part of `power`: three quarters as its facets glow, the rest by area, for places that no probe saw.
    fn reaches(&self, lamp: &AreaLight, materials: &[Material], textures: &Textures, power: f64) -> Vec<Reach> {
        const BY_AREA: f64 = 0.25;
        let is_two_sided = materials[lamp.material as usize].emission.as_ref().is_some_and(|e| e.two_sided);
        let runs = 0..self.starts.len() - 1;
        let areas: Vec<f64> =
            runs.clone().map(|r| self.sums[self.range(r)].last().map_or(0.0, |a| f64::from(*a))).collect();
        let glow = |&facet: &u32| lamp.surface.facet(facet).area * lamp.glow_of_facet(facet, materials, textures);
        let glows: Vec<f64> = match lamp.is_textured(materials) {
            true => runs.clone().map(|r| self.facets[self.range(r)].iter().map(glow).sum()).collect(),
            false => areas.clone(),
        };
        let (all_area, all_glow): (f64, f64) = (areas.iter().sum(), glows.iter().sum());
        let over = |x: f64, all: f64| if all > 0.0 { x / all } else { 0.0 };
        runs.map(|r| {
            let facets = &self.facets[self.range(r)];
            let bounds = facets.iter().fold(Bounds3::EMPTY, |b, &f| b.union(lamp.surface.facet(f).bounds));
            let normals = super::Cone::around(facets.iter().map(|&f| lamp.surface.facet(f).normal));
            let part = BY_AREA * over(areas[r], all_area) + (1.0 - BY_AREA) * over(glows[r], all_glow);
            Reach::Near(lamp.reach_of(bounds, normals, power * part, is_two_sided))
        })
        .collect()
    }
}

/// Order facets so that neighbours by place make runs of at most `size`, and note where each starts.
fn part(facets: &mut [u32], centers: &[DVec3], size: usize, first: usize, starts: &mut Vec<u32>) {
    if facets.len() <= size {
        starts.push(first as u32);
        return;
    }
    let place = |f: &u32| centers[*f as usize];
    let (low, high) =
        facets.iter().map(place).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
    let extent = (high - low).to_array();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    let middle = facets.len() / 2;
    facets.select_nth_unstable_by(middle, |a, b| place(a)[axis].total_cmp(&place(b)[axis]).then(a.cmp(b)));
    let (left, right) = facets.split_at_mut(middle);
    part(left, centers, size, first, starts);
    part(right, centers, size, first + middle, starts);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Facet, SurfacePoint};
    use crate::textures::SurfacePatch;
    use kirkas_geometry::{DMat3, Ray, Vec3};

    /// Squares in a spiral, larger and larger.
    struct Squares(u32);

    impl Surface for Squares {
        fn point(&self, _: u32, _: f32, _: f32, _: f32, _: &Ray, _: Detail) -> SurfacePoint {
            unreachable!("no ray is traced")
        }
        fn area(&self) -> Option<f64> {
            None
        }
        fn sample_area(&self, _: (f32, f32), _: Detail) -> Option<AreaSample> {
            None
        }
        fn patch(&self, _: u32, _: f32, _: f32, _: &SurfacePoint) -> SurfacePatch {
            unreachable!("no ray is traced")
        }
        fn object_from_part(&self) -> DMat3 {
            DMat3::IDENTITY
        }
        fn bounds(&self) -> Bounds3 {
            Bounds3::EMPTY
        }
        fn facet_count(&self) -> u32 {
            self.0
        }
        fn facet(&self, facet: u32) -> Facet {
            let place = Vec3::new((facet % 31) as f32, (facet % 57) as f32, facet as f32 * 0.01);
            Facet { bounds: Bounds3::from_corners(place, place + Vec3::ONE), normal: DVec3::Z, area: f64::from(facet) }
        }
    }

    #[test]
    fn each_facet_is_in_one_run_and_runs_are_as_long_as_they_may() {
        for (count, size) in [(3, 1), (1000, 1), (1000, 7), (5, 8)] {
            let runs = Runs::new(&Squares(count), size);
            let mut seen = vec![false; count as usize];
            for run in 0..runs.starts.len() - 1 {
                let range = runs.range(run);
                assert!(!range.is_empty() && range.len() <= size && (range.len() > size / 2 || count < 9));
                let mut sum = 0.0;
                for i in range {
                    let facet = runs.facets[i];
                    assert!(runs.run_of[facet as usize] == run as u32);
                    assert!(!std::mem::replace(&mut seen[facet as usize], true));
                    sum += facet as f32;
                    assert_eq!(runs.sums[i], sum);
                }
            }
            assert!(seen.into_iter().all(|s| s));
        }
    }
}
