//! Recursive ray tracing as Whitted (1980) has it, with the distributed effects of Cook, Porter & Carpenter (1984): ambient
//! term; per light a shadow ray and local shading; mirror and refraction rays; several rays for glossy surfaces and area lights.
//! Light that bounces between diffuse surfaces is not followed: the ambient light stands for it.
//!
//! # Parameters
//! `max_depth` bounces; `min_contribution` below which a ray is not sent; `shadows`; `shade_back`; `glossy_samples`;
//! `ambient` scale; `surface_offset`.
//!
//! # Example
//! ```toml
//! [integrator]
//! type = "whitted"
//! max_depth = 5
//! min_contribution = 0.01
//! shadows = "opaque"
//! ```
//!
//! # Limits
//! No diffuse interreflection, no caustics: a glass ball casts a full shadow, or with `shadows = "transparent"` one that is
//! tinted but not focused. Where depth or contribution ends the tree, light is lost.
//!
//! # References
//! Whitted 1980, "An Improved Illumination Model for Shaded Display"; Cook, Porter & Carpenter 1984, "Distributed Ray
//! Tracing"; Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray Traced Images".

use super::{Blocker, Integrator, PathState, RayKind, ShadowRay, StepOutput, crossing};
use crate::lights::Lamp;
use crate::observe::{Answer, Asked, Fate, Note, PathEnd, Saw, Sent, Shone};
use crate::sampler::Sampler;
use crate::scene::{Scene, SurfaceHit};
use kirkas_geometry::hash::{combine, of_name};
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::{Bsdf, BsdfSample, Light, LobeSet, Mode};
use kirkas_scene::spec::{NOT_NEGATIVE, UNIT};
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Integrator,
    name: "whitted",
    doc: "Recursive ray tracing with distributed rays.",
    params: &[
        ParamSpec::integer("max_depth", 8, (0.0, 1000.0), "Bounces; 0 sends no reflected or refracted ray.")
            .unit("bounces"),
        ParamSpec::number("min_contribution", 0.001, "A ray that can add less than this share is not sent.")
            .range(UNIT),
        ParamSpec::choice(
            "shadows",
            &["opaque", "transparent", "none"],
            "`opaque`: any surface blocks; `transparent`: clear ones tint, without bending; `none`: no shadow rays.",
        ),
        ParamSpec::bool(
            "shade_back",
            true,
            "Shade surfaces seen from behind as well; without it they are black, as in the course.",
        ),
        ParamSpec::integer("glossy_samples", 4, (1.0, 65_536.0), "Rays per glossy lobe at the first bounce, 1 deeper.")
            .range((1.0, 65_536.0)),
        ParamSpec::number("ambient", 1.0, "Scales all ambient light.").range(NOT_NEGATIVE),
        ParamSpec::bool(
            "surface_offset",
            true,
            "Rays start clear of rounding errors; without it surfaces shade themselves (acne).",
        ),
    ],
};

/// What shadow rays do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    /// Any surface blocks.
    Opaque,
    /// Clear surfaces tint.
    Transparent,
    /// There are none.
    None,
}

/// The integrator.
#[derive(Clone, Debug)]
pub struct Whitted {
    max_depth: u32,
    min_contribution: f32,
    shadows: Shadows,
    shade_back: bool,
    glossy_samples: u32,
    ambient: f32,
    surface_offset: bool,
}

impl Whitted {
    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        Whitted {
            max_depth: p.integer("max_depth") as u32,
            min_contribution: p.f32("min_contribution"),
            shadows: match p.text("shadows") {
                Some("none") => Shadows::None,
                Some("transparent") => Shadows::Transparent,
                _ => Shadows::Opaque,
            },
            shade_back: p.bool("shade_back"),
            glossy_samples: p.integer("glossy_samples") as u32,
            ambient: p.f32("ambient"),
            surface_offset: p.bool("surface_offset"),
        }
    }
}

