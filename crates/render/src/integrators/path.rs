//! Path tracing: light that reaches the eye after any number of bounces. At every surface one light is chosen and asked, one ray
//! goes on in a direction that the surface prefers; whatever both could have found is weighted so that the better one counts.
//!
//! # Parameters
//! `max_depth` bounces, 0 showing only what shines and 1 adding direct light; `roulette_depth` from which on weak paths are ended
//! by chance; `light_selection`: how the one light is chosen.
//!
//! # Example
//! ```toml
//! [integrator]
//! type = "path"
//! max_depth = 12
//! ```
//!
//! # Limits
//! Light that small or pointlike lamps throw through glass or off mirrors (caustics) is found only by rays that hit the lamp by
//! chance: noise, and for points nothing at all. `ambient` lights, a stand-in for what `path` computes, are ignored.
//!
//! # References
//! Kajiya 1986, "The Rendering Equation"; Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", sections 9.2
//! (the power heuristic, with exponent 2) and 10.4 (Russian roulette); Conty Estevez & Kulla 2018, "Importance Sampling of Many
//! Lights with Adaptive Tree Splitting"; Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray
//! Traced Images".

use super::particle::{self, Particle};
use super::{Integrator, LastVertex, PathState, RayKind, ShadowRay, StepOutput, crossing};
use crate::lights::pick::SELECTION;
use crate::media::{FlightEnd, Volume, Way};
use crate::observe::{Answer, Asked, Fate, Note, Notes, PathEnd, Saw, Sent, Shone};
use crate::sampler::Sampler;
use crate::scene::{Scene, SurfaceHit};
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::{Bsdf, Light, Lobe, LobeSet, Mode};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Integrator,
    name: "path",
    doc: "Path tracing: all light, after any number of bounces.",
    params: &[MAX_DEPTH, ROULETTE_DEPTH, SELECTION],
};
pub(super) const MAX_DEPTH: ParamSpec = ParamSpec::integer(
    "max_depth",
    1000,
    (0.0, 1e6),
    "Bounces between eye and lamp: 0 shows only what shines, 1 adds direct light.",
)
.unit("bounces");
pub(super) const ROULETTE_DEPTH: ParamSpec = ParamSpec::integer(
    "roulette_depth",
    4,
    (0.0, 1e6),
    "From this bounce on a path goes on only as probably as it still carries light; the survivors count more, so that nothing is lost on average.",
)
.unit("bounces");

/// The integrator.
#[derive(Clone, Debug)]
pub struct Path {
    max_depth: u32,
    pub(super) roulette_depth: u32,
}

impl Path {
    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        Path { max_depth: p.integer("max_depth") as u32, roulette_depth: p.integer("roulette_depth") as u32 }
    }
}

impl Integrator for Path {
    fn step(&self, scene: &Scene, path: &PathState, sampler: &Sampler, hit: Option<&SurfaceHit>, out: &mut StepOutput) {
        // Fly through what fills the space, and scatter in it or come out.
        let weakened;
        let path = match scene.is_empty(&path.media) {
            true => path,
            false => match self.fly(scene, path, sampler, hit, out) {
                Some(left) => {
                    weakened = left;
                    &weakened
                }
                None => return,
            },
        };

        // What left the scene sees the background.
        let Some(hit) = hit else {
            escape(scene, path, out);
            return;
        };

        // Ask a light, and go on.
        if !reach(scene, path, hit, self.max_depth, out) {
            return;
        }
        let bsdf = crossing::bsdf(scene, path, hit);
        let Some(vertex) = Vertex::new(path, hit, &bsdf, out) else { return };
        if vertex.lobes.intersects(LobeSet::NON_DELTA) {
            out.shadow_rays.extend(vertex.ask_light(scene, path, sampler, LobeSet::ALL, &mut out.notes));
        }
        vertex.send_on(scene, path, sampler, LobeSet::ALL, self.roulette_depth, out);
    }
}

