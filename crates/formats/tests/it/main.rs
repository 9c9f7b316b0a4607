//! Tests of the readers and writers.

mod damaged;
mod load;
mod mit6837;
mod obj;
mod ply;
mod schema;
mod show;
mod toml;
mod toml_broken;
mod toml_errors;
