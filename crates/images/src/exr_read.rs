//! OpenEXR in: flat files, tiled or not, of one part or several, of any compression but B44.

use crate::error::{Result, damaged};
use crate::exr_guard::{check_claims, translate};
use crate::exr_header::attributes_of;
use crate::image::{Channel, ChannelData, Image, Window};
use exr::meta::MetaData;
use exr::prelude as x;
use exr::prelude::{ReadChannels as _, ReadLayers as _};
use std::io::Cursor;

/// Read an EXR file: every channel of every part at full resolution, and what its header says in texts and numbers.
///
/// With several parts a channel is named `part.channel`, and the parts must share one data window. Deep samples,
/// subsampled channels and B44 compression are refused.
pub fn read_exr(bytes: &[u8]) -> Result<Image> {
    // Read the header alone and judge what it claims, before memory is taken.
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(translate)?;
    let first = meta.headers.first().ok_or_else(|| damaged("EXR", "it has no part"))?;
    check_claims(&meta.headers, bytes)?;
    let window = window_of(first.own_attributes.layer_position, first.layer_size);
    let display = first.shared_attributes.display_window;

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

fn window_of(position: x::Vec2<i32>, size: x::Vec2<usize>) -> Window {
    Window { x: position.0, y: position.1, width: size.0 as u32, height: size.1 as u32 }
}

fn lossy(text: &x::Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
