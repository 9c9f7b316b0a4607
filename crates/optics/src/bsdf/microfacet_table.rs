//! # microfacet_table
//!
//! A "designer" surface: facets spread in any way one likes, by a formula or by a table, over a diffuse base. The shape of the
//! highlight is the distribution itself: rings, crosses, letters.
//! `f = k_d / pi + p(h) <n.h> F(v.h) / (4 g(v) g(l))`, where `g(k)` is how many facets face `k` and `<n.h>` how many face up.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `diffuse` | colour or texture, 0..1 | | 0 | diffuse colour k_d |
//! | `reflectance` | colour or texture, 0..1 | | 0.8 | what a facet reflects straight on |
//! | `fresnel` | `schlick`, `constant` | | `schlick` | rising from `reflectance` to 1 at grazing angles, or the same at every angle |
//! | `shape` | `gaussian`, `ring`, `grooves`, `cross`, `table` | | `gaussian` | how facets are spread |
//! | `spread` | number, 0.01..2 | rad | 0.2 | width of the formulas' bumps |
//! | `angle` | number, 0..1.57 | rad | 0.4 | tilt of the ring's, or of the grooves' two, bumps |
//! | `table` | numbers | | none | `shape = "table"`: facets per solid angle, at any scale; rows from the normal to 90 degrees, each of `columns` around |
//! | `columns` | whole number, 1..1024 | | 1 | numbers in a row, evenly around from the texture's u; 1 is the same all around |
//!
//! With delta the angle between h and the normal and phi its longitude, `gaussian` is `exp(-(delta / spread)^2)`, `ring`
//! `exp(-((delta - angle) / spread)^2)`, `grooves` two bumps tilted by `angle` to both sides along u, and `cross` a Gaussian of
//! `spread` times `cos^2(2 phi)`, four arms along u and v.
//!
//! ## Example
//!
//! ```toml
//! [materials.halo]
//! type = "microfacet_table"
//! reflectance = [0.9, 0.7, 0.3]
//! shape = "ring"
//! angle = 0.3
//! spread = 0.06
//! ```
//!
//! ## Limits
//!
//! Facets are resolved to about 1.3 degrees near the normal and 1.8 to the side, and 5.6 around it. Masking is that of facets whose
//! tilt says nothing of where they are; light that bounces among them is lost.
//!
//! ## References
//!
//! M. Ashikhmin, S. Premože & P. Shirley, "A Microfacet-Based BRDF Generator", SIGGRAPH 2000, equation 9.

use super::boundary::Fresnel;
use super::opaque::{Opaque, Reflector};
use super::{Interface, Mode, Prepare, slot};
use crate::fresnel::{reflect, schlick};
use crate::microfacet::tabulated::Tabulated;
use crate::{Lanes, Light, Palette};
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{acos, cos, exp, sin};
use kirkas_scene::{Fallback, Kind, Node, ParamSpec, ParamType, Params, TypeSpec};
use std::sync::Arc;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Material,
    name: "microfacet_table",
    doc: "Facets spread in any way, by formula or table: designed highlights.",
    params: &[
        ParamSpec::reflectance("diffuse", [0.0; 3], "diffuse colour k_d"),
        ParamSpec::reflectance("reflectance", [0.8; 3], "what a facet reflects straight on"),
        ParamSpec::choice(
            "fresnel",
            &["schlick", "constant"],
            "rising to 1 at grazing angles, or the same at every angle",
        ),
        ParamSpec::choice("shape", &["gaussian", "ring", "grooves", "cross", "table"], "how facets are spread"),
        ParamSpec::number("spread", 0.2, "width of the formulas' bumps").range((0.01, 2.0)).unit("rad"),
        ParamSpec::number("angle", 0.4, "tilt of the ring's or grooves' bumps").range((0.0, 1.57)).unit("rad"),
        ParamSpec::new(
            "table",
            ParamType::Numbers,
            Fallback::Absent,
            "facets per solid angle, from the normal to 90 degrees",
        ),
        ParamSpec::integer("columns", 1, (1.0, 1024.0), "numbers in each row of `table`, around the normal"),
    ],
};
const DIFFUSE: usize = slot(SPEC.params, "diffuse");
const REFLECTANCE: usize = slot(SPEC.params, "reflectance");

/// The facets; none if the table is empty.
#[derive(Clone, Debug)]
pub struct Prepared {
    facets: Option<Arc<Tabulated>>,
    fresnel: Fresnel,
}

/// At a point.
pub type MicrofacetTable = Opaque<Designed>;

