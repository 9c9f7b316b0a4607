//! Any picture into RGBA pixels, told apart by its first bytes: for textures and for comparing.

use crate::error::{ImageError, Result, damaged};
use crate::image::{Attribute, RgbImage};
use crate::limits::check_size;
use crate::srgb::{srgb8_to_linear, srgb16_to_linear};
use crate::tiff_file::read_tiff;
use crate::{Texts, read_exr, read_hdr, read_png};
use image::codecs::{bmp::BmpDecoder, jpeg::JpegDecoder, tga::TgaDecoder};
use image::{DynamicImage, ImageDecoder};
use std::io::Cursor;

/// A picture as a file gave it.
#[derive(Debug, Clone, PartialEq)]
pub struct DecodedImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels, rows from the top.
    pub pixels: Pixels,
    /// The texts of the file's header or chunks.
    pub texts: Texts,
    /// The file says that its codes are linear.
    pub says_linear: bool,
}

/// Red, green, blue and alpha as the file has them: EXR colours come multiplied by alpha, the others do not.
#[derive(Debug, Clone, PartialEq)]
pub enum Pixels {
    /// Codes of 8 bits: sRGB in the colours (or plain numbers, if the picture is a map of numbers), linear in alpha.
    Srgb8(Vec<[u8; 4]>),
    /// Codes of 16 bits, likewise.
    Srgb16(Vec<[u16; 4]>),
    /// Linear floats.
    Linear(Vec<[f32; 4]>),
}

/// Read a PNG, JPEG, BMP, TGA, TIFF, HDR or EXR picture, whatever its name says.
///
/// TGA files need not say what they are: such bytes are tried only if `hint`, the ending of the file's name,
/// is `tga`, or if they end like a TGA file. Of an EXR file the colours of its data window are taken, as
/// [`crate::Image::rgb`] finds them.
pub fn decode(bytes: &[u8], hint: Option<&str>) -> Result<DecodedImage> {
    let starts = |magic: &[u8]| bytes.starts_with(magic);
    if starts(b"\x89PNG\r\n\x1a\n") {
        read_png(bytes)
    } else if starts(&[0x76, 0x2f, 0x31, 0x01]) {
        from_exr(bytes)
    } else if starts(b"#?RADIANCE") || starts(b"#?RGBE") {
        read_hdr(bytes)
    } else if starts(&[0xff, 0xd8, 0xff]) {
        let decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(|error| damaged("JPEG", error))?;
        from_codec("JPEG", decoder, bytes.len())
    } else if starts(b"II*\0") || starts(b"MM\0*") {
        read_tiff(bytes)
    } else if starts(b"BM") {
        let decoder = BmpDecoder::new(Cursor::new(bytes)).map_err(|error| damaged("BMP", error))?;
        from_codec("BMP", decoder, bytes.len())
    } else if bytes.ends_with(b"TRUEVISION-XFILE.\0") || hint.is_some_and(|ending| ending.eq_ignore_ascii_case("tga")) {
        let decoder = TgaDecoder::new(Cursor::new(bytes)).map_err(|error| damaged("TGA", error))?;
        from_codec("TGA", decoder, bytes.len())
    } else {
        Err(ImageError::UnknownFormat)
    }
}

impl DecodedImage {
    /// True where its numbers are proportional to light: floats, and codes of a file that says so.
    pub fn is_linear(&self) -> bool {
        self.says_linear || matches!(self.pixels, Pixels::Linear(_))
    }

    /// Linear RGBA: sRGB codes decoded exactly, alpha as it is.
    pub fn linear(&self) -> Vec<[f32; 4]> {
        if self.is_linear() {
            return self.raw();
        }
        match &self.pixels {
            Pixels::Srgb8(codes) => codes
                .iter()
                .map(|&[r, g, b, a]| [srgb8_to_linear(r), srgb8_to_linear(g), srgb8_to_linear(b), f32::from(a) / 255.0])
                .collect(),
            Pixels::Srgb16(codes) => codes
                .iter()
                .map(|&[r, g, b, a]| {
                    [srgb16_to_linear(r), srgb16_to_linear(g), srgb16_to_linear(b), f32::from(a) / 65535.0]
                })
                .collect(),
            Pixels::Linear(values) => values.clone(),
        }
    }

    /// The numbers as they stand in the file, codes scaled to `[0, 1]`: for maps of normals, roughness, masks.
    pub fn raw(&self) -> Vec<[f32; 4]> {
        match &self.pixels {
            Pixels::Srgb8(codes) => codes.iter().map(|code| code.map(|lane| f32::from(lane) / 255.0)).collect(),
            Pixels::Srgb16(codes) => codes.iter().map(|code| code.map(|lane| f32::from(lane) / 65535.0)).collect(),
            Pixels::Linear(values) => values.clone(),
        }
    }

    /// The linear colours without alpha.
    pub fn rgb(&self) -> RgbImage {
        let pixels = self.linear().into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
        RgbImage { width: self.width, height: self.height, pixels }
    }
}

fn from_exr(bytes: &[u8]) -> Result<DecodedImage> {
    let image = read_exr(bytes)?;
    let rgb = image.rgb().ok_or_else(|| ImageError::Unsupported {
        format: "EXR",
        what: "no float channels R, G, B or Y".into(),
        cure: "name its colour channels so",
    })?;
    let mut decoded = DecodedImage::from(rgb);
    if let (Some(alpha), Pixels::Linear(pixels)) = (image.channel("A").and_then(|a| a.floats()), &mut decoded.pixels) {
        for (pixel, &alpha) in pixels.iter_mut().zip(alpha) {
            pixel[3] = alpha;
        }
    }
    decoded.texts = image
        .attributes
        .into_iter()
        .filter_map(|(name, value)| match value {
            Attribute::Text(text) => Some((name, text)),
            Attribute::Number(_) => None,
        })
        .collect();
    Ok(decoded)
}

/// Read the pixels of a decoder that has read its header.
pub(crate) fn from_codec(
    format: &'static str,
    mut decoder: impl ImageDecoder,
    file_length: usize,
) -> Result<DecodedImage> {
    let (width, height) = decoder.dimensions();
    check_size(format, [u64::from(width), u64::from(height)], 16, file_length)?;
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(crate::MAX_BYTES);
    decoder.set_limits(limits).map_err(|error| damaged(format, error))?;
    let pixels = match DynamicImage::from_decoder(decoder).map_err(|error| damaged(format, error))? {
        float @ (DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) => {
            Pixels::Linear(float.into_rgba32f().pixels().map(|pixel| pixel.0).collect())
        }
        coded => Pixels::Srgb8(coded.into_rgba8().pixels().map(|pixel| pixel.0).collect()),
    };
    Ok(DecodedImage { width, height, pixels, texts: Texts::new(), says_linear: false })
}
