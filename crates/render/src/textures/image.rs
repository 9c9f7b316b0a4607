//! # image: a picture on a surface
//!
//! Puts a PNG, JPEG, BMP, TGA, HDR or EXR file on a surface by its texture coordinates: u to the right, v up.
//!
//! ## Parameters
//!
//! - `file` (path, required): the picture, relative to the file that names it.
//! - `wrap` (`repeat`, `clamp`, `mirror`, `black`; default `repeat`): what lies beyond the picture: itself again, its
//!   border stretched, its mirror image, or nothing (black, and transparent as a mask).
//! - `filter` (`bilinear`, `nearest`; default `bilinear`): between texels: smooth, or the nearest one.
//! - `encoding` (`auto`, `srgb`, `linear`; default `auto`): how the file's numbers mean light. `auto` takes codes of 8 or 16
//!   bits as sRGB and floats as linear. For maps of numbers (roughness, masks without alpha) write `linear`.
//! - `scale` (two numbers, default `[1, 1]`): how often the picture fits into one unit of u and of v.
//! - `offset` (two numbers, default `[0, 0]`): added to u and v after `scale`.
//! - and those of all textures: `transform`, applied before `scale` and `offset`; `space` does not matter.
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
//! Texels are not filtered over a pixel's footprint (no mip maps): far away the samples of each pixel must average them.
//! Colours of an EXR file, which come multiplied by its alpha, are divided by it; numbers that are not finite count as 0.
//!
//! ## References
//!
//! sRGB: IEC 61966-2-1:1999, decoded exactly and before filtering.

