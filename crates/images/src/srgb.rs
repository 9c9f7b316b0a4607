//! The sRGB transfer function (IEC 61966-2-1:1999), the same bits on every platform.
//!
//! Eight-bit codes go through tables: decoding is one load; encoding is a search among the 255 linear values
//! at which the rounded code changes.

use kirkas_geometry::elementary::pow;
use std::sync::LazyLock;

static LINEAR_FROM_CODE: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| decode_exact(code as f64 / 255.0) as f32));

/// `[k - 1]` is the smallest f32 whose code is at least k.
static FIRST_OF_CODE: LazyLock<[f32; 255]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let border = decode_exact((k as f64 + 0.5) / 255.0);
        let nearest = border as f32;
        if f64::from(nearest) < border { nearest.next_up() } else { nearest }
    })
});

fn decode_exact(coded: f64) -> f64 {
    if coded <= 0.04045 { coded / 12.92 } else { pow((coded + 0.055) / 1.055, 2.4) }
}

fn encode_exact(linear: f64) -> f64 {
    if linear <= 0.0031308 { linear * 12.92 } else { 1.055 * pow(linear, 1.0 / 2.4) - 0.055 }
}

/// The linear value of an sRGB-coded one; `[0, 1]` to `[0, 1]`, continued beyond.
pub fn srgb_to_linear(coded: f32) -> f32 {
    decode_exact(f64::from(coded)) as f32
}

/// The sRGB-coded value of a linear one; `[0, 1]` to `[0, 1]`, continued beyond.
pub fn linear_to_srgb(linear: f32) -> f32 {
    encode_exact(f64::from(linear)) as f32
}

/// The linear value of an eight-bit code.
pub fn srgb8_to_linear(code: u8) -> f32 {
    LINEAR_FROM_CODE[usize::from(code)]
}

/// The linear value of a sixteen-bit code.
pub fn srgb16_to_linear(code: u16) -> f32 {
    decode_exact(f64::from(code) / 65535.0) as f32
}

/// The nearest eight-bit code; values outside `[0, 1]` go to its ends, NaN to 0.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    FIRST_OF_CODE.partition_point(|&first| first <= linear) as u8
}

/// The nearest sixteen-bit code; values outside `[0, 1]` go to its ends, NaN to 0.
pub fn linear_to_srgb16(linear: f32) -> u16 {
    let coded = encode_exact(f64::from(linear).clamp(0.0, 1.0));
    (coded * 65535.0 + 0.5) as u16
}
