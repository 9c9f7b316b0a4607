//! A drawing as pixels.

use crate::color::{Color, Dash};
use crate::drawing::{Anchor, Drawing, Item, Path, Picture, Text};
use crate::font::{self, Pen};
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

/// Pixels: red, green and blue (sRGB), from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Three to a pixel.
    pub rgb: Vec<u8>,
}

/// The drawing with `scale` pixels to a point; `None` if that leaves no pixel or too many.
pub fn rasterize(drawing: &Drawing, scale: f64) -> Option<Pixels> {
    let (width, height) = ((drawing.width * scale).round() as u32, (drawing.height * scale).round() as u32);
    const MOST: u32 = 1 << 14;
    if width > MOST || height > MOST {
        return None;
    }
    let mut sheet = Pixmap::new(width, height)?;
    sheet.fill(tiny_skia::Color::WHITE);
    let to_pixels = Transform::from_scale(scale as f32, scale as f32);
    for item in &drawing.items {
        match item {
            Item::Path(p) => path(&mut sheet, p, to_pixels),
            Item::Text(t) => text(&mut sheet, t, to_pixels),
            Item::Picture(p) => picture(&mut sheet, p, scale),
        }
    }
    let rgb = sheet.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    Some(Pixels { width, height, rgb })
}

fn path(sheet: &mut Pixmap, path: &Path, to_pixels: Transform) {
    let mut builder = PathBuilder::new();
    for line in &path.lines {
        for (i, at) in line.iter().enumerate() {
            match i {
                0 => builder.move_to(at[0] as f32, at[1] as f32),
                _ => builder.line_to(at[0] as f32, at[1] as f32),
            }
        }
        if path.is_closed && !line.is_empty() {
            builder.close();
        }
    }
    let Some(built) = builder.finish() else { return };
    if let Some(color) = path.fill {
        sheet.fill_path(&built, &paint(color), FillRule::Winding, to_pixels, None);
    }
    if let Some((color, width, dash)) = path.stroke {
        sheet.stroke_path(&built, &paint(color), &stroke(width, dash), to_pixels, None);
    }
}

fn stroke(width: f64, dash: Dash) -> Stroke {
    let lengths: Vec<f32> = dash.pattern().iter().map(|x| (x * width) as f32).collect();
    Stroke {
        width: width as f32,
        line_cap: LineCap::Butt,
        line_join: LineJoin::Round,
        dash: StrokeDash::new(lengths, 0.0),
        ..Stroke::default()
    }
}

fn text(sheet: &mut Pixmap, text: &Text, to_pixels: Transform) {
    let before = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * font::width(text),
        Anchor::End => font::width(text),
    };
    let mut outline = Outline(PathBuilder::new());
    font::outline(text, &mut outline);
    let Some(built) = outline.0.finish() else { return };
    let mut place = Transform::from_translate(-before as f32, 0.0);
    if text.is_upright {
        place = place.post_concat(Transform::from_row(0.0, -1.0, 1.0, 0.0, 0.0, 0.0));
    }
    let place = place.post_translate(text.at[0] as f32, text.at[1] as f32).post_concat(to_pixels);
    sheet.fill_path(&built, &paint(text.color), FillRule::Winding, place, None);
}

/// Pixels are laid over the sheet's, linear between their middles where they are enlarged.
fn picture(sheet: &mut Pixmap, picture: &Picture, scale: f64) {
    let [left, top, w, h] = picture.place.map(|v| v * scale);
    let (width, height) = (f64::from(picture.width), f64::from(picture.height));
    let columns = left.round().max(0.0) as u32..((left + w).round().max(0.0) as u32).min(sheet.width());
    let rows = top.round().max(0.0) as u32..((top + h).round().max(0.0) as u32).min(sheet.height());
    let stride = sheet.width();
    let codes = |x: f64, y: f64| {
        let (x, y) = (x.clamp(0.0, width - 1.0), y.clamp(0.0, height - 1.0));
        let (x0, y0) = (x as usize, y as usize);
        let (x1, y1) = ((x0 + 1).min(picture.width as usize - 1), (y0 + 1).min(picture.height as usize - 1));
        let at = |x: usize, y: usize, c: usize| f64::from(picture.pixels[3 * (y * picture.width as usize + x) + c]);
        let (fx, fy) = (x - x0 as f64, y - y0 as f64);
        core::array::from_fn(|c| {
            let upper = at(x0, y0, c) * (1.0 - fx) + at(x1, y0, c) * fx;
            let lower = at(x0, y1, c) * (1.0 - fx) + at(x1, y1, c) * fx;
            (upper * (1.0 - fy) + lower * fy).round() as u8
        })
    };
    if picture.width == 0 || picture.height == 0 || picture.pixels.len() < 3 * (width * height) as usize {
        return;
    }
    let data = sheet.data_mut();
    for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
        let (u, v) = ((f64::from(x) + 0.5 - left) / w * width - 0.5, (f64::from(y) + 0.5 - top) / h * height - 0.5);
        let [r, g, b]: [u8; 3] = codes(u, v);
        let first = 4 * (y as usize * stride as usize + x as usize);
        data[first..first + 4].copy_from_slice(&[r, g, b, 255]);
    }
}

fn paint(Color([r, g, b], opacity): Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, (opacity * 255.0).round() as u8);
    paint
}

/// Outlines of letters as a path.
struct Outline(PathBuilder);

impl Pen for Outline {
    fn move_to(&mut self, [x, y]: [f64; 2]) {
        self.0.move_to(x as f32, y as f32);
    }
    fn line_to(&mut self, [x, y]: [f64; 2]) {
        self.0.line_to(x as f32, y as f32);
    }
    fn quad_to(&mut self, [a, b]: [f64; 2], [x, y]: [f64; 2]) {
        self.0.quad_to(a as f32, b as f32, x as f32, y as f32);
    }
    fn cubic_to(&mut self, [a, b]: [f64; 2], [c, d]: [f64; 2], [x, y]: [f64; 2]) {
        self.0.cubic_to(a as f32, b as f32, c as f32, d as f32, x as f32, y as f32);
    }
    fn close(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_fills_its_place_and_nothing_else() {
        let mut sheet = Drawing::new(4.0, 2.0);
        let picture =
            Picture { place: [1.0, 0.0, 2.0, 1.0], width: 2, height: 1, pixels: vec![9, 8, 7, 1, 2, 3], png: vec![] };
        sheet.picture(picture);
        let pixels = rasterize(&sheet, 1.0).unwrap();
        assert_eq!((pixels.width, pixels.height), (4, 2));
        assert_eq!(pixels.rgb[..12], [255, 255, 255, 9, 8, 7, 1, 2, 3, 255, 255, 255]);
        assert!(pixels.rgb[12..].iter().all(|&x| x == 255));
    }

    #[test]
    fn letters_leave_ink_where_they_stand() {
        let mut sheet = Drawing::new(60.0, 30.0);
        sheet.text("θ~i = 45°", [2.0, 20.0], 12.0, Anchor::Start, Color::INK);
        let pixels = rasterize(&sheet, 2.0).unwrap();
        let dark = pixels.rgb.chunks(3).filter(|p| p[0] < 100).count();
        assert!((60..1000).contains(&dark), "{dark}");
        assert!(pixels.rgb[..3 * 120 * 10].iter().all(|&x| x == 255), "nothing above the line");
    }

    #[test]
    fn no_sheet_is_too_large_or_empty() {
        assert!(rasterize(&Drawing::new(1e6, 10.0), 2.0).is_none());
        assert!(rasterize(&Drawing::new(0.0, 10.0), 2.0).is_none());
    }
}
