//! Radiance HDR (RGBE) in and out: three mantissas of 8 bits and one exponent per pixel.
//!
//! A component is `mantissa * 2^(exponent - 136)`. Texts live in header lines `# name=value`.
//! Reference: G. Ward, "Real Pixels", Graphics Gems II, 1991;
//! <https://radsite.lbl.gov/radiance/refer/filefmts.pdf>.

use crate::Texts;
use crate::decode::{DecodedImage, Pixels, from_codec};
use crate::error::{Result, damaged, unwritable};
use crate::image::RgbImage;
use std::io::Cursor;

/// Read an HDR file and the texts that [`write_hdr`] left in its header.
pub fn read_hdr(bytes: &[u8]) -> Result<DecodedImage> {
    // Strict reading wants the newer of the two signatures.
    let strict = bytes.starts_with(b"#?RADIANCE");
    let decoder = image::codecs::hdr::HdrDecoder::with_strictness(Cursor::new(bytes), strict)
        .map_err(|error| damaged("HDR", error))?;
    let mut image = from_codec("HDR", decoder, bytes.len())?;
    image.texts = texts_of(bytes);
    Ok(image)
}

/// The bytes of an HDR file. What RGBE cannot hold is brought to its ends: negative values and NaN to 0, what is
/// beyond 2^127 to the largest value.
pub fn write_hdr(image: &RgbImage, texts: &Texts) -> Result<Vec<u8>> {
    image.validate()?;
    if image.pixels.is_empty() {
        return Err(unwritable("HDR", "it has no pixels"));
    }
    let mut file = b"#?RADIANCE\n".to_vec();
    for (name, value) in texts {
        if name.is_empty() || name.contains(['=', '\n', '\\']) {
            return Err(unwritable(
                "HDR",
                format!("text name `{name}` must not be empty or hold `=`, `\\` or a line end"),
            ));
        }
        let line = format!("# {name}={}\n", value.replace('\\', "\\\\").replace('\n', "\\n").replace('\r', "\\r"));
        file.extend_from_slice(line.as_bytes());
    }
    let header = format!("FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
    file.extend_from_slice(header.as_bytes());
    for row in image.pixels.chunks_exact(image.width as usize) {
        let row: Vec<[u8; 4]> = row.iter().map(|&pixel| rgbe(pixel)).collect();
        write_row(&row, &mut file);
    }
    Ok(file)
}

/// 255 * 2^119: the largest component that the format holds.
const LARGEST: f32 = f32::from_bits(0x7eff_0000);

/// The shared exponent is that of the largest component, so that its mantissa lies in 128..=255.
fn rgbe(pixel: [f32; 3]) -> [u8; 4] {
    let [r, g, b] = pixel.map(|value| if value > 0.0 { f64::from(value.min(LARGEST)) } else { 0.0 });
    let largest = r.max(g).max(b);
    let exponent = ((largest.to_bits() >> 52) as i32) - 1022;
    if largest == 0.0 || exponent < -127 {
        return [0; 4];
    }
    // 2^(8 - exponent), made from its bits: exact, and the same everywhere.
    let scale = f64::from_bits(((1023 + 8 - exponent) as u64) << 52);
    let mantissa = |value: f64| (value * scale) as u8;
    [mantissa(r), mantissa(g), mantissa(b), (exponent + 128) as u8]
}

/// Rows of 8 to 32767 pixels are run-length coded lane by lane, others flat.
fn write_row(row: &[[u8; 4]], file: &mut Vec<u8>) {
    if !(8..=0x7fff).contains(&row.len()) {
        file.extend(row.iter().flatten());
        return;
    }
    file.extend([2, 2, (row.len() >> 8) as u8, row.len() as u8]);
    for lane in 0..4 {
        let lane: Vec<u8> = row.iter().map(|pixel| pixel[lane]).collect();
        let run_at = |at: usize| lane[at..].iter().take(127).take_while(|&&value| value == lane[at]).count();
        let mut at = 0;
        while at < lane.len() {
            let run = run_at(at);
            if run >= 4 {
                file.extend([128 + run as u8, lane[at]]);
                at += run;
                continue;
            }
            let start = at;
            while at < lane.len() && at - start < 128 && run_at(at) < 4 {
                at += 1;
            }
            file.push((at - start) as u8);
            file.extend_from_slice(&lane[start..at]);
        }
    }
}

fn texts_of(bytes: &[u8]) -> Texts {
    let header = bytes.windows(2).position(|pair| pair == b"\n\n").map_or(&[][..], |end| &bytes[..end]);
    let unescape = |value: &str| {
        let mut characters = value.chars();
        let mut text = String::new();
        while let Some(character) = characters.next() {
            text.push(match character {
                '\\' => match characters.next() {
                    Some('n') => '\n',
                    Some('r') => '\r',
                    other => other.unwrap_or('\\'),
                },
                plain => plain,
            });
        }
        text
    };
    String::from_utf8_lossy(header)
        .split('\n')
        .filter_map(|line| line.strip_prefix("# ")?.split_once('='))
        .map(|(name, value)| (name.to_owned(), unescape(value)))
        .collect()
}

impl From<RgbImage> for DecodedImage {
    fn from(image: RgbImage) -> Self {
        let pixels = image.pixels.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect();
        Self {
            width: image.width,
            height: image.height,
            pixels: Pixels::Linear(pixels),
            texts: Texts::new(),
            says_linear: false,
        }
    }
}