impl Path {
    /// The path behind the body or the medium that it is in; `None` if it scattered there.
    fn fly(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        hit: Option<&SurfaceHit>,
        out: &mut StepOutput,
    ) -> Option<PathState> {
        let mut path = *path;
        if let Some(volume) = scene.volume_of(&path.media) {
            let way = Way::of_ray(&path.ray, hit.map_or(f32::INFINITY, |h| h.t));
            let flight = particle::fly(volume, &path, &way, sampler);
            see_medium(volume, &path, flight.emitted, out);
            match flight.end {
                FlightEnd::Passed(weight) => path.throughput *= weight,
                FlightEnd::Scattered { distance, weight } => {
                    path.throughput *= weight * scene.clearness(&path.lanes, &path.media, distance);
                    self.scatter(scene, &path, &Particle::new(volume, &path, way.at(distance)), sampler, out);
                    return None;
                }
            }
        }
        if let Some(hit) = hit {
            let distance = f64::from(hit.t * path.ray.direction.length());
            path.throughput *= scene.clearness(&path.lanes, &path.media, distance);
        }
        Some(path)
    }

    /// Ask a light from within a medium, and go on.
    fn scatter(&self, scene: &Scene, path: &PathState, particle: &Particle, sampler: &Sampler, out: &mut StepOutput) {
        if path.depth >= self.max_depth || path.throughput.is_black() {
            out.end = Some(PathEnd::Depth);
            return;
        }
        out.shadow_rays.extend(particle.ask_light(scene, path, sampler, &mut out.notes));
        match particle.go_on(path, sampler, &mut out.notes) {
            Some(next) => play_roulette(scene, next, sampler, self.roulette_depth, out),
            None => out.end = Some(PathEnd::Absorbed),
        }
    }
}

/// Send the path on, or end it by chance.
#[inline(always)]
fn play_roulette(scene: &Scene, mut next: PathState, sampler: &Sampler, roulette_depth: u32, out: &mut StepOutput) {
    let mut survival = 1.0;
    if next.depth >= roulette_depth {
        survival = (next.throughput.max_component() * scene.gain(&next.media)).min(MOST_CHANCE);
        if sampler.one(combine(next.branch, ROULETTE)) >= survival {
            out.notes.settle(survival, Fate::Roulette);
            out.end = Some(PathEnd::Roulette);
            return;
        }
        next.throughput *= 1.0 / survival;
    }
    out.notes.settle(survival, Fate::Goes);
    out.paths.push(next);
}

/// The path sees the medium on its way shine, if it does.
pub(super) fn see_medium(volume: &Volume, path: &PathState, emitted: Light, out: &mut StepOutput) {
    if !emitted.is_black() {
        out.notes.add(|| Note::Saw(Saw { what: Shone::Medium, radiance: emitted, weight: 1.0 }));
        out.contributions.push((path.throughput * emitted, volume.group));
    }
}

/// See the surface at the path's end shine; false where it is a covered boundary, which is passed, or the path ends.
#[inline(always)]
pub(super) fn reach(scene: &Scene, path: &PathState, hit: &SurfaceHit, max_depth: u32, out: &mut StepOutput) -> bool {
    if crossing::is_covered(scene, path, hit) {
        out.paths.extend(crossing::passed(path, hit));
        return false;
    }
    see_emission(scene, path, hit, out);
    if path.depth >= max_depth {
        out.end = Some(PathEnd::Depth);
        return false;
    }
    true
}

/// The path sees the background and ends.
pub(super) fn escape(scene: &Scene, path: &PathState, out: &mut StepOutput) {
    let (sky, weight) = match (&path.last, scene.background_light) {
        (Some(last), Some(light)) => {
            let (sky, pdf) = scene.background.seen(&path.lanes, path.ray.direction.as_dvec3().normalize());
            (sky, last.weight(scene, light, pdf))
        }
        _ => (scene.background.radiance(&path.lanes, path.ray.direction), 1.0),
    };
    let sky = sky * scene.clearness(&path.lanes, &path.media, f64::INFINITY);
    if !sky.is_black() {
        out.notes.add(|| Note::Saw(Saw { what: Shone::Background, radiance: sky, weight }));
        out.contributions.push((path.throughput * sky * weight, scene.background_group));
    }
    out.end = Some(PathEnd::Escaped);
}

