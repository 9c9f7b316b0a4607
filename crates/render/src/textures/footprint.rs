//! How much of a surface one sample stands for: a thin cone around each path, and what it covers where it meets a surface.
//!
//! `width` is that of a pixel's share of the picture at the ray's start, `spread` by how much it grows per unit of distance.
//! Mirrors and glass bend the cone by the surface's curvature; a rough bounce opens it by the lobe it chose from.
//!
//! Akenine-Möller et al. 2021, "Improved Shader and Texture Level of Detail Using Ray Cones" (cones, curvature, the ellipse on the
//! surface); Igehy 1999, "Tracing Ray Differentials" (transfer, reflection, refraction: here for the mean of both axes).

use kirkas_geometry::{DVec3, Vec3};

/// The cone of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCone {
    /// Width where the ray starts, in scene units; negative behind a focus.
    pub width: f32,
    /// Growth of the width per unit of distance (radians, for what is small); negative where it narrows.
    pub spread: f32,
}

/// A rough bounce opens the cone by this part of the width of its lobe: less detail would be seen through all of them together.
const SHARE_OF_LOBE: f32 = 0.25;
/// The most that a cone opens.
const MOST_SPREAD: f32 = 0.5;
/// The lowest cosine at which a cone's ellipse is computed.
const LEAST_COSINE: f64 = 1e-4;

impl RayCone {
    /// A ray without width: nothing is filtered along it, nor after its bounces.
    pub const POINT: RayCone = RayCone { width: 0.0, spread: 0.0 };

    /// The same for a part of a pixel, or for several.
    pub fn times(self, pixels: f32) -> RayCone {
        RayCone { width: self.width * pixels, spread: self.spread * pixels }
    }

    /// Where the ray has gone `distance`.
    pub fn after(self, distance: f32) -> RayCone {
        RayCone { width: self.width + self.spread * distance, ..self }
    }

    /// Mirrored by a surface of mean `curvature` (1 / radius; positive where it bulges towards the ray).
    pub fn mirrored(self, curvature: f32) -> RayCone {
        RayCone { spread: bounded(self.spread + 2.0 * curvature * self.width), ..self }
    }

    /// Bent into a body of relative index `eta` (that of the far side over that of the near one).
    pub fn refracted(self, curvature: f32, eta: f32) -> RayCone {
        let spread = self.spread / eta - curvature * self.width * (1.0 - 1.0 / eta);
        RayCone { spread: bounded(spread), ..self }
    }

    /// Scattered into a direction that was chosen with density `pdf` per solid angle.
    pub fn scattered(self, pdf: f32) -> RayCone {
        if self == Self::POINT {
            return self;
        }
        // As if the lobe were even over a cone of solid angle 1 / pdf.
        let lobe = (4.0 / (core::f32::consts::PI * pdf)).sqrt();
        let opened = (SHARE_OF_LOBE * lobe).min(MOST_SPREAD);
        RayCone { width: self.width.abs(), spread: bounded(self.spread.abs().max(opened)) }
    }

    /// The axes of the ellipse, the longer first, that the cone covers on a surface with unit `normal`.
    pub(crate) fn axes_on(self, direction: DVec3, normal: DVec3) -> [DVec3; 2] {
        let width = f64::from(self.width.abs());
        let d = direction.normalize();
        let cosine = d.dot(normal);
        let across = d - normal * cosine;
        let along = across.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        [along * (width / cosine.abs().max(LEAST_COSINE)), normal.cross(along) * width]
    }
}

fn bounded(spread: f32) -> f32 {
    if spread.is_finite() { spread.clamp(-MOST_SPREAD, MOST_SPREAD) } else { MOST_SPREAD }
}

/// What textures may ask of the surface around a point, besides the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// What one sample covers, as two steps of the object's space, the longer first.
    pub object_axes: [Vec3; 2],
    /// The same in the world.
    pub world_axes: [Vec3; 2],
    /// The same in texture coordinates.
    pub uv_axes: [[f32; 2]; 2],
    /// Geometric normal in the object's space; any length.
    pub object_normal: Vec3,
    /// In the world.
    pub world_normal: Vec3,
    /// Colour of the mesh's vertices, linear, and 1; zeros where it has none.
    pub color: [f32; 4],
}

impl Patch {
    /// Of a point that is asked for itself alone.
    pub const POINT: Patch = Patch {
        object_axes: [Vec3::ZERO; 2],
        world_axes: [Vec3::ZERO; 2],
        uv_axes: [[0.0; 2]; 2],
        object_normal: Vec3::ZERO,
        world_normal: Vec3::ZERO,
        color: [0.0; 4],
    };
}

/// What a shape knows of the surface around a point, in part space.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePatch {
    /// Derivatives of position by the texture coordinates; zero where unknown.
    pub tangents: [DVec3; 2],
    /// Colour of the mesh's vertices, linear, and 1; zeros where it has none.
    pub color: [f32; 4],
}

impl SurfacePatch {
    /// The step of texture coordinates that a step along the surface makes: the nearest, where `tangents` are not square.
    pub(crate) fn uv_step(&self, step: DVec3) -> [f32; 2] {
        let [u, v] = self.tangents;
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let (su, sv) = (step.dot(u), step.dot(v));
        let determinant = uu * vv - uv * uv;
        let solved = [(vv * su - uv * sv) / determinant, (uu * sv - uv * su) / determinant];
        if solved.iter().all(|x| x.is_finite()) { solved.map(|x| x as f32) } else { [0.0; 2] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_covers_a_wall_evenly_and_a_floor_along_the_view() {
        let cone = RayCone { width: 0.0, spread: 0.01 }.after(10.0);
        let [long, short] = cone.axes_on(DVec3::NEG_Z, DVec3::Z);
        assert!((long.length() - 0.1).abs() < 1e-7 && (short.length() - 0.1).abs() < 1e-7);
        let [long, short] = cone.axes_on(DVec3::new(0.0, -0.1, -1.0).normalize(), DVec3::Y);
        assert!((long.length() / short.length() - (1.01_f64).sqrt() / 0.1).abs() < 1e-5, "{long} {short}");
        assert!(long.cross(DVec3::NEG_Z).length() < 1e-6 && short.cross(DVec3::X).length() < 1e-6);
    }

    #[test]
    fn a_ball_lens_focuses_and_a_convex_mirror_scatters() {
        // A thin bundle meets a sphere of radius 1 and index 1.5: paraxially it comes to a focus 3 radii behind the front.
        let inside = RayCone { width: 0.001, spread: 0.0 }.refracted(1.0, 1.5);
        assert!((inside.after(3.0).width).abs() < 1e-8, "{inside:?}");
        // A mirror ball's focus lies half a radius behind its surface.
        let mirrored = RayCone { width: 0.001, spread: 0.0 }.mirrored(1.0);
        assert!((mirrored.spread - 0.002).abs() < 1e-9);
    }

    #[test]
    fn a_ray_without_width_stays_so() {
        let after = RayCone::POINT.after(5.0).mirrored(2.0).refracted(1.0, 1.5).scattered(0.3);
        assert_eq!(after, RayCone::POINT);
    }
}
