//! From a place on a surface to the place in a pattern: by texture coordinates, by projection, or straight through space.
//!
//! All projections work in the space of the texture (`space`, then `transform` undone). `planar` looks along -z: u = x, v = y.
//! `spherical` runs u once around the y axis and v from the south pole to the north pole, as a `sphere` has them; `cylindrical` runs
//! u likewise and takes v = y. `box` looks along the axis that the surface faces most; `triplanar` looks along all three and
//! blends by the fourth powers of the normal's parts, so that no seam shows.
//!
//! Bier & Sloan 1986, "Two-Part Texture Mappings" (plane, cylinder, sphere, box).

use super::{Patch, PatternPoint, Placed, TexturePoint, Textures};
use core::f64::consts::{PI, TAU};
use kirkas_geometry::elementary::{acos, atan2};
use kirkas_geometry::{DVec3, Vec3};
use kirkas_scene::{ParamSpec, Params};

/// How a pattern finds its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mapping {
    Uv,
    Solid,
    Planar,
    Spherical,
    Cylindrical,
    Box,
    Triplanar,
}

const DOC: &str = "how the pattern lies on the surface: by texture coordinates, projected, or through space";

/// The row of flat patterns.
pub(super) const FLAT: ParamSpec =
    ParamSpec::choice("mapping", &["uv", "planar", "spherical", "cylindrical", "box", "triplanar"], DOC);
/// The row of patterns that are flat or solid, flat first.
pub(super) const FLAT_FIRST: ParamSpec =
    ParamSpec::choice("mapping", &["uv", "solid", "planar", "spherical", "cylindrical", "box", "triplanar"], DOC);
/// The row of patterns that are flat or solid, solid first.
pub(super) const SOLID_FIRST: ParamSpec =
    ParamSpec::choice("mapping", &["solid", "uv", "planar", "spherical", "cylindrical", "box", "triplanar"], DOC);

impl Mapping {
    pub(super) fn compile(params: &Params) -> Self {
        // Some textures have no place in a pattern.
        if !params.spec().params.iter().any(|row| row.name == "mapping") {
            return Mapping::Uv;
        }
        match params.text("mapping") {
            Some("solid") => Mapping::Solid,
            Some("planar") => Mapping::Planar,
            Some("spherical") => Mapping::Spherical,
            Some("cylindrical") => Mapping::Cylindrical,
            Some("box") => Mapping::Box,
            Some("triplanar") => Mapping::Triplanar,
            _ => Mapping::Uv,
        }
    }

    /// It has to know which way the surface faces.
    pub(super) fn needs_normal(self) -> bool {
        matches!(self, Mapping::Box | Mapping::Triplanar)
    }
}

