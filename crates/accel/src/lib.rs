//! Rays against triangles, quads, spheres, disks, cylinders, round curves and user shapes, with instances of instances and
//! motion. Knows nothing of materials or files, and owns no threads: the caller lends an [`Executor`].
//!
//! **A hit has one definition**, shared by every structure. A primitive is hit when its own test passes ([`triangle`],
//! [`sphere`], [`UserShape`]), its own bounds pass [`Bounds3::intersect`], and `t` lies in the ray's open interval; `t` is
//! then clamped into the interval within those bounds (and within the bounds of its instances). The nearest `t` wins, ties
//! go to the lowest (path of instances, geometry, primitive). Box tests are monotone and equal `t` is never culled, so
//! every tree of boxes answers exactly as [`AccelKind::BruteForce`] does, to the bit. The structures of cells and of spheres
//! allow for the roundings between a hit and its bounds, and so do as well.
//!
//! # What to hit
//!
//! [`Shape`] lists it: triangles, still or moving, quads, spheres, disks, cylinders, round curves, and whatever implements
//! [`UserShape`]. A [`Geometry`] is a shape with its visibility; a [`SceneGeometry`] holds geometries, [`Aggregate`]s of them, and
//! [`Instance`]s of aggregates. [`Accel::build`] answers a scene that cannot be with an [`AccelError`] that names the fault.
//!
//! # What to ask
//!
//! The nearest hit, whether there is any, and both for a batch of rays, which is the fastest way to ask:
//!
//! ```
//! use kirkas_accel::*;
//! use kirkas_geometry::{DVec3, Ray, Vec3};
//! use std::sync::Arc;
//!
//! let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
//! let scene = SceneGeometry {
//!     world: vec![Geometry { shape: Shape::Spheres(Arc::new(vec![ball])), opaque: true, mask: u32::MAX }],
//!     ..SceneGeometry::default()
//! };
//! let accel = Accel::build(AccelKind::default(), scene, &Serial)?;
//! let counters = &mut Counters::default();
//!
//! let ray = Ray::new(Vec3::new(0.0, 0.0, 5.0), -Vec3::Z);
//! let hit = accel.closest_hit(&ray, Query::ALL, 0, counters).unwrap();
//! assert_eq!((hit.t, hit.primitive), (4.0, 0));
//! assert_eq!(accel.normal(&ray, &hit), Some(DVec3::Z));
//! assert!(!accel.any_hit(&ray.until(3.0), Query::ALL, 0, counters));
//!
//! let rays: Vec<Ray> = (0..8).map(|k| Ray::new(Vec3::new(0.25 * k as f32, 0.0, 5.0), -Vec3::Z)).collect();
//! let mut hits = vec![None; rays.len()];
//! accel.closest_hits(&rays, Query::ALL, &mut hits, counters);
//! assert_eq!(hits.iter().flatten().count(), 4);
//!
//! // The same rays, each blind to what it hit.
//! let excluded: Vec<_> = hits.iter().map(|hit| hit.map(|hit| hit.id())).collect();
//! let mut blocked = vec![true; rays.len()];
//! accel.any_hits(&rays, Query::ALL.excluding(&excluded), &mut blocked, counters);
//! assert!(!blocked.contains(&true));
//!
//! // All hits along a ray, nearest first.
//! let mut all = Vec::new();
//! accel.all_hits(&ray, Query::ALL, 0, counters, &mut |hit| {
//!     all.push(hit.t);
//!     false // go on
//! });
//! assert_eq!(all, [4.0, 6.0]);
//!
//! // The closest point of all surfaces.
//! let near = accel.closest_point(&PointQuery::new(Vec3::new(0.0, 3.0, 0.0), f32::INFINITY)).unwrap();
//! assert_eq!((near.distance, near.position), (2.0, Vec3::Y));
//! # Ok::<(), AccelError>(())
//! ```
//!
//! A [`HitFilter`] decides about hits on what is not opaque, for cut-outs and the like: [`Query::filtered`].
//!
//! # Instances
//!
//! Aggregates are placed into the world and into each other, up to [`MAX_NESTING`] deep, still or moving; an [`InstancePath`] tells
//! the way to a hit. However deep, rays are transformed once, in f64.
//!
//! ```
//! use kirkas_accel::*;
//! use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Ray, Vec3};
//! use std::sync::Arc;
//!
//! let quad = Shape::Quads {
//!     positions: Arc::new(vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y]),
//!     indices: Arc::new(vec![[0, 1, 2, 3]]),
//! };
//! let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
//! let instance = |aggregate, outer_from_object| Instance { aggregate, outer_from_object, mask: u32::MAX };
//! let scene = SceneGeometry {
//!     aggregates: vec![
//!         vec![Geometry { shape: quad, opaque: true, mask: u32::MAX }].into(),
//!         // Two copies of aggregate 0, side by side.
//!         Aggregate { instances: [0.0, 2.0].map(|x| instance(0, AnimatedTransform::still(at(x)))).into(), ..Default::default() },
//!     ],
//!     // Both, on the way from x = 0 to x = 10.
//!     instances: vec![instance(1, AnimatedTransform::from_keys(&[(0.0, at(0.0)), (1.0, at(10.0))]).unwrap())],
//!     shutter: (0.0, 1.0),
//!     ..SceneGeometry::default()
//! };
//! let accel = Accel::build(AccelKind::Bvh2, scene, &Serial)?;
//! let ray = Ray::new(Vec3::new(7.25, 0.5, 1.0), -Vec3::Z).at_time(0.5);
//! let hit = accel.closest_hit(&ray, Query::ALL, 0, &mut Counters::default()).unwrap();
//! assert_eq!((hit.instance.iter().collect::<Vec<_>>(), hit.u, hit.v), (vec![0, 1], 0.25, 0.5));
//! # Ok::<(), AccelError>(())
//! ```
//!
//! # Motion within a mesh
//!
//! ```
//! use kirkas_accel::*;
//! use kirkas_geometry::{Ray, Vec3};
//! use std::sync::Arc;
//!
//! let open = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
//! let close = open.iter().map(|p| *p + Vec3::Z * 4.0).collect();
//! let shape = Shape::MovingTriangles { keys: Arc::new(vec![open, close]), indices: Arc::new(vec![[0, 1, 2]]) };
//! let scene = SceneGeometry {
//!     world: vec![Geometry { shape, opaque: true, mask: u32::MAX }],
//!     shutter: (0.0, 1.0),
//!     ..SceneGeometry::default()
//! };
//! let accel = Accel::build(AccelKind::Bvh2, scene, &Serial)?;
//! let ray = Ray::new(Vec3::new(0.25, 0.25, 9.0), -Vec3::Z).at_time(0.75);
//! assert_eq!(accel.closest_hit(&ray, Query::ALL, 0, &mut Counters::default()).unwrap().t, 6.0);
//! # Ok::<(), AccelError>(())
//! ```
//!
//! # Shapes of one's own
//!
//! ```
//! use kirkas_accel::*;
//! use kirkas_geometry::{Bounds3, Ray, Vec3};
//! use std::sync::Arc;
//!
//! /// The ground, y = 0, without end.
//! struct Ground;
//!
//! impl UserShape for Ground {
//!     fn len(&self) -> usize {
//!         1
//!     }
//!     fn bounds(&self, _primitive: u32) -> Bounds3 {
//!         let mut bounds = Bounds3::EVERYTHING;
//!         (bounds.min.y, bounds.max.y) = (0.0, 0.0);
//!         bounds
//!     }
//!     fn intersect(&self, _primitive: u32, ray: &Ray, visit: &mut dyn FnMut(f32, f32, f32) -> bool) {
//!         let t = -ray.origin.y / ray.direction.y;
//!         if t > ray.t_min && t < ray.t_max {
//!             visit(t, 0.0, 0.0);
//!         }
//!     }
//! }
//!
//! let scene = SceneGeometry {
//!     world: vec![Geometry { shape: Shape::User(Arc::new(Ground)), opaque: true, mask: u32::MAX }],
//!     ..SceneGeometry::default()
//! };
//! let accel = Accel::build(AccelKind::Bvh2, scene, &Serial)?;
//! let ray = Ray::new(Vec3::new(3.0, 2.0, 0.0), Vec3::new(1.0, -0.5, 0.0));
//! assert_eq!(accel.closest_hit(&ray, Query::ALL, 0, &mut Counters::default()).unwrap().t, 4.0);
//! # Ok::<(), AccelError>(())
//! ```

