//! How light meets matter: lanes of light, Fresnel's equations, microfacets, and the models of scattering (BSDFs) that
//! materials are made of and of phase functions that media are made of.
//!
//! Nothing here knows of rays, textures or files. The renderer evaluates a material's textures into values and gets a
//! [`Bsdf`] back; all its directions are in a local frame whose +z is the shading normal.

pub mod bsdf;
pub mod fresnel;
pub mod index;
pub mod lanes;
pub mod light;
pub mod measured;
pub mod medium;
pub mod microfacet;
pub mod phase;
pub mod spectrum;
pub mod thin_film;

pub use bsdf::{Branches, Bsdf, BsdfModel, BsdfSample, Interface, Lobe, LobeSet, Mode, SPECS};
pub use index::Index;
pub use lanes::{ColorMode, FilmWeights, Lanes};
pub use light::Light;
pub use medium::Medium;
pub use phase::{PhaseFunction, PhaseSample};
pub use spectrum::{Paint, Palette, Spectrum};