impl Placed {
    /// Where the pattern is asked. Solid patterns that are laid flat see z = 0.
    pub(super) fn pattern_point<'a>(&self, point: &'a TexturePoint) -> PatternPoint<'a> {
        match self.mapping {
            Mapping::Uv => self.at_uv(point),
            Mapping::Solid => self.through_space(point),
            Mapping::Planar => flat(self.through_space(point), |p| [p.x, p.y], |_, d| [d.x, d.y]),
            Mapping::Spherical => {
                let uv = |p: DVec3| [turn(p), acos((-p.y / p.length()).clamp(-1.0, 1.0)) / PI];
                flat(self.through_space(point), uv, |p, d| {
                    let level = (p.x * p.x + p.z * p.z).sqrt();
                    let rise = (d.y * level - p.y * (p.x * d.x + p.z * d.z) / level) / p.length_squared();
                    [turn_step(p, d), rise / PI]
                })
            }
            Mapping::Cylindrical => flat(self.through_space(point), |p| [turn(p), p.y], |p, d| [turn_step(p, d), d.y]),
            Mapping::Box | Mapping::Triplanar => {
                let n = self.normal(point).abs();
                let side = if n.x >= n.y && n.x >= n.z {
                    0
                } else if n.y >= n.z {
                    1
                } else {
                    2
                };
                self.on_side(point, side)
            }
        }
    }

    /// The pattern from all three sides, weighted by how much the surface faces each.
    pub(super) fn blend_sides(&self, textures: &Textures, point: &TexturePoint) -> [f32; 4] {
        let weights = self.normal(point).to_array().map(|n| (n * n) * (n * n));
        let total = weights[0] + weights[1] + weights[2];
        if !(total > 0.0) {
            return self.eval(textures, &self.on_side(point, 2));
        }
        let mut sum = [0.0; 4];
        for (side, weight) in weights.into_iter().enumerate().filter(|(_, w)| *w > 0.0) {
            let value = self.eval(textures, &self.on_side(point, side));
            let share = (weight / total) as f32;
            sum = core::array::from_fn(|i| sum[i] + value[i] * share);
        }
        sum
    }

    /// As seen along axis `side` from where the surface faces: u to the right, v up.
    fn on_side<'a>(&self, point: &'a TexturePoint, side: usize) -> PatternPoint<'a> {
        let sign = if self.normal(point)[side] < 0.0 { -1.0 } else { 1.0 };
        let lay = |p: DVec3| match side {
            0 => [-p.z * sign, p.y],
            1 => [p.x, -p.z * sign],
            _ => [p.x * sign, p.y],
        };
        flat(self.through_space(point), lay, |_, d| lay(d))
    }

    /// The way the surface faces, in the pattern's space; any length.
    fn normal(&self, point: &TexturePoint) -> DVec3 {
        let Patch { object_normal, world_normal, .. } = point.patch;
        let normal = if self.is_in_world { world_normal } else { object_normal }.as_dvec3();
        match &self.texture_from_space {
            None => normal.normalize_or_zero(),
            Some(m) => (m.matrix3.inverse().transpose() * normal).normalize_or_zero(),
        }
    }

    fn at_uv<'a>(&self, point: &'a TexturePoint) -> PatternPoint<'a> {
        let mut uv = point.uv.map(f64::from);
        let mut uv_axes = point.patch.uv_axes.map(|axis| axis.map(f64::from));
        if let Some(m) = &self.texture_from_space {
            let p = m.transform_point3(DVec3::new(uv[0], uv[1], 0.0));
            uv = [p.x, p.y];
            uv_axes = uv_axes.map(|[u, v]| {
                let d = m.transform_vector3(DVec3::new(u, v, 0.0));
                [d.x, d.y]
            });
        }
        lie_flat(uv, uv_axes, point)
    }

    fn through_space<'a>(&self, point: &'a TexturePoint) -> PatternPoint<'a> {
        let (mut position, axes) = match self.is_in_world {
            true => (point.world_position, point.patch.world_axes),
            false => (point.object_position, point.patch.object_axes),
        };
        let mut axes = axes.map(Vec3::as_dvec3);
        if let Some(m) = &self.texture_from_space {
            position = m.transform_point3(position);
            axes = axes.map(|axis| m.transform_vector3(axis));
        }
        PatternPoint { uv: [0.0; 2], uv_axes: [[0.0; 2]; 2], position, axes, original: point }
    }
}

/// Lay a solid place flat: `lay` gives texture coordinates of a point, `step` their change by a small step there.
fn flat<'a>(
    solid: PatternPoint<'a>,
    lay: impl Fn(DVec3) -> [f64; 2],
    step: impl Fn(DVec3, DVec3) -> [f64; 2],
) -> PatternPoint<'a> {
    let sound = |x: f64| if x.is_finite() { x } else { 0.0 };
    let p = solid.position;
    lie_flat(lay(p).map(sound), solid.axes.map(|d| step(p, d).map(sound)), solid.original)
}

fn lie_flat(uv: [f64; 2], uv_axes: [[f64; 2]; 2], original: &TexturePoint) -> PatternPoint<'_> {
    let space = |[u, v]: [f64; 2]| DVec3::new(u, v, 0.0);
    PatternPoint { uv, uv_axes, position: space(uv), axes: uv_axes.map(space), original }
}

/// Part of a turn around the y axis, in `[0, 1)`, as spheres have it.
fn turn(p: DVec3) -> f64 {
    let u = atan2(-p.x, -p.z) / TAU;
    if u < 0.0 { u + 1.0 } else { u }
}

/// Its change by a small step `d`.
fn turn_step(p: DVec3, d: DVec3) -> f64 {
    (p.z * d.x - p.x * d.z) / ((p.x * p.x + p.z * p.z) * TAU)
}
