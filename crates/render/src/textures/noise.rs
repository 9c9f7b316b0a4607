//! # noise: clouds
//!
//! Smooth random blotches in space, mixing two colours; more octaves add finer detail.
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default black and white): the two that are mixed; `a` where the noise is high.
//! - `octaves` (whole number, default 1): layers, each twice as fine and half as strong.
//! - and those of all textures: `transform` (scale it to make the blotches larger), `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.clouds]
//! type = "noise"
//! a = [0.2, 0.4, 0.8]
//! b = 1
//! octaves = 5
//! transform = [{ scale = 0.5 }]
//! ```
//!
//! ## Limits
//!
//! Blotches are about one unit apart; the pattern repeats after 256 units. Weights beyond 0 and 1 are cut off.
//!
//! ## References
//!
//! `N(p) = noise(p) + noise(2 p) / 2 + noise(4 p) / 4 + ...`, weight of `a`: `N + 1/2`. As in MIT 6.837 (2004),
//! assignment 6, with the noise of K. Perlin: "Improving Noise", 2002, <https://doi.org/10.1145/566654.566636>.

use super::perlin::turbulence;
use super::{ColorSource, PatternPoint, TextureInput, Textures};
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// The row `a` of the mixing textures.
pub(super) const A: ParamSpec = ParamSpec::reflectance("a", [0.0; 3], "the one of the two that are mixed");
/// The row `b`.
pub(super) const B: ParamSpec = ParamSpec::reflectance("b", [1.0; 3], "the other");
/// The most octaves: beyond, a layer is finer than any pixel and weaker than any step of colour.
pub(super) const OCTAVES: (f64, f64) = (0.0, 32.0);

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "noise",
    doc: "Smooth random blotches in space.",
    params: &[A, B, ParamSpec::integer("octaves", 1, OCTAVES, "layers, each twice as fine and half as strong")],
};

#[derive(Clone, Debug)]
pub(super) struct Noise {
    sources: [ColorSource; 2],
    octaves: u32,
}

impl Noise {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Noise { sources: input.a_and_b(), octaves: octaves(input) }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        let weight_of_a = (0.5 + turbulence(at.position, self.octaves)).clamp(0.0, 1.0);
        textures.mix(self.sources, weight_of_a, at.original)
    }
}

pub(super) fn octaves(input: &TextureInput) -> u32 {
    input.params.integer("octaves").clamp(0, OCTAVES.1 as i64) as u32
}
