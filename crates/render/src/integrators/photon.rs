//! Progressive photon mapping: light through glass and off mirrors (caustics), also of lamps without size. Each sample index is a
//! pass: photons go out from the lights and land on matte surfaces; paths from the camera go on until they meet one, ask the
//! lights there, and gather the photons around. From pass to pass the radius shrinks, so that the mean over passes comes ever
//! closer to the truth.
//!
//! # Parameters
//! `photons` of each pass; `radius` of the first pass; `alpha`, how much of the photons each further pass keeps; `max_depth` bounces, as
//! for `path`; `roulette_depth`.
//!
//! # Example
//! ```toml
//! [integrator]
//! type = "photon"
//! photons = 200000
//! radius = 0.02
//! ```
//!
//! # Limits
//! Any number of passes is blurred by about its mean radius: edges of caustics, and a dark rim around matte surfaces. Light that
//! reaches a surface without matte scattering (brushed metal) through glass is found as `path` finds it. Light from far away
//! enters through the sphere around what is bounded: planes without end are lit indirectly only within it. All paths of one pass
//! share the moment (and, with wavelengths, the wavelengths), so motion blur takes many passes. Memory: about 64 bytes for each
//! bounce of each photon of one pass.
//!
//! # References
//! Knaus & Zwicker 2011, "Progressive Photon Mapping: A Probabilistic Approach" (the radii: equation 10); Jensen 1996, "Global
//! Illumination using Photon Maps"; Veach 1997, section 5.3 (shading normals).

mod map;

use super::forward::{Arrival, Place, Receiver, Tracer, usual_count};
use super::path::{self, MAX_DEPTH, ROULETTE_DEPTH, Vertex};
use super::{Integrator, Pass, PathState, Shared, StepOutput, crossing};
use crate::camera::CameraSample;
use crate::observe::{Fate, Note, Saw, Shone};
use crate::render::Renderer;
use crate::sampler::Sampler;
use crate::scene::{Scene, SurfaceHit};
use kirkas_accel::Query;
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_optics::{Light, LobeSet, Mode};
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use map::PhotonMap;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Integrator,
    name: "photon",
    doc: "Progressive photon mapping: caustics of all lamps, small ones too.",
    params: &[
        ParamSpec::new("photons", ParamType::Integer, Fallback::Absent, "Photons of each pass (a pass is one sample of every pixel); absent = as many as the picture has pixels.")
            .range((1.0, 16_777_216.0)),
        ParamSpec::new("radius", ParamType::Number, Fallback::Absent, "Within which the first pass gathers photons; absent = four pixels, at the middle distance of what is seen.")
            .unit("scene units")
            .range((1e-9, 1e9)),
        ParamSpec::number("alpha", 2.0 / 3.0, "How the radius shrinks: pass k+1 has (k + alpha) / (k + 1) of the area of pass k.").range((0.05, 1.0)),
        MAX_DEPTH,
        ROULETTE_DEPTH,
    ],
};

/// The integrator.
#[derive(Clone, Debug)]
pub struct Photon {
    photons: Option<u32>,
    radius: Option<f64>,
    alpha: f64,
    max_depth: u32,
    roulette_depth: u32,
}

impl Photon {
    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        Photon {
            photons: p.optional_number("photons").map(|n| n as u32),
            radius: p.optional_number("radius"),
            alpha: p.number("alpha"),
            max_depth: p.integer("max_depth") as u32,
            roulette_depth: p.integer("roulette_depth") as u32,
        }
    }

    /// The radius of pass number `pass`, where the first one has `first`.
    fn radius_of(&self, pass: u32, first: f64) -> f64 {
        let area = (1..=pass).map(f64::from).fold(1.0, |area, i| area * ((i + self.alpha) / (i + 1.0)));
        first * area.sqrt()
    }
}

