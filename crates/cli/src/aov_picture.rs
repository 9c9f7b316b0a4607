//! Extra layers as pictures for the eye. Depth and normals look as in MIT 6.837: plain numbers, no sRGB curve.

use crate::aov_args::AovArg;
use crate::pictures::raw_code;
use kirkas_images::{ChannelData, srgb};
use kirkas_render::Film;
use kirkas_render::film::aov::AOVS;

/// Three codes per pixel of the crop.
pub fn aov_codes(film: &Film, aov: &AovArg) -> Vec<u8> {
    let lanes = AOVS.iter().find(|a| a.0 == aov.name).map_or(0, |a| a.1.len());
    let channels: Vec<ChannelData> = (0..lanes).map(|c| film.aov_channel(aov.name, c)).collect();
    let pixels = film.layout.crop.area();
    match aov.name {
        "depth" => grey(&depth_codes(film, floats(&channels[0]), aov.range)),
        "normals" => colours(&channels, pixels, |v| raw_code(v.abs())),
        "albedo" => colours(&channels, pixels, srgb::linear_to_srgb8),
        "object_id" | "material_id" => integers(&channels[0]).iter().flat_map(|&id| id_colour(id)).collect(),
        "sample_count" => {
            let counts = integers(&channels[0]);
            let most = counts.iter().copied().max().unwrap_or(0).max(1);
            grey(&counts.iter().map(|&n| raw_code(n as f32 / most as f32)).collect::<Vec<_>>())
        }
        _ => stretched(&channels, pixels),
    }
}

fn floats(data: &ChannelData) -> &[f32] {
    data.floats().unwrap_or_default()
}

fn integers(data: &ChannelData) -> &[u32] {
    data.integers().unwrap_or_default()
}

/// White at `near`, black at `far` and where nothing was hit; without a range, at the nearest and farthest hit.
fn depth_codes(film: &Film, depth: &[f32], range: Option<(f32, f32)>) -> Vec<u8> {
    let c = film.layout.crop;
    let mut is_hit = vec![false; depth.len()];
    for (x, y, tile, i) in film.pixels() {
        let at = (y - c.y0) as usize * c.width() as usize + (x - c.x0) as usize;
        is_hit[at] = tile.aovs.as_ref().is_some_and(|a| a.hits[i] > 0);
    }
    let hits = || depth.iter().zip(&is_hit).filter(|(_, hit)| **hit).map(|(d, _)| *d);
    let (near, far) = range.unwrap_or_else(|| (hits().fold(f32::INFINITY, f32::min), hits().fold(0.0, f32::max)));
    let extent = if far == near { 1.0 } else { far - near };
    let code = |(d, hit): (&f32, &bool)| if *hit { raw_code((1.0 - (d - near) / extent).clamp(0.0, 1.0)) } else { 0 };
    depth.iter().zip(&is_hit).map(code).collect()
}

fn grey(codes: &[u8]) -> Vec<u8> {
    codes.iter().flat_map(|&c| [c; 3]).collect()
}

fn colours(channels: &[ChannelData], pixels: usize, code: impl Fn(f32) -> u8) -> Vec<u8> {
    (0..pixels).flat_map(|i| channels.iter().map(move |c| floats(c)[i])).map(code).collect()
}

/// Each channel from its least to its greatest value: for positions and variances, which have no scale of their own.
fn stretched(channels: &[ChannelData], pixels: usize) -> Vec<u8> {
    let bounds = |c: &ChannelData| {
        let finite = || floats(c).iter().copied().filter(|v| v.is_finite());
        let (low, high) = (finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max));
        (low, if high > low { high - low } else { 1.0 })
    };
    let scales: Vec<(f32, f32)> = channels.iter().map(bounds).collect();
    let code = |i: usize, c: usize| raw_code((floats(&channels[c])[i] - scales[c].0) / scales[c].1);
    (0..pixels).flat_map(|i| (0..channels.len()).map(move |c| (i, c))).map(|(i, c)| code(i, c)).collect()
}

/// Colours that neighbours in number do not share; black for none.
fn id_colour(id: u32) -> [u8; 3] {
    if id == 0 {
        return [0; 3];
    }
    // Golden-ratio steps around the hues, and three brightnesses.
    let hue = (id as f32 * 0.618_034).fract() * 6.0;
    let value = [255.0, 200.0, 150.0][id as usize / 7 % 3];
    let lane = |n: f32| {
        let k = (n + hue) % 6.0;
        (value * (1.0 - 0.75 * k.min(4.0 - k).clamp(0.0, 1.0))) as u8
    };
    [lane(5.0), lane(3.0), lane(1.0)]
}
