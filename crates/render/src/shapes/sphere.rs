//! # sphere
//!
//! A ball, or with an uneven scale an ellipsoid.
//!
//! ## Parameters
//! - `center` (point, scene units, default `[0, 0, 0]`).
//! - `radius` (above 0, scene units, default 1).
//!
//! Texture: `u` runs once around the y axis of the object's space, from -z over -x, +z (`u = 0.5`) and +x, so that an image
//! is seen unmirrored; `v` is the angle from the south pole (`v = 0`) to the north pole (`v = 1`).
//!
//! ## Example
//! ```toml
//! [objects.ball]
//! type = "sphere"
//! center = [0, 1, 0]
//! radius = 1
//! ```
//!
//! ## Limits
//! As a light it must not be scaled unevenly. Centre and radius are rounded to f32 (about 7 digits).
//!
//! ## References
//! Intersection: Haines, Günther & Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", 2019.
//! Sampling by solid angle: Wang, "Physically Correct Direct Lighting for Distribution Ray Tracing", 1992.

use super::analytic::{Canonical, CenteredLine, Crossings, Local, place, similarity_scale, turn};
use super::spheres::SphereSet;
use super::{Part, ShapeInput, quadratic};
use core::f64::consts::{PI, TAU};
use kirkas_geometry::elementary::{acos, cos, sin};
use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::spec::POSITIVE;
use kirkas_scene::{Diagnostic, Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "sphere",
    doc: "A ball.",
    params: &[
        ParamSpec::vector("center", [0.0; 3], "Its centre.").unit("scene units"),
        ParamSpec::number("radius", 1.0, "Radius.").unit("scene units").range(POSITIVE),
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let center = DVec3::from_array(input.params.vector("center"));
    let radius = input.params.number("radius");
    if similarity_scale(&input.part_from_object.matrix3).is_some() {
        return SphereSet::parts(&[(center, radius)], input);
    }
    place(UnitSphere, DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(radius)), translation: center }, input)
}

/// Texture coordinates of a unit direction from the centre, in object space.
pub(super) fn sphere_uv(n: DVec3) -> [f64; 2] {
    [turn(-n.x, -n.z), acos(-n.y.clamp(-1.0, 1.0)) / PI]
}

/// The way in which `u` grows there; as long as a whole turn of `u`.
pub(super) fn sphere_tangent(n: DVec3) -> DVec3 {
    DVec3::new(n.z, 0.0, -n.x) * TAU
}

/// The way in which `v` grows there; as long as half a turn.
pub(super) fn sphere_bitangent(n: DVec3) -> DVec3 {
    let sine = (n.x * n.x + n.z * n.z).sqrt();
    let level = if sine > 0.0 { DVec3::new(n.x, 0.0, n.z) / sine } else { DVec3::X };
    (DVec3::Y * sine - level * n.y) * PI
}

/// A unit direction, uniform over the sphere.
pub(super) fn uniform_direction(u: (f64, f64)) -> DVec3 {
    let y = 1.0 - 2.0 * u.0;
    let r = (1.0 - y * y).max(0.0).sqrt();
    DVec3::new(r * sin(TAU * u.1), y, r * cos(TAU * u.1))
}

/// Canonical: radius 1 about the origin. Only for ellipsoids; balls go to the accelerator as they are.
struct UnitSphere;

impl Canonical for UnitSphere {
    const FLAT: bool = false;

    fn support(&self, n: DVec3) -> f64 {
        n.length()
    }

    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings {
        let mut found = Crossings::default();
        let line = CenteredLine::new(o, d);
        let b = line.o.dot(line.d);
        if let Some((s0, s1)) = quadratic::roots(1.0, b, line.o.length_squared() - 1.0) {
            found.push(line.t(s0), 0);
            found.push(line.t(s1), 0);
        }
        found
    }

    fn project(&self, p: DVec3, _face: u8) -> DVec3 {
        p.try_normalize().unwrap_or(DVec3::Y)
    }

    fn local(&self, p: DVec3, _face: u8) -> Local {
        Local { normal: p, uv: sphere_uv(p), tangent: sphere_tangent(p) }
    }

    fn bitangent(&self, p: DVec3, _face: u8) -> DVec3 {
        sphere_bitangent(p)
    }

    fn curvature(&self, _face: u8) -> f64 {
        1.0
    }

    fn area(&self, m: &DMat3) -> Option<f64> {
        let scale = similarity_scale(m)?;
        Some(4.0 * PI * scale * scale)
    }

    fn sample(&self, _m: &DMat3, u: (f64, f64)) -> (DVec3, u8) {
        (uniform_direction(u), 0)
    }
}
