//! The command line as a user meets it: the built program, run on small scenes.

mod common;

mod adaptive;
mod aovs;
mod bench;
mod bits;
mod brdf;
mod commands;
mod denoise;
mod errors;
mod explain;
mod faults;
mod films;
mod interruptions;
mod pages;
mod relight;
mod samplers;
mod spectral_bins;
