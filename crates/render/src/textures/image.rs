//! # image: a picture on a surface
//!
//! Puts a PNG, JPEG, BMP, TGA, TIFF, HDR or EXR file on a surface: by its texture coordinates, u to the right and v up, or by
//! projection.
//!
//! ## Parameters
//!
//! - `file` (path, required): the picture, relative to the file that names it.
//! - `mapping` (`uv`, `planar`, `spherical`, `cylindrical`, `box`, `triplanar`; default `uv`): how it lies on the surface; see
//!   below.
//! - `wrap` (`repeat`, `clamp`, `mirror`, `black`; default `repeat`): what lies beyond the picture: itself again, its
//!   border stretched, its mirror image, or nothing (black, and transparent as a mask).
//! - `filter` (`anisotropic`, `mipmap`, `bilinear`, `nearest`; default `anisotropic`): what a sample sees of the picture: the
//!   mean over the ellipse that it stands for; over a square as wide as the ellipse is long; between the four nearest texels; or
//!   the nearest one.
//! - `encoding` (`auto`, `srgb`, `linear`; default `auto`): how the file's numbers mean light. `auto` takes codes of 8 or 16
//!   bits as sRGB (unless a PNG file says in its header that they are linear) and floats as linear; `kirkas check` lists what
//!   was taken. For maps of numbers (roughness, masks without alpha) write `linear`.
//! - `scale` (two numbers, default `[1, 1]`): how often the picture fits into one unit of u and of v.
//! - `rotation` (number, degrees, default 0): turns the picture counter-clockwise about the origin of u and v.
//! - `offset` (two numbers, default `[0, 0]`): added to u and v after `scale` and `rotation`.
//! - and those of all textures: `transform`, applied before `scale`, and `space`, for the mappings that project.
//!
//! Mappings: `uv` takes the shape's own texture coordinates; `planar` looks along -z (u = x, v = y); `spherical` and
//! `cylindrical` wrap the picture once around the y axis (v from pole to pole, or v = y); `box` looks along the axis that the
//! surface faces most; `triplanar` blends the views along all three axes.
//!
//! ## Example
//!
//! ```toml
//! [textures.poster]
//! type = "image"
//! file = "poster.png"
//! wrap = "clamp"
//! ```
//!
//! ## Limits
//!
//! Filtering knows what a pixel of the picture covers, not how many samples share it: far away and at grazing angles detail is
//! as fine as one sample per pixel can show without aliasing. Smaller copies make a picture take 2/3 more memory (floats: 1/3).
//! Where `spherical` and `cylindrical` come around, filtering does not look across the seam. Colours of an EXR file, which come
//! multiplied by its alpha, are divided by it; numbers that are not finite count as 0.
//!
//! ## References
//!
//! sRGB: IEC 61966-2-1:1999, decoded exactly and before filtering. Williams 1983, "Pyramidal Parametrics"; McCormack et al. 1999,
//! "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping" (several lookups along the ellipse); Akenine-Möller et al.
//! 2021, "Improved Shader and Texture Level of Detail Using Ray Cones".