mod accel;
mod brute_force;
mod build;
mod bvh2;
mod cells;
mod check;
mod checksum;
mod closest;
pub mod curve;
pub mod cylinder;
pub mod disk;
mod error;
mod executor;
mod fingerprint;
mod gather;
mod grid;
mod hit;
mod instance;
mod kd_tree;
mod kind;
mod local_ray;
mod memory;
pub mod moving;
mod normal;
mod path;
mod prepared_ray;
mod primitive;
pub mod quad;
mod query;
pub mod ray_sets;
mod record;
mod refit;
mod saved;
mod scene_geometry;
mod search;
pub mod sphere;
mod sphere_hierarchy;
mod structure;
pub mod triangle;
mod wide;

pub use accel::{Accel, Statistics};
pub use closest::{PointHit, PointQuery, SurfacePoint};
pub use error::AccelError;
pub use executor::{Executor, Serial};
pub use hit::{Counters, Hit, PrimitiveId};
pub use kind::AccelKind;
pub use path::{InstancePath, MAX_NESTING, NO_INSTANCE};
pub use prepared_ray::PreparedRay;
pub use query::{HitFilter, Query};
pub use refit::RefitError;
pub use saved::SavedTreeError;
pub use scene_geometry::{Aggregate, CurvePoint, Cylinder, Disk, Geometry, Instance};
pub use scene_geometry::{SceneGeometry, Shape, Sphere, UserShape};

#[cfg(doc)]
use kirkas_geometry::Bounds3;
