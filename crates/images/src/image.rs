//! A picture as numbers: named planes of samples, where they lie, and what is known about them.

use crate::error::{ImageError, Result};
use std::collections::BTreeMap;

/// A picture of any number of channels (an EXR file in memory): colour, AOVs, exact sums, metadata.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Image {
    /// Where the samples lie; every channel has `data.width * data.height` of them.
    pub data: Window,
    /// The whole picture of which `data` may be a crop.
    pub display: Window,
    /// The planes. Files hold them sorted by name, so that is the order in which they come back.
    pub channels: Vec<Channel>,
    /// Everything else that is known: what made the picture.
    pub attributes: BTreeMap<String, Attribute>,
}

/// A rectangle of pixels; x to the right, y down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Window {
    /// Leftmost column.
    pub x: i32,
    /// Topmost row.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// One plane of an [`Image`].
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// The name as in EXR: `R`, `depth.Z`, `kirkas.sum.R.0`; what stands before the last dot is the layer.
    pub name: String,
    /// One sample per pixel, rows from the top.
    pub data: ChannelData,
}

/// The samples of a channel, and the type in which a file keeps them.
#[derive(Debug, Clone, PartialEq)]
pub enum ChannelData {
    /// Kept as 16-bit floats; finite values beyond their range are kept as the largest one.
    F16(Vec<f32>),
    /// Kept as 32-bit floats, every bit.
    F32(Vec<f32>),
    /// Kept as 32-bit integers.
    U32(Vec<u32>),
}

/// A piece of metadata.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// UTF-8 text.
    Text(String),
    /// A number; integers and 32-bit floats of other programs fit exactly.
    Number(f64),
}

/// A picture of red, green and blue: linear, Rec.709 primaries.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RgbImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels, rows from the top.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A picture of this size without channels.
    pub fn new(width: u32, height: u32) -> Self {
        let window = Window { x: 0, y: 0, width, height };
        Self { data: window, display: window, ..Self::default() }
    }

    /// The channels `R`, `G`, `B` of `rgb`, kept as `keep` says: `ChannelData::F16` or `ChannelData::F32`.
    pub fn from_rgb(rgb: &RgbImage, keep: fn(Vec<f32>) -> ChannelData) -> Self {
        let mut image = Self::new(rgb.width, rgb.height);
        for (lane, name) in ["R", "G", "B"].into_iter().enumerate() {
            image.push(name, keep(rgb.pixels.iter().map(|pixel| pixel[lane]).collect()));
        }
        image
    }

    /// Append a channel.
    pub fn push(&mut self, name: impl Into<String>, data: ChannelData) {
        self.channels.push(Channel { name: name.into(), data });
    }

    /// The samples of the channel of this name.
    pub fn channel(&self, name: &str) -> Option<&ChannelData> {
        self.channels.iter().find(|channel| channel.name == name).map(|channel| &channel.data)
    }

    /// The value of a text attribute.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.attributes.get(name)? {
            Attribute::Text(text) => Some(text),
            Attribute::Number(_) => None,
        }
    }

    /// The colours of the data window: the channels `R`, `G`, `B`; else `Y` as grey; else `R`, `G`, `B` of the
    /// first layer that has them. None where there is no such float channel.
    pub fn rgb(&self) -> Option<RgbImage> {
        let [r, g, b] = self.colour_channels()?;
        let pixels = r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]).collect();
        Some(RgbImage { width: self.data.width, height: self.data.height, pixels })
    }

    fn colour_channels(&self) -> Option<[&[f32]; 3]> {
        let floats = |name: &str| self.channel(name)?.floats();
        let layer = |prefix: &str| {
            let lane = |name: &str| floats(&format!("{prefix}{name}"));
            Some([lane("R")?, lane("G")?, lane("B")?])
        };
        layer("").or_else(|| floats("Y").map(|y| [y, y, y])).or_else(|| {
            let mut prefixes: Vec<&str> =
                self.channels.iter().filter_map(|c| c.name.strip_suffix('R')).filter(|p| p.ends_with('.')).collect();
            prefixes.sort_unstable();
            prefixes.into_iter().find_map(layer)
        })
    }
}

impl ChannelData {
    /// The samples, if they are floats.
    pub fn floats(&self) -> Option<&[f32]> {
        match self {
            Self::F16(values) | Self::F32(values) => Some(values),
            Self::U32(_) => None,
        }
    }

    /// The samples, if they are integers.
    pub fn integers(&self) -> Option<&[u32]> {
        match self {
            Self::U32(values) => Some(values),
            Self::F16(_) | Self::F32(_) => None,
        }
    }

    /// How many samples there are.
    pub fn len(&self) -> usize {
        match self {
            Self::F16(values) | Self::F32(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }

    /// Whether there is no sample at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl RgbImage {
    /// The picture whose pixel (x, y) is `colour(x, y)`.
    pub fn from_fn(width: u32, height: u32, colour: impl Fn(u32, u32) -> [f32; 3]) -> Self {
        let colour = &colour;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| colour(x, y))).collect();
        Self { width, height, pixels }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Check that the number of pixels is the product of the sides.
    pub fn validate(&self) -> Result<()> {
        if self.pixels.len() as u64 == u64::from(self.width) * u64::from(self.height) {
            return Ok(());
        }
        Err(ImageError::OutOfRange {
            name: "the number of pixels",
            value: self.pixels.len().to_string(),
            range: "width times height",
        })
    }
}
