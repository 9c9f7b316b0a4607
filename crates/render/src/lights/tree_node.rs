//! A node of the tree of lights: what is known of the lights below it, and how much they could send to a point (Conty Estevez &
//! Kulla 2018, equation 3).

use super::cone::Cone;
use core::f64::consts::FRAC_PI_2;
use kirkas_geometry::elementary::{cos, sin};
use kirkas_geometry::{Bounds3, Vec3};

/// What is known of one light, or of many together.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds {
    /// Where light leaves from.
    pub bounds: Bounds3,
    /// Normals of what shines.
    pub normals: Cone,
    /// How far from a normal light goes, radians.
    pub spread: f64,
    /// W, all lanes together.
    pub power: f64,
}

impl LightBounds {
    /// Light that goes everywhere from within a box.
    pub fn all_around(bounds: Bounds3, power: f64) -> Self {
        LightBounds { bounds, normals: Cone::ALL, spread: FRAC_PI_2, power }
    }

    /// Both together.
    pub fn union(&self, other: &Self) -> Self {
        LightBounds {
            bounds: self.bounds.union(other.bounds),
            normals: self.normals.union(other.normals),
            spread: self.spread.max(other.spread),
            power: self.power + other.power,
        }
    }
}

/// One light, or two subtrees that stand side by side in the list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    center: Vec3,
    /// Of the sphere around the box, widened by rounding.
    radius: f32,
    axis: Vec3,
    cos_normals: f32,
    sin_normals: f32,
    /// Cosine of the spread, widened.
    cos_spread: f32,
    pub(super) power: f32,
    /// The first of two children, or a light.
    pub(super) link: Link,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Link {
    Children(u32),
    Light(u32),
}

impl Node {
    pub(super) fn new(b: &LightBounds, link: Link) -> Self {
        let center = b.bounds.center();
        let far = center.abs().max_element();
        // Points are rounded to f32, and the sphere must hold the box when seen from there.
        let radius = 0.5 * b.bounds.extent().length() * 1.000_01 + far * 1e-6 + f32::MIN_POSITIVE;
        // Beyond a right angle from the normals, light of wider spread is that of wider normals.
        let wider = (b.spread - FRAC_PI_2).max(0.0);
        let angle = (b.normals.angle + wider).min(core::f64::consts::PI);
        Node {
            center,
            radius,
            axis: b.normals.axis.as_vec3(),
            cos_normals: cos(angle) as f32,
            sin_normals: sin(angle) as f32,
            cos_spread: cos(b.spread.min(FRAC_PI_2)) as f32 - SLACK,
            power: (b.power as f32).clamp(f32::MIN_POSITIVE, 1e30),
            link,
        }
    }

    /// An estimate of the light that arrives at `point` on a surface of this normal (zero: on none), for lights spread evenly
    /// through the sphere. 0 only if none can arrive.
    ///
    /// Conty Estevez & Kulla 2018, equation 3, with the cosines of the nearest directions only where they decide about 0.
    /// The mean of `cos / d^2` over a ball above the horizon is that of its centre (Newton's shell theorem), and that is
    /// what a good share follows.
    pub(super) fn importance(&self, point: Vec3, normal: Vec3) -> f32 {
        let to = self.center - point;
        let (d2, r2) = (to.length_squared(), self.radius * self.radius);
        let has_normal = normal != Vec3::ZERO;
        if d2 <= r2 {
            // Within the ball: from the mean at its centre, 3/4 or 3 over r^2, to that at its border.
            let share = (d2 / r2).sqrt();
            let cosine = if has_normal && d2 > 0.0 { normal.dot(to) / d2.sqrt() } else { 0.0 };
            let (middle, border) = if has_normal { (0.75, above_horizon(cosine, 1.0)) } else { (3.0, 1.0) };
            return self.power / r2 * (middle + (border - middle) * share).max(GRAZING);
        }
        let inverse = 1.0 / d2.sqrt();
        let sin_u = self.radius * inverse;
        let mut share = inverse * inverse;

        // What the lights' normals say ...
        if self.cos_normals > -1.0 {
            let cos_u = (1.0 - sin_u * sin_u).max(0.0).sqrt();
            let cos_theta = -self.axis.dot(to) * inverse;
            let (cos_x, sin_x) = nearer(cos_theta, sine(cos_theta), self.cos_normals, self.sin_normals);
            let (cos_nearest, _) = nearer(cos_x, sin_x, cos_u, sin_u);
            if cos_nearest <= self.cos_spread {
                return 0.0;
            }
            let is_lambert = self.cos_spread <= 0.0;
            share *= if is_lambert { above_horizon(cos_x, sin_u) } else { cos_nearest }.max(GRAZING);
        }

        // ... and what the surface's does.
        if has_normal {
            let cosine = normal.dot(to) * inverse;
            if cosine <= -sin_u - SLACK {
                return 0.0;
            }
            share *= above_horizon(cosine, sin_u).max(GRAZING);
        }
        (self.power * share).max(f32::MIN_POSITIVE)
    }
}

/// No cosine counts for less: bounds are crude where light grazes.
const GRAZING: f32 = 1e-3;

/// The mean cosine of a ball in the direction of this cosine, `sin_u` being the sine of the angle under which its radius is
/// seen: that of the centre while the ball is above the horizon, fading to 0 where it has set.
fn above_horizon(cosine: f32, sin_u: f32) -> f32 {
    if cosine >= sin_u {
        return cosine;
    }
    let rest = (cosine + sin_u).max(0.0);
    rest * rest / (4.0 * sin_u)
}

/// By how much cosines are taken to be wrong.
const SLACK: f32 = 1e-4;

fn sine(cosine: f32) -> f32 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}

/// Cosine and sine of `max(a - b, 0)`, both angles from 0 to pi.
fn nearer(cos_a: f32, sin_a: f32, cos_b: f32, sin_b: f32) -> (f32, f32) {
    if cos_a >= cos_b {
        return (1.0, 0.0);
    }
    (cos_a * cos_b + sin_a * sin_b, sin_a * cos_b - cos_a * sin_b)
}
