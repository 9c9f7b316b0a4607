//! Tests of the optics crate. The statistical ones run over every listed model by themselves: a new model needs only its
//! parameter sets in `models.rs`.

mod closed_forms;
mod delta;
mod distribution;
mod energy;
mod extremes;
mod indices;
mod lanes;
mod merl;
mod microfacet;
mod models;
mod phase;
mod reference;
mod rgl;
mod samples;
mod spectrum;
mod thin_film;
mod values;

/// `|a - b| <= tolerance`, with both in the message.
#[track_caller]
pub fn near(a: impl Into<f64>, b: impl Into<f64>, tolerance: f64) {
    let (a, b) = (a.into(), b.into());
    assert!((a - b).abs() <= tolerance, "{a} is not {b} within {tolerance}");
}
