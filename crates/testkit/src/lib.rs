//! Instruments for tests: is what was sampled what the density says, does no energy appear from nowhere, do two images
//! agree. All take closures and slices, so no crate's types are needed, and all are deterministic: seeds are arguments.
//!
//! Many tests at once find a "significant" one by chance: choose one level for all and pass
//! [`sidak`](statistics::sidak) of it to each.

pub mod chi_square;
pub mod furnace;
pub mod images;
pub mod random;
pub mod sphere;
pub mod statistics;

pub use chi_square::{ChiSquare, ChiSquareResult};
pub use furnace::{Estimate, albedo_by_quadrature, albedo_by_sampling, reciprocity_error};
pub use images::{Measured, ZTest, fraction_within, z_test};
pub use random::Random;
pub use sphere::integrate_sphere;
pub use statistics::sidak;