use super::{PatternPoint, TextureInput, TextureNames, mean};
use kirkas_images::srgb::{srgb_to_linear, srgb8_to_linear};
use kirkas_images::{DecodedImage, Pixels, decode};
use kirkas_scene::{Assets, Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, Span, TypeSpec};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "image",
    doc: "A picture, by texture coordinates.",
    params: &[
        ParamSpec::new("file", ParamType::Path, Fallback::Required, "the picture: PNG, JPEG, BMP, TGA, HDR or EXR"),
        ParamSpec::choice("wrap", &["repeat", "clamp", "mirror", "black"], "what lies beyond the picture"),
        ParamSpec::choice("filter", &["bilinear", "nearest"], "between texels: smooth, or the nearest one"),
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
        ParamSpec::new("offset", ParamType::Vector2, Fallback::Vector2([0.0, 0.0]), "added to u and v after `scale`"),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Image {
    texels: Arc<Texels>,
    wrap: Wrap,
    is_bilinear: bool,
    scale: [f64; 2],
    offset: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Wrap {
    Repeat,
    Clamp,
    Mirror,
    Black,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Encoding {
    Auto,
    Srgb,
    Linear,
}

impl Image {
    pub(super) fn compile(input: &TextureInput, files: &mut ImageFiles) -> Result<Self, Diagnostic> {
        let params = &input.params;
        let wrap = match params.text("wrap") {
            Some("clamp") => Wrap::Clamp,
            Some("mirror") => Wrap::Mirror,
            Some("black") => Wrap::Black,
            _ => Wrap::Repeat,
        };
        Ok(Image {
            texels: files.read(input)?,
            wrap,
            is_bilinear: params.text("filter") != Some("nearest"),
            scale: params.vector2("scale"),
            offset: params.vector2("offset"),
        })
    }

    pub(super) fn eval(&self, at: &PatternPoint) -> [f32; 4] {
        // In texels, from the bottom left corner.
        let place = |axis: usize, texels: u32| {
            let at = (at.uv[axis] * self.scale[axis] + self.offset[axis]) * f64::from(texels);
            if at.is_finite() { at } else { 0.0 }
        };
        let (x, y) = (place(0, self.texels.width), place(1, self.texels.height));
        if !self.is_bilinear {
            return self.texel(whole(x), whole(y));
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (i, j) = (whole(x), whole(y));
        let (s, t) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
        let row = |j| lerp(self.texel(i, j), self.texel(i + 1, j), s);
        lerp(row(j), row(j + 1), t)
    }

    /// `up` counts rows from the bottom.
    fn texel(&self, x: i64, up: i64) -> [f32; 4] {
        match (self.wrap.apply(x, self.texels.width), self.wrap.apply(up, self.texels.height)) {
            (Some(x), Some(up)) => self.texels.get(x, self.texels.height as usize - 1 - up),
            _ => [0.0; 4],
        }
    }
}

impl Wrap {
    /// The column or row of the picture that is seen at `i`, of `n`.
    fn apply(self, i: i64, n: u32) -> Option<usize> {
        let n = i64::from(n);
        let inside = match self {
            Wrap::Repeat => i.rem_euclid(n),
            Wrap::Clamp => i.clamp(0, n - 1),
            Wrap::Mirror => {
                let k = i.rem_euclid(2 * n);
                if k < n { k } else { 2 * n - 1 - k }
            }
            Wrap::Black if (0..n).contains(&i) => i,
            Wrap::Black => return None,
        };
        Some(inside as usize)
    }
}

/// The largest whole number not above `x`, far from the ends of `i64`.
fn whole(x: f64) -> i64 {
    const FAR: f64 = (1_i64 << 52) as f64;
    x.floor().clamp(-FAR, FAR) as i64
}

fn lerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|lane| a[lane] * (1.0 - t) + b[lane] * t)
}

/// A decoded picture: linear colour and, last, the number it means as a mask.
#[derive(Debug, PartialEq)]
struct Texels {
    width: u32,
    height: u32,
    has_alpha: bool,
    data: TexelData,
}

#[derive(Debug, PartialEq)]
enum TexelData {
    /// A quarter of the memory: decoded by table when looked up.
    Codes {
        codes: Vec<[u8; 4]>,
        linear_from_code: Box<[f32; 256]>,
    },
    Floats(Vec<[f32; 4]>),
}

impl Texels {
    fn new(image: DecodedImage, encoding: Encoding) -> Self {
        let (width, height) = (image.width, image.height);
        let data = match (image.pixels, encoding) {
            (Pixels::Srgb8(codes), encoding) => {
                let linear_from_code = Box::new(std::array::from_fn(|code| match encoding {
                    Encoding::Linear => code as f32 / 255.0,
                    Encoding::Auto | Encoding::Srgb => srgb8_to_linear(code as u8),
                }));
                TexelData::Codes { codes, linear_from_code }
            }
            (pixels @ Pixels::Srgb16(_), encoding) => {
                let image = DecodedImage { width, height, pixels, texts: Default::default() };
                TexelData::Floats(if encoding == Encoding::Linear { image.raw() } else { image.linear() })
            }
            (Pixels::Linear(mut pixels), encoding) => {
                pixels.iter_mut().for_each(|pixel| clean(pixel, encoding));
                TexelData::Floats(pixels)
            }
        };
        let has_alpha = match &data {
            TexelData::Codes { codes, .. } => codes.iter().any(|code| code[3] != 255),
            TexelData::Floats(pixels) => pixels.iter().any(|pixel| pixel[3] != 1.0),
        };
        Texels { width, height, has_alpha, data }
    }

    fn get(&self, x: usize, y: usize) -> [f32; 4] {
        let index = y * self.width as usize + x;
        let [r, g, b, a] = match &self.data {
            TexelData::Codes { codes, linear_from_code } => {
                let [r, g, b, a] = codes[index];
                let linear = |code: u8| linear_from_code[usize::from(code)];
                [linear(r), linear(g), linear(b), f32::from(a) / 255.0]
            }
            TexelData::Floats(pixels) => pixels[index],
        };
        [r, g, b, if self.has_alpha { a } else { mean([r, g, b]) }]
    }
}

/// Make a float pixel finite, not multiplied by its alpha, and linear.
fn clean(pixel: &mut [f32; 4], encoding: Encoding) {
    let alpha = pixel[3];
    for lane in &mut pixel[..3] {
        if alpha > 0.0 && alpha < 1.0 {
            *lane /= alpha;
        }
        if encoding == Encoding::Srgb {
            *lane = srgb_to_linear(*lane);
        }
    }
    for lane in pixel {
        *lane = if lane.is_finite() { *lane } else { 0.0 };
    }
}

/// A picture's linear colours, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// In texels.
    pub width: usize,
    /// In texels.
    pub height: usize,
    /// `width * height` of them, linear Rec.709.
    pub texels: Vec<[f32; 3]>,
}

impl From<&Texels> for Picture {
    fn from(t: &Texels) -> Self {
        let (width, height) = (t.width as usize, t.height as usize);
        let color = |i: usize| {
            let [r, g, b, _] = t.get(i % width, i / width);
            [r, g, b]
        };
        Picture { width, height, texels: (0..width * height).map(color).collect() }
    }
}

/// Pictures that have been read: materials name the same one more than once.
#[derive(Clone, Debug, Default)]
pub(super) struct ImageFiles(BTreeMap<(Folder, String, Encoding), Arc<Texels>>);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Folder {
    OfSource(u32),
    Path(String),
}

impl ImageFiles {
    fn read(&mut self, input: &TextureInput) -> Result<Arc<Texels>, Diagnostic> {
        let encoding = match input.params.text("encoding") {
            Some("srgb") => Encoding::Srgb,
            Some("linear") => Encoding::Linear,
            _ => Encoding::Auto,
        };
        let path = input.params.text("file").unwrap_or_default();
        let span = input.params.span("file");
        let from = span.is_some().then_some(span.source);
        let folder = match input.folder {
            Some(folder) => Folder::Path(folder.to_string()),
            None => Folder::OfSource(from.map_or(u32::MAX, |source| source.0)),
        };
        let key = (folder, path.to_string(), encoding);
        if let Some(texels) = self.0.get(&key) {
            return Ok(texels.clone());
        }
        let read = match input.folder {
            Some("") => input.assets.bytes(None, path),
            Some(folder) => input.assets.bytes(None, &format!("{folder}/{path}")),
            None => input.assets.bytes(from, path),
        };
        let bytes = read.map_err(|error| if error.labels.is_empty() { error.at(span, "named here") } else { error })?;
        let ending = path.rsplit_once('.').map(|(_, ending)| ending);
        let image = decode(&bytes, ending).map_err(|error| unreadable(path, span, &error))?;
        let texels = Arc::new(Texels::new(image, encoding));
        self.0.insert(key, texels.clone());
        Ok(texels)
    }
}

/// The picture that the parameters `file` and `encoding` name.
pub fn read_picture(params: &Params, assets: &dyn Assets) -> Result<Picture, Diagnostic> {
    let input = TextureInput { params: *params, names: &TextureNames::default(), assets, folder: None };
    ImageFiles::default().read(&input).map(|texels| Picture::from(&*texels))
}

fn unreadable(path: &str, span: Span, error: &kirkas_images::ImageError) -> Diagnostic {
    let text = error.to_string();
    // Errors of pictures say the problem, then the cure.
    let (problem, cure) = text.split_once("; ").unwrap_or((&text, "give another picture"));
    Diagnostic::error("bad-image", format!("the picture `{path}` cannot be read: {problem}"))
        .at(span, "this picture")
        .help(cure)
}
