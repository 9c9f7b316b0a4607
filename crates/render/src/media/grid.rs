//! # grid
//!
//! A medium whose density is sampled on a grid, from a file: smoke, a cloud, a scan. Between samples density is linear along each
//! axis; outside the grid there is nothing.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `file` | path | | required | `.vol`: Mitsuba's grid volume, version 3, one channel, 32-bit floats or bytes |
//! | `transform` | transform | | the file's box | places the unit cube, which the grid fills, in the world |
//! | `majorants` | `local`, `global` | | `local` | bounds of the density for each block of 4 samples along each axis, or one bound for all: slower, same picture |
//!
//! and the coefficients and the phase function of every medium, at density 1.
//!
//! ## Example
//!
//! ```toml
//! [media.smoke]
//! type = "grid"
//! file = "smoke.vol"
//! scattering = 4
//! absorption = 1
//! transform = [{translate = [-0.5, 0, -0.5]}, {scale = 2}]
//! ```
//!
//! ## Limits
//!
//! Grids do not move, even with objects that they fill. Light that the medium emits is found by chance, where paths look.
//!
//! ## References
//!
//! Woodcock et al. 1965; Amanatides & Woo 1987; Novak, Selle & Jarosz 2014 (see `tracking.rs`).

use super::Way;
use super::majorants::{Majorants, Stretch, Walk};
use super::volume_file;
use super::voxels::Voxels;
use kirkas_geometry::{Bounds3, DAffine3, DMat3, DVec3, Vec3};
use kirkas_scene::transforms::read_transform;
use kirkas_scene::{Assets, Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Medium,
    name: "grid",
    doc: "Density on a grid, from a file: smoke, a cloud, a scan.",
    params: &[
        ParamSpec::new(
            "file",
            ParamType::Path,
            Fallback::Required,
            "`.vol`: Mitsuba's grid volume, version 3, one channel, 32-bit floats or bytes.",
        ),
        TRANSFORM,
        MAJORANTS,
    ],
};
pub(super) const TRANSFORM: ParamSpec = ParamSpec::new(
    "transform",
    ParamType::Transform,
    Fallback::Absent,
    "Places the unit cube, which the grid fills, in the world; without it the file's own box, or the unit cube.",
);
pub(super) const MAJORANTS: ParamSpec = ParamSpec::choice(
    "majorants",
    &["local", "global"],
    "Bounds of the density for each block of 4 samples along each axis, or one bound for all: slower, same picture.",
);

/// Samples along the edge of a block that has bounds of its own.
const BLOCK: usize = 4;

/// A grid in the world.
#[derive(Clone, Debug)]
pub struct Grid {
    voxels: Voxels,
    majorants: Majorants,
    /// To the unit cube.
    cube_from_world: DAffine3,
}

impl Grid {
    pub(super) fn new(voxels: Voxels, world_from_cube: DAffine3, is_local: bool) -> Self {
        let block = if is_local { BLOCK } else { voxels.size().into_iter().fold(1, usize::max) };
        Grid { majorants: Majorants::new(&voxels, block), voxels, cube_from_world: world_from_cube.inverse() }
    }

    /// Density at a point of the world.
    #[inline]
    pub fn density(&self, point: DVec3) -> f32 {
        let p = self.cube_from_world.transform_point3(point);
        let is_inside = |x: f64| (0.0..=1.0).contains(&x);
        if is_inside(p.x) && is_inside(p.y) && is_inside(p.z) { self.voxels.at(p) } else { 0.0 }
    }

    /// Density is nowhere above this.
    pub fn most(&self) -> f32 {
        self.majorants.most()
    }

    /// Around it, in the world.
    pub(super) fn bounds(&self) -> Bounds3 {
        Bounds3 { min: Vec3::ZERO, max: Vec3::ONE }.transformed(&self.cube_from_world.inverse())
    }

    /// A way as the unit cube sees it; distances stay those of the world.
    pub(super) fn crossing(&self, way: &Way) -> Crossing<'_> {
        Crossing {
            grid: self,
            origin: self.cube_from_world.transform_point3(way.origin),
            direction: self.cube_from_world.transform_vector3(way.direction),
            length: way.length,
        }
    }
}

/// A way through a grid.
pub(super) struct Crossing<'a> {
    grid: &'a Grid,
    origin: DVec3,
    direction: DVec3,
    length: f64,
}

impl Crossing<'_> {
    /// Its stretches, in order.
    pub fn walk(&self) -> Walk<'_> {
        self.grid.majorants.walk(self.origin, self.direction, 0.0, self.length)
    }

    /// Density at this distance, which lies on the stretch.
    #[inline]
    pub fn density(&self, distance: f64, stretch: &Stretch) -> f32 {
        let density = self.grid.voxels.at(self.origin + self.direction * distance);
        density.max(stretch.least).min(stretch.most)
    }
}

/// From its file.
pub(super) fn read(p: &Params, assets: &dyn Assets) -> Result<Grid, Diagnostic> {
    let file = p.text("file").unwrap_or_default();
    let span = p.span("file");
    let from = span.is_some().then_some(span.source);
    let read = assets.bytes(from, file);
    let bytes = read.map_err(|d| if d.labels.is_empty() { d.at(span, "named here") } else { d })?;
    let volume = volume_file::read(&bytes).map_err(|why| {
        Diagnostic::error("bad-volume", format!("`{file}`: {why}"))
            .at(span, "named here")
            .help("write it as Mitsuba's grid volume: `VOL`, version 3, encoding 1, one channel")
    })?;
    let [low, high] = volume.bounds;
    let own = DAffine3::from_mat3_translation(DMat3::from_diagonal(high - low), low);
    Ok(Grid::new(volume.voxels, placed(p)?.unwrap_or(own), is_local(p)))
}

/// Where the unit cube is put, if anything is written.
pub(super) fn placed(p: &Params) -> Result<Option<DAffine3>, Diagnostic> {
    let Some(node) = p.entity.params.get("transform") else { return Ok(None) };
    let m = read_transform(node)?;
    let det = m.matrix3.determinant();
    if !(det != 0.0 && det.is_finite()) {
        return Err(Diagnostic::error("flat-volume", "this transform leaves the grid no volume")
            .at(node.span, "here")
            .help("scale by numbers other than 0"));
    }
    Ok(Some(m))
}

pub(super) fn is_local(p: &Params) -> bool {
    p.text("majorants") != Some("global")
}
