//! Tests of the readers and writers.

mod mit6837;
mod obj;
mod ply;
mod toml;