impl Integrator for Photon {
    fn prepare_pass<'a>(&self, renderer: &Renderer<'a>, pass: u32) -> Option<Pass<'a>> {
        let Renderer { scene, seed, resolution, .. } = *renderer;
        let (moment, wavelength) = owen_sobol_2d(pass, combine(seed, SHARED));
        let shared = Shared { moment, lanes: scene.lanes(|| wavelength) };
        let first = self.radius.unwrap_or_else(|| usual_radius(scene, resolution, scene.camera.time_at(moment)));
        let radius = self.radius_of(pass, first) as f32;
        let count = self.photons.map_or_else(|| usual_count(resolution), u64::from);
        let from = u64::from(pass) * count;
        let bounces = self.max_depth.saturating_sub(1);
        let tracer = Tracer::new(scene, seed, Some(shared), bounces);
        let all = if bounces > 0 { from..from + count } else { 0..0 };
        let (photons, counted) = tracer.trace(all, 1.0 / count as f32, &Landing);
        let map = PhotonMap::new(&photons.concat(), radius);
        Some(Pass { integrator: Box::new(Gatherer { settings: self.clone(), shared, map }), counted })
    }

    /// Without a pass there are no photons to gather, and nothing to see.
    fn step(&self, _: &Scene, _: &PathState, _: &Sampler, _: Option<&SurfaceHit>, _: &mut StepOutput) {}
}

/// Four pixels wide at the median of the distances seen, and never more than a tenth of the scene.
fn usual_radius(scene: &Scene, resolution: (u32, u32), time: f64) -> f64 {
    const RAYS: u32 = 24;
    const PIXELS: f64 = 4.0;
    let most = 0.1 * scene.bounding_sphere((time, time)).radius;
    let place = |n: u32, size: u32| (f64::from(n) + 0.5) / f64::from(RAYS) * f64::from(size);
    let ray = |film| scene.camera.ray(&CameraSample { film, lens: (0.5, 0.5), time }, resolution);
    let width = |n: u32| {
        let (x, y) = (place(n % RAYS, resolution.0), place(n / RAYS, resolution.1));
        let (here, beside) = (ray((x, y)), ray((x + 1.0, y)));
        let hit = scene.accel.closest_hit(&here, Query::ALL, 0, &mut Default::default())?;
        Some(f64::from((here.at(hit.t) - beside.at(hit.t)).length()))
    };
    let mut widths: Vec<f64> = (0..RAYS * RAYS).filter_map(width).collect();
    widths.sort_by(f64::total_cmp);
    widths.get(widths.len() / 2).map_or(most, |w| (PIXELS * w).min(most)).max(1e-9)
}

/// Keeps what lands on matte surfaces after a bounce: direct light is asked for.
struct Landing;

impl Receiver for Landing {
    type Kept = Vec<map::Photon>;

    fn receive(&self, arrival: &Arrival, kept: &mut Self::Kept) {
        let (path, Place::Surface(hit, bsdf)) = (arrival.path, &arrival.place) else { return };
        if path.depth > 0 && bsdf.lobes().intersects(LobeSet::DIFFUSE) {
            let side = if hit.is_front { hit.normal } else { -hit.normal };
            kept.push(map::Photon {
                position: hit.position.as_vec3(),
                wi: -path.ray.direction.normalize(),
                normal: side.as_vec3(),
                power: path.throughput,
                group: arrival.group,
                bounces: path.depth,
                is_alone: path.lanes.is_alone(),
            });
        }
    }
}

/// The integrator of one pass.
struct Gatherer {
    settings: Photon,
    shared: Shared,
    map: PhotonMap,
}

impl Integrator for Gatherer {
    fn shared(&self) -> Option<Shared> {
        Some(self.shared)
    }

