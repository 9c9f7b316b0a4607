//! # noise: clouds
//!
//! Smooth random blotches in space, mixing two colours; more octaves add finer detail.
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default black and white): the two that are mixed; `a` where the noise is high.
//! - `octaves` (whole number, default 1): layers, each finer and weaker than the one before.
//! - `style` (`fractal`, `turbulence`; default `fractal`): layers as they are, or without their signs, which makes creases.
//! - `lacunarity` (number, default 2): how much finer each layer is.
//! - `gain` (number, default 0.5): how strong each layer is beside the one before.
//! - `mapping` (`solid`, `uv` and the projections of `image`; default `solid`): through space, or laid on the surface.
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
//! Blotches are about one unit apart; the pattern repeats after 256 units. Weights beyond 0 and 1 are cut off. Layers finer than
//! what a sample covers fade into their mean.
//!
//! ## References
//!
//! `N(p) = noise(p) + gain noise(lacunarity p) + gain^2 noise(lacunarity^2 p) + ...`, weight of `a`: `N + 1/2`, for turbulence
//! `N` of the layers' absolute values. As in MIT 6.837 (2004),
//! assignment 6, with the noise of K. Perlin: "Improving Noise", 2002, <https://doi.org/10.1145/566654.566636>.

use super::fractal::{Fractal, GAIN, LACUNARITY, OCTAVES, STYLE};
use super::{ColorSource, PatternPoint, TextureInput, Textures, mapping};
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// The row `a` of the mixing textures.
pub(super) const A: ParamSpec = ParamSpec::reflectance("a", [0.0; 3], "the one of the two that are mixed");
/// The row `b`.
pub(super) const B: ParamSpec = ParamSpec::reflectance("b", [1.0; 3], "the other");

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "noise",
    doc: "Smooth random blotches in space.",
    params: &[
        A,
        B,
        ParamSpec::integer("octaves", 1, OCTAVES, "layers, each finer and weaker than the one before"),
        STYLE,
        LACUNARITY,
        GAIN,
        mapping::SOLID_FIRST,
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Noise {
    sources: [ColorSource; 2],
    fractal: Fractal,
    /// Added to the noise.
    middle: f64,
}

impl Noise {
    pub(super) fn compile(input: &TextureInput) -> Self {
        // Without signs it is no longer about 0.
        let middle = if input.params.text("style") == Some("turbulence") { 0.0 } else { 0.5 };
        Noise { sources: input.a_and_b(), fractal: Fractal::compile(input), middle }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        let weight = |p, width| (self.middle + self.fractal.value(p, width)).clamp(0.0, 1.0);
        let weight_of_a = at.solid_mean(self.fractal.finest(), weight);
        textures.mix(self.sources, weight_of_a, at.original)
    }
}
