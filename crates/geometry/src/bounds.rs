//! Axis-aligned boxes and the one box test that every structure shares.

use crate::{DAffine3, DVec3, Ray, Vec3};

/// An axis-aligned box. Empty when `min > max` on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// Lowest corner.
    pub min: Vec3,
    /// Highest corner.
    pub max: Vec3,
}

impl Bounds3 {
    /// The box with nothing in it.
    pub const EMPTY: Self = Bounds3 { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    /// The box with everything in it.
    pub const EVERYTHING: Self = Bounds3 { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

    /// The box with these two corners, given in any order.
    pub fn from_corners(a: Vec3, b: Vec3) -> Self {
        Bounds3 { min: a.min(b), max: a.max(b) }
    }

    /// The smallest box around some points.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.with_point(p))
    }

    /// The smallest f32 box that holds an f64 box.
    pub fn around_f64(min: DVec3, max: DVec3) -> Self {
        let down = |v: f64| {
            let f = v as f32;
            if f64::from(f) > v { f.next_down() } else { f }
        };
        let up = |v: f64| {
            let f = v as f32;
            if f64::from(f) < v { f.next_up() } else { f }
        };
        Bounds3 {
            min: Vec3::new(down(min.x), down(min.y), down(min.z)),
            max: Vec3::new(up(max.x), up(max.y), up(max.z)),
        }
    }

    /// This box, grown to hold `p`.
    pub fn with_point(self, p: Vec3) -> Self {
        Bounds3 { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        Bounds3 { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// What both share (perhaps empty).
    pub fn intersection(self, other: Self) -> Self {
        Bounds3 { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// True when nothing is inside.
    pub fn is_empty(&self) -> bool {
        !(self.min.cmple(self.max).all())
    }

    /// True when no coordinate is infinite or NaN.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// True when `p` is inside or on the boundary.
    pub fn contains(&self, p: Vec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Mid point.
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Edge lengths.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Total area of the six faces; 0 for the empty box.
    pub fn surface_area(&self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let e = self.extent();
        2.0 * (e.x * e.y + e.y * e.z + e.z * e.x)
    }

    /// The box around this one after an affine map, exact to outward rounding.
    pub fn transformed(&self, m: &DAffine3) -> Self {
        if self.is_empty() {
            return *self;
        }
        if !self.is_finite() {
            return Self::EVERYTHING;
        }
        let c = (self.min.as_dvec3() + self.max.as_dvec3()) * 0.5;
        let h = (self.max.as_dvec3() - self.min.as_dvec3()) * 0.5;
        let center = m.transform_point3(c);
        let a = &m.matrix3;
        let half = a.x_axis.abs() * h.x + a.y_axis.abs() * h.y + a.z_axis.abs() * h.z;
        let slack = (center.abs() + half) * 1e-15;
        Self::around_f64(center - half - slack, center + half + slack)
    }

    /// The slab test: the interval of `t` inside the box, or `None`.
    ///
    /// Monotone: a box that holds this one answers with an interval that holds this one's, because each plane's
    /// distance is a monotone function of the plane and the far side is padded by the same factor
    /// (Ize 2013, "Robust BVH Ray Traversal", `1 + 2 gamma(3)`).
    #[inline]
    pub fn intersect(&self, ray: &Ray, inverse_direction: Vec3) -> Option<(f32, f32)> {
        let t0 = (self.min - ray.origin) * inverse_direction;
        let t1 = (self.max - ray.origin) * inverse_direction;
        // `min`/`max` of a NaN (0 * infinity on a box face) with a number keep the number.
        let near = t0.x.min(t1.x).max(t0.y.min(t1.y)).max(t0.z.min(t1.z)).max(ray.t_min);
        let far = t0.x.max(t1.x).min(t0.y.max(t1.y)).min(t0.z.max(t1.z)) * FAR_PAD;
        let far = far.min(ray.t_max);
        (near <= far).then_some((near, far))
    }
}

const FAR_PAD: f32 = 1.0 + 2.0 * crate::rounding::gamma(3);

/// `1 / direction`, with zeros replaced by a huge finite number of the same sign so that no `0 * infinity` appears.
#[inline]
pub fn safe_inverse(direction: Vec3) -> Vec3 {
    let inv = |d: f32| if d.abs() < 1e-37 { 1e37_f32.copysign(d) } else { 1.0 / d };
    Vec3::new(inv(direction.x), inv(direction.y), inv(direction.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_through_the_middle_enters_and_leaves() {
        let b = Bounds3::from_corners(Vec3::splat(-1.0), Vec3::splat(1.0));
        let ray = Ray::new(Vec3::new(0.0, 0.0, -5.0), Vec3::Z);
        let (near, far) = b.intersect(&ray, safe_inverse(ray.direction)).unwrap();
        assert_eq!(near, 4.0);
        assert!((far - 6.0).abs() < 1e-5 && far >= 6.0);
        let miss = Ray::new(Vec3::new(2.0, 0.0, -5.0), Vec3::Z);
        assert_eq!(b.intersect(&miss, safe_inverse(miss.direction)), None);
    }

    #[test]
    fn rounding_an_f64_box_never_shrinks_it() {
        let (lo, hi) = (DVec3::splat(0.1), DVec3::splat(0.7));
        let b = Bounds3::around_f64(lo, hi);
        assert!(b.min.as_dvec3().cmple(lo).all() && b.max.as_dvec3().cmpge(hi).all());
    }
}
