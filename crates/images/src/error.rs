//! What can go wrong with a picture, in words that name the cure.

use thiserror::Error;

/// The result of everything here that can fail.
pub type Result<T> = std::result::Result<T, ImageError>;

/// Why a picture could not be read, written or compared.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ImageError {
    /// The bytes begin like no format that can be read here.
    #[error("not a picture of a known format; give a PNG, JPEG, BMP, TGA, TIFF, HDR or EXR file")]
    UnknownFormat,
    /// The bytes contradict themselves or end too early.
    #[error("this {format} file is damaged ({reason}); write it again or fetch a fresh copy")]
    Damaged {
        /// The name of the format.
        format: &'static str,
        /// What the reader stumbled over.
        reason: String,
    },
    /// The bytes may be well, but use something that is not understood here.
    #[error("this {format} file uses {what}, which is not supported; {cure}")]
    Unsupported {
        /// The name of the format.
        format: &'static str,
        /// The feature.
        what: String,
        /// What the user can do.
        cure: &'static str,
    },
    /// The header claims a size beyond what this crate, or the length of the file, allows.
    #[error("this {format} file claims {width} x {height} pixels, {why}; scale or crop it, or fetch a fresh copy")]
    TooLarge {
        /// The name of the format.
        format: &'static str,
        /// Claimed width in pixels.
        width: u64,
        /// Claimed height in pixels.
        height: u64,
        /// Which limit it breaks.
        why: String,
    },
    /// The picture handed in for writing is not one.
    #[error("this picture cannot be written as {format}: {reason}")]
    Unwritable {
        /// The name of the format.
        format: &'static str,
        /// What to change.
        reason: String,
    },
    /// Two pictures of different sizes cannot be compared.
    #[error(
        "pictures of {0} x {1} and {2} x {3} pixels cannot be compared; render or crop them to one size",
        a[0], a[1], b[0], b[1]
    )]
    SizesDiffer {
        /// Width and height of the first.
        a: [u32; 2],
        /// Width and height of the second.
        b: [u32; 2],
    },
    /// A number that a function was given lies outside its range.
    #[error("{name} is {value}; it must be {range}")]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// The value given.
        value: String,
        /// The values allowed.
        range: &'static str,
    },
}

pub(crate) fn damaged(format: &'static str, reason: impl ToString) -> ImageError {
    ImageError::Damaged { format, reason: reason.to_string() }
}

pub(crate) fn unwritable(format: &'static str, reason: impl ToString) -> ImageError {
    ImageError::Unwritable { format, reason: reason.to_string() }
}
