//! What a surface does to a path besides scattering: bodies that are entered and left, boundaries that others cover, and sides
//! that a shading normal gets wrong. Every integrator does these alike.

use super::{Blocker, MediumStack, PathState, ShadowRay};
use crate::media::Way;
use crate::sampler::Sampler;
use crate::scene::{AlphaFilter, Scene, SurfaceHit};
use crate::textures::RayCone;
use kirkas_geometry::{DVec3, Ray};
use kirkas_optics::{Bsdf, BsdfSample, Light, Lobe};

/// Covered boundaries passed in a row before a path is given up.
const MOST_PASSED: u32 = 256;

/// True when the surface is not there: a hull, or a boundary that lies inside a body of higher rank.
#[inline]
pub fn is_covered(scene: &Scene, path: &PathState, hit: &SurfaceHit) -> bool {
    let material = scene.material(hit);
    material.is_hull || material.medium.is_some() && scene.is_covered(&path.media, hit.material, hit.is_front)
}

/// The path behind a covered boundary; `None` when it has passed too many.
pub fn passed(path: &PathState, hit: &SurfaceHit) -> Option<PathState> {
    let media = if hit.is_front { path.media.entered(hit.material) } else { path.media.left(hit.material) };
    (path.passed < MOST_PASSED).then(|| PathState {
        ray: hit.ray_towards(path.ray.direction.as_dvec3(), &path.ray),
        media,
        cone: path.cone.after(distance(path, hit)),
        passed: path.passed + 1,
        travelled: path.travelled + distance(path, hit),
        ..*path
    })
}

fn distance(path: &PathState, hit: &SurfaceHit) -> f32 {
    hit.t * path.ray.direction.length()
}

/// The cone of the path that goes on with `sample`.
#[inline]
pub fn cone_after(scene: &Scene, path: &PathState, hit: &SurfaceHit, sample: &BsdfSample) -> RayCone {
    if path.cone == RayCone::POINT {
        return RayCone::POINT;
    }
    let cone = path.cone.after(distance(path, hit));
    match sample.lobe {
        Lobe::DeltaReflection => cone.mirrored(scene.curvature(hit)),
        Lobe::DeltaTransmission => cone.refracted(scene.curvature(hit), sample.eta),
        _ => cone.scattered(sample.pdf),
    }
}

/// The ray along `ray` that asks whether `light` arrives from lamp number `lamp`, through these bodies; `None` if there is no light
/// to ask for. What fades light on its way does so now if it stays in one body, else as it goes.
#[inline(always)]
pub fn ask(
    scene: &Scene,
    path: &PathState,
    sampler: &Sampler,
    ray: Ray,
    media: MediumStack,
    light: Light,
    lamp: u32,
) -> Option<ShadowRay> {
    let lamp = scene.pieces.light(lamp);
    let (blocked_by, light) = if scene.has_hulls {
        (Blocker::AllButHulls, light)
    } else if scene.is_empty(&media) {
        (Blocker::Anything, light)
    } else {
        let key = AlphaFilter::shadow_key(sampler, path.branch);
        let way = Way::of_ray(&ray, ray.t_max.min(if ray.t_max.is_finite() { 1.0 } else { f32::INFINITY }));
        (Blocker::Anything, light * scene.transmittance(&path.lanes, &media, &way, key))
    };
    (!light.is_black()).then(|| ShadowRay {
        ray,
        lanes: path.lanes,
        light,
        group: scene.lights[lamp as usize].group,
        branch: path.branch,
        lamp,
        blocked_by,
        media,
        passed: 0,
    })
}

/// The surface's scattering, with the bodies on both its sides.
#[inline(always)]
pub fn bsdf(scene: &Scene, path: &PathState, hit: &SurfaceHit) -> Bsdf {
    let interface = scene.interface(&path.lanes, &path.media, hit);
    scene.bsdf(&path.lanes, hit, interface)
}

/// True when light along `direction` (away from the surface, in the world), which the shading frame has on the side of `local_z`,
/// is on that side of the true surface as well. Light that a shading normal would let through an opaque surface is not let through.
pub fn agrees(hit: &SurfaceHit, direction: DVec3, local_z: f32) -> bool {
    let side = direction.dot(hit.normal);
    side != 0.0 && (side > 0.0) == (local_z > 0.0)
}

/// True when `lobe` sends the path to the side of the true surface that such a lobe goes to.
pub fn keeps_side(hit: &SurfaceHit, direction: DVec3, lobe: Lobe) -> bool {
    (goes_up(hit, direction) == hit.is_front) != lobe.is_transmission()
}

/// Bodies around a ray that leaves the surface along `direction`.
#[inline(always)]
pub fn media_towards(scene: &Scene, media: &MediumStack, hit: &SurfaceHit, direction: DVec3) -> MediumStack {
    match (goes_up(hit, direction), hit.is_front) {
        _ if scene.material(hit).medium.is_none() => *media,
        (false, true) => media.entered(hit.material),
        (true, false) => media.left(hit.material),
        _ => *media,
    }
}

fn goes_up(hit: &SurfaceHit, direction: DVec3) -> bool {
    direction.dot(hit.normal) > 0.0
}
