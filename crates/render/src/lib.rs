//! From a description to an image: compile it, move rays through it, add up light.
//!
//! In the order in which a ray meets them: [`compile_scene`] · [`frames`] · [`render`] (the main path on one page) · [`camera`] ·
//! [`sampler`] · [`shapes`] · [`materials`] · [`textures`] · [`lights`] · [`background`] · [`integrators`] · [`film`] ·
//! [`observe`].
//!
//! Knows nothing of file syntax, terminals, clocks or sockets.

pub mod background;
pub mod camera;
pub mod catalog;
pub mod compile_scene;
pub mod film;
pub mod flock;
pub mod frames;
pub mod integrators;
pub mod lights;
pub mod materials;
pub mod media;
pub mod observe;
mod placement;
pub mod render;
pub mod sampler;
pub mod scene;
pub mod shapes;
pub mod statistics;
pub mod textures;
mod wave_files;

pub use catalog::catalog;
pub use compile_scene::{Options, Prepared, prepare};
pub use film::{Film, FilmLayout, Rect};
pub use render::{Control, Renderer};
pub use scene::Scene;
pub use statistics::Statistics;