    fn step(&self, scene: &Scene, path: &PathState, sampler: &Sampler, hit: Option<&SurfaceHit>, out: &mut StepOutput) {
        // All as `path` does it ...
        let Some(hit) = hit else {
            path::escape(scene, path, out);
            return;
        };
        let mut path = *path;
        path.throughput *= scene.clearness(&path.lanes, &path.media, f64::from(hit.t * path.ray.direction.length()));
        if !path::reach(scene, &path, hit, self.settings.max_depth, out) {
            return;
        }
        let bsdf = crossing::bsdf(scene, &path, hit);
        let Some(vertex) = Vertex::new(&path, hit, &bsdf, out) else { return };
        let roulette_depth = self.settings.roulette_depth;
        if !vertex.lobes.intersects(LobeSet::DIFFUSE) {
            if vertex.lobes.intersects(LobeSet::NON_DELTA) {
                out.shadow_rays.extend(vertex.ask_light(scene, &path, sampler, LobeSet::ALL, &mut out.notes));
            }
            vertex.send_on(scene, &path, sampler, LobeSet::ALL, roulette_depth, out);
        } else {
            // ... up to the first matte surface: there direct light is asked for and looked for, the rest is gathered.
            self.gather(&path, &vertex, out);
            out.shadow_rays.extend(vertex.ask_light(scene, &path, sampler, LobeSet::NON_DELTA, &mut out.notes));
            if let Some(probe) = vertex.go_on(scene, &path, sampler, LobeSet::NON_DELTA, &mut out.notes) {
                out.notes.settle(1.0, Fate::Goes);
                let branch = combine(path.branch, PROBE);
                out.paths.push(PathState { depth: self.settings.max_depth.max(probe.depth), branch, ..probe });
            }
            if vertex.lobes.intersects(LobeSet::DELTA) {
                vertex.send_on(scene, &path, sampler, LobeSet::DELTA, roulette_depth, out);
            }
        }
    }
}

impl Gatherer {
    /// Add what the photons around bring, light group by light group.
    fn gather(&self, path: &PathState, vertex: &Vertex, out: &mut StepOutput) {
        let hit = vertex.hit;
        let most_bounces = self.settings.max_depth - path.depth - 1;
        // Where a lane goes alone it stands for all: once, though both halves of the path say so.
        let all_lanes = self.shared.lanes.hero_weight().max_component();
        let both_alone = if path.lanes.is_alone() { 1.0 / all_lanes } else { 1.0 };
        let mut found: Vec<(u32, Light)> = Vec::new();
        self.map.gather(hit.position.as_vec3(), |photon, density| {
            let wi = photon.wi.as_dvec3();
            let cos = wi.dot(hit.normal);
            // What landed on another face, around a corner, says nothing of this one.
            let is_same_face = photon.normal.dot(hit.normal.as_vec3()) * cos.signum() as f32 > SAME_FACE;
            let local = hit.frame.to_local(photon.wi);
            if photon.bounces > most_bounces || !is_same_face || !crossing::agrees(hit, wi, local.z) {
                return;
            }
            // The density is per area of the true surface; the camera's estimate weighs by the shading normal.
            let f = vertex.bsdf.eval(vertex.wo, local, LobeSet::NON_DELTA, Mode::Radiance);
            let lanes = if photon.is_alone { both_alone } else { 1.0 };
            let light = f * photon.power * (lanes * density * local.z.abs() / cos.abs() as f32);
            match found.iter_mut().find(|f| f.0 == photon.group) {
                Some(sum) => sum.1 += light,
                None => found.push((photon.group, light)),
            }
        });
        for (group, light) in found {
            out.notes.add(|| Note::Saw(Saw { what: Shone::Photons, radiance: light, weight: 1.0 }));
            out.contributions.push((path.throughput * light, group));
        }
    }
}

/// Least cosine between the normals of places that count as one face.
const SAME_FACE: f32 = 0.7;

const SHARED: u64 = of_name("shared");
const PROBE: u64 = of_name("probe");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_radius_shrinks_as_knaus_and_zwicker_have_it() {
        let photon = Photon { photons: None, radius: None, alpha: 2.0 / 3.0, max_depth: 9, roulette_depth: 9 };
        let square = |pass| photon.radius_of(pass, 0.5).powi(2);
        assert_eq!(square(0), 0.25);
        for pass in [0, 1, 7, 400] {
            let i = f64::from(pass + 1);
            assert!((square(pass + 1) / square(pass) - (i + 2.0 / 3.0) / (i + 1.0)).abs() < 1e-12);
        }
        // It goes to 0 as k^(alpha - 1), so bias does, and slower than 1 / k, so noise does too.
        let exponent = (square(100_000) / square(10_000)).log10();
        assert!((exponent + 1.0 / 3.0).abs() < 1e-3, "{exponent}");
    }
}