/// Facets over a diffuser.
#[derive(Clone, Debug)]
pub struct Designed {
    diffuse: Light,
    reflectance: Light,
    fresnel: Fresnel,
    facets: Option<Arc<Tabulated>>,
}

/// The formulas.
fn formula(shape: &str, spread: f64, angle: f64) -> impl Fn(f64, f64) -> f64 {
    let bump = move |x: f64| exp(-(x / spread) * (x / spread));
    let is = |word| shape == word;
    let (ring, grooves, cross) = (is("ring"), is("grooves"), is("cross"));
    move |theta: f64, phi: f64| match (ring, grooves, cross) {
        (true, _, _) => bump(theta - angle),
        (_, true, _) => {
            // Angles from the two directions tilted along +u and -u.
            let aside = |sign: f64| {
                acos((cos(theta) * cos(angle) + sign * sin(theta) * cos(phi) * sin(angle)).clamp(-1.0, 1.0))
            };
            bump(aside(1.0)) + bump(aside(-1.0))
        }
        (_, _, true) => bump(theta) * cos(2.0 * phi) * cos(2.0 * phi),
        _ => bump(theta),
    }
}

/// A written table, linear between its entries.
fn written(numbers: &[f64], columns: usize) -> Option<Tabulated> {
    let rows = numbers.len() / columns;
    if rows == 0 {
        return None;
    }
    Tabulated::new(|theta, phi| {
        let y = theta / FRAC_PI_2 * (rows - 1) as f64;
        let (i, fy) = ((y as usize).min(rows.saturating_sub(2)), y);
        let x = phi / TAU * columns as f64;
        let (j, fx) = ((x as usize).min(columns - 1), x);
        let at = |i: usize, j: usize| numbers[i.min(rows - 1) * columns + j % columns];
        let along = |i: usize| at(i, j) + (at(i, j + 1) - at(i, j)) * (fx - j as f64);
        along(i) + (along(i + 1) - along(i)) * (fy - i as f64).clamp(0.0, 1.0)
    })
}

impl Prepare for Prepared {
    type At = MicrofacetTable;
    fn prepare(params: &Params, _: &Palette) -> Self {
        let numbers =
            |node: &Node| node.list().map(|l| l.iter().map(|n| n.number().unwrap_or(0.0)).collect::<Vec<f64>>());
        let facets = match params.text("shape") {
            Some("table") => {
                let list = params.entity.params.get("table").and_then(numbers).unwrap_or_default();
                written(&list, params.integer("columns").max(1) as usize)
            }
            shape => Tabulated::new(formula(shape.unwrap_or(""), params.number("spread"), params.number("angle"))),
        };
        let fresnel = if params.text("fresnel") == Some("constant") { Fresnel::Constant } else { Fresnel::Schlick };
        Prepared { facets: facets.map(Arc::new), fresnel }
    }
    fn at(&self, _: &Lanes, slots: &[Light], _: Interface) -> MicrofacetTable {
        Opaque(Designed {
            diffuse: slots[DIFFUSE],
            reflectance: slots[REFLECTANCE],
            fresnel: self.fresnel,
            facets: self.facets.clone(),
        })
    }
}

impl Reflector for Designed {
    fn parts(&self) -> (bool, bool) {
        (!self.diffuse.is_black(), !self.reflectance.is_black() && self.facets.is_some())
    }
    fn weights(&self, _: Vec3) -> (f32, f32) {
        (self.diffuse.max_component(), self.reflectance.max_component())
    }
    fn base(&self, _: Vec3, _: Vec3) -> Light {
        self.diffuse / PI as f32
    }
    fn highlight(&self, wo: Vec3, wi: Vec3, _: Mode) -> Light {
        let Some(facets) = &self.facets else { return Light::BLACK };
        let h = (wo + wi).normalize();
        let cos = wo.dot(h);
        let tint = match self.fresnel {
            Fresnel::Constant => self.reflectance,
            _ => self.reflectance.map(|r0| if r0 > 0.0 { schlick(r0, cos) } else { 0.0 }),
        };
        tint * (0.25 * facets.p(h) * facets.visibility(wo, wi))
    }
    fn sample_highlight(&self, wo: Vec3, u: (f32, f32)) -> Vec3 {
        self.facets.as_ref().map_or(Vec3::ZERO, |facets| reflect(wo, facets.sample(u)))
    }
    fn highlight_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        self.facets.as_ref().map_or(0.0, |facets| facets.pdf(h) / (4.0 * wo.dot(h)))
    }
    fn ambient(&self) -> Light {
        self.diffuse
    }
}
