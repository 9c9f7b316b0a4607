//! # wood: wavy rings
//!
//! Rings around the y axis, shaken by noise, mixing two colours: a log that stands upright.
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default black and white): the two that are mixed.
//! - `octaves` (whole number, default 4): layers of the noise; 0 leaves the rings round.
//! - `style`, `lacunarity`, `gain`: of these layers, as in `noise`.
//! - `frequency` (number, radians per unit, default 1): how dense the rings are; one takes `2 pi / frequency` units.
//! - `amplitude` (number, radians, default 1): how strongly the noise shakes them.
//! - `mapping` (`solid`, `uv` and the projections of `image`; default `solid`): through space, or laid on the surface.
//! - and those of all textures: `transform` (turn it to lay the log down), `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.board]
//! type = "wood"
//! a = [0.5, 0.2, 0.1]
//! b = [1.0, 0.8, 0.8]
//! octaves = 5
//! frequency = 7
//! amplitude = 2
//! transform = [{ rotate = [1, 0, 0, 90] }]
//! ```
//!
//! ## Limits
//!
//! The noise repeats after 256 units.
//!
//! ## References
//!
//! Weight of `a`: `(M + 1) / 2` with `M = sin(frequency sqrt(x^2 + z^2) + amplitude N(p))`, `N` as in `noise`. After
//! K. Perlin: "An Image Synthesizer", 1985, <https://doi.org/10.1145/325165.325247>, as in MIT 6.837 (2004), assignment 6.

use super::marble::{Layers, ROWS};
use super::{ColorSource, PatternPoint, TextureInput, Textures};
use kirkas_scene::{Kind, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec =
    TypeSpec { kind: Kind::Texture, name: "wood", doc: "Wavy rings around the y axis.", params: ROWS };

#[derive(Clone, Debug)]
pub(super) struct Wood {
    sources: [ColorSource; 2],
    layers: Layers,
}

impl Wood {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Wood { sources: input.a_and_b(), layers: Layers::compile(input) }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        let weight_of_a = self.layers.weight_of_a(at, |p| (p.x * p.x + p.z * p.z).sqrt());
        textures.mix(self.sources, weight_of_a, at.original)
    }
}
