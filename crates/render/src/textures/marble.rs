//! # marble: wavy layers
//!
//! Layers across the x axis, shaken by noise, mixing two colours.
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default black and white): the two that are mixed.
//! - `octaves` (whole number, default 4): layers of the noise; 0 leaves the layers straight.
//! - `style`, `lacunarity`, `gain`: of these layers, as in `noise`.
//! - `frequency` (number, radians per unit, default 1): how dense the layers are; one takes `2 pi / frequency` units.
//! - `amplitude` (number, radians, default 1): how strongly the noise shakes them.
//! - `mapping` (`solid`, `uv` and the projections of `image`; default `solid`): through space, or laid on the surface.
//! - and those of all textures: `transform`, `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.marble]
//! type = "marble"
//! a = [0.2, 0.1, 0.5]
//! b = [0.8, 0.8, 1.0]
//! octaves = 5
//! frequency = 3
//! amplitude = 2
//! ```
//!
//! ## Limits
//!
//! The noise repeats after 256 units.
//!
//! ## References
//!
//! Weight of `a`: `(M + 1) / 2` with `M = sin(frequency x + amplitude N(p))`, `N` as in `noise`. After K. Perlin: "An Image
//! Synthesizer", 1985, <https://doi.org/10.1145/325165.325247>, as in MIT 6.837 (2004), assignment 6.

use super::fractal::{Fractal, GAIN, LACUNARITY, OCTAVES, STYLE};
use super::noise::{A, B};
use super::{ColorSource, PatternPoint, TextureInput, Textures, mapping};
use core::f64::consts::TAU;
use kirkas_geometry::DVec3;
use kirkas_geometry::elementary::{exp, sin};
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// The rows that `marble` and `wood` share.
pub(super) const ROWS: &[ParamSpec] = &[
    A,
    B,
    ParamSpec::integer("octaves", 4, OCTAVES, "layers of the noise, each finer and weaker"),
    STYLE,
    LACUNARITY,
    GAIN,
    ParamSpec::number("frequency", 1.0, "how dense the layers are; one takes 2 pi / frequency")
        .unit("radians per unit"),
    ParamSpec::number("amplitude", 1.0, "how strongly the noise shakes them").unit("radians"),
    mapping::SOLID_FIRST,
];

/// Its table.
pub const SPEC: TypeSpec =
    TypeSpec { kind: Kind::Texture, name: "marble", doc: "Wavy layers across the x axis.", params: ROWS };

#[derive(Clone, Debug)]
pub(super) struct Marble {
    sources: [ColorSource; 2],
    layers: Layers,
}

/// Layers along a coordinate, shaken by noise.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    fractal: Fractal,
    frequency: f64,
    amplitude: f64,
}

impl Marble {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Marble { sources: input.a_and_b(), layers: Layers::compile(input) }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        textures.mix(self.sources, self.layers.weight_of_a(at, |p| p.x), at.original)
    }
}

impl Layers {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Layers {
            fractal: Fractal::compile(input),
            frequency: input.params.number("frequency"),
            amplitude: input.params.number("amplitude"),
        }
    }

    /// Of `a`, the coordinate across the layers being `across`.
    pub(super) fn weight_of_a(&self, at: &PatternPoint, across: impl Fn(DVec3) -> f64) -> f64 {
        let finest = self.fractal.finest().max(self.frequency.abs() / TAU);
        at.solid_mean(finest, |p, width| {
            let phase = self.frequency * across(p) + self.amplitude * self.fractal.value(p, width);
            // A wave under a filter keeps its phase; its height falls as that of a Gaussian as wide as a tent over the sample.
            let angle = self.frequency * width;
            let height = if angle > 0.0 { 0.5 * exp(-angle * angle / 12.0) } else { 0.5 };
            if phase.is_finite() { 0.5 + height * sin(phase) } else { 0.5 }
        })
    }
}
