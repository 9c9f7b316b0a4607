//! # brick: a wall
//!
//! Rows of bricks in mortar, every row shifted against the one below.
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default brick red and grey): the bricks, and the mortar.
//! - `size` (two numbers, default `[0.25, 0.125]`): width and height of a brick with its share of mortar, in units of the pattern.
//! - `mortar` (number, default 0.015): width of the joints, likewise.
//! - `offset` (number, 0 to 1, default 0.5): by which part of a brick each row is shifted.
//! - `mapping` (`uv`, `solid` and the projections of `image`; default `uv`): `solid` builds a wall in x and y, as thick as you like.
//! - and those of all textures: `transform`, `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.wall]
//! type = "brick"
//! size = [0.2, 0.07]
//! mortar = 0.01
//! mapping = "box"
//! ```
//!
//! ## Limits
//!
//! All bricks are alike; give `a` a `noise` to tell them apart. Where a sample covers parts of several bricks it sees their mean.
//!
//! ## References
//!
//! Gritz in Apodaca & Gritz 1999, "Advanced RenderMan", section 11 (box-filtered pulse trains); here row by row, as every row has
//! its own shift.

use super::taps::Taps;
use super::{ColorSource, PatternPoint, TextureInput, Textures, mapping};
use kirkas_scene::spec::{NOT_NEGATIVE, POSITIVE, UNIT};
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "brick",
    doc: "Bricks in mortar.",
    params: &[
        ParamSpec::reflectance("a", [0.42, 0.12, 0.07], "the bricks"),
        ParamSpec::reflectance("b", [0.55, 0.53, 0.5], "the mortar"),
        ParamSpec::new(
            "size",
            ParamType::Vector2,
            Fallback::Vector2([0.25, 0.125]),
            "width and height of a brick with its share of mortar",
        )
        .range(POSITIVE),
        ParamSpec::number("mortar", 0.015, "width of the joints").range(NOT_NEGATIVE),
        ParamSpec::number("offset", 0.5, "by which part of a brick each row is shifted").range(UNIT),
        mapping::FLAT_FIRST,
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Brick {
    sources: [ColorSource; 2],
    size: [f64; 2],
    /// The part of a brick's width and height that the joint takes.
    joints: [f64; 2],
    offset: f64,
}

/// The most places along the ellipse of a sample.
const MOST_TAPS: u32 = 8;
/// Rows that a sample covers at most before only their mean is seen.
const MOST_ROWS: f64 = 6.0;

impl Brick {
    pub(super) fn compile(input: &TextureInput) -> Self {
        let (size, mortar) = (input.params.vector2("size"), input.params.number("mortar"));
        Brick {
            sources: input.a_and_b(),
            size,
            joints: size.map(|s| (mortar / s).min(1.0)),
            offset: input.params.number("offset"),
        }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        let place = [at.position.x / self.size[0], at.position.y / self.size[1]];
        let axes = at.axes.map(|axis| [axis.x / self.size[0], axis.y / self.size[1]]);
        let weight_of_a = Taps::along(axes, MOST_TAPS).mean(place, |place, width| self.coverage(place, width));
        textures.mix(self.sources, if weight_of_a.is_finite() { weight_of_a } else { 0.5 }, at.original)
    }

    /// How much of a box, in bricks, is brick. A filter `width` wide to either side is as wide as a box of 1.5 times that in all.
    fn coverage(&self, [x, y]: [f64; 2], width: [f64; 2]) -> f64 {
        let [wide, high] = width.map(|w| 1.5 * w);
        let (low, top) = (y - 0.5 * high, y + 0.5 * high);
        let in_row = |row: f64| {
            let shift = x + self.offset * row;
            if wide > 1e-9 {
                covered(shift - 0.5 * wide, shift + 0.5 * wide, self.joints[0])
            } else {
                pulse(shift, self.joints[0])
            }
        };
        if high <= 1e-9 {
            return pulse(y, self.joints[1]) * in_row(y.floor());
        }
        if high > MOST_ROWS {
            return covered(low, top, self.joints[1]) * in_row(0.0).midpoint(in_row(1.0));
        }
        let (mut sum, mut row) = (0.0, low.floor());
        while row < top {
            let part = (top.min(row + 1.0) - low.max(row)).max(0.0);
            if part > 0.0 {
                sum += part * covered(low.max(row), top.min(row + 1.0), self.joints[1]) * in_row(row);
            }
            row += 1.0;
        }
        sum / high
    }
}

/// 1 on a brick, 0 in the joint, which is half at either end of the period.
fn pulse(x: f64, joint: f64) -> f64 {
    let within = x - x.floor();
    if within >= 0.5 * joint && within < 1.0 - 0.5 * joint { 1.0 } else { 0.0 }
}

/// The mean of [`pulse`] from `a` to `b`.
fn covered(a: f64, b: f64, joint: f64) -> f64 {
    let integral = |x: f64| x.floor() * (1.0 - joint) + (x - x.floor() - 0.5 * joint).clamp(0.0, 1.0 - joint);
    (integral(b) - integral(a)) / (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_seen_from_afar_is_as_red_as_its_share_of_bricks() {
        let wall = Brick {
            sources: [ColorSource::Constant([1.0; 3]), ColorSource::Constant([0.0; 3])],
            size: [1.0; 2],
            joints: [0.1, 0.2],
            offset: 0.5,
        };
        let whole = 0.9 * 0.8;
        for width in [4.0 / 3.0, 3.7, 40.1] {
            let seen = wall.coverage([0.3, 0.6], [width, width]);
            assert!((seen - whole).abs() < 0.1 / width, "{width}: {seen}");
        }
        assert_eq!(wall.coverage([0.5, 0.5], [0.0; 2]), 1.0);
        assert_eq!(wall.coverage([0.02, 0.5], [0.0; 2]), 0.0);
        // The next row is shifted by half a brick.
        assert_eq!(wall.coverage([0.02, 1.5], [0.0; 2]), 1.0);
        // Against the sum of many points.
        let (x, y, w, h) = (0.4, 0.9, 0.7, 0.9);
        let n = 400;
        let mut sum = 0.0;
        for i in 0..n * n {
            let (s, t) = ((f64::from(i % n) + 0.5) / f64::from(n), (f64::from(i / n) + 0.5) / f64::from(n));
            sum += wall.coverage([x + 1.5 * w * (s - 0.5), y + 1.5 * h * (t - 0.5)], [0.0; 2]);
        }
        let mean = sum / f64::from(n * n);
        let seen = wall.coverage([x, y], [w, h]);
        assert!((seen - mean).abs() < 2e-3, "{seen} {mean}");
    }
}
