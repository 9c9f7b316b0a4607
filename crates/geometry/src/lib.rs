//! The ground floor of Kirkas: vectors, rays, bounds, frames, transforms, hashes, sample points and
//! portable elementary functions. Nothing here knows of light or of a scene.
//!
//! Everything is a pure function of its arguments and gives the same bits on every platform: only unfused
//! `+ - * / sqrt` in written order, and [`elementary`] for the rest.

pub mod bounds;
pub mod elementary;
pub mod frame;
pub mod halton;
pub mod hash;
pub mod low_discrepancy;
pub mod motion;
pub mod permutation;
pub mod ray;
pub mod rounding;
pub mod transform;
pub mod warp;

pub use bounds::Bounds3;
pub use frame::Frame;
pub use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3, Vec4};
pub use motion::AnimatedTransform;
pub use ray::Ray;
