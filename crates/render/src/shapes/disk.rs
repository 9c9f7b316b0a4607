//! # disk
//!
//! A flat round disk, or with `inner_radius` a ring. Both sides are seen; a light shines from the side of `normal`.
//!
//! ## Parameters
//! - `center` (point, scene units, default `[0, 0, 0]`).
//! - `normal` (direction, default `[0, 1, 0]`): the way it faces; any length but 0.
//! - `radius` (above 0, scene units, default 1).
//! - `inner_radius` (0 or more and below `radius`, scene units, default 0): radius of the hole.
//!
//! Texture: `u` and `v` run from 0 to 1 across the square around the disk.
//!
//! ## Example
//! ```toml
//! [objects.coin]
//! type = "disk"
//! center = [0, 1, 0]
//! normal = [0, 1, 0]
//! radius = 0.5
//! ```
//!
//! ## Limits
//! None: uneven scales make it an ellipse, also as a light.
//!
//! ## References
//! Uniform points: Shirley & Chiu, "A Low Distortion Map Between Disk and Square", 1997.

use super::analytic::{Canonical, Crossings, Local, degenerate, frame_around, place, unit_vector};
use super::{Part, ShapeInput};
use core::f64::consts::{PI, TAU};
use kirkas_geometry::elementary::{cos, sin};
use kirkas_geometry::warp::square_to_uniform_disk;
use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::spec::{NOT_NEGATIVE, POSITIVE};
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "disk",
    doc: "A flat disk or ring.",
    params: &[
        ParamSpec::vector("center", [0.0; 3], "Its centre.").unit("scene units"),
        ParamSpec::vector("normal", [0.0, 1.0, 0.0], "The way it faces."),
        ParamSpec::number("radius", 1.0, "Radius.").unit("scene units").range(POSITIVE),
        ParamSpec::number("inner_radius", 0.0, "Radius of the hole.").unit("scene units").range(NOT_NEGATIVE),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let normal = unit_vector(input, "normal")?;
    let center = DVec3::from_array(input.params.vector("center"));
    let radius = input.params.number("radius");
    let hole = input.params.number("inner_radius") / radius;
    if hole >= 1.0 {
        return Err(degenerate(input, "inner_radius", "the hole is as large as the disk".into(), "not below `radius`")
            .help("make `inner_radius` smaller than `radius`"));
    }
    place(Disk { hole }, DAffine3 { matrix3: frame_around(normal) * radius, translation: center }, input)
}

/// Canonical: radius 1 in the plane z = 0, facing +z, with a hole.
struct Disk {
    hole: f64,
}

impl Canonical for Disk {
    const FLAT: bool = true;

    fn support(&self, n: DVec3) -> f64 {
        (n.x * n.x + n.y * n.y).sqrt()
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        if d.z != 0.0 {
            let t = -o.z / d.z;
            let (x, y) = (o.x + t * d.x, o.y + t * d.y);
            let r2 = x * x + y * y;
            if r2 <= 1.0 && r2 >= self.hole * self.hole {
                found.push(t, 0);
            }
        }
        found
    }

    fn project(&self, p: DVec3, _face: u8) -> DVec3 {
        let r = (p.x * p.x + p.y * p.y).sqrt();
        let scale = if r > 0.0 { r.clamp(self.hole, 1.0) / r } else { 1.0 };
        DVec3::new(p.x * scale, p.y * scale, 0.0)
    }

    fn local(&self, p: DVec3, _face: u8) -> Local {
        Local { normal: DVec3::Z, uv: [0.5 + 0.5 * p.x, 0.5 + 0.5 * p.y], tangent: DVec3::new(2.0, 0.0, 0.0) }
    }

    fn bitangent(&self, _p: DVec3, _face: u8) -> DVec3 {
        DVec3::new(0.0, 2.0, 0.0)
    }

    fn area(&self, m: &DMat3) -> Option<f64> {
        Some(PI * (1.0 - self.hole * self.hole) * m.x_axis.cross(m.y_axis).length())
    }

    fn sample(&self, _m: &DMat3, u: (f64, f64)) -> (DVec3, u8) {
        if self.hole == 0.0 {
            let d = square_to_uniform_disk((u.0 as f32, u.1 as f32));
            return (DVec3::new(f64::from(d.x), f64::from(d.y), 0.0), 0);
        }
        let inner = self.hole * self.hole;
        let r = (inner + u.0 * (1.0 - inner)).sqrt();
        (DVec3::new(r * cos(TAU * u.1), r * sin(TAU * u.1), 0.0), 0)
    }
}
