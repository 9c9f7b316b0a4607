//! The picture that stands in an explanation's page: the explained one, or a quick one of the scene; never large.

use super::source::Source;
use crate::pictures::codes;
use kirkas_images::{RgbImage, Texts, write_png8};
use kirkas_render::film::FilmLayout;
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Rect, Renderer};

/// Columns and rows at most.
const MOST: u32 = 640;
/// Samples per pixel of a quick picture, at most.
const QUICK_SAMPLES: u32 = 4;
const QUICK: u32 = 320;

/// A PNG, with its width and height.
pub fn picture(source: &Source) -> Option<(Vec<u8>, u32, u32)> {
    let whole = source.prepared.film.size;
    let rgb = match source.image().filter(|i| (i.data.width, i.data.height) == whole).and_then(|i| i.rgb()) {
        Some(rgb) => smaller(rgb),
        None => quick(source),
    };
    let codes = codes(&rgb, &source.prepared.tone, source.prepared.exposure);
    let png = write_png8(rgb.width, rgb.height, &codes, &Texts::default()).ok()?;
    Some((png, rgb.width, rgb.height))
}

/// Means of blocks of pixels.
fn smaller(image: RgbImage) -> RgbImage {
    let n = image.width.max(image.height).div_ceil(MOST);
    if n < 2 {
        return image;
    }
    let (width, height) = (image.width / n, image.height / n);
    let mean = |x: u32, y: u32| {
        let mut sum = [0.0_f32; 3];
        for (dx, dy) in (0..n).flat_map(|dy| (0..n).map(move |dx| (dx, dy))) {
            let p = image.pixels[((y * n + dy) * image.width + x * n + dx) as usize];
            (0..3).for_each(|c| sum[c] += p[c]);
        }
        sum.map(|s| s / (n * n) as f32)
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
    RgbImage { width, height, pixels }
}

/// A small picture with few samples.
fn quick(source: &Source) -> RgbImage {
    let prepared = &source.prepared;
    let (w, h) = prepared.film.size;
    let n = w.max(h).div_ceil(QUICK).max(1);
    let size = ((w / n).max(1), (h / n).max(1));
    let layout = FilmLayout {
        size,
        crop: Rect { x0: 0, y0: 0, x1: size.0, y1: size.1 },
        groups: Vec::new(),
        aovs: Default::default(),
        bins: None,
    };
    let mut film = Film::new(layout);
    let renderer = Renderer {
        resolution: size,
        shift: [0.0; 2],
        planes: 1,
        bins: None,
        keeps_aovs: false,
        target: None,
        ..prepared.renderer(256)
    };
    renderer.render(&mut film, 0..prepared.samples.min(QUICK_SAMPLES), &Undisturbed);
    film.to_rgb()
}
