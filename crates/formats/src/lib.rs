//! Scene and mesh files, read into the description and written back.
//!
//! Everything is read through [`kirkas_scene::files::FileAccess`]; nothing here knows how a picture is made. A reader
//! takes any bytes: it answers with a description or with a [`Failure`] that says what is wrong and where.

pub mod load;

pub mod mit6837;
pub mod obj;
pub mod ply;
pub mod toml;

pub mod assets;
pub mod failure;
pub mod manual;
pub mod mesh_scene;
pub mod paths;
pub mod schema;

mod json;

pub use assets::{FormatAssets, MeshCache};
pub use failure::Failure;
pub use load::{load, load_cached, load_with_warnings};
pub use paths::rebase_paths;
