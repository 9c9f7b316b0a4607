//! Fixed ray sets for measuring: the kinds of rays that rendering asks about, the same on every machine. After Aila & Laine
//! 2009 ("Understanding the Efficiency of Ray Traversal on GPUs"): camera rays, occlusion rays and diffuse bounces, and
//! random rays beside them.

use crate::{Accel, Counters, Query};
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_uniform_sphere};
use kirkas_geometry::{Bounds3, Frame, Ray, Vec3};

/// Rays on a side of the default set: 512 x 512 = 262,144.
pub const DEFAULT_SIDE: u32 = 512;

/// How long an occlusion ray is, in diagonals of the scene.
const OCCLUSION_LENGTH: f32 = 0.1;

/// How far rays start from the surface they leave, relative to the largest coordinate there.
const OFFSET: f32 = 1e-5;

/// How often each pixel is tried again where paths leave the scene.
const MAX_TRIES: u64 = 16;

/// A kind of rays, and the question they ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RaySet {
    /// Through the pixels of a pinhole camera in Morton order; nearest hit.
    Primary,
    /// Cosine-distributed from what the camera sees, at most a tenth of the scene's diagonal long; any hit.
    Occlusion,
    /// After one diffuse bounce; nearest hit.
    Diffuse1,
    /// After two diffuse bounces; nearest hit.
    Diffuse2,
    /// The rays of [`RaySet::Diffuse2`]; any hit.
    Diffuse2Any,
    /// From anywhere in the bounds in any direction; nearest hit.
    Random,
}

impl RaySet {
    /// Every set with its name.
    pub const ALL: [(RaySet, &str); 6] = [
        (RaySet::Primary, "primary"),
        (RaySet::Occlusion, "ao"),
        (RaySet::Diffuse1, "diff1"),
        (RaySet::Diffuse2, "diff2"),
        (RaySet::Diffuse2Any, "diff2any"),
        (RaySet::Random, "random"),
    ];

    /// True when the set asks for any hit, false when for the nearest.
    pub fn asks_any(self) -> bool {
        matches!(self, RaySet::Occlusion | RaySet::Diffuse2Any)
    }
}

/// A pinhole camera: rays run from `eye` through `center + x right + y up`, x and y in -1..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Where it stands.
    pub eye: Vec3,
    /// Unit vector to the middle of the picture.
    pub forward: Vec3,
    /// From the middle to the right edge of the picture, at unit distance.
    pub right: Vec3,
    /// From the middle to the upper edge of the picture, at unit distance.
    pub up: Vec3,
}

impl Pinhole {
    /// Look from `eye` at `target`; `half_width` is the tangent of half the opening angle. Up is +y, so do not look along it.
    pub fn look_at(eye: Vec3, target: Vec3, half_width: f32) -> Self {
        let forward = (target - eye).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        Pinhole { eye, forward, right: right * half_width, up: right.cross(forward) * half_width }
    }
}

/// What the rays are made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Where camera rays start.
    pub camera: Pinhole,
    /// The box around the scene.
    pub bounds: Bounds3,
    /// Rays on a side, a power of two.
    pub side: u32,
    /// Other seeds, other rays.
    pub seed: u64,
}

/// Where a ray ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Ray parameter of the nearest hit.
    pub t: f32,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3,
}

/// The rays of `set`: `side * side`, or fewer where hardly any path stays in the scene. `nearest` finds what a ray sees.
pub fn rays(set: RaySet, setup: &Setup, nearest: impl Fn(&Ray) -> Option<Surface>) -> Vec<Ray> {
    assert!(setup.side.is_power_of_two(), "rays on a side: a power of two");
    let count = setup.side as usize * setup.side as usize;
    if set == RaySet::Random {
        return (0..count as u64).map(|i| random_ray(setup, i)).collect();
    }
    let length = setup.bounds.extent().length() * OCCLUSION_LENGTH;
    let (bounces, t_max) = match set {
        RaySet::Primary | RaySet::Random => (0, f32::INFINITY),
        RaySet::Occlusion => (1, length),
        RaySet::Diffuse1 => (1, f32::INFINITY),
        RaySet::Diffuse2 | RaySet::Diffuse2Any => (2, f32::INFINITY),
    };
    let paths = (0..count as u64 * MAX_TRIES).filter_map(|i| path(setup, i, bounces, &nearest));
    paths.take(count).map(|ray| ray.until(t_max)).collect()
}

