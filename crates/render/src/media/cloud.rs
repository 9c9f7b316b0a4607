//! # cloud
//!
//! A heap of cloud, made of noise: puffs of several sizes on a ball, dense within and empty without. It fills the unit cube, which
//! `transform` puts in its place, and is sampled on a grid.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `resolution` | whole number, 2..1024 | | 128 | samples along each edge of the cube |
//! | `cover` | number, 0..1 | | 0.5 | how much of the ball is cloud |
//! | `puffs` | number, above 0 | | 4 | puffs across the cube |
//! | `octaves` | whole number, 1..12 | | 5 | sizes of puffs, each half the one before |
//! | `seed` | whole number | | 0 | which cloud |
//! | `transform` | transform | | unit cube | places the cube in the world |
//! | `majorants` | `local`, `global` | | `local` | as for `grid` |
//!
//! and the coefficients and the phase function of every medium, at density 1.
//!
//! ## Example
//!
//! ```toml
//! [media.cumulus]
//! type = "cloud"
//! scattering = 30
//! cover = 0.6
//! ```
//!
//! ## Limits
//!
//! No weather is simulated; the shape is noise.
//!
//! ## References
//!
//! K. Perlin, "Improving Noise", 2002; D. Ebert et al., "Texturing and Modeling: A Procedural Approach", chapter 9.

use super::grid::{Grid, MAJORANTS, TRANSFORM, is_local, placed};
use super::voxels::Voxels;
use crate::textures::perlin::turbulence;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{DAffine3, DVec3};
use kirkas_scene::spec::{POSITIVE, UNIT};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, Params, TypeSpec};
use rayon::prelude::*;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Medium,
    name: "cloud",
    doc: "A heap of cloud, made of noise.",
    params: &[
        ParamSpec::integer("resolution", 128, (2.0, 1024.0), "Samples along each edge of the cube."),
        ParamSpec::number("cover", 0.5, "How much of the ball is cloud.").range(UNIT),
        ParamSpec::number("puffs", 4.0, "Puffs across the cube.").range(POSITIVE),
        ParamSpec::integer("octaves", 5, (1.0, 12.0), "Sizes of puffs, each half the one before."),
        ParamSpec::integer("seed", 0, (0.0, 1e9), "Which cloud."),
        TRANSFORM,
        MAJORANTS,
    ],
};

/// From its parameters.
pub(super) fn make(p: &Params) -> Result<Grid, Diagnostic> {
    let n = p.integer("resolution") as usize;
    let shape = Shape {
        cover: p.number("cover"),
        puffs: p.number("puffs"),
        octaves: p.integer("octaves") as u32,
        shift: shift(p.integer("seed") as u64),
    };
    let centre = |i: usize| (i as f64 + 0.5) / n as f64;
    let sheet = |k: usize| {
        let shape = &shape;
        (0..n * n)
            .map(move |at| shape.density(DVec3::new(centre(at % n), centre(at / n), centre(k))))
            .collect::<Vec<f32>>()
    };
    let values: Vec<f32> = (0..n).into_par_iter().flat_map_iter(sheet).collect();
    let voxels = Voxels::new([n; 3], values).expect("densities are between 0 and 1");
    Ok(Grid::new(voxels, placed(p)?.unwrap_or(DAffine3::IDENTITY), is_local(p)))
}

struct Shape {
    cover: f64,
    puffs: f64,
    octaves: u32,
    shift: DVec3,
}

impl Shape {
    /// Between 0 and 1, at a point of the unit cube: noise that is lowered the farther it is from the middle, cut off at 0.
    fn density(&self, p: DVec3) -> f32 {
        let radius = 2.0 * (p - 0.5).length();
        if radius >= 1.0 {
            return 0.0;
        }
        let noise = turbulence(p * self.puffs + self.shift, self.octaves);
        // Steep, so that a cloud has an edge.
        (6.0 * (noise + 2.0 * self.cover - 0.6 - radius * radius * radius)).clamp(0.0, 1.0) as f32
    }
}

/// Another place of the noise for each seed.
fn shift(seed: u64) -> DVec3 {
    let place = |i: u64| 256.0 * f64::from(unit_f32((combine(seed, i) >> 32) as u32));
    DVec3::new(place(1), place(2), place(3))
}
