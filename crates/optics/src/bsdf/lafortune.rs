//! # lafortune
//!
//! Any number of generalised cosine lobes over a diffuse base, as fits of measurements give them: each lobe can mirror, lean,
//! face back to the light or widen towards grazing. `f = k_d / pi + sum k_i (C_x v_x l_x + C_y v_y l_y + C_z v_z l_z)^n`, where
//! negative sums count nothing.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture, 0..1 | | 0.5 | diffuse colour k_d |
//! | `lobes` | numbers | | required | seven to a lobe: `C_x, C_y, C_z`, exponent `n` (0..10^6), and its colour k_i (red, green, blue, from 0), in 1/sr |
//!
//! ## Example
//!
//! ```toml
//! [materials.blue_paint]
//! type = "lafortune"
//! diffuse = [0.05, 0.1, 0.35]
//! lobes = [
//!   -0.86, -0.86, 0.90, 16, 0.3, 0.3, 0.3,
//!   0.71, 0.71, 0.69, 15, 0.05, 0.06, 0.1,
//! ]
//! ```
//!
//! ## Limits
//!
//! It conserves energy only as far as its numbers do: nothing here checks them. `C_x = C_y = -1, C_z = 1`, k = (n + 2) / (2 pi) is
//! `phong`'s normalised highlight. An incomplete last lobe is ignored.
//!
//! ## References
//!
//! E. P. F. Lafortune, S.-C. Foo, K. E. Torrance & D. P. Greenberg, "Non-Linear Approximation of Reflectance Functions", SIGGRAPH
//! 1997, equation 6.

use super::opaque::{Opaque, Reflector};
use super::phong::square_to_power_cosine;
use super::{Interface, Mode, Prepare, slot};
use crate::{Lanes, Light, Palette, Spectrum};
use core::f32::consts::PI;
use kirkas_geometry::elementary::pow_f32;
use kirkas_geometry::{Frame, Vec3};
use kirkas_scene::{Fallback, Kind, Node, ParamSpec, ParamType, Params, TypeSpec};
use std::sync::Arc;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "lafortune",
    doc: "Generalised cosine lobes over a diffuse base, as fits of measurements give them.",
    params: &[
        ParamSpec::reflectance("diffuse", [0.5; 3], "diffuse colour k_d"),
        ParamSpec::new(
            "lobes",
            ParamType::Numbers,
            Fallback::Required,
            "seven numbers to a lobe: Cx, Cy, Cz, exponent, red, green, blue",
        ),
    ],
};
const DIFFUSE: usize = slot(SPEC.params, "diffuse");

#[derive(Clone, Debug)]
struct Cosine {
    c: Vec3,
    n: f32,
    color: Spectrum,
    /// How strongly it is drawn.
    weight: f32,
}

/// The lobes.
#[derive(Clone, Debug)]
pub struct Prepared {
    lobes: Arc<[Cosine]>,
}

/// At a point.
pub type Lafortune = Opaque<Lobes>;

/// Lobes over a diffuser.
#[derive(Clone, Debug)]
pub struct Lobes {
    diffuse: Light,
    lobes: Arc<[Cosine]>,
    lanes: Lanes,
}

impl Prepare for Prepared {
    type At = Lafortune;
    fn prepare(params: &Params, palette: &Palette) -> Self {
        let written = params.entity.params.get("lobes").and_then(Node::list).unwrap_or(&[]);
        let numbers: Vec<f32> = written.iter().map(|n| n.number().unwrap_or(0.0) as f32).collect();
        let lobes = numbers.chunks_exact(7).map(|x| {
            let (c, n) = (Vec3::new(x[0], x[1], x[2]), x[3].clamp(0.0, 1e6));
            let rgb = [x[4], x[5], x[6]].map(|k| k.max(0.0));
            // The lobe's power where it points straight up, or mirrors at 45 degrees if that is more.
            let height = c.z.abs().max(0.5 * (c.x.abs().max(c.y.abs()) + c.z.abs()));
            let weight = rgb.iter().fold(0.0_f32, |a, b| a.max(*b)) * pow_f32(height, n) / (n + 2.0);
            Cosine { c, n, color: palette.unbounded(rgb), weight: weight.clamp(1e-12, 1e12) }
        });
        Prepared { lobes: lobes.collect() }
    }
    fn at(&self, lanes: &Lanes, slots: &[Light], _: Interface) -> Lafortune {
        Opaque(Lobes { diffuse: slots[DIFFUSE], lobes: self.lobes.clone(), lanes: *lanes })
    }
}

impl Cosine {
    /// Where the lobe of `wo` points, not normalised.
    fn axis(&self, wo: Vec3) -> Vec3 {
        self.c * wo
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let axis = self.axis(wo);
        let length = axis.length();
        if !(length > 0.0) {
            return 0.0;
        }
        let cos = (axis.dot(wi) / length).min(1.0);
        if cos > 0.0 { (self.n + 1.0) / (2.0 * PI) * pow_f32(cos, self.n) } else { 0.0 }
    }
}

impl Lobes {
    fn total(&self) -> f32 {
        self.lobes.iter().map(|l| l.weight).sum()
    }
}

impl Reflector for Lobes {
    fn parts(&self) -> (bool, bool) {
        (!self.diffuse.is_black(), !self.lobes.is_empty())
    }
    fn weights(&self, _: Vec3) -> (f32, f32) {
        (self.diffuse.max_component(), (2.0 * PI * self.total()).clamp(1e-3, 10.0))
    }
    fn base(&self, _: Vec3, _: Vec3) -> Light {
        self.diffuse / PI
    }
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        let mut f = Light::BLACK;
        for lobe in self.lobes.iter() {
            let sum = lobe.axis(wo).dot(wi);
            if sum > 0.0 {
                f += lobe.color.at(&self.lanes) * pow_f32(sum, lobe.n);
            }
        }
        f
    }
    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        // Pick a lobe with the first number, and use what is left of it.
        let mut left = u.0 * self.total();
        let mut last = Vec3::ZERO;
        for lobe in self.lobes.iter() {
            let axis = lobe.axis(wo);
            if left < lobe.weight && axis.length() > 0.0 {
                let u = ((left / lobe.weight).min(1.0 - f32::EPSILON), u.1);
                last = Frame::from_z(axis.normalize()).to_world(square_to_power_cosine(u, lobe.n));
                break;
            }
            left -= lobe.weight;
        }
        last
    }
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let mut pdf = 0.0;
        for lobe in self.lobes.iter() {
            pdf += lobe.weight * lobe.pdf(wo, wi);
        }
        pdf / self.total()
    }
    fn ambient(&self) -> Light {
        self.diffuse
    }
}
