//! How large a picture may claim to be: checked on the header, before memory is taken.

use crate::error::{ImageError, Result};

/// The most pixels a picture read here may have.
pub const MAX_PIXELS: u64 = 1 << 28;

/// The most bytes the decoded samples of a picture may take.
pub const MAX_BYTES: u64 = if usize::BITS > 32 { 1 << 35 } else { 1 << 30 };

/// No codec read here packs more than this many bytes into one (deflate reaches 1032, of one-bit pixels 8256).
const MAX_EXPANSION: u64 = 1 << 16;

/// Refuse a header that claims more than the limits, or more than `file_length` bytes could hold.
pub(crate) fn check_size(
    format: &'static str,
    [width, height]: [u64; 2],
    bytes_per_pixel: u64,
    file_length: usize,
) -> Result<()> {
    let too_large = |why: String| Err(ImageError::TooLarge { format, width, height, why });
    if width == 0 || height == 0 {
        return too_large("which is no pixel at all".into());
    }
    let pixels = width.saturating_mul(height);
    let bytes = pixels.saturating_mul(bytes_per_pixel);
    if pixels > MAX_PIXELS {
        return too_large(format!("more than the limit of {MAX_PIXELS}"));
    }
    if bytes > MAX_BYTES {
        return too_large(format!("{bytes_per_pixel} bytes each, more than the limit of {MAX_BYTES} bytes"));
    }
    if bytes > (file_length as u64).saturating_mul(MAX_EXPANSION) {
        return too_large(format!("more than its {file_length} bytes can hold"));
    }
    Ok(())
}
