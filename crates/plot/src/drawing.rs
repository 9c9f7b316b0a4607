//! What is drawn: paths, texts and pictures, one above the other, in points from the top left, y down.

use crate::color::{Color, Dash};

/// A sheet and what is on it.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// In points.
    pub width: f64,
    /// In points.
    pub height: f64,
    /// From below to above.
    pub items: Vec<Item>,
}

/// One thing on it.
#[derive(Clone, Debug)]
pub enum Item {
    /// Lines or an area.
    Path(Path),
    /// One line of text.
    Text(Text),
    /// Pixels.
    Picture(Picture),
}

/// Polylines that are drawn together.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Each a run of points.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// The last point of each is joined to its first.
    pub is_closed: bool,
    /// Of the area.
    pub fill: Option<Color>,
    /// Of the line, its width in points and its dashes.
    pub stroke: Option<(Color, f64, Dash)>,
    /// What it is, for whoever reads the SVG: `curve`, `grid`.
    pub class: &'static str,
}

/// Where a text stands from its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// To the right of it.
    Start,
    /// Around it.
    Middle,
    /// To the left of it.
    End,
}

/// One line of text; `~` lowers the character behind it: `θ~i`.
#[derive(Clone, Debug)]
pub struct Text {
    /// What it says.
    pub text: String,
    /// On the baseline.
    pub at: [f64; 2],
    /// In points.
    pub size: f64,
    /// From `at`.
    pub anchor: Anchor,
    /// Its colour.
    pub color: Color,
    /// Semi-bold.
    pub is_bold: bool,
    /// It runs upwards.
    pub is_upright: bool,
}

/// Pixels in a rectangle.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Left, top, width, height.
    pub place: [f64; 4],
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Red, green and blue (sRGB), from the top left.
    pub pixels: Vec<u8>,
    /// The same as a PNG file.
    pub png: Vec<u8>,
}

impl Drawing {
    /// An empty white sheet.
    pub fn new(width: f64, height: f64) -> Self {
        let mut sheet = Drawing { width, height, items: Vec::new() };
        sheet.area([0.0, 0.0, width, height], Color::WHITE);
        sheet
    }

    /// A filled rectangle: left, top, width, height.
    pub fn area(&mut self, [x, y, w, h]: [f64; 4], color: Color) {
        let lines = vec![vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]]];
        self.items.push(Item::Path(Path { lines, is_closed: true, fill: Some(color), stroke: None, class: "area" }));
    }

    /// A line through points.
    pub fn line(&mut self, points: Vec<[f64; 2]>, color: Color, width: f64, class: &'static str) {
        self.lines(vec![points], color, width, Dash::Solid, class);
    }

    /// Lines of one colour.
    pub fn lines(&mut self, lines: Vec<Vec<[f64; 2]>>, color: Color, width: f64, dash: Dash, class: &'static str) {
        let stroke = Some((color, width, dash));
        self.items.push(Item::Path(Path { lines, is_closed: false, fill: None, stroke, class }));
    }

    /// A text of this size.
    pub fn text(&mut self, text: impl Into<String>, at: [f64; 2], size: f64, anchor: Anchor, color: Color) {
        let (is_bold, is_upright) = (false, false);
        self.items.push(Item::Text(Text { text: text.into(), at, size, anchor, color, is_bold, is_upright }));
    }

    /// The heading of a sheet or a panel, centred.
    pub fn heading(&mut self, text: impl Into<String>, at: [f64; 2], size: f64) {
        let (anchor, color) = (Anchor::Middle, Color::INK);
        let text = text.into();
        self.items.push(Item::Text(Text { text, at, size, anchor, color, is_bold: true, is_upright: false }));
    }

    /// A text that runs upwards, centred.
    pub fn upright(&mut self, text: impl Into<String>, at: [f64; 2], size: f64, color: Color) {
        let (anchor, text) = (Anchor::Middle, text.into());
        self.items.push(Item::Text(Text { text, at, size, anchor, color, is_bold: false, is_upright: true }));
    }

    /// Pixels.
    pub fn picture(&mut self, picture: Picture) {
        self.items.push(Item::Picture(picture));
    }

    /// Everything on `other`, with its top left corner at (x, y).
    pub fn place(&mut self, other: Drawing, x: f64, y: f64) {
        self.items.extend(other.items.into_iter().map(|mut item| {
            match &mut item {
                Item::Path(p) => p.lines.iter_mut().flatten().for_each(|at| *at = [at[0] + x, at[1] + y]),
                Item::Text(t) => t.at = [t.at[0] + x, t.at[1] + y],
                Item::Picture(p) => {
                    p.place[0] += x;
                    p.place[1] += y;
                }
            }
            item
        }));
    }
}

impl Text {
    /// Its runs: what stands on the baseline and what is lowered.
    pub fn runs(&self) -> Vec<(String, bool)> {
        let mut runs: Vec<(String, bool)> = Vec::new();
        let mut is_low = false;
        for c in self.text.chars() {
            if c == '~' && !is_low {
                is_low = true;
                continue;
            }
            match runs.last_mut() {
                Some((run, low)) if *low == is_low => run.push(c),
                _ => runs.push((c.to_string(), is_low)),
            }
            is_low = false;
        }
        runs
    }
}

/// The size of lowered text, and how far it is lowered, in sizes of the text.
pub const LOW: (f64, f64) = (0.72, 0.2);

/// The points without those that lie within `tolerance` of the line through the others (Ramer 1972, Douglas & Peucker 1973).
pub fn thinned(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut keeps = vec![false; points.len()];
    let mut open = vec![(0, points.len().saturating_sub(1))];
    for end in [keeps.len().checked_sub(1), (!keeps.is_empty()).then_some(0)].into_iter().flatten() {
        keeps[end] = true;
    }
    while let Some((first, last)) = open.pop() {
        let off = |i: usize| (i, distance(points[i], points[first], points[last]));
        let farthest = (first + 1..last).map(off).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, _)) = farthest.filter(|f| f.1 > tolerance) {
            keeps[i] = true;
            open.extend([(first, i), (i, last)]);
        }
    }
    points.iter().zip(keeps).filter(|p| p.1).map(|p| *p.0).collect()
}

/// From a point to the line from `a` to `b`.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length2 = dx * dx + dy * dy;
    let t = if length2 > 0.0 { ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 } else { 0.0 }.clamp(0.0, 1.0);
    let (x, y) = (a[0] + t * dx - p[0], a[1] + t * dy - p[1]);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_line_are_left_out() {
        let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 5.0], [2.0, 6.0], [9.0, 9.0]];
        assert_eq!(thinned(&points, 0.01), [[0.0, 0.0], [2.0, 0.0], [2.0, 6.0], [9.0, 9.0]]);
        assert_eq!(thinned(&points[..1], 0.01), [[0.0, 0.0]]);
        assert!(thinned(&[], 0.01).is_empty());
    }
}
