//! # box
//!
//! A box between two corners, its faces along the axes of the object's space.
//!
//! ## Parameters
//! - `min` (point, scene units, default `[-0.5, -0.5, -0.5]`): lowest corner.
//! - `max` (point, scene units, default `[0.5, 0.5, 0.5]`): highest corner; above `min` on every axis.
//!
//! Texture: on every face `u` and `v` run from 0 to 1, `u` to the right and `v` up as seen from outside (for the top and the
//! bottom: with the front, +z, towards the viewer).
//!
//! ## Example
//! ```toml
//! [objects.crate]
//! type = "box"
//! min = [-1, 0, -1]
//! max = [1, 2, 1]
//! ```
//!
//! ## Limits
//! None: any transform is fine, also for lights.
//!
//! ## References
//! The slab method: Kay & Kajiya, "Ray Tracing Complex Scenes", 1986.

use super::analytic::{Canonical, Crossings, Local, degenerate, place};
use super::{Part, ShapeInput};
use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "box",
    doc: "A box between two corners.",
    params: &[
        ParamSpec::vector("min", [-0.5; 3], "Lowest corner.").unit("scene units"),
        ParamSpec::vector("max", [0.5; 3], "Highest corner.").unit("scene units"),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let min = DVec3::from_array(input.params.vector("min"));
    let max = DVec3::from_array(input.params.vector("max"));
    if let Some(axis) = (0..3).find(|&i| min[i] >= max[i]) {
        let name = ["x", "y", "z"][axis];
        return Err(degenerate(input, "max", format!("`max` is not above `min` in {name}"), "not above `min`")
            .help("write the lowest corner as `min` and the highest as `max`; a flat thing is a `rectangle`"));
    }
    place(UnitCube, DAffine3 { matrix3: DMat3::from_diagonal(max - min), translation: min }, input)
}

/// Canonical: the unit cube from the origin. Faces: -x +x -y +y -z +z.
struct UnitCube;

impl UnitCube {
    /// Areas of the faces across x, y and z after the map.
    fn areas(m: &DMat3) -> [f64; 3] {
        [m.y_axis.cross(m.z_axis).length(), m.z_axis.cross(m.x_axis).length(), m.x_axis.cross(m.y_axis).length()]
    }
}

impl Canonical for UnitCube {
    const FLAT: bool = true;

    fn support(&self, n: DVec3) -> f64 {
        n.x.max(0.0) + n.y.max(0.0) + n.z.max(0.0)
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for axis in 0..3_u8 {
            let (p, v) = (o[axis as usize], d[axis as usize]);
            if v == 0.0 {
                if !(0.0..=1.0).contains(&p) {
                    return found;
                }
                continue;
            }
            let (low, high) = ((-p / v, 2 * axis), ((1.0 - p) / v, 2 * axis + 1));
            let (near, far) = if v > 0.0 { (low, high) } else { (high, low) };
            if near.0 > enter.0 {
                enter = near;
            }
            if far.0 < leave.0 {
                leave = far;
            }
        }
        if enter.0 < leave.0 {
            found.push(enter.0, enter.1);
            found.push(leave.0, leave.1);
        }
        found
    }

    fn project(&self, p: DVec3, face: u8) -> DVec3 {
        let mut q = p.clamp(DVec3::ZERO, DVec3::ONE);
        q[(face / 2) as usize] = f64::from(face % 2);
        q
    }

    fn local(&self, p: DVec3, face: u8) -> Local {
        let q = DVec3::ONE - p;
        let (normal, uv, tangent) = match face {
            0 => (DVec3::NEG_X, [p.z, p.y], DVec3::Z),
            1 => (DVec3::X, [q.z, p.y], DVec3::NEG_Z),
            2 => (DVec3::NEG_Y, [p.x, p.z], DVec3::X),
            3 => (DVec3::Y, [p.x, q.z], DVec3::X),
            4 => (DVec3::NEG_Z, [q.x, p.y], DVec3::NEG_X),
            _ => (DVec3::Z, [p.x, p.y], DVec3::X),
        };
        Local { normal, uv, tangent }
    }

    fn bitangent(&self, _p: DVec3, face: u8) -> DVec3 {
        match face {
            2 => DVec3::Z,
            3 => DVec3::NEG_Z,
            _ => DVec3::Y,
        }
    }

    fn area(&self, m: &DMat3) -> Option<f64> {
        Some(2.0 * Self::areas(m).iter().sum::<f64>())
    }

    fn sample(&self, m: &DMat3, u: (f64, f64)) -> (DVec3, u8) {
        let areas = Self::areas(m);
        let mut rest = u.0 * 2.0 * areas.iter().sum::<f64>();
        let mut face = 5;
        for i in 0..6 {
            if rest < areas[i / 2] {
                face = i;
                break;
            }
            rest -= areas[i / 2];
        }
        let s = (rest / areas[face / 2]).clamp(0.0, 1.0);
        let fixed = (face % 2) as f64;
        let p = match face / 2 {
            0 => DVec3::new(fixed, s, u.1),
            1 => DVec3::new(s, fixed, u.1),
            _ => DVec3::new(s, u.1, fixed),
        };
        (p, face as u8)
    }
}
