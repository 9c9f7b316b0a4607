//! # vertex_color: colours of a mesh's vertices
//!
//! What a PLY file says in `red`, `green`, `blue` and an OBJ file behind the position of a `v` line, mixed over each triangle.
//!
//! ## Parameters
//!
//! - `fallback` (colour or texture, default white): where the object has no such colours.
//! - `scale` (number, default 1): the colours are multiplied by it.
//! - and those of all textures: `transform` and `space` do not matter.
//!
//! ## Example
//!
//! ```toml
//! [textures.scan]
//! type = "vertex_color"
//! fallback = [0.5, 0.5, 0.5]
//! ```
//!
//! ## Limits
//!
//! Whole numbers of a PLY file are sRGB codes, its floats and those of an OBJ file linear. Triangles smaller than a pixel are not
//! filtered: the samples of each pixel must average them.
//!
//! ## References
//!
//! Gouraud 1971, "Continuous Shading of Curved Surfaces" (colours of corners, mixed over each face).

use super::{ColorSource, PatternPoint, TextureInput, Textures, mean};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "vertex_color",
    doc: "The colours of a mesh's vertices.",
    params: &[
        ParamSpec::reflectance("fallback", [1.0; 3], "where the object has no such colours"),
        ParamSpec::number("scale", 1.0, "the colours are multiplied by it").range(NOT_NEGATIVE),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct VertexColor {
    fallback: ColorSource,
    scale: f32,
}

impl VertexColor {
    pub(super) fn compile(input: &TextureInput) -> Self {
        VertexColor { fallback: input.names.color(&input.params, "fallback"), scale: input.params.f32("scale") }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        match at.original.patch.color {
            [_, _, _, 0.0] => textures.lookup(self.fallback, at.original),
            [r, g, b, _] => {
                let [r, g, b] = [r, g, b].map(|c| c * self.scale);
                [r, g, b, mean([r, g, b])]
            }
        }
    }
}
