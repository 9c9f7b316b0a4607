//! Pictures as bytes and as numbers: PNG, EXR and HDR in and out, tone curves, image metrics.
//! Nothing here knows of the renderer or of files.
//!
//! Every function takes and returns byte slices and vectors; no file handle, thread or clock. What is written
//! depends on the input alone, so equal pictures are equal files, on every platform. Any bytes may be read:
//! damaged ones give an [`ImageError`], never a panic, and a header that claims an absurd size is refused
//! before memory is taken.
//!
//! Conventions: pixels count from the top left, rows first. Colours are linear, scene-referred, Rec.709
//! primaries, unless a name says `srgb`.

mod error;
mod image;
mod limits;
pub mod srgb;

mod decode;
mod exr_guard;
mod exr_header;
mod exr_read;
mod exr_write;
mod hdr;
mod png_file;
mod tiff_file;

pub mod heat;
pub mod metrics;
mod tone;

pub use decode::{DecodedImage, Pixels, decode};
pub use error::{ImageError, Result};
pub use exr_read::read_exr;
pub use exr_write::{ExrCompression, write_exr};
pub use hdr::{read_hdr, write_hdr};
pub use image::{Attribute, Channel, ChannelData, Image, RgbImage, Window};
pub use limits::{MAX_BYTES, MAX_PIXELS};
pub use png_file::{read_png, write_png8, write_png16};
pub use srgb::{linear_to_srgb, srgb_to_linear};
pub use tone::{ToneCurve, to_srgb8, to_srgb16};

/// Metadata of files that hold only texts: name and value, in the order of the names.
pub type Texts = std::collections::BTreeMap<String, String>;
