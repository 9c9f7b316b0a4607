//! Scene and mesh files, read into the description and written back.
//!
//! Everything is read through [`kirkas_scene::files::FileAccess`]; nothing here knows how a picture is made. A reader
//! takes any bytes: it answers with a description or with a [`Failure`] that says what is wrong and where.

pub mod failure;

pub mod toml;

pub mod mit6837;
pub mod obj;
pub mod ply;

pub use failure::Failure;