impl Integrator for Whitted {
    fn step(&self, scene: &Scene, path: &PathState, sampler: &Sampler, hit: Option<&SurfaceHit>, out: &mut StepOutput) {
        let mut path = *path;

        // Weaken the path by the body it went through.
        if let Some(hit) = hit {
            path.throughput *=
                scene.clearness(&path.lanes, &path.media, f64::from(hit.t * path.ray.direction.length()));
        }

        // What left the scene sees the background.
        let Some(hit) = hit else {
            let sky = scene.background.radiance(&path.lanes, path.ray.direction);
            out.notes.add(|| Note::Saw(Saw { what: Shone::Background, radiance: sky, weight: 1.0 }));
            out.contributions.push((path.throughput * sky, scene.background_group));
            out.end = Some(PathEnd::Escaped);
            return;
        };

        let bare = SurfaceHit { error: DVec3::ZERO, ..*hit };
        let hit = if self.surface_offset { hit } else { &bare };

        // Pass boundaries that another body covers.
        if crossing::is_covered(scene, &path, hit) {
            out.paths.extend(crossing::passed(&path, hit));
            return;
        }

        // A surface that shines is seen.
        let emitted = scene.emitted(&path.lanes, hit);
        if !emitted.is_black() {
            out.notes.add(|| Note::Saw(Saw { what: Shone::Surface, radiance: emitted, weight: 1.0 }));
            out.contributions.push((path.throughput * emitted, hit.emission_group));
        }

        let bsdf = crossing::bsdf(scene, &path, hit);
        let wo_world = -path.ray.direction.normalize();
        let wo = hit.frame.to_local(wo_world);
        let is_boundary = scene.material(hit).medium.is_some();

        if !self.shade_back && !hit.is_front && !is_boundary {
            // The course's rule: backs are black.
            out.end = Some(PathEnd::Absorbed);
            return;
        }
        self.add_ambient(scene, &path, &bsdf, out);
        self.light_directly(scene, &path, sampler, hit, &bsdf, wo, out);

        // Follow mirror and refraction rays.
        if bsdf.lobes().intersects(LobeSet::DELTA | bsdf.traced_lobes()) {
            self.branch(scene, &path, sampler, hit, &bsdf, wo, out);
        } else {
            out.end = Some(PathEnd::Absorbed);
        }
    }
}

impl Whitted {
    fn add_ambient(&self, scene: &Scene, path: &PathState, bsdf: &Bsdf, out: &mut StepOutput) {
        let albedo = bsdf.ambient();
        if albedo.is_black() || self.ambient == 0.0 {
            return;
        }
        for (light, group) in &scene.ambient {
            let radiance = || albedo * light.at(&path.lanes) * self.ambient;
            out.notes.add(|| Note::Saw(Saw { what: Shone::Ambient, radiance: radiance(), weight: 1.0 }));
            out.contributions.push((path.throughput * albedo * light.at(&path.lanes) * self.ambient, *group));
        }
    }

    /// For every light: shadow rays and local shading.
    fn light_directly(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        hit: &SurfaceHit,
        bsdf: &Bsdf,
        wo: Vec3,
        out: &mut StepOutput,
    ) {
        let shaded = bsdf.lobes() & LobeSet::NON_DELTA;
        if shaded.is_empty() {
            return;
        }
        let traced = if path.depth < self.max_depth { bsdf.traced_lobes() } else { LobeSet::NONE };
        for (number, light) in scene.lights.iter().enumerate() {
            if matches!(light.lamp, Lamp::Background(_)) {
                continue;
            }
            // A glossy surface finds area lights with its own rays.
            let lobes = if matches!(light.lamp, Lamp::Area(_)) { shaded.without(traced) } else { shaded };
            if lobes.is_empty() {
                continue;
            }
            let count = if path.depth == 0 { light.samples } else { light.samples.min(1) };
            let purpose = combine(path.branch, light.hash);
            for i in 0..count {
                let u = sampler.pair_of(purpose, i, count);
                let time = f64::from(path.ray.time);
                let asked = |answer| Asked::of(Some(number as u32), count as f32, answer);
                let Some(s) = scene.sample_light(&path.lanes, light, hit.position, time, u) else {
                    out.notes.add(|| Note::Asked(asked(Answer::Dark)));
                    continue;
                };
                let wi = hit.frame.to_local(s.direction.as_vec3());
                let f = bsdf.eval(wo, wi, lobes, Mode::Radiance);
                let weight = path.throughput * f * s.light * (wi.z.abs() / count as f32);
                let asked = |answer| Asked { bsdf: f, cosine: wi.z.abs(), ..s.noted(hit.position, asked(answer)) };
                if weight.is_black() || !crossing::agrees(hit, s.direction, wi.z) {
                    out.notes.add(|| {
                        let agrees = crossing::agrees(hit, s.direction, wi.z);
                        Note::Asked(asked(if agrees { Answer::of_black(f, wo, wi) } else { Answer::Behind }))
                    });
                    continue;
                }
                let media = crossing::media_towards(scene, &path.media, hit, s.direction);
                // What a straight ray meets weakens it as it goes; otherwise it stays in one body all the way.
                let blocked_by = match self.shadows {
                    Shadows::Transparent => Blocker::Opaque,
                    Shadows::None => Blocker::Anything,
                    _ if scene.has_hulls => Blocker::AllButHulls,
                    _ => Blocker::Anything,
                };
                // What meets surfaces on its way is weakened as it goes; otherwise it stays in one body all the way.
                let weight = match blocked_by {
                    Blocker::Anything => weight * scene.clearness(&path.lanes, &media, s.distance(hit.position)),
                    _ => weight,
                };
                if self.shadows == Shadows::None {
                    let radiance = || f * s.light * wi.z.abs();
                    let weight_of_one = 1.0 / count as f32;
                    out.notes
                        .add(|| Note::Saw(Saw { what: Shone::Light, radiance: radiance(), weight: weight_of_one }));
                    out.contributions.push((weight, light.group));
                    continue;
                }
                out.notes.add(|| Note::Asked(asked(Answer::Waits)));
                out.shadow_rays.push(ShadowRay {
                    ray: hit.shadow_ray(&s, &path.ray),
                    lanes: path.lanes,
                    light: weight,
                    group: light.group,
                    branch: path.branch,
                    lamp: number as u32,
                    blocked_by,
                    media,
                    passed: 0,
                });
            }
        }
    }