/// What a ray sees in `accel`. User shapes have no normal here: they are taken to face the ray.
pub fn nearest_in(accel: &Accel) -> impl Fn(&Ray) -> Option<Surface> + '_ {
    |ray| {
        let hit = accel.closest_hit(ray, Query::ALL, 0, &mut Counters::default())?;
        let normal = accel.normal(ray, &hit).map(|n| n.as_vec3()).filter(|n| n.is_finite() && *n != Vec3::ZERO);
        Some(Surface { t: hit.t, normal: normal.unwrap_or_else(|| -ray.direction.normalize()) })
    }
}

/// The ray that path `index` sends off after some diffuse bounces; `None` when the path leaves the scene before.
fn path(setup: &Setup, index: u64, bounces: u64, nearest: impl Fn(&Ray) -> Option<Surface>) -> Option<Ray> {
    let pixels = u64::from(setup.side) * u64::from(setup.side);
    let mut ray = camera_ray(setup, (index % pixels) as u32);
    for bounce in 0..bounces {
        let surface = nearest(&ray)?;
        let p = ray.at(surface.t);
        let faces_away = surface.normal.dot(ray.direction) > 0.0;
        let frame = Frame::from_z(if faces_away { -surface.normal } else { surface.normal });
        let direction = frame.to_world(square_to_cosine_hemisphere(random_pair(setup, index, bounce)));
        ray = Ray::new(p + frame.z * (p.abs().max_element() * OFFSET), direction);
    }
    Some(ray)
}

/// Through the middle of a pixel, counted in Morton order.
fn camera_ray(setup: &Setup, pixel: u32) -> Ray {
    let at = |k: u32| (k as f32 + 0.5) / setup.side as f32 * 2.0 - 1.0;
    let (x, y) = (at(even_bits(pixel)), -at(even_bits(pixel >> 1)));
    let c = &setup.camera;
    Ray::new(c.eye, (c.forward + c.right * x + c.up * y).normalize())
}

/// Bits 0, 2, 4... of `x`, moved together.
fn even_bits(x: u32) -> u32 {
    (0..16).fold(0, |out, k| out | (x >> (2 * k) & 1) << k)
}

fn random_ray(setup: &Setup, index: u64) -> Ray {
    let ((x, y), (z, _)) = (random_pair(setup, index, 8), random_pair(setup, index, 9));
    let origin = setup.bounds.min + setup.bounds.extent() * Vec3::new(x, y, z);
    Ray::new(origin, square_to_uniform_sphere(random_pair(setup, index, 10)))
}

