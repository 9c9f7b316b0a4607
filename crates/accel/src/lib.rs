//! Rays against triangles, quads, spheres, disks, cylinders, round curves and user shapes, with instances of instances and
//! motion. Knows nothing of materials or files, and
//! owns no threads: the caller lends an [`Executor`].
//!
//! **A hit has one definition**, shared by every structure. A primitive is hit when its own test passes ([`triangle`],
//! [`sphere`], [`UserShape`]), its own bounds pass [`Bounds3::intersect`], and `t` lies in the ray's open interval; `t` is
//! then clamped into the interval within those bounds (and within the bounds of its instance). The nearest `t` wins, ties
//! go to the lowest (path of instances, geometry, primitive). Box tests are monotone and equal `t` is never culled, so every tree
//! of boxes answers exactly as [`AccelKind::BruteForce`] does, to the bit.
//!
//! ```
//! use kirkas_accel::*;
//! use kirkas_geometry::{Ray, Vec3};
//! use std::sync::Arc;
//!
//! let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
//! let scene = SceneGeometry {
//!     world: vec![Geometry { shape: Shape::Spheres(Arc::new(vec![ball])), opaque: true, mask: u32::MAX }],
//!     ..SceneGeometry::default()
//! };
//! let accel = Accel::build(AccelKind::Bvh2, scene, &Serial)?;
//! let ray = Ray::new(Vec3::new(0.0, 0.0, 5.0), -Vec3::Z);
//! let hit = accel.closest_hit(&ray, Query::ALL, 0, &mut Counters::default()).unwrap();
//! assert_eq!(hit.t, 4.0);
//! # Ok::<(), AccelError>(())
//! ```

mod accel;
mod brute_force;
mod build;
mod bvh2;
mod check;
pub mod curve;
pub mod cylinder;
pub mod disk;
mod error;
mod executor;
mod hit;
mod instance;
mod kind;
mod local_ray;
pub mod moving;
mod path;
mod prepared_ray;
mod primitive;
pub mod quad;
mod query;
pub mod ray_sets;
mod record;
mod scene_geometry;
mod search;
pub mod sphere;
mod structure;
pub mod triangle;
mod wide;

pub use accel::{Accel, Statistics};
pub use error::AccelError;
pub use executor::{Executor, Serial};
pub use hit::{Counters, Hit, PrimitiveId};
pub use kind::AccelKind;
pub use path::{InstancePath, MAX_NESTING, NO_INSTANCE};
pub use prepared_ray::PreparedRay;
pub use query::{HitFilter, Query};
pub use scene_geometry::{Aggregate, Geometry, Instance, SceneGeometry, Shape, Sphere, UserShape};
pub use scene_geometry::{CurvePoint, Cylinder, Disk};

#[cfg(doc)]
use kirkas_geometry::Bounds3;
