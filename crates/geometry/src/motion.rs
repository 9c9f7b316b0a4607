//! Transforms that move: key frames, each split into translation, rotation and stretch, interpolated apart.
//!
//! After Shoemake & Duff 1992, "Matrix Animation and Polar Decomposition": `M = T R S`; T and S linearly, R by slerp.
//! Moving groups inside moving groups are products of several such motions.

use crate::elementary::{acos, sin};
use crate::{Bounds3, DAffine3, DMat3, DVec3};
use glam::DQuat;

/// A transform as a function of time. Before the first and after the last key it stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimatedTransform {
    /// Outermost first; never empty, each with at least one key.
    links: Vec<Vec<Key>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Key {
    time: f64,
    matrix: DAffine3,
    rotation: DQuat,
    stretch: DMat3,
}

impl AnimatedTransform {
    /// One that never moves.
    pub fn still(matrix: DAffine3) -> Self {
        AnimatedTransform { links: vec![vec![Key::new(0.0, matrix)]] }
    }

    /// Key frames `(time, matrix)`. `None` when there are none, a time is not after the one before, or a matrix cannot be inverted.
    pub fn from_keys(keys: &[(f64, DAffine3)]) -> Option<Self> {
        let rising = keys.windows(2).all(|w| w[0].0 < w[1].0);
        let sound = keys.iter().all(|k| k.0.is_finite() && crate::transform::is_invertible(&k.1));
        (!keys.is_empty() && rising && sound)
            .then(|| AnimatedTransform { links: vec![keys.iter().map(|&(t, m)| Key::new(t, m)).collect()] })
    }

    /// True when it differs between two times.
    pub fn is_moving(&self) -> bool {
        self.links.iter().any(|keys| keys.windows(2).any(|w| w[0].matrix != w[1].matrix))
    }

    /// The map at `time`.
    pub fn at(&self, time: f64) -> DAffine3 {
        let first = at(&self.links[0], time);
        self.links[1..].iter().fold(first, |m, keys| m * at(keys, time))
    }

    /// A box that holds `object` at every time of `[start, end]`.
    ///
    /// Samples the motion and pads by how far a corner can travel between samples: an arc deviates from its chord by at
    /// most the square of its length over eight radii, bounded here by the chord itself times a safety factor.
    pub fn swept_bounds(&self, object: &Bounds3, start: f64, end: f64) -> Bounds3 {
        if !self.is_moving() || start >= end {
            return object.transformed(&self.at(start));
        }
        if object.is_empty() || !object.is_finite() {
            return *object;
        }
        const STEPS: usize = 64;
        let mut times: Vec<f64> = (0..=STEPS).map(|i| start + (end - start) * i as f64 / STEPS as f64).collect();
        times.extend(self.key_times().filter(|t| (start..=end).contains(t)));
        times.sort_by(f64::total_cmp);
        let boxes: Vec<Bounds3> = times.iter().map(|&t| object.transformed(&self.at(t))).collect();
        let mut all = boxes.iter().fold(Bounds3::EMPTY, |b, &c| b.union(c));
        let mut travel = 0.0_f32;
        for (w, b) in times.windows(2).zip(boxes.windows(2)) {
            let (m0, m1) = (self.at(w[0]), self.at(w[1]));
            for corner in 0..8 {
                let pick = |bit: usize, lo: f32, hi: f32| f64::from(if corner >> bit & 1 == 0 { lo } else { hi });
                let p = DVec3::new(
                    pick(0, object.min.x, object.max.x),
                    pick(1, object.min.y, object.max.y),
                    pick(2, object.min.z, object.max.z),
                );
                travel = travel.max((m1.transform_point3(p) - m0.transform_point3(p)).length() as f32);
            }
            debug_assert!(!b[0].is_empty());
        }
        let pad = DVec3::splat(f64::from(travel) * 0.5);
        all = Bounds3::around_f64(all.min.as_dvec3() - pad, all.max.as_dvec3() + pad);
        all
    }

    /// This motion, seen from a space that itself moves by `outer`: `outer(t) * self(t)`.
    pub fn within(&self, outer: &AnimatedTransform) -> Self {
        let fixed = |m: &AnimatedTransform| (!m.is_moving()).then(|| m.at(0.0));
        if let Some((a, b)) = fixed(outer).zip(fixed(self)) {
            return AnimatedTransform::still(a * b);
        }
        AnimatedTransform { links: outer.links.iter().chain(&self.links).cloned().collect() }
    }

