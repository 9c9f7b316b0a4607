//! A ray in f64 near a primitive: measured from where it passes closest to the primitive's middle, along a unit direction, so
//! that what is far away costs no digits.

use crate::prepared_ray::PreparedRay;
use kirkas_geometry::DVec3;

/// Points `origin + s * direction`.
pub(crate) struct LocalRay {
    /// Where the ray passes closest to the middle, relative to it.
    pub origin: DVec3,
    /// Of length 1.
    pub direction: DVec3,
    /// Where the ray itself starts, relative to the middle.
    pub start: DVec3,
    /// `s` of the start, negated.
    shift: f64,
    /// Length of the ray's own direction.
    length: f64,
}

impl LocalRay {
    pub fn new(ray: &PreparedRay, middle: DVec3) -> Self {
        let direction = ray.clipped.direction.as_dvec3();
        let length = direction.length();
        let direction = direction * (1.0 / length);
        let start = ray.clipped.origin.as_dvec3() - middle;
        let shift = -start.dot(direction);
        LocalRay { origin: start + direction * shift, direction, start, shift, length }
    }

    /// The ray's own parameter.
    pub fn t(&self, s: f64) -> f64 {
        (self.shift + s) / self.length
    }

    /// Where the ray enters and leaves a ball about `center`, which is relative to the middle.
    pub fn through_ball(&self, center: DVec3, radius: f64) -> Option<[f64; 2]> {
        let to_origin = self.origin - center;
        let nearest = -to_origin.dot(self.direction);
        let off = to_origin + self.direction * nearest;
        let reach2 = radius * radius - off.dot(off);
        (reach2 > 0.0).then(|| [nearest - reach2.sqrt(), nearest + reach2.sqrt()])
    }
}

/// Two crossings of which one is where the ray starts, as far as f64 can tell: the other.
pub(crate) fn without_start(crossings: [f64; 2]) -> [f64; 2] {
    let [a, b] = crossings;
    if a.abs() < b.abs() { [f64::NAN, b] } else { [a, f64::NAN] }
}

/// Bound on the error of a distance from a surface, for sizes of 1: 16 roundings in f64.
pub(crate) const DISTANCE_ERROR: f64 = 8.0 * f64::EPSILON;
