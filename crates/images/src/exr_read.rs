//! OpenEXR in: flat files of any compression the `exr` crate knows, tiled or not, of one part or several.

use crate::error::{ImageError, Result, damaged};
use crate::exr_header::attributes_of;
use crate::image::{Channel, ChannelData, Image, Window};
use crate::limits::check_size;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude as x;
use exr::prelude::{ReadChannels as _, ReadLayers as _};
use std::io::Cursor;

/// Read an EXR file: every channel of every part at full resolution, and what its header says in texts and numbers.
///
/// With several parts a channel is named `part.channel`, and the parts must share one data window. Deep samples
/// and subsampled channels are refused.
pub fn read_exr(bytes: &[u8]) -> Result<Image> {
    // Read the header alone and judge what it claims, before memory is taken.
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(translate)?;
    let first = meta.headers.first().ok_or_else(|| damaged("EXR", "it has no part"))?;
    let window = window_of(first.own_attributes.layer_position, first.layer_size);
    let mut bytes_per_pixel = 0;
    for header in &meta.headers {
        check_part(header, window)?;
        bytes_per_pixel +=
            header.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample() as u64).sum::<u64>();
    }
    check_size("EXR", [first.layer_size.0 as u64, first.layer_size.1 as u64], bytes_per_pixel, bytes.len())?;
    let display = first.shared_attributes.display_window;
    check_chunks(&meta.headers, bytes.len())?;

    // Read the samples.
    let file = x::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(translate)?;
    let mut image = Image { data: window, display: window_of(display.position, display.size), ..Image::default() };
    let several = file.layer_data.len() > 1;
    for layer in file.layer_data {
        let part = layer.attributes.layer_name.filter(|_| several).map(|name| lossy(&name) + ".").unwrap_or_default();
        for channel in layer.channel_data.list {
            let data = match channel.sample_data {
                x::FlatSamples::F16(values) => ChannelData::F16(values.into_iter().map(x::f16::to_f32).collect()),
                x::FlatSamples::F32(values) => ChannelData::F32(values),
                x::FlatSamples::U32(values) => ChannelData::U32(values),
            };
            image.channels.push(Channel { name: part.clone() + &lossy(&channel.name), data });
        }
    }
    for header in &meta.headers {
        for (name, value) in attributes_of(header) {
            image.attributes.entry(name).or_insert(value);
        }
    }
    Ok(image)
}

fn check_part(header: &Header, window: Window) -> Result<()> {
    let unsupported = |what: String, cure| Err(ImageError::Unsupported { format: "EXR", what, cure });
    if header.deep {
        return unsupported("deep samples".into(), "flatten it with `exrflatten` or in a compositor");
    }
    if let Some(channel) = header.channels.list.iter().find(|channel| channel.sampling != x::Vec2(1, 1)) {
        let what = format!("a subsampled channel, `{}`", channel.name);
        return unsupported(what, "save it again with full-resolution RGB channels");
    }
    if window_of(header.own_attributes.layer_position, header.layer_size) != window {
        return unsupported("parts with different data windows".into(), "split it with `exrmultipart -separate`");
    }
    Ok(())
}

/// Each chunk needs at least its place in the table, so a short file has few.
fn check_chunks(headers: &[Header], file_length: usize) -> Result<()> {
    let chunks = headers.iter().fold(0usize, |sum, header| sum.saturating_add(header.chunk_count));
    if chunks > file_length / 8 {
        return Err(damaged("EXR", format!("{file_length} bytes cannot hold {chunks} chunks")));
    }
    Ok(())
}

fn window_of(position: x::Vec2<i32>, size: x::Vec2<usize>) -> Window {
    Window { x: position.0, y: position.1, width: size.0 as u32, height: size.1 as u32 }
}

fn lossy(text: &x::Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

fn translate(error: x::Error) -> ImageError {
    match error {
        x::Error::NotSupported(what) => ImageError::Unsupported {
            format: "EXR",
            what: what.into_owned(),
            cure: "save it again as flat scan lines with ZIP compression",
        },
        other => damaged("EXR", other),
    }
}