use super::image_files::ImageFiles;
use super::texels::{Texels, Wrap, lerp};
use super::{PatternPoint, TextureInput, mapping};
use kirkas_geometry::elementary::{floor, log2, sin_cos};
use kirkas_scene::{Diagnostic, Fallback, Kind, ParamSpec, ParamType, TypeSpec};
use std::sync::Arc;

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "image",
    doc: "A picture, by texture coordinates or projected.",
    params: &[
        ParamSpec::new(
            "file",
            ParamType::Path,
            Fallback::Required,
            "the picture: PNG, JPEG, BMP, TGA, TIFF, HDR or EXR",
        ),
        mapping::FLAT,
        ParamSpec::choice("wrap", &["repeat", "clamp", "mirror", "black"], "what lies beyond the picture"),
        ParamSpec::choice(
            "filter",
            &["anisotropic", "mipmap", "bilinear", "nearest"],
            "what a sample sees: the mean over its ellipse, over a square, between texels, or the nearest one",
        ),
        ParamSpec::choice(
            "encoding",
            &["auto", "srgb", "linear"],
            "how numbers mean light; auto: codes are sRGB, floats are linear",
        ),
        ParamSpec::new(
            "scale",
            ParamType::Vector2,
            Fallback::Vector2([1.0, 1.0]),
            "how often the picture fits into one unit of u and of v",
        ),
        ParamSpec::number("rotation", 0.0, "turns the picture counter-clockwise, after `scale`").unit("degrees"),
        ParamSpec::new("offset", ParamType::Vector2, Fallback::Vector2([0.0, 0.0]), "added to u and v at last"),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Image {
    texels: Arc<Texels>,
    wrap: Wrap,
    filter: Filter,
    /// From u and v to the picture's own, by columns.
    turn: [[f64; 2]; 2],
    offset: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Filter {
    Anisotropic,
    Mipmap,
    Bilinear,
    Nearest,
}

/// The most lookups along an ellipse.
const MOST_TAPS: f64 = 8.0;

impl Image {
    pub(super) fn compile(input: &TextureInput, files: &mut ImageFiles) -> Result<Self, Diagnostic> {
        let params = &input.params;
        let wrap = match params.text("wrap") {
            Some("clamp") => Wrap::Clamp,
            Some("mirror") => Wrap::Mirror,
            Some("black") => Wrap::Black,
            _ => Wrap::Repeat,
        };
        let filter = match params.text("filter") {
            Some("mipmap") => Filter::Mipmap,
            Some("bilinear") => Filter::Bilinear,
            Some("nearest") => Filter::Nearest,
            _ => Filter::Anisotropic,
        };
        let texels = files.read(input)?;
        if matches!(filter, Filter::Anisotropic | Filter::Mipmap) {
            texels.prepare_levels();
        }
        let ([su, sv], degrees) = (params.vector2("scale"), params.number("rotation"));
        // The picture turns one way as its coordinates turn the other.
        let (s, c) = if degrees == 0.0 { (0.0, 1.0) } else { sin_cos(-degrees.to_radians()) };
        let turn = [[su * c, su * s], [-sv * s, sv * c]];
        Ok(Image { texels, wrap, filter, turn, offset: params.vector2("offset") })
    }

    pub(super) fn filters(&self) -> bool {
        matches!(self.filter, Filter::Anisotropic | Filter::Mipmap)
    }

    pub(super) fn eval(&self, at: &PatternPoint) -> [f32; 4] {
        let turned =
            |[u, v]: [f64; 2]| [u * self.turn[0][0] + v * self.turn[1][0], u * self.turn[0][1] + v * self.turn[1][1]];
        let [u, v] = turned(at.uv);
        let uv = [u + self.offset[0], v + self.offset[1]];
        let value = match self.filter {
            Filter::Nearest => self.texels.level(0).nearest(self.wrap, uv),
            Filter::Bilinear => self.texels.level(0).bilinear(self.wrap, uv),
            Filter::Mipmap | Filter::Anisotropic => self.filtered(uv, at.uv_axes.map(turned)),
        };
        self.texels.finish(value)
    }

    /// The mean over the ellipse with these axes.
    fn filtered(&self, uv: [f64; 2], axes: [[f64; 2]; 2]) -> [f32; 4] {
        let (width, height) = self.texels.size();
        let length = |[u, v]: [f64; 2]| {
            let (x, y) = (u * f64::from(width), v * f64::from(height));
            (x * x + y * y).sqrt()
        };
        let (a, b) = (length(axes[0]), length(axes[1]));
        let (long, major, minor) = if a >= b { (axes[0], a, b) } else { (axes[1], b, a) };
        if !(major > 1.0) {
            return self.texels.level(0).bilinear(self.wrap, uv);
        }
        if self.filter == Filter::Mipmap || !major.is_finite() {
            return self.between_levels(uv, Levels::of_width(major));
        }

        // Look several times along the ellipse, each time as wide as it is across, or as the lookups are apart.
        let count = (2.0 * major / minor.max(1.0)).ceil().clamp(1.0, MOST_TAPS);
        let width = minor.max(2.0 * major / count);
        let levels = Levels::of_width(width);
        let (mut sum, mut weights) = ([0.0_f32; 4], 0.0_f32);
        for i in 0..count as u32 {
            // From -1 to 1, with the weights of a tent.
            let along = (2.0 * f64::from(i) + 1.0) / count - 1.0;
            let weight = (1.0 - along.abs()) as f32;
            let place = [uv[0] + long[0] * along, uv[1] + long[1] * along];
            let value = self.between_levels(place, levels);
            sum = std::array::from_fn(|lane| sum[lane] + value[lane] * weight);
            weights += weight;
        }
        sum.map(|lane| lane / weights)
    }

    /// The mean over a square, between the two sizes of the picture that are nearest to it.
    fn between_levels(&self, uv: [f64; 2], Levels { finer, part }: Levels) -> [f32; 4] {
        let last = self.texels.last_level();
        if finer >= last {
            return self.texels.level(last).bilinear(self.wrap, uv);
        }
        let value = self.texels.level(finer).bilinear(self.wrap, uv);
        if part == 0.0 {
            return value;
        }
        lerp(value, self.texels.level(finer + 1).bilinear(self.wrap, uv), part)
    }
}

/// Two sizes of a picture.
#[derive(Clone, Copy)]
struct Levels {
    finer: usize,
    /// How much of the coarser one.
    part: f32,
}

impl Levels {
    /// For a square of `width` texels.
    fn of_width(width: f64) -> Self {
        let level = if width > 1.0 { log2(width) } else { 0.0 };
        Levels { finer: level as usize, part: (level - floor(level)) as f32 }
    }
}
