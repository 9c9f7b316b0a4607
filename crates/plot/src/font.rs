//! The font of all plots: Inter, cut to what they need (`fonts/OFL.txt`), so that no font of the system is asked for.

use crate::drawing::{LOW, Text};
use ttf_parser::{Face, OutlineBuilder};

const REGULAR: &[u8] = include_bytes!("../fonts/Inter-Regular.otf");
const BOLD: &[u8] = include_bytes!("../fonts/Inter-SemiBold.otf");

/// What outlines are given to, in points, y down.
pub trait Pen {
    /// Begin at a point.
    fn move_to(&mut self, at: [f64; 2]);
    /// A line to a point.
    fn line_to(&mut self, at: [f64; 2]);
    /// A quadratic curve.
    fn quad_to(&mut self, control: [f64; 2], at: [f64; 2]);
    /// A cubic curve.
    fn cubic_to(&mut self, first: [f64; 2], second: [f64; 2], at: [f64; 2]);
    /// Back to the beginning.
    fn close(&mut self);
}

/// The width of a text, in points.
pub fn width(text: &Text) -> f64 {
    let Some(face) = face(text.is_bold) else { return 0.0 };
    text.runs().iter().map(|(run, is_low)| run_width(&face, run, size_of(text, *is_low))).sum()
}

/// The outlines of a text that begins at (0, 0) and runs to the right.
pub fn outline(text: &Text, pen: &mut dyn Pen) {
    let Some(face) = face(text.is_bold) else { return };
    let mut x = 0.0;
    for (run, is_low) in text.runs() {
        let size = size_of(text, is_low);
        let scale = size / f64::from(face.units_per_em());
        let y = if is_low { LOW.1 * text.size } else { 0.0 };
        for glyph in run.chars().filter_map(|c| face.glyph_index(c).or_else(|| face.glyph_index('?'))) {
            face.outline_glyph(glyph, &mut Placed { pen, x, y, scale });
            x += f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) * scale;
        }
    }
}

fn face(is_bold: bool) -> Option<Face<'static>> {
    Face::parse(if is_bold { BOLD } else { REGULAR }, 0).ok()
}

fn size_of(text: &Text, is_low: bool) -> f64 {
    if is_low { text.size * LOW.0 } else { text.size }
}

fn run_width(face: &Face, run: &str, size: f64) -> f64 {
    let advance = |c: char| {
        let glyph = face.glyph_index(c).or_else(|| face.glyph_index('?'))?;
        face.glyph_hor_advance(glyph)
    };
    let units: u32 = run.chars().filter_map(advance).map(u32::from).sum();
    f64::from(units) * size / f64::from(face.units_per_em())
}

/// A glyph at its place.
struct Placed<'a> {
    pen: &'a mut dyn Pen,
    x: f64,
    y: f64,
    scale: f64,
}

impl Placed<'_> {
    fn at(&self, x: f32, y: f32) -> [f64; 2] {
        [self.x + f64::from(x) * self.scale, self.y - f64::from(y) * self.scale]
    }
}

impl OutlineBuilder for Placed<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pen.move_to(self.at(x, y));
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.pen.line_to(self.at(x, y));
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.pen.quad_to(self.at(x1, y1), self.at(x, y));
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.pen.cubic_to(self.at(x1, y1), self.at(x2, y2), self.at(x, y));
    }
    fn close(&mut self) {
        self.pen.close();
    }
}
