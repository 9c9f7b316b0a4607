//! Curves over a horizontal axis.

use crate::color::{Color, Dash};
use crate::drawing::{Anchor, Drawing, thinned};
use crate::legend::{self, Entry};
use crate::scale::Axis;

/// One curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its points, from left to right; what is no number leaves a gap.
    pub points: Vec<[f64; 2]>,
    /// Its colour.
    pub color: Color,
    /// Its dashes.
    pub dash: Dash,
}

/// A place on the horizontal axis that means something.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Where.
    pub x: f64,
    /// What it is.
    pub label: String,
    /// Its colour.
    pub color: Color,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Above it.
    pub title: String,
    /// Horizontal.
    pub x: Axis,
    /// Vertical.
    pub y: Axis,
    /// From below to above.
    pub curves: Vec<Curve>,
    /// Vertical lines.
    pub marks: Vec<Mark>,
    /// Below it.
    pub legend: Vec<Entry>,
    /// Both axes are equally long.
    pub is_square: bool,
}

/// Sizes of texts, in points.
pub(crate) const TITLE: f64 = 15.0;
pub(crate) const LABEL: f64 = 12.5;
pub(crate) const NUMBER: f64 = 11.0;

impl Chart {
    /// On a sheet of this size in points.
    pub fn draw(&self, width: f64, height: f64) -> Drawing {
        let mut sheet = Drawing::new(width, height);
        let y_ticks = self.y.ticks();
        let numbers = y_ticks.iter().map(|t| legend::text_width(&t.1, NUMBER)).fold(0.0, f64::max);
        let (left, right) = (40.0 + numbers, 24.0);
        let top =
            16.0 + if self.title.is_empty() { 0.0 } else { 26.0 } + if self.marks.is_empty() { 0.0 } else { 14.0 };
        let legend_height = legend::height(&self.legend, width - 40.0);
        let (mut w, mut h) = (width - left - right, height - top - 54.0 - legend_height);
        if self.is_square {
            (w, h) = (w.min(h), w.min(h));
        }
        let left = left + 0.5 * (width - left - right - w);
        let place = |p: [f64; 2]| [left + w * self.x.place(p[0]), top + h * (1.0 - self.y.place(p[1]))];
        if !self.title.is_empty() {
            sheet.heading(legend::fitted(&self.title, TITLE, width - 30.0), [0.5 * width, 28.0], TITLE);
        }

        // The grid and its numbers.
        let mut grid = Vec::new();
        for (x, text) in self.x.ticks() {
            let at = place([x, self.y.range.0]);
            grid.push(vec![[at[0], top], [at[0], top + h]]);
            sheet.text(text, [at[0], top + h + 17.0], NUMBER, Anchor::Middle, Color::GREY);
        }
        for (y, text) in y_ticks {
            let at = place([self.x.range.0, y]);
            grid.push(vec![[left, at[1]], [left + w, at[1]]]);
            sheet.text(text, [left - 8.0, at[1] + 4.0], NUMBER, Anchor::End, Color::GREY);
        }
        sheet.lines(grid, Color::GRID, 0.8, Dash::Solid, "grid");
        sheet.line(vec![[left, top], [left, top + h], [left + w, top + h]], Color::GREY, 1.0, "axis");
        sheet.text(&self.x.label, [left + 0.5 * w, top + h + 39.0], LABEL, Anchor::Middle, Color::INK);
        sheet.upright(&self.y.label, [left - numbers - 20.0, top + 0.5 * h], LABEL, Color::INK);

        // What is shown.
        for mark in &self.marks {
            let x = place([mark.x, self.y.range.0])[0];
            sheet.lines(vec![vec![[x, top], [x, top + h]]], mark.color.faint(0.7), 1.0, Dash::Dotted, "mark");
            sheet.text(&mark.label, [x, top - 5.0], NUMBER, Anchor::Middle, mark.color);
        }
        for curve in &self.curves {
            let drawn = |run: Vec<[f64; 2]>| thinned(&run.into_iter().map(place).collect::<Vec<_>>(), 0.04);
            let lines = self.within(&curve.points).into_iter().map(drawn).collect();
            sheet.lines(lines, curve.color, 2.0, curve.dash, "curve");
        }
        legend::draw(&mut sheet, &self.legend, 20.0, width - 40.0, height - legend_height);
        sheet
    }

    /// The runs of points that lie within both axes, cut where a line between two points leaves them.
    fn within(&self, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut runs: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
        for pair in points.windows(2) {
            let Some((a, b)) = self.cut(pair[0], pair[1]) else {
                runs.push(Vec::new());
                continue;
            };
            if let Some(run) = runs.last_mut() {
                if run.last() != Some(&a) {
                    let old = std::mem::take(run);
                    *run = vec![a, b];
                    if old.len() > 1 {
                        let at = runs.len() - 1;
                        runs.insert(at, old);
                    }
                } else {
                    run.push(b);
                }
            }
        }
        runs.retain(|r| r.len() > 1);
        runs
    }

    /// The part of a line between two points that can be seen, its ends in values.
    fn cut(&self, a: [f64; 2], b: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        if !(a[0] + a[1] + b[0] + b[1]).is_finite() {
            return None;
        }
        let (low, high) = self.y.range;
        let (pa, pb) = (self.y.place(a[1]), self.y.place(b[1]));
        if (pa < 0.0 && pb < 0.0) || (pa > 1.0 && pb > 1.0) {
            return None;
        }
        let end = |p: f64, at: [f64; 2], other: [f64; 2], other_p: f64| {
            let limit = p.clamp(0.0, 1.0);
            if limit == p {
                return at;
            }
            let t = (limit - p) / (other_p - p);
            [at[0] + t * (other[0] - at[0]), if limit == 0.0 { low } else { high }]
        };
        Some((end(pa, a, b, pb), end(pb, b, a, pa)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        Chart {
            title: String::new(),
            x: Axis::linear("x", (0.0, 4.0)),
            y: Axis::linear("y", (0.0, 1.0)),
            curves: Vec::new(),
            marks: Vec::new(),
            legend: Vec::new(),
            is_square: false,
        }
    }

    #[test]
    fn a_curve_is_cut_where_it_leaves_the_axes() {
        let runs = chart().within(&[[0.0, 0.5], [1.0, 1.5], [2.0, 0.5], [3.0, f64::NAN], [4.0, 0.0]]);
        assert_eq!(runs, [vec![[0.0, 0.5], [0.5, 1.0]], vec![[1.5, 1.0], [2.0, 0.5]]]);
    }

    #[test]
    fn a_curve_inside_stays_whole() {
        let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.25], [4.0, 0.5]];
        assert_eq!(chart().within(&points), [points.to_vec()]);
    }
}
