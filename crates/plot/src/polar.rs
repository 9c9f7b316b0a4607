//! Curves around a point: how far a value reaches in each direction of a plane, upwards at 0 degrees, clockwise to the right.

use crate::chart::{LABEL, NUMBER, TITLE};
use crate::color::{Color, Dash};
use crate::drawing::{Anchor, Drawing, Item, Path, thinned};
use crate::legend::{self, Entry};
use crate::scale::Axis;
use kirkas_geometry::elementary::{cos, sin};

/// A curve: angles in degrees, and values.
#[derive(Clone, Debug)]
pub struct Around {
    /// Angle and value.
    pub points: Vec<[f64; 2]>,
    /// Its colour.
    pub color: Color,
    /// Its dashes.
    pub dash: Dash,
    /// The area it encloses is tinted.
    pub is_filled: bool,
}

/// A direction that means something.
#[derive(Clone, Debug)]
pub struct Ray {
    /// In degrees.
    pub angle: f64,
    /// What it is.
    pub label: String,
    /// Its colour.
    pub color: Color,
    /// It points to the middle.
    pub arrives: bool,
}

/// A polar chart.
#[derive(Clone, Debug)]
pub struct Polar {
    /// Above it.
    pub title: String,
    /// From the middle outwards.
    pub radius: Axis,
    /// Below the horizon, too.
    pub is_whole: bool,
    /// From below to above.
    pub curves: Vec<Around>,
    /// Directions.
    pub rays: Vec<Ray>,
    /// Below it.
    pub legend: Vec<Entry>,
}

impl Polar {
    /// On a sheet of this size in points.
    pub fn draw(&self, width: f64, height: f64) -> Drawing {
        let mut sheet = Drawing::new(width, height);
        let legend_height = legend::height(&self.legend, width - 40.0);
        let top = 34.0 + if self.title.is_empty() { 0.0 } else { 26.0 };
        let below = 46.0 + legend_height;
        let free = height - top - below;
        let r = (0.5 * width - 44.0).min(if self.is_whole { 0.5 * free } else { free });
        let middle = [0.5 * width, top + r + 0.5 * (free - if self.is_whole { 2.0 * r } else { r }).max(0.0)];
        let at = |degrees: f64, part: f64| {
            let angle = degrees.to_radians();
            [middle[0] + r * part * sin(angle), middle[1] - r * part * cos(angle)]
        };
        if !self.title.is_empty() {
            sheet.heading(legend::fitted(&self.title, TITLE, width - 30.0), [0.5 * width, 28.0], TITLE);
        }

        // The grid: circles at round values, spokes every 15 degrees.
        let ends: (i32, i32) = if self.is_whole { (-180, 180) } else { (-90, 90) };
        let arc = |part: f64| (ends.0..=ends.1).step_by(2).map(|d| at(f64::from(d), part)).collect::<Vec<_>>();
        let circles: Vec<(f64, String)> =
            self.radius.ticks().into_iter().map(|(v, t)| (self.radius.place(v), t)).filter(|c| c.0 > 1e-6).collect();
        let mut grid: Vec<Vec<[f64; 2]>> = circles.iter().map(|c| arc(c.0)).collect();
        grid.push(arc(1.0));
        let spokes = (ends.0..=ends.1).step_by(15);
        grid.extend(spokes.clone().map(|d| vec![middle, at(f64::from(d), 1.0)]));
        sheet.lines(grid, Color::GRID, 0.8, Dash::Solid, "grid");
        sheet.line(vec![at(-90.0, 1.0), at(90.0, 1.0)], Color::GREY, 1.0, "axis");
        for d in spokes.filter(|d| d % 30 == 0 && *d != -180) {
            let [x, y] = at(f64::from(d), 1.0 + 14.0 / r);
            sheet.text(format!("{}°", d.abs()), [x, y + 4.0], NUMBER, Anchor::Middle, Color::GREY);
        }
        let every = circles.len().div_ceil(5).max(1);
        for (part, text) in circles.iter().rev().step_by(every) {
            let [x, y] = at(90.0, *part);
            sheet.text(text, [x, y + if self.is_whole { -4.0 } else { 14.0 }], NUMBER, Anchor::Middle, Color::GREY);
        }
        let label_y = if self.is_whole { middle[1] + r + 34.0 } else { middle[1] + 34.0 };
        sheet.text(&self.radius.label, [0.5 * width, label_y], LABEL, Anchor::Middle, Color::INK);

        // Directions, then curves.
        for ray in &self.rays {
            let (outer, inner) = (at(ray.angle, 1.0), at(ray.angle, 0.0));
            sheet.lines(vec![vec![outer, inner]], ray.color.faint(0.75), 1.1, Dash::Dotted, "ray");
            // The head: 9 points long, 3 to either side.
            let (tip, back) = if ray.arrives { (0.90, 0.90 + 9.0 / r) } else { (0.98, 0.98 - 9.0 / r) };
            let aside = (3.0 / (r * back)).to_degrees();
            let head = vec![at(ray.angle - aside, back), at(ray.angle, tip), at(ray.angle + aside, back)];
            sheet.line(head, ray.color, 1.3, "ray");
            if !ray.label.is_empty() {
                let [x, y] = at(ray.angle, 1.0 + 27.0 / r);
                sheet.text(&ray.label, [x, y + 4.0], NUMBER, Anchor::Middle, ray.color);
            }
        }
        for curve in &self.curves {
            let place = |p: &[f64; 2]| at(p[0], self.radius.place(p[1]).clamp(0.0, 1.0));
            let points: Vec<[f64; 2]> = curve.points.iter().filter(|p| p[1].is_finite()).map(place).collect();
            let points = thinned(&points, 0.04);
            if curve.is_filled {
                sheet.items.push(Item::Path(Path {
                    lines: vec![points.clone()],
                    is_closed: true,
                    fill: Some(curve.color.faint(0.10)),
                    stroke: None,
                    class: "lobe",
                }));
            }
            sheet.lines(vec![points], curve.color, 2.0, curve.dash, "curve");
        }
        legend::draw(&mut sheet, &self.legend, 20.0, width - 40.0, height - legend_height);
        sheet
    }
}
