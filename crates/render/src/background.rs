//! Backgrounds: what rays see that hit nothing. They are seen by camera, mirror and refraction rays; `whitted` does not
//! light surfaces with them.

use kirkas_geometry::Vec3;
use kirkas_optics::{Lanes, Light};
use kirkas_scene::params::read_color;
use kirkas_scene::{Fallback, Kind, Node, ParamSpec, ParamType, Params, TypeSpec};

/// Every background type.
pub const BACKGROUNDS: &[&TypeSpec] = &[&CONSTANT, &GRADIENT];

/// One colour everywhere.
pub const CONSTANT: TypeSpec = TypeSpec {
    kind: Kind::Background,
    name: "constant",
    doc: "The same radiance in all directions.",
    params: &[ParamSpec::color("color", [0.0, 0.0, 0.0], "Radiance.")],
};

/// By elevation.
pub const GRADIENT: TypeSpec = TypeSpec {
    kind: Kind::Background,
    name: "gradient",
    doc: "Radiance by elevation, as a simple sky.",
    params: &[
        ParamSpec::new(
            "stops",
            ParamType::Gradient,
            Fallback::Required,
            "[[s, colour], ...] with s the sine of the elevation, rising from -1 (down) to 1 (up).",
        ),
        ParamSpec::vector("up", [0.0, 1.0, 0.0], "Which way is up."),
    ],
};

/// A compiled background.
#[derive(Clone, Debug)]
pub enum Background {
    /// One radiance.
    Constant(Light),
    /// Stops by sine of elevation.
    Gradient {
        /// Up.
        up: Vec3,
        /// Rising.
        stops: Vec<(f32, Light)>,
    },
}

impl Background {
    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        let light = |c: [f64; 3]| Lanes::RGB.illuminant(c.map(|x| x as f32));
        if p.spec().name == "constant" {
            return Background::Constant(light(p.color("color")));
        }
        let stop = |n: &Node| {
            let l = n.list()?;
            Some((l.first()?.number()? as f32, light(read_color(&l.get(1)?.value)?)))
        };
        let stops =
            p.entity.params.get("stops").and_then(|n| n.list()).unwrap_or(&[]).iter().filter_map(stop).collect();
        let up = p.vector("up");
        let up = Vec3::new(up[0] as f32, up[1] as f32, up[2] as f32).normalize_or(Vec3::Y);
        Background::Gradient { up, stops }
    }

    /// True when it sends nothing from anywhere.
    pub fn is_black(&self) -> bool {
        match self {
            Background::Constant(l) => l.is_black(),
            Background::Gradient { stops, .. } => stops.iter().all(|s| s.1.is_black()),
        }
    }

    /// Radiance from `direction` (any length).
    pub fn radiance(&self, direction: Vec3) -> Light {
        match self {
            Background::Constant(l) => *l,
            Background::Gradient { up, stops } => {
                let s = direction.normalize_or_zero().dot(*up);
                let next = stops.partition_point(|x| x.0 <= s);
                match (next.checked_sub(1).and_then(|i| stops.get(i)), stops.get(next)) {
                    (Some(a), Some(b)) => {
                        let w = (s - a.0) / (b.0 - a.0);
                        a.1 * (1.0 - w) + b.1 * w
                    }
                    (Some(only), None) | (None, Some(only)) => only.1,
                    (None, None) => Light::BLACK,
                }
            }
        }
    }
}
