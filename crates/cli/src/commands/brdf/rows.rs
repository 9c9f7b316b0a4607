//! A row of lit spheres.

use super::material::Matter;
use super::plot::Plot;
use super::studio::{framed, spheres};
use crate::problem::Problem;
use kirkas_plot::{Anchor, Color, Drawing, legend};

/// Points from one sphere to the next.
const GAP: f64 = 8.0;
/// Spheres in a row.
const MOST: usize = 8;

/// One for each material.
pub fn draw(args: &Plot, materials: &[Matter]) -> Result<Drawing, Problem> {
    let columns = materials.len().min(MOST);
    let rows = materials.len().div_ceil(MOST);
    let (width, _) = args.size_or((146.0 * columns as f64).clamp(300.0, 1168.0), 0.0);
    let side = (width - GAP) / columns as f64 - GAP;
    let head = if args.title.is_some() { 44.0 } else { 10.0 };
    let row = side + 26.0;
    let mut sheet = Drawing::new(width, head + row * rows as f64 + 4.0);
    if let Some(title) = &args.title {
        sheet.heading(legend::fitted(title, 16.0, width - 30.0), [0.5 * width, 28.0], 16.0);
    }
    for (i, (image, matter)) in spheres(materials, side, &args.studio)?.iter().zip(materials).enumerate() {
        let (x, y) = (GAP + (i % MOST) as f64 * (side + GAP), head + (i / MOST) as f64 * row);
        sheet.picture(framed(image, [x, y, side, side]));
        let name = legend::fitted(&matter.label, 11.5, side);
        sheet.text(name, [x + 0.5 * side, y + side + 16.0], 11.5, Anchor::Middle, Color::INK);
    }
    Ok(sheet)
}
