//! Light tracing: particles leave the lights, and from every surface and every bit of fog that they light, what goes to the camera
//! is put on the film where it is seen. Caustics on matte surfaces, of small lamps too, come out sharp and without bias.
//!
//! # Parameters
//! `particles` of each pass (a pass is one sample of every pixel); `max_depth` bounces, as for `path`; `roulette_depth` and
//! `light_selection` of paths from the camera, which are those through glass and off mirrors.
//!
//! # Example
//! ```toml
//! [integrator]
//! type = "light"
//! particles = 200000
//! ```
//!
//! # Limits
//! Particles cannot choose to meet the camera off a mirror or through clear glass: what is seen there is found as `path` finds it,
//! so a caustic at the bottom of a pool seen through the water is not found better than by `path`. What is seen from nearby, or small
//! in a large scene, few particles reach: noise. Light from far away enters through the sphere around what is bounded: planes
//! without end are lit only within it. Media that shine are seen, but light nothing. Interpolated normals on coarse
//! meshes: light that grazes them is a little off. No spectral bins. Filter `point` does as `box` for particles. Memory: 48 bytes for each pixel (and
//! light group).
//!
//! # References
//! Dutre, Lafortune & Willems 1993, "Monte Carlo Light Tracing with Direct Computation of Pixel Intensities"; Veach 1997, "Robust
//! Monte Carlo Methods for Light Transport Simulation", sections 5.2 and 5.3 (what refraction and shading normals change for
//! particles) and 8.3 (the camera as a sensor of importance).

mod connect;
mod splats;

use super::forward::{RANGE, Tracer, usual_count};
use super::path::{self, MAX_DEPTH, Path, ROULETTE_DEPTH, Vertex};
use super::{Integrator, Landed, Pass, PathState, StepOutput, crossing, particle};
use crate::lights::pick::SELECTION;
use crate::media::{FlightEnd, Way};
use crate::observe::PathEnd;
use crate::render::Renderer;
use crate::sampler::Sampler;
use crate::scene::{Scene, SurfaceHit};
use crate::statistics::Statistics;
use connect::Connector;
use kirkas_optics::LobeSet;
use kirkas_scene::{Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use splats::Splatted;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Integrator,
    name: "light",
    doc: "Light tracing: from the lamps to the camera; caustics without bias.",
    params: &[
        ParamSpec::new(
            "particles",
            ParamType::Integer,
            Fallback::Absent,
            "Particles of each pass (a pass is one sample of every pixel); absent = as many as the picture has pixels.",
        )
        .range((1.0, 16_777_216.0)),
        MAX_DEPTH,
        ROULETTE_DEPTH,
        SELECTION,
    ],
};

/// The integrator.
#[derive(Clone, Debug)]
pub struct LightTracing {
    particles: Option<u32>,
    max_depth: u32,
    path: Path,
}

impl LightTracing {
    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        LightTracing {
            particles: p.optional_number("particles").map(|n| n as u32),
            max_depth: p.integer("max_depth") as u32,
            path: Path::new(p),
        }
    }
}

/// Ranges of particles whose splats are kept before they are put on the film.
const RANGES_AT_ONCE: u64 = 64;

impl Integrator for LightTracing {
    fn warnings(&self, scene: &Scene) -> Vec<Diagnostic> {
        let is_endless = scene.world.iter().any(|part| !part.surface.bounds().is_finite());
        let endless = (is_endless && scene.lights.iter().any(|l| l.lamp.is_far())).then(|| {
            Diagnostic::warning(
                "endless-shape",
                "`light` lights shapes without end only near the others, where light comes from far away",
            )
            .help("use rectangles and disks in place of planes, or choose `[integrator] type = \"path\"`")
        });
        let glowing = scene.volumes.iter().any(|v| v.shines()).then(|| {
            Diagnostic::warning("glowing-medium", "`light` shows media that shine, but they light nothing")
                .help("choose `[integrator] type = \"path\"`")
        });
        endless.into_iter().chain(glowing).collect()
    }

    fn prepare_pass<'a>(&self, renderer: &Renderer<'a>, pass: u32) -> Option<Pass<'a>> {
        let mut splatted = Splatted::new(renderer);
        let mut counted = Statistics::default();
        if self.max_depth > 0 {
            let tracer = Tracer::new(renderer.scene, renderer.seed, None, self.max_depth - 1);
            let connector = Connector { renderer };
            let count = self.particles.map_or_else(|| usual_count(renderer.resolution), u64::from);
            let (first, end) = (u64::from(pass) * count, (u64::from(pass) + 1) * count);
            for from in (first..end).step_by((RANGES_AT_ONCE * RANGE) as usize) {
                let to = end.min(from + RANGES_AT_ONCE * RANGE);
                let (kept, rays) = tracer.trace(from..to, 1.0 / count as f32, &connector);
                let splats: Vec<_> = kept.into_iter().flat_map(|k| k.splats).collect();
                splatted.add(&splats, renderer.filter, renderer.shift);
                counted = counted.plus(&rays);
            }
        }
        Some(Pass { integrator: Box::new(Shown { settings: self.clone(), splatted }), counted })
    }

    /// Without a pass there are no particles, and nothing to see.
    fn step(&self, _: &Scene, _: &PathState, _: &Sampler, _: Option<&SurfaceHit>, _: &mut StepOutput) {}
}

/// The integrator of one pass: what particles brought, and what only paths from the camera find.
struct Shown {
    settings: LightTracing,
    splatted: Splatted,
}

impl Integrator for Shown {
    fn landed(&self, x: u32, y: u32) -> Option<Landed<'_>> {
        Some(self.splatted.at(x, y))
    }

    fn step(&self, scene: &Scene, path: &PathState, sampler: &Sampler, hit: Option<&SurfaceHit>, out: &mut StepOutput) {
        // Behind a mirror or clear glass all as `path` does it.
        if path.depth > 0 {
            self.settings.path.step(scene, path, sampler, hit, out);
            return;
        }

        // See what shines by itself; what scatters in between is the particles' part.
        let mut path = *path;
        if let Some(volume) = scene.volume_of(&path.media) {
            let way = Way::of_ray(&path.ray, hit.map_or(f32::INFINITY, |h| h.t));
            let flight = particle::fly(volume, &path, &way, sampler);
            path::see_medium(volume, &path, flight.emitted, out);
            let FlightEnd::Passed(weight) = flight.end else {
                out.end = Some(PathEnd::Absorbed);
                return;
            };
            path.throughput *= weight;
        }
        let Some(hit) = hit else {
            path::escape(scene, &path, out);
            return;
        };
        path.throughput *= scene.clearness(&path.lanes, &path.media, f64::from(hit.t * path.ray.direction.length()));

        // Go on where no particle could have come from.
        if !path::reach(scene, &path, hit, self.settings.max_depth, out) {
            return;
        }
        let bsdf = crossing::bsdf(scene, &path, hit);
        let Some(vertex) = Vertex::new(&path, hit, &bsdf, out) else { return };
        if vertex.lobes.intersects(LobeSet::DELTA) {
            vertex.send_on(scene, &path, sampler, LobeSet::DELTA, self.settings.path.roulette_depth, out);
        } else {
            out.end = Some(PathEnd::Absorbed);
        }
    }
}
