//! Integrals over directions.

use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{acos, cos, sin};
use std::f64::consts::PI;

/// Steps in height and longitude.
const ROWS: usize = 24;
const COLUMNS: usize = 48;

/// The integral of `f` over all directions, per solid angle: to about 1e-5 where `f` is smooth, 1e-4 where it breaks off.
pub fn integrate_sphere(f: impl Fn(Vec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            sum += integrate_cell(&f, Cell::of_grid(row, ROWS, column, COLUMNS), 1e-5);
        }
    }
    sum
}

/// A patch of the sphere, bounded by two polar angles and two longitudes. (Angles, not heights: a lobe at the pole is as
/// wide as one elsewhere.)
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    theta0: f64,
    theta1: f64,
    phi0: f64,
    phi1: f64,
}

impl Cell {
    /// One of a grid of equal solid angles: steps in height from -1 up, and in longitude from -pi.
    pub(crate) fn of_grid(row: usize, rows: usize, column: usize, columns: usize) -> Cell {
        let theta = |i: usize| acos(-1.0 + 2.0 * i as f64 / rows as f64);
        let phi = |i: usize| -PI + 2.0 * PI * i as f64 / columns as f64;
        Cell { theta0: theta(row + 1), theta1: theta(row), phi0: phi(column), phi1: phi(column + 1) }
    }

    fn quarters(self) -> [Cell; 4] {
        let (theta, phi) = (0.5 * (self.theta0 + self.theta1), 0.5 * (self.phi0 + self.phi1));
        [
            Cell { theta1: theta, phi1: phi, ..self },
            Cell { theta0: theta, phi1: phi, ..self },
            Cell { theta1: theta, phi0: phi, ..self },
            Cell { theta0: theta, phi0: phi, ..self },
        ]
    }

    /// Gauss & Lobatto, four points each way. The outer ones stand at the very edge (a hair inside, since densities break
    /// off at the horizon, where cells end), so that a break just within the cell is noticed.
    fn lobatto(self, f: &impl Fn(Vec3) -> f64) -> f64 {
        const EDGE: f64 = 1.0 - 1e-5;
        const INNER: f64 = 0.447_213_595_499_957_94;
        const NODES: [(f64, f64); 4] = [(-EDGE, 1.0 / 6.0), (-INNER, 5.0 / 6.0), (INNER, 5.0 / 6.0), (EDGE, 1.0 / 6.0)];
        let (half_theta, half_phi) = (0.5 * (self.theta1 - self.theta0), 0.5 * (self.phi1 - self.phi0));
        let mut sum = 0.0;
        for (a, wa) in NODES {
            let theta = 0.5 * (self.theta0 + self.theta1) + a * half_theta;
            for (b, wb) in NODES {
                let phi = 0.5 * (self.phi0 + self.phi1) + b * half_phi;
                sum += wa * wb * sin(theta) * f(spherical(cos(theta), phi));
            }
        }
        sum * half_theta * half_phi
    }
}

/// The direction at height `z` and longitude `phi`.
pub fn spherical(z: f64, phi: f64) -> Vec3 {
    let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    Vec3::new((r * cos(phi)) as f32, (r * sin(phi)) as f32, z as f32)
}

/// Adaptive: each patch is halved both ways until that changes it by no more than `relative`. One halving comes first, so
/// that a narrow peak is not missed.
pub(crate) fn integrate_cell(f: &impl Fn(Vec3) -> f64, cell: Cell, relative: f64) -> f64 {
    cell.quarters().into_iter().map(|c| refine(f, c, c.lobatto(f), relative, 9)).sum()
}

fn refine(f: &impl Fn(Vec3) -> f64, cell: Cell, coarse: f64, relative: f64, depth: u32) -> f64 {
    let parts = cell.quarters().map(|c| (c, c.lobatto(f)));
    let fine: f64 = parts.iter().map(|p| p.1).sum();
    if depth == 0 || (fine - coarse).abs() < 1e-3 * relative + relative * fine.abs() {
        return fine;
    }
    parts.iter().map(|&(c, v)| refine(f, c, v, relative, depth - 1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::elementary::pow;

    #[test]
    fn integrals_over_the_sphere_meet_their_closed_forms() {
        assert!((integrate_sphere(|_| 1.0) - 4.0 * PI).abs() < 1e-5);
        assert!((integrate_sphere(|w| f64::from(w.x * w.x)) - 4.0 * PI / 3.0).abs() < 1e-5);
        assert!((integrate_sphere(|w| f64::from(w.z.max(0.0))) - PI).abs() < 1e-5);
        // A lobe two degrees wide, off the grid's lines.
        let axis = spherical(0.3, 0.7);
        let lobe = |w: Vec3| 2001.0 / (2.0 * PI) * pow(f64::from(w.dot(axis).max(0.0)), 2000.0);
        assert!((integrate_sphere(lobe) - 1.0).abs() < 1e-4);
    }
}
