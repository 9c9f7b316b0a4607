//! A particle of a medium that a path has met, with all that is asked of it: the counterpart of a surface in `path`.

use super::path::{BOUNCE, DIRECTION, LIGHT, LOBE, PICK, power_heuristic};
use super::{LastVertex, PathState, RayKind, ShadowRay, crossing};
use crate::media::{Flight, Volume, Way, shares};
use crate::observe::{Answer, Asked, Fate, Note, Notes, Sent};
use crate::sampler::Sampler;
use crate::scene::{SECONDARY, Scene, ray_to_light};
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::{DVec3, Ray, Vec3};
use kirkas_optics::{Light, PhaseFunction};

/// Send the path on its way through a medium.
pub(super) fn fly(volume: &Volume, path: &PathState, way: &Way, sampler: &Sampler) -> Flight {
    // Boundaries that are passed leave the branch as it is.
    let purpose = combine(combine(path.branch, FLIGHT), u64::from(path.passed));
    let key = combine(sampler.key(), purpose);
    volume.fly(&path.lanes, path.throughput, way, sampler.pair(purpose), key)
}

/// Where a path scatters.
pub(super) struct Particle<'a> {
    phase: &'a PhaseFunction,
    position: DVec3,
    wo: Vec3,
    /// What each lane counts in densities.
    shares: Light,
}

impl<'a> Particle<'a> {
    /// Of `volume`, met by a path that carries its throughput up to here.
    pub(super) fn new(volume: &'a Volume, path: &PathState, position: DVec3) -> Self {
        let wo = -path.ray.direction.normalize();
        Particle { phase: &volume.phase, position, wo, shares: shares(path.throughput) }
    }

    /// One light, and what comes from it unless something is in the way.
    pub(super) fn ask_light(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        notes: &mut Notes,
    ) -> Option<ShadowRay> {
        let u = if scene.has_choice() { sampler.one(combine(path.branch, PICK)) } else { 0.0 };
        let Some((number, probability)) = scene.picker.pick(self.position, DVec3::ZERO, u) else {
            notes.add(|| Note::Asked(Asked::of(None, 0.0, Answer::NoLight)));
            return None;
        };
        let u = sampler.pair(combine(path.branch, LIGHT));
        let asked = |answer| Asked::of(Some(scene.pieces.light(number)), probability, answer);
        let Some(s) = scene.sample_picked(&path.lanes, number, self.position, f64::from(path.ray.time), u) else {
            notes.add(|| Note::Asked(asked(Answer::Dark)));
            return None;
        };
        let wi = s.direction.as_vec3();
        let weight = match s.pdf > 0.0 {
            true => power_heuristic(probability * s.pdf, self.phase.pdf(&path.lanes, self.shares, self.wo, wi)),
            false => 1.0,
        };
        let value = self.phase.value(&path.lanes, self.wo, wi);
        let light = path.throughput * value * s.light * (weight / probability);
        let ray = ray_to_light(self.position.as_vec3(), &s, &path.ray);
        let is_black = light.is_black();
        let ray = if is_black { None } else { crossing::ask(scene, path, sampler, ray, path.media, light, number) };
        notes.add(|| {
            let answer = if ray.is_some() { Answer::Waits } else { Answer::Black };
            Note::Asked(Asked { bsdf: value, cosine: 1.0, weight, ..s.noted(self.position, asked(answer)) })
        });
        ray
    }

    /// The path after this particle, of which `notes` holds how it was chosen.
    pub(super) fn go_on(&self, path: &PathState, sampler: &Sampler, notes: &mut Notes) -> Option<PathState> {
        let u_lane = sampler.one(combine(path.branch, LOBE));
        let u = sampler.pair(combine(path.branch, DIRECTION));
        let s = self.phase.sample(&path.lanes, self.shares, self.wo, u_lane, u)?;
        let origin = self.position.as_vec3();
        notes.hold(|| Sent { bsdf: s.value, pdf: s.pdf, cosine: 1.0, fate: Fate::Goes, ..Sent::NOWHERE });
        Some(PathState {
            ray: Ray { origin, direction: s.wi, t_min: 0.0, t_max: f32::INFINITY, mask: SECONDARY, ..path.ray },
            throughput: path.throughput * s.value / s.pdf,
            depth: path.depth + 1,
            kind: RayKind::Diffuse,
            branch: combine(path.branch, BOUNCE),
            cone: path.cone.after((self.position - path.ray.origin.as_dvec3()).length() as f32).scattered(s.pdf),
            passed: 0,
            travelled: 0.0,
            last: Some(LastVertex { position: self.position, normal: DVec3::ZERO, pdf: s.pdf }),
            ..*path
        })
    }
}

const FLIGHT: u64 = of_name("flight");
