//! # henyey_greenstein
//!
//! One lobe, forward or back, told by the mean cosine `g` of the angle of scattering alone:
//! `p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2))`. Fog, smoke, skin, dust between the stars.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `g` | number, -0.999..0.999 | | 0 | mean cosine: 0 evenly, towards 1 forward, towards -1 back |
//!
//! ## Example
//!
//! ```toml
//! [phases.haze]
//! type = "henyey_greenstein"
//! g = 0.8
//! ```
//!
//! ## Limits
//!
//! No bow, no glory, no corona: for drops of water see `droplet`.
//!
//! ## References
//!
//! L. G. Henyey & J. L. Greenstein, "Diffuse Radiation in the Galaxy", ApJ 93, 1941, equation 2.

use super::{Scatter, Turn};
use crate::{Lanes, Light, Palette};
use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_scene::{Kind, ParamSpec, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Phase,
    name: "henyey_greenstein",
    doc: "One lobe, forward or back.",
    params: &[ParamSpec::number("g", 0.0, "Mean cosine of the angle of scattering: 0 evenly, towards 1 forward.")
        .range((-0.999, 0.999))],
};

/// Its parameters.
#[derive(Clone, Debug)]
pub struct HenyeyGreenstein {
    g: f32,
}

impl Scatter for HenyeyGreenstein {
    fn prepare(params: &Params, _: &Palette) -> Self {
        HenyeyGreenstein { g: params.f32("g") }
    }

    fn value(&self, lanes: &Lanes, wo: Vec3, wi: Vec3) -> Light {
        let g = self.g;
        // 2 (1 - cos) or 2 (1 + cos), from the pole of the lobe, so that a narrow lobe keeps its digits:
        // 1 + g^2 - 2 g cos = (1 - |g|)^2 + |g| chord^2.
        let chord2 = if g > 0.0 { (wo + wi).length_squared() } else { (wo - wi).length_squared() };
        let base = (1.0 - g.abs()) * (1.0 - g.abs()) + g.abs() * chord2;
        lanes.one() * (0.25 / PI * (1.0 - g * g) / (base * base.sqrt()))
    }

    fn turn(&self, _: &Lanes, _: usize, u: f32) -> Turn {
        // Solve for h = (1 - cos) / 2 measured from the pole of the lobe: with a = |g|, s = (1 - a^2) / (1 + a - 2 a u),
        // 4 a h = s^2 - (1 - a)^2, written without the difference of near equals; a = 0 is the even case.
        let a = self.g.abs();
        let d = 1.0 + a - 2.0 * a * u;
        let h = u * (1.0 - a) * (1.0 - a) * (1.0 + a - a * u) / (d * d);
        let cos = 1.0 - 2.0 * h;
        let sin = 2.0 * (h * (1.0 - h)).max(0.0).sqrt();
        Turn { cos: if self.g > 0.0 { cos } else { -cos }, sin }
    }
}
