//! Cones of directions: where the normals of a group of lights point.

use core::f64::consts::PI;
use kirkas_geometry::DVec3;
use kirkas_geometry::elementary::{acos, cos, sin};

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit.
    pub axis: DVec3,
    /// Half angle, radians, 0 to pi.
    pub angle: f64,
}

impl Cone {
    /// Every direction.
    pub const ALL: Self = Cone { axis: DVec3::Z, angle: PI };

    /// One direction (unit).
    pub fn of(axis: DVec3) -> Self {
        Cone { axis, angle: 0.0 }
    }

    /// A cone around directions (of any length; zero ones say nothing): not the smallest one, but near it. All of them
    /// lie within it but for rounding. Every direction where there is none.
    pub fn around(directions: impl Iterator<Item = DVec3> + Clone) -> Self {
        let units = directions.map(DVec3::normalize_or_zero).filter(|d| *d != DVec3::ZERO);
        let Some(axis) = units.clone().sum::<DVec3>().try_normalize() else { return Cone::ALL };
        let cosine = units.fold(1.0_f64, |least, d| least.min(d.dot(axis)));
        Cone { axis, angle: acos(cosine.max(-1.0)) }
    }

    /// A cone that holds both (Conty Estevez & Kulla 2018, algorithm 1).
    pub fn union(self, other: Self) -> Self {
        let (a, b) = if self.angle >= other.angle { (self, other) } else { (other, self) };
        let between = acos(a.axis.dot(b.axis).clamp(-1.0, 1.0));
        if (between + b.angle).min(PI) <= a.angle {
            return a;
        }
        let angle = 0.5 * (a.angle + between + b.angle);
        let aside = (b.axis - a.axis * a.axis.dot(b.axis)).try_normalize();
        match aside {
            Some(aside) if angle < PI => {
                let turn = angle - a.angle;
                Cone { axis: (a.axis * cos(turn) + aside * sin(turn)).normalize(), angle }
            }
            _ => Cone { angle: PI, ..a },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::warp::square_to_uniform_sphere;
    use kirkas_testkit::Random;

    #[test]
    fn a_union_holds_both_and_no_more_than_it_must() {
        let mut r = Random::new(4);
        let mut direction = || square_to_uniform_sphere(r.pair()).as_dvec3().normalize();
        for i in 0..2000 {
            let spread = [0.0, 0.3, 1.2, 3.0][i % 4];
            let a = Cone { axis: direction(), angle: spread * 0.7 };
            let b = Cone { axis: if i % 7 == 0 { a.axis } else { direction() }, angle: spread };
            let both = a.union(b);
            let between = |c: Cone| acos(c.axis.dot(both.axis).clamp(-1.0, 1.0));
            for c in [a, b] {
                assert!(both.angle == PI || between(c) + c.angle <= both.angle + 1e-6, "{a:?} {b:?} {both:?}");
            }
            assert!(both.angle <= a.angle.max(b.angle).max(0.5 * (a.angle + b.angle + PI)) + 1e-9);
        }
    }

    #[test]
    fn opposite_directions_make_a_half_space_of_any_side_or_more() {
        assert!(Cone::of(DVec3::X).union(Cone::of(-DVec3::X)).angle >= PI / 2.0);
        assert_eq!(Cone::around([DVec3::X, -DVec3::X].into_iter()), Cone::ALL);
        assert_eq!(Cone::around([DVec3::ZERO].into_iter()), Cone::ALL);
        let right = Cone::around([DVec3::X, DVec3::Y * 9.0].into_iter());
        assert!((right.angle - PI / 4.0).abs() < 1e-12);
    }
}
