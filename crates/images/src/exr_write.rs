//! OpenEXR out: one part, scan lines, any mix of 16-bit, 32-bit and integer channels.

use crate::error::{Result, unwritable};
use crate::exr_header::{check_name, insert_attributes};
use crate::image::{ChannelData, Image, Window};
use crate::limits::MAX_PIXELS;
use exr::prelude as x;
use std::io::Cursor;

/// How the samples of an EXR file are packed; both without loss.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExrCompression {
    /// Fast to write, large: for checkpoints.
    None,
    /// Deflate over 16 lines: what every program reads.
    #[default]
    Zip,
}

/// The bytes of an EXR file: all channels, both windows and all attributes of `image`.
///
/// Floats keep every bit in `F32` channels, integers are exact, and equal images give equal bytes.
pub fn write_exr(image: &Image, compression: ExrCompression) -> Result<Vec<u8>> {
    validate(image)?;
    let compression = match compression {
        ExrCompression::None => x::Compression::Uncompressed,
        ExrCompression::Zip => x::Compression::ZIP16,
    };
    let encoding = x::Encoding { compression, blocks: x::Blocks::ScanLines, line_order: x::LineOrder::Increasing };
    let list = image.channels.iter().map(|channel| x::AnyChannel::new(text(&channel.name), samples(&channel.data)));
    let layer = x::Layer::new(
        size(image.data),
        x::LayerAttributes { layer_position: x::Vec2(image.data.x, image.data.y), ..Default::default() },
        encoding,
        x::AnyChannels::sort(list.collect()),
    );
    let display = x::IntegerBounds { position: x::Vec2(image.display.x, image.display.y), size: size(image.display) };
    let part = x::Image::new(x::ImageAttributes::new(display), layer);

    let mut file = Vec::new();
    x::WritableImage::write(&part)
        .non_parallel()
        .to_buffered(Cursor::new(&mut file))
        .map_err(|error| unwritable("EXR", error))?;
    let chunks = (image.data.height as usize).div_ceil(compression.scan_lines_per_block());
    insert_attributes(file, &image.attributes, chunks)
}

fn validate(image: &Image) -> Result<()> {
    let fail = |reason: String| Err(unwritable("EXR", reason));
    for (name, window) in [("data", image.data), ("display", image.display)] {
        // The format computes with corners, and readers refuse those beyond half the range.
        let reach = |start: i32, length: u32| i64::from(start).abs() + i64::from(length);
        if window.width == 0 || window.height == 0 {
            return fail(format!("the {name} window is empty"));
        }
        if reach(window.x, window.width).max(reach(window.y, window.height)) >= 1 << 30 {
            return fail(format!("the {name} window reaches beyond 2^30"));
        }
    }
    let pixels = u64::from(image.data.width) * u64::from(image.data.height);
    if pixels > MAX_PIXELS {
        return fail(format!("{pixels} pixels are more than the limit of {MAX_PIXELS}; render it in crops"));
    }
    let mut names: Vec<&str> = image.channels.iter().map(|channel| channel.name.as_str()).collect();
    names.sort_unstable();
    if names.is_empty() {
        return fail("it has no channels".into());
    }
    if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return fail(format!("two channels are named `{}`", twice[0]));
    }
    for channel in &image.channels {
        check_name("channel", &channel.name)?;
        if channel.data.len() as u64 != pixels {
            let length = channel.data.len();
            return fail(format!("channel `{}` has {length} samples for {pixels} pixels", channel.name));
        }
    }
    Ok(())
}

fn samples(data: &ChannelData) -> x::FlatSamples {
    // A finite value stays finite: half floats end at 65504.
    let half = |&value: &f32| {
        let clamped = if value.is_finite() { value.clamp(-65504.0, 65504.0) } else { value };
        x::f16::from_f32(clamped)
    };
    match data {
        ChannelData::F16(values) => x::FlatSamples::F16(values.iter().map(half).collect()),
        ChannelData::F32(values) => x::FlatSamples::F32(values.clone()),
        ChannelData::U32(values) => x::FlatSamples::U32(values.clone()),
    }
}

fn text(name: &str) -> x::Text {
    x::Text::from_slice_unchecked(name.as_bytes())
}

fn size(window: Window) -> x::Vec2<usize> {
    x::Vec2(window.width as usize, window.height as usize)
}