    /// Send the rays of the tree.
    fn branch(
        &self,
        scene: &Scene,
        path: &PathState,
        sampler: &Sampler,
        hit: &SurfaceHit,
        bsdf: &Bsdf,
        wo: Vec3,
        out: &mut StepOutput,
    ) {
        if path.depth >= self.max_depth {
            out.end = Some(PathEnd::Depth);
            return;
        }
        let before = out.paths.len();
        for s in bsdf.delta_branches(wo, Mode::Radiance) {
            let kind = if s.lobe.is_transmission() { RayKind::Refracted } else { RayKind::Reflected };
            self.send(scene, path, hit, &s, s.weight(), kind, 0, out);
        }
        let count = if path.depth == 0 { self.glossy_samples } else { 1 };
        for lobe in bsdf.traced_lobes().iter() {
            let purpose = combine(path.branch, combine(GLOSSY, lobe as u64));
            for i in 0..count {
                let u = sampler.pair_of(purpose, i, count);
                if let Some(s) = bsdf.sample(wo, 0.0, u, LobeSet::of(lobe), Mode::Radiance) {
                    let weight = s.weight() * (1.0 / count as f32);
                    self.send(scene, path, hit, &s, weight, RayKind::Glossy, i, out);
                }
            }
        }
        if out.paths.len() == before {
            out.end = Some(PathEnd::Contribution);
        }
    }

    fn send(
        &self,
        scene: &Scene,
        path: &PathState,
        hit: &SurfaceHit,
        sample: &BsdfSample,
        weight: Light,
        kind: RayKind,
        number: u32,
        out: &mut StepOutput,
    ) {
        let (wi, lobe) = (sample.wi, sample.lobe);
        let throughput = path.throughput * weight;
        if throughput.max_component() < self.min_contribution || throughput.is_black() {
            let fate = if throughput.is_black() { Fate::Swallowed } else { Fate::TooWeak };
            out.notes.add(|| Note::Sent(Sent { fate, ..Sent::of(sample) }));
            return;
        }
        let direction: DVec3 = hit.frame.to_world(wi).as_dvec3().normalize();
        // A shading normal may bend a ray to the wrong side of the true surface: such a ray is dropped.
        if !crossing::keeps_side(hit, direction, lobe) {
            out.notes.add(|| Note::Sent(Sent { fate: Fate::WrongSide, ..Sent::of(sample) }));
            return;
        }
        out.notes.add(|| Note::Sent(Sent::of(sample)));
        out.paths.push(PathState {
            ray: hit.ray_towards(direction, &path.ray),
            lanes: sample.lanes(path.lanes),
            throughput,
            depth: path.depth + 1,
            kind,
            branch: combine(path.branch, u64::from(number) << 8 | lobe as u64),
            media: crossing::media_towards(scene, &path.media, hit, direction),
            cone: crossing::cone_after(scene, path, hit, sample),
            passed: 0,
            travelled: 0.0,
            last: None,
        });
    }
}

const GLOSSY: u64 = of_name("glossy");
