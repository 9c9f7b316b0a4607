//! A ray with what every test against it needs, computed once.

use kirkas_geometry::bounds::safe_inverse;
use kirkas_geometry::{Ray, Vec3};

/// A ray ready to be tested. Rays inside an instance carry two intervals: the world ray's own, and that of the instance's
/// bounds, into which `t` is clamped.
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    /// The ray, its `t` limited to the bounds of its instance: what boxes are tested with.
    pub(crate) clipped: Ray,
    /// Hits lie after this.
    pub(crate) t_min: f32,
    /// Hits lie before this.
    pub(crate) t_max: f32,
    /// One over the direction.
    pub(crate) inverse: Vec3,
    /// The axes, the one along which the ray runs fastest last (each below 3).
    pub(crate) axes: [usize; 3],
    /// The origin along these axes.
    pub(crate) sheared_origin: [f32; 3],
    /// How far the ray moves along the first two axes for each step along the last.
    pub(crate) shear: [f32; 2],
}

impl PreparedRay {
    /// `None` for a ray that can hit nothing: NaN or infinity in origin or direction, no direction, or NaN in `t`.
    #[inline]
    pub fn new(ray: &Ray) -> Option<Self> {
        Self::clipped(*ray, (ray.t_min, ray.t_max))
    }

    /// A ray whose hits lie within the open interval `t`, clamped into the interval that `clipped` carries.
    #[inline]
    pub(crate) fn clipped(clipped: Ray, t: (f32, f32)) -> Option<Self> {
        let d = clipped.direction;
        let usable = clipped.origin.is_finite() && d.is_finite() && d != Vec3::ZERO && t.0 < t.1;
        if !usable {
            return None;
        }
        let a = d.abs();
        let z = if a.x > a.y { if a.x > a.z { 0 } else { 2 } } else { if a.y > a.z { 1 } else { 2 } };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        Some(PreparedRay {
            clipped,
            t_min: t.0,
            t_max: t.1,
            inverse: safe_inverse(d),
            axes,
            sheared_origin: axes.map(|k| clipped.origin[k]),
            shear: [d[axes[0]] / d[z], d[axes[1]] / d[z]],
        })
    }

    /// A crossing, clamped into what `Bounds3::intersect` gave for its bounds, if it may be a hit.
    #[inline]
    pub(crate) fn accept(&self, t: f64, inside: (f32, f32)) -> Option<f32> {
        // NaN is not accepted.
        if !(t > f64::from(self.t_min) && t < f64::from(self.t_max)) {
            return None;
        }
        let t = clamp(t as f32, inside);
        self.admits(t).then_some(t)
    }

    /// True when `t` may be a hit.
    #[inline]
    pub(crate) fn admits(&self, t: f32) -> bool {
        t > self.t_min && t < self.t_max
    }
}

/// `t` moved into `[near, far]`; NaN stays.
#[inline]
pub(crate) fn clamp(t: f32, (near, far): (f32, f32)) -> f32 {
    if t < near {
        near
    } else if t > far {
        far
    } else {
        t
    }
}
