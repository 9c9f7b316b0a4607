//! # gradient: a ramp of colours
//!
//! Colours that run into each other along a coordinate, or outward from the origin.
//!
//! ## Parameters
//!
//! - `stops` (list of `[position, colour]`, rising; default black at 0, white at 1): the ramp; before the first and behind the
//!   last it stays as it is, unless `repeat` says otherwise.
//! - `along` (`u`, `v`, `w`, `radial`, `angle`; default `u`): the coordinate: one of the pattern's own three (with
//!   `mapping = "solid"` those are x, y and z); the distance from the origin; or the part of a turn about it, in the plane of the
//!   first two.
//! - `repeat` (`clamp`, `repeat`, `mirror`; default `clamp`): what lies beyond positions 0 and 1.
//! - `mapping` (`uv`, `solid` and the projections of `image`; default `uv`).
//! - and those of all textures: `transform`, `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.dusk]
//! type = "gradient"
//! along = "v"
//! stops = [[0.0, [0.9, 0.4, 0.1]], [0.4, [0.5, 0.1, 0.3]], [1.0, [0.02, 0.02, 0.1]]]
//! ```
//!
//! ## Limits
//!
//! Colours mix in linear light. What a sample covers is taken as a length along the coordinate and averaged exactly, but for `angle`
//! near the origin and where it comes around.
//!
//! ## References
//!
//! The mean of a ramp is the difference of its integral: Crow 1984, "Summed-Area Tables for Texture Mapping", in one dimension.

use super::{PatternPoint, TextureInput, mapping, mean};
use core::f64::consts::TAU;
use kirkas_geometry::DVec3;
use kirkas_geometry::elementary::atan2;
use kirkas_scene::params::read_color;
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "gradient",
    doc: "A ramp of colours along a coordinate, or outward.",
    params: &[
        ParamSpec::new("stops", ParamType::Gradient, Fallback::Absent, "the ramp; absent: black at 0, white at 1")
            .range(NOT_NEGATIVE),
        ParamSpec::choice("along", &["u", "v", "w", "radial", "angle"], "the coordinate that the ramp follows"),
        ParamSpec::choice("repeat", &["clamp", "repeat", "mirror"], "what lies beyond positions 0 and 1"),
        mapping::FLAT_FIRST,
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Gradient {
    ramp: Ramp,
    along: Along,
    beyond: Beyond,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Along {
    Axis(usize),
    Radial,
    Angle,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Beyond {
    Clamp,
    Repeat,
    Mirror,
}

/// Colours by position, linear in between.
#[derive(Clone, Debug)]
struct Ramp {
    positions: Vec<f64>,
    colors: Vec<DVec3>,
    /// The integral up to each position.
    integrals: Vec<DVec3>,
}

impl Gradient {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Gradient {
            ramp: Ramp::compile(input),
            along: match input.params.text("along") {
                Some("v") => Along::Axis(1),
                Some("w") => Along::Axis(2),
                Some("radial") => Along::Radial,
                Some("angle") => Along::Angle,
                _ => Along::Axis(0),
            },
            beyond: match input.params.text("repeat") {
                Some("repeat") => Beyond::Repeat,
                Some("mirror") => Beyond::Mirror,
                _ => Beyond::Clamp,
            },
        }
    }

    pub(super) fn eval(&self, at: &PatternPoint) -> [f32; 4] {
        let (p, [a, b]) = (at.position, at.axes);
        let place = match self.along {
            Along::Axis(i) => p[i],
            Along::Radial => p.length(),
            Along::Angle => {
                let turn = atan2(p.y, p.x) / TAU;
                if turn < 0.0 { turn + 1.0 } else { turn }
            }
        };
        let step = |d: DVec3| match self.along {
            Along::Axis(i) => d[i].abs(),
            Along::Radial => d.dot(p).abs() / p.length(),
            Along::Angle => (p.x * d.y - p.y * d.x).abs() / ((p.x * p.x + p.y * p.y) * TAU),
        };
        let (a, b) = (step(a), step(b));
        // The two axes' widths add as those of independent filters.
        let width = (a * a + b * b).sqrt();
        let width = if width.is_finite() { width } else { 0.0 };
        let place = if place.is_finite() { place } else { 0.0 };
        let color = if width > 0.0 { self.mean(place - width, place + width) } else { self.at(place) };
        let [r, g, b] = color.as_vec3().to_array();
        [r, g, b, mean([r, g, b])]
    }

    fn at(&self, place: f64) -> DVec3 {
        let turn = place - place.floor();
        self.ramp.at(match self.beyond {
            Beyond::Clamp => place,
            Beyond::Repeat => turn,
            Beyond::Mirror if place.floor().rem_euclid(2.0) == 0.0 => turn,
            Beyond::Mirror => 1.0 - turn,
        })
    }

    fn mean(&self, from: f64, to: f64) -> DVec3 {
        (self.integral(to) - self.integral(from)) / (to - from)
    }

    /// Of the colour from 0 to `place`.
    fn integral(&self, place: f64) -> DVec3 {
        let (turns, turn) = (place.floor(), place - place.floor());
        let ramp = |x: f64| self.ramp.integral(x) - self.ramp.integral(0.0);
        match self.beyond {
            Beyond::Clamp => ramp(place),
            Beyond::Repeat => ramp(1.0) * turns + ramp(turn),
            Beyond::Mirror if turns.rem_euclid(2.0) == 0.0 => ramp(1.0) * turns + ramp(turn),
            Beyond::Mirror => ramp(1.0) * turns + (ramp(1.0) - ramp(1.0 - turn)),
        }
    }
}

impl Ramp {
    fn compile(input: &TextureInput) -> Self {
        let list = input.params.entity.params.get("stops").and_then(|n| n.list()).unwrap_or_default();
        let stop = |node: &kirkas_scene::Node| {
            let [position, color] = node.list()? else { return None };
            Some((position.number()?, DVec3::from_array(read_color(&color.value)?)))
        };
        let mut stops: Vec<(f64, DVec3)> = list.iter().filter_map(stop).collect();
        if stops.is_empty() {
            stops = vec![(0.0, DVec3::ZERO), (1.0, DVec3::ONE)];
        }
        let (positions, colors): (Vec<f64>, Vec<DVec3>) = stops.into_iter().unzip();
        let mut integrals = vec![DVec3::ZERO];
        for i in 1..positions.len() {
            let piece = (colors[i] + colors[i - 1]) * (0.5 * (positions[i] - positions[i - 1]));
            integrals.push(integrals[i - 1] + piece);
        }
        Ramp { positions, colors, integrals }
    }

    fn at(&self, x: f64) -> DVec3 {
        let next = self.positions.partition_point(|&p| p <= x);
        let last = self.positions.len() - 1;
        match next {
            0 => self.colors[0],
            n if n > last => self.colors[last],
            n => {
                let t = (x - self.positions[n - 1]) / (self.positions[n] - self.positions[n - 1]);
                self.colors[n - 1].lerp(self.colors[n], t)
            }
        }
    }

    /// From the first position to `x`.
    fn integral(&self, x: f64) -> DVec3 {
        let next = self.positions.partition_point(|&p| p <= x);
        let last = self.positions.len() - 1;
        match next {
            0 => self.colors[0] * (x - self.positions[0]),
            n if n > last => self.integrals[last] + self.colors[last] * (x - self.positions[last]),
            n => {
                let color = self.at(x);
                self.integrals[n - 1] + (self.colors[n - 1] + color) * (0.5 * (x - self.positions[n - 1]))
            }
        }
    }
}
