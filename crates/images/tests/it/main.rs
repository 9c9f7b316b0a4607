//! The tests of `kirkas-images`, one module per promise.

mod colour;
mod decoding;
mod exr;
mod flip;
mod hdr;
mod hostile;
mod metrics;
mod png;
mod samples;
