//! # sphereflake
//!
//! The snowflake of spheres that ray tracers are measured with: each sphere bears nine smaller ones, six around its equator
//! and three about its pole, each of which bears nine again.
//!
//! ## Parameters
//! - `center` (point, scene units, default `[0, 0, 0]`): of the largest sphere.
//! - `radius` (above 0, scene units, default 1): of the largest sphere.
//! - `depth` (0 to 7, default 4): generations; 0 is one sphere, 4 are 7,381, 5 are 66,430, 7 are 5,380,840.
//! - `ratio` (0.01 to 1, default 1/3): radius of a child by that of its parent.
//! - `axis` (direction, default `[0, 1, 0]`): where the pole of the largest sphere points; any length but 0.
//!
//! Texture: each sphere as for `sphere`.
//!
//! ## Example
//! ```toml
//! [objects.flake]
//! type = "sphereflake"
//! depth = 5
//! axis = [0, 1, 0]
//! ```
//!
//! ## Limits
//! No uneven scales. With a ratio above 0.4 the children overlap.
//!
//! ## References
//! Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 1987 (the Standard Procedural Databases, `balls`).

use super::analytic::{frame_around, unit_vector};
use super::spheres::SphereSet;
use super::{Part, ShapeInput};
use kirkas_geometry::{DMat3, DVec3};
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "sphereflake",
    doc: "A snowflake of spheres: each bears nine smaller ones.",
    params: &[
        ParamSpec::vector("center", [0.0; 3], "Centre of the largest sphere.").unit("scene units"),
        ParamSpec::number("radius", 1.0, "Radius of the largest sphere.").unit("scene units").range(POSITIVE),
        ParamSpec::integer("depth", 4, (0.0, 7.0), "Generations; 5 makes 66,430 spheres, each more 9 times as many."),
        ParamSpec::number("ratio", 1.0 / 3.0, "Radius of a child by that of its parent.").range((0.01, 1.0)),
        ParamSpec::vector("axis", [0.0, 1.0, 0.0], "Where the pole of the largest sphere points."),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let axis = unit_vector(input, "axis")?;
    let center = DVec3::from_array(input.params.vector("center"));
    // The table's range was checked; this is the last guard against 9^depth spheres.
    let depth = input.params.integer("depth").clamp(0, 7) as u32;
    let flake = Flake { directions: directions(), ratio: input.params.number("ratio") };
    let mut spheres = Vec::with_capacity((9_usize.pow(depth + 1) - 1) / 8);
    flake.grow(center, input.params.number("radius"), frame_around(axis), depth, &mut spheres);
    SphereSet::parts(&spheres, input)
}

struct Flake {
    directions: [DVec3; 9],
    ratio: f64,
}

impl Flake {
    /// Add a sphere, whose pole is the z axis of `frame`, and all that it bears.
    fn grow(&self, center: DVec3, radius: f64, frame: DMat3, depth: u32, out: &mut Vec<(DVec3, f64)>) {
        out.push((center, radius));
        if depth == 0 {
            return;
        }
        let child = radius * self.ratio;
        for direction in self.directions {
            let along = (frame * direction).normalize();
            self.grow(center + along * (radius + child), child, turned_to(frame, along), depth - 1, out);
        }
    }
}

/// Where the children of a sphere with its pole at +z sit: six around the equator, three 60 degrees from each other and
/// from two of the six, as far up as that makes them (Haines' trio, turned thrice about z).
fn directions() -> [DVec3; 9] {
    let turn = |x: f64, y: f64, z: f64, quarter: usize| {
        let (c, s) = [(1.0, 0.0), (-0.5, 0.75_f64.sqrt()), (-0.5, -(0.75_f64.sqrt()))][quarter];
        DVec3::new(c * x - s * y, s * x + c * y, z)
    };
    let up = (2.0_f64 / 3.0).sqrt();
    let out = (1.0_f64 / 3.0).sqrt();
    let half = 0.75_f64.sqrt();
    std::array::from_fn(|i| match i % 3 {
        0 => turn(half, -0.5, 0.0, i / 3),
        1 => turn(half, 0.5, 0.0, i / 3),
        _ => turn(out, 0.0, up, i / 3),
    })
}

/// `frame`, turned the shortest way so that its z axis becomes `z` (Rodrigues' formula without angles).
fn turned_to(frame: DMat3, z: DVec3) -> DMat3 {
    let from = frame.z_axis;
    let (axis, cosine) = (from.cross(z), from.dot(z));
    if cosine < -1.0 + 1e-12 {
        return DMat3::from_cols(frame.x_axis, -frame.y_axis, -frame.z_axis);
    }
    let k = 1.0 / (1.0 + cosine);
    let turned = |v: DVec3| v * cosine + axis.cross(v) + axis * (axis.dot(v) * k);
    DMat3::from_cols(turned(frame.x_axis), turned(frame.y_axis), z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_children_stand_60_degrees_apart() {
        let d = directions();
        for (i, a) in d.iter().enumerate() {
            assert!((a.length() - 1.0).abs() < 1e-15);
            let near = d.iter().enumerate().filter(|(j, b)| *j != i && (a.dot(**b) - 0.5).abs() < 1e-12).count();
            assert_eq!(near, if i % 3 == 2 { 4 } else { 3 });
            assert!(d.iter().enumerate().all(|(j, b)| j == i || a.dot(*b) < 0.5 + 1e-12));
        }
    }

    #[test]
    fn children_touch_their_parents_and_no_other_sphere_of_their_generation() {
        let flake = Flake { directions: directions(), ratio: 1.0 / 3.0 };
        let mut spheres = Vec::new();
        flake.grow(DVec3::ZERO, 1.0, DMat3::IDENTITY, 3, &mut spheres);
        assert_eq!(spheres.len(), 820);
        let generation: Vec<_> = spheres.iter().filter(|s| (s.1 - 1.0 / 9.0).abs() < 1e-9).collect();
        assert_eq!(generation.len(), 81);
        for (i, a) in generation.iter().enumerate() {
            assert!(generation[..i].iter().all(|b| (a.0 - b.0).length() > 2.0 / 9.0 - 1e-9));
        }
    }
}
