//! PNG in and out, 8 and 16 bit sRGB, with text chunks.
//!
//! Colour is taken to be sRGB-coded unless a `gAMA` or `cICP` chunk says that it is linear; profiles are not looked at.

use crate::Texts;
use crate::decode::{DecodedImage, Pixels};
use crate::error::{Result, damaged, unwritable};
use crate::limits::check_size;
use png::{BitDepth, ColorType, Transformations};
use std::io::Cursor;

/// Read a PNG and its text chunks. Palettes, grey and small depths are expanded to RGBA of 8 bits; 16 bits stay.
pub fn read_png(bytes: &[u8]) -> Result<DecodedImage> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let info = decoder.read_header_info().map_err(|error| damaged("PNG", error))?;
    let (width, height) = info.size();
    check_size("PNG", [u64::from(width), u64::from(height)], 8, bytes.len())?;
    // The reader needs room for lines and texts, never more than a few times the file and the picture.
    let pixels = width as usize * height as usize;
    decoder.set_limits(png::Limits { bytes: (64 << 20) + 8 * bytes.len() + 16 * pixels });

    let mut reader = decoder.read_info().map_err(|error| damaged("PNG", error))?;
    let size = reader.output_buffer_size().ok_or_else(|| damaged("PNG", "the picture does not fit into memory"))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(|error| damaged("PNG", error))?;
    if (frame.width, frame.height) != (width, height) {
        return Err(damaged("PNG", "its first frame does not fill it"));
    }
    // Texts may stand behind the pixels; a file that ends there has still given its picture.
    let _ = reader.finish();

    let pixels = match frame.bit_depth {
        BitDepth::Sixteen => {
            let codes: Vec<u16> = samples.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
            Pixels::Srgb16(rgba(&codes, frame.color_type, u16::MAX))
        }
        _ => Pixels::Srgb8(rgba(&samples, frame.color_type, u8::MAX)),
    };
    let info = reader.info();
    Ok(DecodedImage { width, height, pixels, texts: texts_of(info), says_linear: says_linear(info) })
}

/// The bytes of an 8-bit PNG. `samples` holds 1 (grey), 2 (grey and alpha), 3 (RGB) or 4 (RGBA) codes per pixel.
pub fn write_png8(width: u32, height: u32, samples: &[u8], texts: &Texts) -> Result<Vec<u8>> {
    write(width, height, samples.len(), BitDepth::Eight, samples, texts)
}

/// The bytes of a 16-bit PNG; `samples` as in [`write_png8`].
pub fn write_png16(width: u32, height: u32, samples: &[u16], texts: &Texts) -> Result<Vec<u8>> {
    let bytes: Vec<u8> = samples.iter().flat_map(|code| code.to_be_bytes()).collect();
    write(width, height, samples.len(), BitDepth::Sixteen, &bytes, texts)
}

fn write(width: u32, height: u32, samples: usize, depth: BitDepth, bytes: &[u8], texts: &Texts) -> Result<Vec<u8>> {
    let fail = |error: png::EncodingError| unwritable("PNG", error);
    let pixels = width as usize * height as usize;
    let colours = [ColorType::Grayscale, ColorType::GrayscaleAlpha, ColorType::Rgb, ColorType::Rgba];
    let colour = (1..=4)
        .find(|lanes| pixels > 0 && samples == lanes * pixels)
        .map(|lanes| colours[lanes - 1])
        .ok_or_else(|| {
            unwritable("PNG", format!("{samples} samples are not 1, 2, 3 or 4 for each of {width} x {height} pixels"))
        })?;

    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (keyword, text) in texts {
        if keyword.is_empty()
            || keyword.len() > 79
            || !keyword.is_ascii()
            || keyword.contains('\0')
            || text.contains('\0')
        {
            let reason = format!("text `{keyword}` needs an ASCII name of 1 to 79 bytes and no null byte");
            return Err(unwritable("PNG", reason));
        }
        if text.is_ascii() {
            encoder.add_text_chunk(keyword.clone(), text.clone()).map_err(fail)?;
        } else {
            encoder.add_itxt_chunk(keyword.clone(), text.clone()).map_err(fail)?;
        }
    }
    let mut writer = encoder.write_header().map_err(fail)?;
    writer.write_image_data(bytes).map_err(fail)?;
    writer.finish().map_err(fail)?;
    Ok(file)
}

fn rgba<T: Copy>(samples: &[T], colour: ColorType, opaque: T) -> Vec<[T; 4]> {
    match colour {
        ColorType::Grayscale | ColorType::Indexed => samples.iter().map(|&y| [y, y, y, opaque]).collect(),
        ColorType::GrayscaleAlpha => samples.chunks_exact(2).map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        ColorType::Rgb => samples.chunks_exact(3).map(|p| [p[0], p[1], p[2], opaque]).collect(),
        ColorType::Rgba => samples.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect(),
    }
}

/// A `cICP` chunk of transfer 8, or a `gAMA` chunk of 1 that no `sRGB` or `iCCP` chunk overrules.
fn says_linear(info: &png::Info) -> bool {
    const LINEAR: u8 = 8;
    if let Some(points) = &info.coding_independent_code_points {
        return points.transfer_function == LINEAR;
    }
    let is_overruled = info.srgb.is_some() || info.icc_profile.is_some();
    !is_overruled && info.gama_chunk.is_some_and(|gamma| (gamma.into_value() - 1.0).abs() < 0.01)
}

fn texts_of(info: &png::Info) -> Texts {
    let latin = info.uncompressed_latin1_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.text.clone()));
    let packed =
        info.compressed_latin1_text.iter().filter_map(|chunk| Some((chunk.keyword.clone(), chunk.get_text().ok()?)));
    let utf8 = info.utf8_text.iter().filter_map(|chunk| Some((chunk.keyword.clone(), chunk.get_text().ok()?)));
    latin.chain(packed).chain(utf8).collect()
}
