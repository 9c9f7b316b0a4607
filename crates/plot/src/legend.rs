//! The legend: below the plot, in as many rows as it needs, so that it never covers a curve.

use crate::color::{Color, Dash};
use crate::drawing::{Anchor, Drawing, Text};
use crate::font;

/// One line of it.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What the line shows.
    pub name: String,
    /// Its colour.
    pub color: Color,
    /// Its dashes.
    pub dash: Dash,
}

const SIZE: f64 = 12.0;
const ROW: f64 = 19.0;
const SAMPLE: f64 = 26.0;
const GAP: f64 = 22.0;

/// Its height for a sheet of this width.
pub fn height(entries: &[Entry], width: f64) -> f64 {
    if entries.is_empty() { 0.0 } else { rows(entries, width).len() as f64 * ROW + 6.0 }
}

/// Draw it, centred, from `top` downwards.
pub fn draw(sheet: &mut Drawing, entries: &[Entry], left: f64, width: f64, top: f64) {
    for (i, row) in rows(entries, width).into_iter().enumerate() {
        let whole: f64 = row.iter().map(|e| entry_width(e)).sum::<f64>() - GAP;
        let mut x = left + (0.5 * (width - whole)).max(0.0);
        let y = top + ROW * (i as f64 + 0.75);
        for entry in row {
            let middle = y - 4.0;
            sheet.lines(vec![vec![[x, middle], [x + SAMPLE - 6.0, middle]]], entry.color, 2.2, entry.dash, "key");
            sheet.text(&entry.name, [x + SAMPLE, y], SIZE, Anchor::Start, Color::INK);
            x += entry_width(entry);
        }
    }
}

fn rows(entries: &[Entry], width: f64) -> Vec<Vec<&Entry>> {
    let mut rows: Vec<Vec<&Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        let needs = entry_width(entry);
        if used + needs - GAP > width {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += needs;
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

fn entry_width(entry: &Entry) -> f64 {
    SAMPLE + text_width(&entry.name, SIZE) + GAP
}

/// The width of a plain text in points.
pub fn text_width(text: &str, size: f64) -> f64 {
    let (anchor, color) = (Anchor::Start, Color::INK);
    font::width(&Text { text: text.into(), at: [0.0; 2], size, anchor, color, is_bold: false, is_upright: false })
}

/// A text cut to a width, with an ellipsis where something is left out.
pub fn fitted(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_string();
    }
    let mut short: String = text.to_string();
    while !short.is_empty() && text_width(&format!("{short}\u{2026}"), size) > width {
        short.pop();
    }
    format!("{short}\u{2026}")
}
