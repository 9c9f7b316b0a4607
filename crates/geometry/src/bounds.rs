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

    /// The slab test: the interval of `t` inside the box, or `None`. `inverse_direction` is [`safe_inverse`].
    ///
    /// Monotone: a box that holds this one answers with an interval that holds this one's, because each plane's
    /// distance is a monotone function of the plane and the far side is padded by the same factor
    /// (Ize 2013, "Robust BVH Ray Traversal"; see [`FAR_PAD`]). A ray that runs within a face is inside.
    #[inline]
    pub fn intersect(&self, ray: &Ray, inverse_direction: Vec3) -> Option<(f32, f32)> {
        let (mut near, mut far) = (ray.t_min, f32::INFINITY);
        for axis in 0..3 {
            let inverse = inverse_direction[axis];
            let (a, b) = (self.min[axis], self.max[axis]);
            let (enter, leave) = if inverse.is_sign_negative() { (b, a) } else { (a, b) };
            let enter = (enter - ray.origin[axis]) * inverse;
            let leave = (leave - ray.origin[axis]) * inverse;
            // `0 * infinity`, a ray within a face, is NaN: it loses both comparisons and so limits nothing.
            near = if enter > near { enter } else { near };
            far = if leave < far { leave } else { far };
        }
        far = pad_far(far);
        far = if ray.t_max < far { ray.t_max } else { far };
        (near <= far).then_some((near, far))
    }
}

/// How much later than computed a ray is taken to leave a box: `1 + 2 gamma(10)`. 3 roundings are the box test's own; the
/// other 7 cover a watertight triangle test whose vertices are displaced by a few roundings of their distance.
pub const FAR_PAD: f32 = 1.0 + 2.0 * crate::rounding::gamma(10);

/// A little after `far`, whatever its sign; monotone.
#[inline(always)]
pub fn pad_far(far: f32) -> f32 {
    let (after, before) = (far * FAR_PAD, far * (2.0 - FAR_PAD));
    if after > before { after } else { before }
}

/// `1 / direction`; a zero gives the infinity of its sign, which [`Bounds3::intersect`] knows how to use.
#[inline]
pub fn safe_inverse(direction: Vec3) -> Vec3 {
    Vec3::new(1.0 / direction.x, 1.0 / direction.y, 1.0 / direction.z)
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
    fn a_ray_within_a_face_is_inside() {
        let b = Bounds3::from_corners(Vec3::splat(-1.0), Vec3::splat(1.0));
        for y in [-1.0, 1.0] {
            for direction in [Vec3::Z, Vec3::new(-0.0, -0.0, 1.0)] {
                let ray = Ray::new(Vec3::new(0.0, y, -5.0), direction);
                assert_eq!(b.intersect(&ray, safe_inverse(direction)).unwrap().0, 4.0);
                let beside = Ray::new(Vec3::new(0.0, y * 1.0001, -5.0), direction);
                assert_eq!(b.intersect(&beside, safe_inverse(direction)), None);
            }
        }
        let all = Bounds3::EVERYTHING;
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        assert_eq!(all.intersect(&ray, safe_inverse(ray.direction)), Some((0.0, f32::INFINITY)));
    }

    #[test]
    fn rounding_an_f64_box_never_shrinks_it() {
        let (lo, hi) = (DVec3::splat(0.1), DVec3::splat(0.7));
        let b = Bounds3::around_f64(lo, hi);
        assert!(b.min.as_dvec3().cmple(lo).all() && b.max.as_dvec3().cmpge(hi).all());
    }
}
