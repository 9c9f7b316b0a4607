//! TIFF in: grey and RGB with or without alpha, whole numbers of 8 and 16 bits, floats of 32 and 64.

use crate::Texts;
use crate::decode::{DecodedImage, Pixels};
use crate::error::{ImageError, Result, damaged};
use crate::limits::{MAX_BYTES, check_size};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::{ColorType, TiffError};

/// Read the first picture of a TIFF file.
pub fn read_tiff(bytes: &[u8]) -> Result<DecodedImage> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(refused)?;
    let (width, height) = decoder.dimensions().map_err(refused)?;
    check_size("TIFF", [u64::from(width), u64::from(height)], 16, bytes.len())?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_BYTES as usize;
    let mut decoder = decoder.with_limits(limits);
    let color = decoder.colortype().map_err(refused)?;
    let lanes = match color {
        ColorType::Gray(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::RGB(_) => 3,
        ColorType::RGBA(_) => 4,
        other => return Err(unsupported(format!("{other:?} colours"))),
    };
    let pixels = match decoder.read_image().map_err(refused)? {
        DecodingResult::U8(codes) => Pixels::Srgb8(rgba(&codes, lanes, u8::MAX)),
        DecodingResult::U16(codes) => Pixels::Srgb16(rgba(&codes, lanes, u16::MAX)),
        DecodingResult::F32(values) => Pixels::Linear(rgba(&values, lanes, 1.0)),
        DecodingResult::F64(values) => {
            let values: Vec<f32> = values.iter().map(|&v| v as f32).collect();
            Pixels::Linear(rgba(&values, lanes, 1.0))
        }
        _ => return Err(unsupported("whole numbers of other than 8 or 16 bits".into())),
    };
    let count = match &pixels {
        Pixels::Srgb8(p) => p.len(),
        Pixels::Srgb16(p) => p.len(),
        Pixels::Linear(p) => p.len(),
    };
    if count != width as usize * height as usize {
        return Err(damaged("TIFF", "its samples do not fill the picture"));
    }
    Ok(DecodedImage { width, height, pixels, texts: Texts::new(), says_linear: false })
}

fn rgba<T: Copy>(samples: &[T], lanes: usize, opaque: T) -> Vec<[T; 4]> {
    let pixel = |p: &[T]| match *p {
        [y] => [y, y, y, opaque],
        [y, a] => [y, y, y, a],
        [r, g, b] => [r, g, b, opaque],
        _ => [p[0], p[1], p[2], p[3]],
    };
    samples.chunks_exact(lanes).map(pixel).collect()
}

fn refused(error: TiffError) -> ImageError {
    match error {
        TiffError::UnsupportedError(what) => unsupported(what.to_string()),
        other => damaged("TIFF", other),
    }
}

fn unsupported(what: String) -> ImageError {
    ImageError::Unsupported { format: "TIFF", what, cure: "save it as RGB with 8 or 16 bits per channel, or as EXR" }
}