    /// All numbers that define it, in an order of their own: motions that give the same are the same.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let key = |k: &Key| [k.time].into_iter().chain(k.matrix.to_cols_array());
        self.links.iter().flat_map(move |keys| [keys.len() as f64].into_iter().chain(keys.iter().flat_map(key)))
    }

    /// The times of all key frames.
    pub fn key_times(&self) -> impl Iterator<Item = f64> + '_ {
        self.links.iter().flatten().map(|k| k.time)
    }
}

/// One motion's map at `time`.
fn at(keys: &[Key], time: f64) -> DAffine3 {
    let next = keys.partition_point(|k| k.time <= time);
    if next == 0 {
        return keys[0].matrix;
    }
    if next == keys.len() {
        return keys[next - 1].matrix;
    }
    let (a, b) = (&keys[next - 1], &keys[next]);
    if a.matrix == b.matrix {
        return a.matrix;
    }
    let s = (time - a.time) / (b.time - a.time);
    let rotation = DMat3::from_quat(slerp(a.rotation, b.rotation, s));
    let stretch = a.stretch * (1.0 - s) + b.stretch * s;
    let translation = a.matrix.translation * (1.0 - s) + b.matrix.translation * s;
    DAffine3 { matrix3: rotation * stretch, translation }
}

impl Key {
    fn new(time: f64, matrix: DAffine3) -> Self {
        let (rotation, stretch) = polar(matrix.matrix3);
        Key { time, matrix, rotation, stretch }
    }
}

/// `M = R S` with R a proper rotation and S symmetric, by Newton's iteration (Higham 1986).
fn polar(m: DMat3) -> (DQuat, DMat3) {
    let mut r = m;
    for _ in 0..60 {
        if r.determinant() == 0.0 {
            break;
        }
        let next = (r + r.inverse().transpose()) * 0.5;
        let change =
            (next.x_axis - r.x_axis).length() + (next.y_axis - r.y_axis).length() + (next.z_axis - r.z_axis).length();
        r = next;
        if change < 1e-15 {
            break;
        }
    }
    if r.determinant() < 0.0 {
        r *= -1.0;
    }
    (DQuat::from_mat3(&r), r.transpose() * m)
}

fn slerp(a: DQuat, b: DQuat, s: f64) -> DQuat {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let cosine = a.dot(b).min(1.0);
    if cosine > 1.0 - 1e-12 {
        return (a * (1.0 - s) + b * s).normalize();
    }
    let angle = acos(cosine);
    let q = a * (sin((1.0 - s) * angle) / sin(angle)) + b * (sin(s * angle) / sin(angle));
    q.normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::transform::rotation;

    fn spinning() -> AnimatedTransform {
        let key = |deg: f64, x: f64| DAffine3 {
            matrix3: rotation(DVec3::Z, deg) * DMat3::from_diagonal(DVec3::new(2.0, 1.0, 1.0)),
            translation: DVec3::new(x, 0.0, 0.0),
        };
        AnimatedTransform::from_keys(&[(0.0, key(0.0, 0.0)), (1.0, key(90.0, 4.0))]).unwrap()
    }

    #[test]
    fn halfway_is_half_the_turn_and_half_the_way() {
        let m = spinning().at(0.5);
        let expected = rotation(DVec3::Z, 45.0) * DVec3::new(2.0, 0.0, 0.0) + DVec3::new(2.0, 0.0, 0.0);
        assert!((m.transform_point3(DVec3::X) - expected).length() < 1e-12);
    }

    #[test]
    fn swept_bounds_hold_every_moment() {
        let m = spinning();
        let unit = Bounds3::from_corners(Vec3::splat(-1.0), Vec3::splat(1.0));
        let swept = m.swept_bounds(&unit, 0.0, 1.0);
        for i in 0..=1000 {
            let b = unit.transformed(&m.at(f64::from(i) / 1000.0));
            assert_eq!(swept.union(b), swept);
        }
    }

    #[test]
    fn a_motion_within_a_motion_is_their_product() {
        let (a, b) = (spinning(), spinning());
        let both = a.within(&b);
        let p = DVec3::new(0.3, -0.2, 1.0);
        let expected = b.at(0.3).transform_point3(a.at(0.3).transform_point3(p));
        assert!((both.at(0.3).transform_point3(p) - expected).length() < 1e-12);
        assert!(both.is_moving() && both.key_times().count() == 4);
    }

    #[test]
    fn broken_keys_are_refused() {
        let id = DAffine3::IDENTITY;
        assert!(AnimatedTransform::from_keys(&[]).is_none());
        assert!(AnimatedTransform::from_keys(&[(1.0, id), (1.0, id)]).is_none());
        assert!(AnimatedTransform::from_keys(&[(0.0, DAffine3::ZERO)]).is_none());
    }
}
