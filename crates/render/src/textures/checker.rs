//! # checker: two colours in squares
//!
//! Squares on the surface (`mapping = "uv"`), or cubes in space that the object is carved from (`"solid"`).
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default white and black): the two; `a` fills the square that starts at the origin.
//! - `mapping` (`uv`, `solid`; default `uv`): squares of the texture coordinates, or cubes in space.
//! - `scale` (number, squares per unit, default 1): how many squares, or cubes, go into one unit.
//! - and those of all textures: `transform`, `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.floor]
//! type = "checker"
//! a = [0.8, 0.8, 0.8]
//! b = "#203040"
//! mapping = "solid"
//! scale = 2
//! ```
//!
//! ## Limits
//!
//! Edges are hard: they become smooth by the samples of each pixel only. A surface that lies exactly in a plane between
//! cubes shows rounding errors; shift the pattern a little with `transform`.
//!
//! ## References
//!
//! As in MIT 6.837 (2004), assignment 6: `floor(x) + floor(y) + floor(z)` even is `a`, odd is `b`.

use super::{ColorSource, PatternPoint, TextureInput, Textures};
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "checker",
    doc: "Two colours in squares or cubes.",
    params: &[
        ParamSpec::reflectance("a", [1.0; 3], "the square that starts at the origin"),
        ParamSpec::reflectance("b", [0.0; 3], "its neighbours"),
        ParamSpec::choice("mapping", &["uv", "solid"], "squares of the texture coordinates, or cubes in space"),
        ParamSpec::number("scale", 1.0, "how many squares go into one unit").unit("squares per unit").range(POSITIVE),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Checker {
    sources: [ColorSource; 2],
    is_solid: bool,
    scale: f64,
}

impl Checker {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Checker {
            sources: input.a_and_b(),
            is_solid: input.params.text("mapping") == Some("solid"),
            scale: input.params.number("scale"),
        }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        let cell = |x: f64| (x * self.scale).floor();
        let sum = if self.is_solid {
            cell(at.position.x) + cell(at.position.y) + cell(at.position.z)
        } else {
            cell(at.uv[0]) + cell(at.uv[1])
        };
        let is_odd = sum.rem_euclid(2.0) == 1.0;
        textures.lookup(self.sources[usize::from(is_odd)], at.original)
    }
}