/// The path sees the surface shine, if it does.
#[inline(always)]
fn see_emission(scene: &Scene, path: &PathState, hit: &SurfaceHit, out: &mut StepOutput) {
    let emitted = match path.last {
        Some(_) => scene.emitted_at_point(&path.lanes, hit),
        None => scene.emitted(&path.lanes, hit),
    };
    if !emitted.is_black() {
        let weight = match (&path.last, scene.pickable_of(hit)) {
            (Some(last), Some(light)) => {
                let pdf = scene.light_pdf(light, hit, last.position, f64::from(path.ray.time));
                last.weight(scene, light, pdf)
            }
            _ => 1.0,
        };
        out.notes.add(|| Note::Saw(Saw { what: Shone::Surface, radiance: emitted, weight }));
        out.contributions.push((path.throughput * emitted * weight, hit.emission_group));
    }
}

/// Even where nothing is absorbed every path ends.
const MOST_CHANCE: f32 = 0.95;

impl LastVertex {
    /// The weight of light that a ray found by itself which asking light number `light` would have found with density `pdf`.
    fn weight(&self, scene: &Scene, light: u32, pdf: f32) -> f32 {
        power_heuristic(self.pdf, pdf * scene.picker.probability(self.position, self.normal, light))
    }
}

/// The weight of what was found with density `own` and could have been with density `other` (Veach 1997, equation 9.13).
pub(super) fn power_heuristic(own: f32, other: f32) -> f32 {
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

/// A surface that a path has reached, with all that is asked of it twice.
pub(super) struct Vertex<'a> {
    pub(super) hit: &'a SurfaceHit,
    pub(super) bsdf: &'a Bsdf,
    pub(super) lobes: LobeSet,
    /// Back along the path, in the surface's frame.
    pub(super) wo: Vec3,
    /// Of the side that light must come from; zero where it may come from both.
    normal: DVec3,
}

impl<'a> Vertex<'a> {
    /// `None`, and the path ends, where the surface swallows all light.
    #[inline(always)]
    pub(super) fn new(path: &PathState, hit: &'a SurfaceHit, bsdf: &'a Bsdf, out: &mut StepOutput) -> Option<Self> {
        let lobes = bsdf.lobes();
        if lobes.is_empty() {
            out.end = Some(PathEnd::Absorbed);
            return None;
        }
        let normal = match (lobes.intersects(LobeSet::TRANSMISSION), hit.is_front) {
            (true, _) => DVec3::ZERO,
            (false, true) => hit.normal,
            (false, false) => -hit.normal,
        };
        let wo = hit.frame.to_local(-path.ray.direction.normalize());
        Some(Vertex { hit, bsdf, lobes, wo, normal })
    }

    /// One light, and what comes from it unless something is in the way; weighted against a ray that `rivals` send.
    #[inline(always)]
    pub(super) fn ask_light(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        rivals: LobeSet,
        notes: &mut Notes,
    ) -> Option<ShadowRay> {
        let hit = self.hit;
        let u = if scene.has_choice() { sampler.one(combine(path.branch, PICK)) } else { 0.0 };
        let Some((number, probability)) = scene.picker.pick(hit.position, self.normal, u) else {
            notes.add(|| Note::Asked(Asked::of(None, 0.0, Answer::NoLight)));
            return None;
        };
        let u = sampler.pair(combine(path.branch, LIGHT));
        let asked = |answer| Asked::of(Some(scene.pieces.light(number)), probability, answer);
        let Some(s) = scene.sample_picked(&path.lanes, number, hit.position, f64::from(path.ray.time), u) else {
            notes.add(|| Note::Asked(asked(Answer::Dark)));
            return None;
        };
        let wi = hit.frame.to_local(s.direction.as_vec3());
        let asked = |answer| s.noted(hit.position, asked(answer));
        if !crossing::agrees(hit, s.direction, wi.z) {
            notes.add(|| Note::Asked(asked(Answer::Behind)));
            return None;
        }
        let f = self.bsdf.eval(self.wo, wi, LobeSet::NON_DELTA, Mode::Radiance);
        let asked = |answer| Asked { bsdf: f, cosine: wi.z.abs(), ..asked(answer) };
        if f.is_black() || s.light.is_black() {
            notes.add(|| Note::Asked(asked(Answer::of_black(f, self.wo, wi))));
            return None;
        }
        // Where no ray can hit the light, this is the only way to it.
        let weight = match s.pdf > 0.0 {
            true => power_heuristic(probability * s.pdf, self.bsdf.pdf(self.wo, wi, rivals, Mode::Radiance)),
            false => 1.0,
        };
        let media = crossing::media_towards(scene, &path.media, hit, s.direction);
        let light = path.throughput * f * s.light * (wi.z.abs() * weight / probability);
        let ray = crossing::ask(scene, path, sampler, hit.shadow_ray(&s, &path.ray), media, light, number);
        notes.add(|| {
            let answer = if ray.is_some() { Answer::Waits } else { Answer::Black };
            Note::Asked(Asked { weight, ..asked(answer) })
        });
        ray
    }

