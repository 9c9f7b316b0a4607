//! # marble: wavy layers
//!
//! Layers across the x axis, shaken by noise, mixing two colours.
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default black and white): the two that are mixed.
//! - `octaves` (whole number, default 4): layers of the noise; 0 leaves the layers straight.
//! - `frequency` (number, radians per unit, default 1): how dense the layers are; one takes `2 pi / frequency` units.
//! - `amplitude` (number, radians, default 1): how strongly the noise shakes them.
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

use super::noise::{A, B, OCTAVES, octaves};
use super::perlin::turbulence;
use super::{ColorSource, PatternPoint, TextureInput, Textures};
use kirkas_geometry::elementary::sin;
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// The rows that `marble` and `wood` share.
pub(super) const ROWS: &[ParamSpec] = &[
    A,
    B,
    ParamSpec::integer("octaves", 4, OCTAVES, "layers of the noise, each twice as fine and half as strong"),
    ParamSpec::number("frequency", 1.0, "how dense the layers are; one takes 2 pi / frequency")
        .unit("radians per unit"),
    ParamSpec::number("amplitude", 1.0, "how strongly the noise shakes them").unit("radians"),
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
    octaves: u32,
    frequency: f64,
    amplitude: f64,
}

impl Marble {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Marble { sources: input.a_and_b(), layers: Layers::compile(input) }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        textures.mix(self.sources, self.layers.weight_of_a(at.position.x, at), at.original)
    }
}

impl Layers {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Layers {
            octaves: octaves(input),
            frequency: input.params.number("frequency"),
            amplitude: input.params.number("amplitude"),
        }
    }

    /// Of `a`, at a place whose coordinate across the layers is `across`.
    pub(super) fn weight_of_a(&self, across: f64, at: &PatternPoint) -> f64 {
        let phase = self.frequency * across + self.amplitude * turbulence(at.position, self.octaves);
        if phase.is_finite() { 0.5 + 0.5 * sin(phase) } else { 0.5 }
    }
}
