//! # checker: two colours in squares
//!
//! Squares on the surface (`mapping = "uv"`), or cubes in space that the object is carved from (`"solid"`).
//!
//! ## Parameters
//!
//! - `a`, `b` (colour or texture, default white and black): the two; `a` fills the square that starts at the origin.
//! - `mapping` (`uv`, `solid`, `planar`, `spherical`, `cylindrical`, `box`, `triplanar`; default `uv`): squares of the texture
//!   coordinates, cubes in space, or squares projected as an `image` is.
//! - `scale` (number, squares per unit, default 1): how many squares, or cubes, go into one unit.
//! - and those of all textures: `transform`, `space`.
//!
//! ## Example
//!
//! ```toml
//! [textures.floor]
//! type = "checker"
//! a = [0.8, 0.8, 0.8]
//! b = "#203040"
//! mapping = "solid"
//! scale = 2
//! ```
//!
//! ## Limits
//!
//! Where a sample covers parts of several squares it sees their mean, each edge under a tent as wide as two samples. `a` and `b`, if
//! they are textures, are then looked up at the same place. A surface that lies exactly in a plane between
//! cubes shows rounding errors; shift the pattern a little with `transform`.
//!
//! ## References
//!
//! As in MIT 6.837 (2004), assignment 6: `floor(x) + floor(y) + floor(z)` even is `a`, odd is `b`. Filtered as a product of
//! square waves, each by its own second integral (Heckbert 1986, "Filtering by Repeated Integration").

use super::taps::Taps;
use super::{ColorSource, PatternPoint, TextureInput, Textures, mapping};
use kirkas_geometry::elementary::floor;
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Texture,
    name: "checker",
    doc: "Two colours in squares or cubes.",
    params: &[
        ParamSpec::reflectance("a", [1.0; 3], "the square that starts at the origin"),
        ParamSpec::reflectance("b", [0.0; 3], "its neighbours"),
        mapping::FLAT_FIRST,
        ParamSpec::number("scale", 1.0, "how many squares go into one unit").unit("squares per unit").range(POSITIVE),
    ],
};

#[derive(Clone, Debug)]
pub(super) struct Checker {
    sources: [ColorSource; 2],
    is_solid: bool,
    scale: f64,
}

/// The most places along the ellipse of a sample.
const MOST_TAPS: u32 = 8;

impl Checker {
    pub(super) fn compile(input: &TextureInput) -> Self {
        Checker {
            sources: input.a_and_b(),
            is_solid: input.params.text("mapping") == Some("solid"),
            scale: input.params.number("scale"),
        }
    }

    pub(super) fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        let weight_of_a = if self.is_solid {
            let axes = at.axes.map(|axis| (axis * self.scale).to_array());
            weight_of_a((at.position * self.scale).to_array(), axes)
        } else {
            weight_of_a(at.uv.map(|x| x * self.scale), at.uv_axes.map(|axis| axis.map(|x| x * self.scale)))
        };
        if weight_of_a == 1.0 || weight_of_a == 0.0 {
            return textures.lookup(self.sources[usize::from(weight_of_a == 0.0)], at.original);
        }
        textures.mix(self.sources, weight_of_a, at.original)
    }
}

/// How much of what the ellipse covers is even.
fn weight_of_a<const N: usize>(place: [f64; N], axes: [[f64; N]; 2]) -> f64 {
    // All in one square, also under the tents: what is nearest.
    let taps = Taps::along(axes, MOST_TAPS);
    let is_inside = |i: usize| {
        let (within, reach) = (place[i] - floor(place[i]), taps.reach(i));
        within >= reach && 1.0 - within >= reach
    };
    if (0..N).all(is_inside) {
        let sum: f64 = place.iter().map(|x| floor(*x)).sum();
        return if sum.rem_euclid(2.0) == 1.0 { 0.0 } else { 1.0 };
    }
    // Nothing left of the waves.
    if (0..N).map(|i| (0.5 / (taps.width(i) * taps.width(i))).min(1.0)).product::<f64>() < 1e-4 {
        return 0.5;
    }
    let product =
        |place: [f64; N], width: [f64; N]| -> f64 { (0..N).map(|i| filtered_wave(place[i], width[i])).product() };
    0.5 + 0.5 * taps.mean(place, product)
}

/// The square wave that is 1 from 0 to 1 and -1 from 1 to 2, under a tent of full width `2 width`.
fn filtered_wave(x: f64, width: f64) -> f64 {
    let x = x - 2.0 * floor(x * 0.5);
    if width < 1e-6 {
        return if x < 1.0 { 1.0 } else { -1.0 };
    }
    (second_integral(x + width) - 2.0 * second_integral(x) + second_integral(x - width)) / (width * width)
}

/// Of the square wave, without the part that grows evenly: two parabolas per period.
fn second_integral(x: f64) -> f64 {
    let x = x - 2.0 * floor(x * 0.5);
    let half = |x: f64| 0.5 * x * (x - 1.0);
    if x < 1.0 { half(x) } else { -half(x - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filtered_wave_is_its_mean_under_a_tent() {
        for (x, width) in [(0.3, 0.2), (0.95, 0.3), (1.5, 0.9), (-0.7, 1.4), (0.1, 3.3)] {
            let n = 20_000;
            let (mut sum, mut weights) = (0.0, 0.0);
            for i in 0..n {
                let t = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                let weight = 1.0 - t.abs();
                sum += weight * if (x + t * width).rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
                weights += weight;
            }
            let truth = sum / weights;
            assert!((filtered_wave(x, width) - truth).abs() < 1e-3, "{x} {width}: {} {truth}", filtered_wave(x, width));
        }
    }

    #[test]
    fn a_wide_view_of_a_checker_is_half_and_half() {
        let weight = weight_of_a([0.3, 0.4], [[40.3, 5.2], [-0.7, 6.1]]);
        assert!((weight - 0.5).abs() < 0.01, "{weight}");
        assert_eq!(weight_of_a([0.5, 0.5], [[0.1, 0.0], [0.0, 0.1]]), 1.0);
        assert_eq!(weight_of_a([1.5, 0.5], [[0.0; 2]; 2]), 0.0);
        assert_eq!(weight_of_a([1.0, 0.0], [[0.0; 2]; 2]), 0.0);
    }
}