    /// Send the path on by one of `lobes`, or end it by chance.
    pub(super) fn send_on(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        lobes: LobeSet,
        roulette_depth: u32,
        out: &mut StepOutput,
    ) {
        match self.go_on(scene, path, sampler, lobes, &mut out.notes) {
            Some(next) => play_roulette(scene, next, sampler, roulette_depth, out),
            None => out.end = Some(PathEnd::Absorbed),
        }
    }

    /// The path after this surface by one of `lobes`, of which `notes` holds how it was chosen; `None` if the surface swallows it.
    #[inline(always)]
    pub(super) fn go_on(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        lobes: LobeSet,
        notes: &mut Notes,
    ) -> Option<PathState> {
        let hit = self.hit;
        // One lobe leaves nothing to choose.
        let u_lobe = if (self.lobes & lobes).is_single() { 0.0 } else { sampler.one(combine(path.branch, LOBE)) };
        let u = sampler.pair(combine(path.branch, DIRECTION));
        let Some(s) = self.bsdf.sample(self.wo, u_lobe, u, lobes, Mode::Radiance) else {
            notes.add(|| Note::Sent(Sent::NOWHERE));
            return None;
        };
        let throughput: Light = path.throughput * s.weight();
        let direction = hit.frame.to_world(s.wi).as_dvec3().normalize();
        // A shading normal may bend a ray to the wrong side of the true surface: such a ray is dropped.
        let keeps_side = crossing::keeps_side(hit, direction, s.lobe);
        if throughput.is_black() || !keeps_side {
            let fate = if keeps_side { Fate::Swallowed } else { Fate::WrongSide };
            notes.add(|| Note::Sent(Sent { fate, ..Sent::of(&s) }));
            return None;
        }
        let last = LastVertex { position: hit.position, normal: self.normal, pdf: s.pdf };
        notes.hold(|| Sent::of(&s));
        Some(PathState {
            lanes: s.lanes(path.lanes),
            ray: hit.ray_towards(direction, &path.ray),
            throughput,
            depth: path.depth + 1,
            kind: kind_of(s.lobe),
            branch: combine(path.branch, BOUNCE),
            media: crossing::media_towards(scene, &path.media, hit, direction),
            cone: crossing::cone_after(scene, path, hit, &s),
            passed: 0,
            travelled: 0.0,
            last: (!s.lobe.is_delta()).then_some(last),
        })
    }
}

fn kind_of(lobe: Lobe) -> RayKind {
    match lobe {
        Lobe::DeltaReflection => RayKind::Reflected,
        Lobe::DeltaTransmission => RayKind::Refracted,
        Lobe::GlossyReflection | Lobe::GlossyTransmission => RayKind::Glossy,
        Lobe::DiffuseReflection | Lobe::DiffuseTransmission => RayKind::Diffuse,
    }
}

pub(super) const PICK: u64 = of_name("pick");
pub(super) const LIGHT: u64 = of_name("light");
pub(super) const LOBE: u64 = of_name("lobe");
pub(super) const DIRECTION: u64 = of_name("direction");
const ROULETTE: u64 = of_name("roulette");
pub(super) const BOUNCE: u64 = of_name("bounce");
