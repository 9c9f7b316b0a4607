//! How a ray is taken through cells so that no rounding hides a hit: see the head of [`super`].

use crate::prepared_ray::PreparedRay;
use kirkas_geometry::bounds::pad_far;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use kirkas_geometry::{Bounds3, Ray, Vec3};

/// A ray is near when its origin is no farther from the far side of the structure than this many of its sizes.
pub(super) const NEAR: f32 = 8.0;

/// How far from the cut of a primitive by a cell the hits of near rays may lie, along each axis, in a structure with these
/// bounds.
pub(crate) fn growth(root: &Bounds3) -> f64 {
    let extent = root.max.as_dvec3() - root.min.as_dvec3();
    128.0 * f64::from(UNIT_ROUNDOFF) * f64::from(NEAR) * extent.max_element()
}

/// By how much the cells along a ray are to be grown: 0 for near rays, infinity for what must see every cell.
pub(crate) fn thickness(ray: &Ray, root: &Bounds3) -> f32 {
    let distance = (ray.origin - root.min).abs().max((root.max - ray.origin).abs()).max_element();
    let (tiny, speed, huge) = (1e-12_f32, ray.direction.abs().max_element(), 1e18_f32);
    let sound = distance >= tiny && distance <= huge && speed >= tiny && speed <= huge;
    if !sound {
        f32::INFINITY
    } else if distance <= NEAR * (root.max - root.min).max_element() {
        0.0
    } else {
        UNIT_ROUNDOFF * (64.0 * distance + 2.0 * ray.origin.abs().max_element())
    }
}

/// A ray on its way through cells.
pub(crate) struct CellRay {
    /// The origin, seen from the faces through which the ray leaves cells, and enters them.
    leave_origin: Vec3,
    enter_origin: Vec3,
    inverse: Vec3,
    /// Where the ray is within the root.
    pub near: f32,
    pub far: f32,
    /// Whether nothing is to be looked for beyond what was found.
    culls: bool,
}

impl CellRay {
    /// `None` for a ray that passes the root by.
    pub fn new(ray: &PreparedRay, root: &Bounds3) -> Option<Self> {
        let thickness = thickness(&ray.clipped, root);
        let culls = thickness == 0.0;
        let mut line = ray.clipped;
        if !culls {
            (line.t_min, line.t_max) = (f32::NEG_INFINITY, f32::INFINITY);
        }
        let grow = Vec3::splat(thickness);
        let grown = Bounds3 { min: root.min - grow, max: root.max + grow };
        let (near, far) = grown.intersect(&line, ray.inverse())?;
        let shift = grow.copysign(ray.inverse());
        let (leave_origin, enter_origin) = (line.origin - shift, line.origin + shift);
        Some(CellRay { leave_origin, enter_origin, inverse: ray.inverse(), near, far, culls })
    }

    /// True when the ray runs down this axis.
    #[inline(always)]
    pub fn is_backward(&self, axis: usize) -> bool {
        self.inverse[axis].is_sign_negative()
    }

    /// When the ray has left the cells before a plane; NaN: never.
    #[inline(always)]
    pub fn leaves(&self, axis: usize, plane: f32) -> f32 {
        pad_far((plane - self.leave_origin[axis]) * self.inverse[axis])
    }

    /// When the ray enters the cells behind a plane; NaN: it always was there.
    #[inline(always)]
    pub fn enters(&self, axis: usize, plane: f32) -> f32 {
        (plane - self.enter_origin[axis]) * self.inverse[axis]
    }

    /// Cells entered after this hold nothing better, when the nearest hit is at `best`.
    #[inline(always)]
    pub fn limit(&self, best: f32) -> f32 {
        if self.culls { best } else { f32::INFINITY }
    }
}
