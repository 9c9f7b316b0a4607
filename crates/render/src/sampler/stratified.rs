//! Multi-jittered samples: the square is cut into a grid with a cell for each of the `samples`, and no two share a cell, a
//! column or a row of the `samples` finer ones either.
//!
//! # Parameters
//! `samples` per pixel, the number that the grid is made for; `seed`.
//!
//! # Example
//! ```toml
//! [sampler]
//! type = "stratified"
//! samples = 64
//! ```
//!
//! # Limits
//! The grid belongs to one number of samples, so a picture cannot be given more of them later, nor until an error is
//! reached: both are refused. Best is a square number; a prime one has a single row of cells.
//!
//! # References
//! Cook 1986, "Stochastic Sampling in Computer Graphics"; Chiu, Shirley & Wang 1994, "Multi-Jittered Sampling".

use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::permutation::permuted;
use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Sampler,
    name: "stratified",
    doc: "Multi-jittered samples, of a number known beforehand.",
    params: &[
        ParamSpec::integer("samples", 16, (1.0, 1_073_741_824.0), "Samples per pixel: no more can be added."),
        super::sobol::SEED,
    ],
};

/// Point `index` of `total`.
pub(super) fn pair(index: u64, total: u64, seed: u64) -> (f32, f32) {
    let (columns, rows) = grid(total);
    let cell = permuted(index, total, combine(seed, 0));
    let (column, row) = (cell % columns, cell / columns);

    // Chiu, Shirley & Wang 1994: within its cell a point stands in a finer column, and a finer row, of its own.
    let finer_column = column * rows + permuted(row, rows, combine(seed, 2 * column + 1));
    let finer_row = row * columns + permuted(column, columns, combine(seed, 2 * row + 2));
    let jitter = combine(!seed, index);
    let place = |finer: u64, bits: u32| {
        const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
        (((finer as f64 + f64::from(unit_f32(bits))) / total as f64) as f32).min(BELOW_ONE)
    };
    (place(finer_column, jitter as u32), place(finer_row, (jitter >> 32) as u32))
}

/// Columns and rows of a grid of `total` cells, as near to a square as can be.
fn grid(total: u64) -> (u64, u64) {
    let mut rows = total.isqrt();
    while !total.is_multiple_of(rows) {
        rows -= 1;
    }
    (total / rows, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_points_share_a_cell_a_column_or_a_row() {
        for total in [1_u64, 7, 12, 16, 64, 90] {
            let (columns, rows) = grid(total);
            for seed in 0..10 {
                let points: Vec<_> = (0..total).map(|i| pair(i, total, seed)).collect();
                for (nx, ny) in [(columns, rows), (total, 1), (1, total)] {
                    let mut cells: Vec<u64> =
                        points.iter().map(|p| (p.0 * nx as f32) as u64 + nx * (p.1 * ny as f32) as u64).collect();
                    cells.sort_unstable();
                    assert_eq!(cells, (0..total).collect::<Vec<_>>(), "{total}: {nx} x {ny}");
                }
            }
        }
    }

    #[test]
    fn grids_are_near_to_squares() {
        assert_eq!([1, 7, 12, 64, 90].map(grid), [(1, 1), (7, 1), (4, 3), (8, 8), (10, 9)]);
    }
}
