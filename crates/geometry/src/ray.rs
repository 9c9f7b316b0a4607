//! A ray: origin, direction, valid interval, time and mask.

use crate::Vec3;

/// Points `origin + t * direction` with `t_min < t < t_max`. The direction need not be unit; `t` is in units
/// of its length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Where it starts, in scene units.
    pub origin: Vec3,
    /// Where it goes; any length but 0.
    pub direction: Vec3,
    /// Hits at or before this are ignored.
    pub t_min: f32,
    /// Hits at or after this are ignored.
    pub t_max: f32,
    /// Time in seconds, as the shutter and key frames count it.
    pub time: f32,
    /// A geometry is seen when `mask & geometry_mask != 0`.
    pub mask: u32,
}

impl Ray {
    /// A ray from `origin` along `direction`, without an end, at time 0, seeing everything.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, time: 0.0, mask: u32::MAX }
    }

    /// The same ray at another time.
    pub fn at_time(mut self, time: f32) -> Self {
        self.time = time;
        self
    }

    /// The same ray, ending before `t_max`.
    pub fn until(mut self, t_max: f32) -> Self {
        self.t_max = t_max;
        self
    }

    /// The point at parameter `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
