//! Integrals over directions.

use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{cos, sin};
use std::f64::consts::PI;

/// Steps in height and longitude.
const ROWS: usize = 24;
const COLUMNS: usize = 48;

/// The integral of `f` over all directions, per solid angle, to about 1e-5.
pub fn integrate_sphere(f: impl Fn(Vec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            sum += integrate_cell(&f, Cell::of_grid(row, ROWS, column, COLUMNS));
        }
    }
    sum
}

/// A patch of the sphere, bounded by two heights and two longitudes; its solid angle is `(z1 - z0)(phi1 - phi0)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    z0: f64,
    z1: f64,
    phi0: f64,
    phi1: f64,
}

impl Cell {
    pub(crate) fn of_grid(row: usize, rows: usize, column: usize, columns: usize) -> Cell {
        let z = |i: usize| -1.0 + 2.0 * i as f64 / rows as f64;
        let phi = |i: usize| -PI + 2.0 * PI * i as f64 / columns as f64;
        Cell { z0: z(row), z1: z(row + 1), phi0: phi(column), phi1: phi(column + 1) }
    }

    fn quarters(self) -> [Cell; 4] {
        let (z, phi) = (0.5 * (self.z0 + self.z1), 0.5 * (self.phi0 + self.phi1));
        [
            Cell { z1: z, phi1: phi, ..self },
            Cell { z0: z, phi1: phi, ..self },
            Cell { z1: z, phi0: phi, ..self },
            Cell { z0: z, phi0: phi, ..self },
        ]
    }

    /// Gauss & Legendre, three points each way.
    fn gauss(self, f: &impl Fn(Vec3) -> f64) -> f64 {
        const NODES: [(f64, f64); 3] =
            [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
        let (dz, dphi) = (0.5 * (self.z1 - self.z0), 0.5 * (self.phi1 - self.phi0));
        let mut sum = 0.0;
        for (a, wa) in NODES {
            for (b, wb) in NODES {
                let direction = spherical(0.5 * (self.z0 + self.z1) + a * dz, 0.5 * (self.phi0 + self.phi1) + b * dphi);
                sum += wa * wb * f(direction);
            }
        }
        sum * dz * dphi
    }
}

/// The direction at height `z` and longitude `phi`.
pub fn spherical(z: f64, phi: f64) -> Vec3 {
    let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    Vec3::new((r * cos(phi)) as f32, (r * sin(phi)) as f32, z as f32)
}

/// Adaptive: each patch is halved both ways until that changes nothing. Two halvings come first, so that a narrow peak
/// is not missed.
pub(crate) fn integrate_cell(f: &impl Fn(Vec3) -> f64, cell: Cell) -> f64 {
    cell.quarters().iter().flat_map(|q| q.quarters()).map(|c| refine(f, c, c.gauss(f), 8)).sum()
}

fn refine(f: &impl Fn(Vec3) -> f64, cell: Cell, coarse: f64, depth: u32) -> f64 {
    let parts = cell.quarters().map(|c| (c, c.gauss(f)));
    let fine: f64 = parts.iter().map(|p| p.1).sum();
    // The relative part keeps above the rounding of densities in f32.
    if depth == 0 || (fine - coarse).abs() < 1e-8 + 1e-5 * fine.abs() {
        return fine;
    }
    parts.iter().map(|&(c, v)| refine(f, c, v, depth - 1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::elementary::pow;

    #[test]
    fn integrals_over_the_sphere_meet_their_closed_forms() {
        assert!((integrate_sphere(|_| 1.0) - 4.0 * PI).abs() < 1e-9);
        assert!((integrate_sphere(|w| f64::from(w.x * w.x)) - 4.0 * PI / 3.0).abs() < 1e-6);
        assert!((integrate_sphere(|w| f64::from(w.z.max(0.0))) - PI).abs() < 1e-6);
        // A lobe two degrees wide, off the grid's lines.
        let axis = spherical(0.3, 0.7);
        let lobe = |w: Vec3| 2001.0 / (2.0 * PI) * pow(f64::from(w.dot(axis).max(0.0)), 2000.0);
        assert!((integrate_sphere(lobe) - 1.0).abs() < 1e-4);
    }
}
