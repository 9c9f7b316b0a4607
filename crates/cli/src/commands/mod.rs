//! One file per command.

pub mod bench;
pub mod brdf;
pub mod check;
pub mod completions;
pub mod convert;
pub mod diff;
pub mod explain;
pub mod merge;
pub mod relight;
pub mod render;
pub mod schema;