/// Two numbers in `[0, 1)`.
fn random_pair(setup: &Setup, index: u64, dimension: u64) -> (f32, f32) {
    let bits = combine(combine(setup.seed, index), dimension);
    (unit_f32(bits as u32), unit_f32((bits >> 32) as u32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AccelKind, Aggregate, Geometry, Instance, SceneGeometry, Serial, Shape};
    use kirkas_geometry::transform::rotation;
    use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3};

    /// A camera at the height of 3 above the disk of radius 2 in the plane y = 0.
    fn setup() -> Setup {
        let camera = Pinhole::look_at(Vec3::new(0.0, 3.0, 0.1), Vec3::ZERO, 0.5);
        Setup { camera, bounds: Bounds3::from_corners(Vec3::splat(-2.0), Vec3::splat(2.0)), side: 16, seed: 3 }
    }

    fn disk(ray: &Ray) -> Option<Surface> {
        let t = -ray.origin.y / ray.direction.y;
        let is_hit = t > 0.0 && ray.at(t).length() < 2.0;
        is_hit.then_some(Surface { t, normal: Vec3::NEG_Y })
    }

    #[test]
    fn camera_rays_run_through_every_pixel_once_and_neighbours_follow_each_other() {
        let setup = setup();
        let all = rays(RaySet::Primary, &setup, disk);
        let mut distinct: Vec<[u32; 3]> = all.iter().map(|r| r.direction.to_array().map(f32::to_bits)).collect();
        distinct.sort();
        distinct.dedup();
        assert_eq!(distinct.len(), 256);
        let block = |k: usize| all[k].direction.distance(all[k + 3].direction);
        assert!((0..64).all(|k| block(4 * k) < 0.15), "four rays in a row are a block of 2 x 2");
    }

    #[test]
    fn bounces_leave_the_side_that_was_seen() {
        let all = rays(RaySet::Diffuse1, &setup(), disk);
        assert_eq!(all.len(), 256);
        assert!(all.iter().all(|r| r.direction.y > 0.0 && r.origin.y > 0.0 && r.origin.y < 1e-3));
        let mean = all.iter().map(|r| r.direction.y).sum::<f32>() / 256.0;
        assert!((mean - 2.0 / 3.0).abs() < 0.05, "cosine-distributed: {mean}");
    }

    #[test]
    fn sets_are_full_where_paths_stay_and_short_where_all_leave() {
        let half = |ray: &Ray| disk(ray).filter(|s| ray.at(s.t).x > 0.0);
        assert_eq!(rays(RaySet::Occlusion, &setup(), half).len(), 256, "other samples replace what left");
        assert!(rays(RaySet::Diffuse2, &setup(), disk).is_empty(), "nothing returns from above a disk");
    }

    #[test]
    fn normals_follow_instances_within_instances() {
        let turn = |axis: DVec3| AnimatedTransform::still(DAffine3::from_mat3(rotation(axis, 90.0)));
        let place = |aggregate, axis| Instance { aggregate, outer_from_object: turn(axis), mask: u32::MAX };
        let positions = [Vec3::new(-9.0, -9.0, 0.0), Vec3::new(9.0, -9.0, 0.0), Vec3::new(0.0, 9.0, 0.0)].to_vec();
        let shape = Shape::Triangles { positions: positions.into(), indices: vec![[0, 1, 2]].into() };
        let mut outer = Aggregate::default();
        outer.instances.push(place(1, DVec3::Y));
        let inner = vec![Geometry { shape, opaque: true, mask: u32::MAX }].into();
        let scene = SceneGeometry {
            aggregates: vec![outer, inner],
            instances: vec![place(0, DVec3::Z)],
            ..SceneGeometry::default()
        };
        // The normal z becomes x by the inner turn, and y by the outer one.
        let accel = Accel::build(AccelKind::BruteForce, scene, &Serial).expect("a sound scene");
        let seen = nearest_in(&accel)(&Ray::new(Vec3::Y * 2.0, Vec3::NEG_Y)).expect("a hit");
        assert_eq!(seen.t, 2.0);
        assert!((seen.normal.y.abs() - 1.0).abs() < 1e-6, "{seen:?}");
    }

    #[test]
    fn random_rays_start_anywhere_in_the_bounds() {
        let setup = setup();
        let all = rays(RaySet::Random, &setup, |_| None);
        assert!(all.iter().all(|r| setup.bounds.contains(r.origin)));
        let octant = |v: Vec3| (v.x > 0.0) as usize + 2 * (v.y > 0.0) as usize + 4 * (v.z > 0.0) as usize;
        let mut seen = [[0; 8]; 2];
        for r in &all {
            seen[0][octant(r.origin)] += 1;
            seen[1][octant(r.direction)] += 1;
        }
        assert!(seen.iter().flatten().all(|n| (16..64).contains(n)), "{seen:?}");
    }
}
