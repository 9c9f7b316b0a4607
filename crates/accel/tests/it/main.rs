//! The tests of accel as its users see it.

mod agreement;
mod common;
mod faults;
mod hostile;
mod meshes;
mod moving;
mod nested;
mod packets;
mod points;
mod proptests;
mod questions;
mod refit;
mod saved;
mod semantics;
mod solids;
mod surfaces;
mod tiny;
mod watertight;
