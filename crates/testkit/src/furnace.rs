//! Energy and symmetry of scattering functions, given as closures.

use crate::sphere::{integrate_sphere, spherical};
use crate::{Random, sphere};
use kirkas_geometry::Vec3;

/// A mean of random numbers and how far it may be off.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Estimate {
    /// From any numbers.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        // Welford's recurrence.
        let (mut n, mut mean, mut squares) = (0.0, 0.0, 0.0);
        for x in values {
            n += 1.0;
            let d = x - mean;
            mean += d / n;
            squares += d * (x - mean);
        }
        Estimate { mean, standard_error: (squares / (n * (n - 1.0))).sqrt() }
    }

    /// Standard errors between the mean and `truth`; rounding of 1e-6 is let pass.
    pub fn z(&self, truth: f64) -> f64 {
        let off = ((self.mean - truth).abs() - 1e-6 * truth.abs()).max(0.0);
        if off == 0.0 { 0.0 } else { off / self.standard_error }
    }
}

/// The directional albedo: the integral of `f(wi) |cos|` over the sphere, where `f` is without cosine. In a furnace of
/// radiance 1 all round this is what the surface shows.
pub fn albedo_by_quadrature(f: impl Fn(Vec3) -> f64) -> f64 {
    integrate_sphere(|wi| f(wi) * f64::from(wi.z.abs()))
}

/// The same as the mean of what a sampler's weights `f |cos| / pdf` give (0 for a failed sample).
pub fn albedo_by_sampling(samples: usize, seed: u64, mut weight: impl FnMut(f32, (f32, f32)) -> f64) -> Estimate {
    let mut random = Random::new(seed);
    Estimate::of((0..samples).map(|_| {
        let u = random.number();
        weight(u, random.pair())
    }))
}

/// The greatest difference between `f(a, b)` and `f(b, a)` over random pairs of directions, relative to the greater of the
/// two or to `floor`, below which values do not matter. Pass `f / eta_o^2` where light is transmitted.
pub fn reciprocity_error(pairs: usize, seed: u64, floor: f64, f: impl Fn(Vec3, Vec3) -> f64) -> f64 {
    let mut random = Random::new(seed);
    let mut direction = || {
        let (a, b) = random.pair();
        spherical(2.0 * f64::from(a) - 1.0, std::f64::consts::TAU * f64::from(b))
    };
    let mut worst = 0.0_f64;
    for _ in 0..pairs {
        let (a, b) = (direction(), direction());
        let (there, back) = (f(a, b), f(b, a));
        let scale = there.abs().max(back.abs()).max(floor);
        if scale > 0.0 {
            worst = worst.max((there - back).abs() / scale);
        }
    }
    worst
}

/// `n` directions on the +z side from straight up to `lowest` (the least z), around the compass.
pub fn directions_above(n: usize, lowest: f64) -> Vec<Vec3> {
    (0..n)
        .map(|i| {
            let s = i as f64 / (n.max(2) - 1) as f64;
            sphere::spherical(1.0 + s * (lowest - 1.0), 0.4 + 2.4 * i as f64)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::warp::square_to_uniform_sphere;
    use std::f64::consts::PI;

    #[test]
    fn both_albedos_of_a_grey_wall_are_its_grey() {
        let f = |w: Vec3| if w.z > 0.0 { 0.7 / PI } else { 0.0 };
        assert!((albedo_by_quadrature(f) - 0.7).abs() < 1e-6);
        let e = albedo_by_sampling(100_000, 3, |_, u| {
            let w = square_to_uniform_sphere(u);
            f(w) * f64::from(w.z.abs()) * 4.0 * PI
        });
        assert!(e.z(0.7) < 4.0 && e.z(0.72) > 4.0, "{e:?}");
    }

    #[test]
    fn an_estimate_knows_its_error() {
        let e = Estimate::of([1.0, 2.0, 3.0, 4.0]);
        assert_eq!(e.mean, 2.5);
        assert!((e.standard_error - (5.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-12);
        assert!((e.z(3.0) - 0.5 / e.standard_error).abs() < 1e-4);
    }

    #[test]
    fn a_lopsided_function_is_not_reciprocal() {
        assert!(reciprocity_error(100, 1, 1e-3, |a, b| f64::from(a.dot(b))) < 1e-6);
        assert!(reciprocity_error(100, 1, 1e-3, |a, b| f64::from(a.x.abs() + 1.1 * b.x.abs())) > 0.05);
    }

    #[test]
    fn directions_go_from_the_pole_down() {
        let all = directions_above(5, 0.05);
        assert_eq!((all.len(), all[0].z), (5, 1.0));
        assert!((all[4].z - 0.05).abs() < 1e-6 && all.iter().all(|w| (w.length() - 1.0).abs() < 1e-6));
    }
}
