//! A function of two variables in false colour, with its scale beside it.

use crate::chart::{LABEL, NUMBER, TITLE};
use crate::color::{Color, Dash};
use crate::drawing::{Anchor, Drawing, Picture};
use crate::legend;
use crate::scale::Axis;

/// Packs red, green and blue (width, height, bytes) into a file.
pub type ToPng<'a> = &'a dyn Fn(u32, u32, &[u8]) -> Vec<u8>;

/// A map.
#[derive(Clone, Debug)]
pub struct Map {
    /// Above it.
    pub title: String,
    /// Horizontal.
    pub x: Axis,
    /// Vertical.
    pub y: Axis,
    /// What the colours mean.
    pub value: Axis,
    /// Cells in a row.
    pub columns: usize,
    /// Row by row from the top; what is no number stays white.
    pub values: Vec<f64>,
    /// Blue below the middle of the scale, red above it; else dark to bright.
    pub is_difference: bool,
}

impl Map {
    /// On a sheet of this size in points; `to_png` packs red, green and blue into a file.
    pub fn draw(&self, width: f64, height: f64, to_png: ToPng) -> Drawing {
        let mut sheet = Drawing::new(width, height);
        let scale_numbers = self.value.ticks().iter().map(|t| legend::text_width(&t.1, NUMBER)).fold(0.0, f64::max);
        let (left, right, top) = (62.0, 52.0 + scale_numbers, if self.title.is_empty() { 14.0 } else { 40.0 });
        let (w, h) = (width - left - right, height - top - 54.0);
        if !self.title.is_empty() {
            sheet.heading(legend::fitted(&self.title, TITLE - 1.0, width - 20.0), [0.5 * width, 26.0], TITLE - 1.0);
        }
        sheet.picture(self.picture([left, top, w, h], to_png));

        // Frame and axes.
        let frame = |[x, y, w, h]: [f64; 4]| vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]];
        sheet.line(frame([left, top, w, h]), Color::GREY, 1.0, "axis");
        let mut short = Vec::new();
        for (x, text) in self.x.ticks() {
            let at = left + w * self.x.place(x);
            short.push(vec![[at, top + h], [at, top + h + 4.0]]);
            sheet.text(text, [at, top + h + 17.0], NUMBER, Anchor::Middle, Color::GREY);
        }
        for (y, text) in self.y.ticks() {
            let at = top + h * (1.0 - self.y.place(y));
            short.push(vec![[left - 4.0, at], [left, at]]);
            sheet.text(text, [left - 8.0, at + 4.0], NUMBER, Anchor::End, Color::GREY);
        }
        sheet.text(&self.x.label, [left + 0.5 * w, top + h + 38.0], LABEL, Anchor::Middle, Color::INK);
        sheet.upright(&self.y.label, [18.0, top + 0.5 * h], LABEL, Color::INK);

        // The scale of colours.
        let bar = [left + w + 14.0, top, 12.0, h];
        const STEPS: usize = 128;
        let rows = (0..STEPS).flat_map(|i| self.color(1.0 - (i as f64 + 0.5) / STEPS as f64).0).collect();
        sheet.picture(pixels(bar, (1, STEPS as u32), rows, to_png));
        sheet.line(frame(bar), Color::GREY, 0.8, "axis");
        for (v, text) in self.value.ticks() {
            let at = top + h * (1.0 - self.value.place(v));
            short.push(vec![[bar[0] + bar[2], at], [bar[0] + bar[2] + 4.0, at]]);
            sheet.text(text, [bar[0] + bar[2] + 8.0, at + 4.0], NUMBER, Anchor::Start, Color::GREY);
        }
        sheet.lines(short, Color::GREY, 1.0, Dash::Solid, "axis");
        sheet.upright(&self.value.label, [width - 8.0, top + 0.5 * h], LABEL, Color::INK);
        sheet
    }

    fn color(&self, part: f64) -> Color {
        if self.is_difference { Color::of_difference(2.0 * part - 1.0) } else { Color::of_value(part) }
    }

    fn picture(&self, place: [f64; 4], to_png: ToPng) -> Picture {
        let rows = self.values.len() / self.columns.max(1);
        let shown = |v: &f64| if v.is_finite() { self.color(self.value.place(*v)).0 } else { [255; 3] };
        let codes = self.values[..rows * self.columns].iter().flat_map(shown).collect();
        pixels(place, (self.columns as u32, rows as u32), codes, to_png)
    }
}

fn pixels(place: [f64; 4], (width, height): (u32, u32), pixels: Vec<u8>, to_png: ToPng) -> Picture {
    let png = to_png(width, height, &pixels);
    Picture { place, width, height, pixels, png }
}
