//! Chooses among evenly spaced planes, for scenes that are built anew often: the cost is sampled at a few places per axis
//! (Hunt, Mark & Stoll 2006, "Fast kd-tree Construction with an Adaptive Error-Bounded Heuristic"), by counting in which bin
//! each box begins and ends. The samples span what is in the cell, so that the outermost ones cut off empty space.

use super::Primitives;
use super::build::{Plane, PlaneCosts, Splitter};
use kirkas_geometry::Bounds3;

/// Bins of an axis, in cells with more than [`MANY`] primitives and in others.
const BINS: usize = 32;
const FEW_BINS: usize = 8;
const MANY: usize = 24;

pub(super) struct Binned<'a>(pub Primitives<'a>);

/// The part of a primitive within a cell.
pub(super) struct Piece {
    bounds: Bounds3,
    primitive: u32,
}

impl Splitter for Binned<'_> {
    type Pieces = Vec<Piece>;
    type Scratch = ();

    fn all(&self) -> Vec<Piece> {
        let piece =
            |(i, r): (usize, &crate::build::reference::Reference)| Piece { bounds: r.bounds(), primitive: i as u32 };
        self.0.references.iter().enumerate().map(piece).collect()
    }

    fn scratch(&self) {}

    fn count(&self, pieces: &Vec<Piece>) -> usize {
        pieces.len()
    }

    fn best_plane(&self, cell: &Bounds3, pieces: &Vec<Piece>) -> Option<Plane> {
        match pieces.len() {
            0..=MANY => best_of::<FEW_BINS>(cell, pieces),
            _ => best_of::<BINS>(cell, pieces),
        }
    }

    fn divide(&self, pieces: &Vec<Piece>, plane: &Plane, cells: &[Bounds3; 2], _: &mut ()) -> [Vec<Piece>; 2] {
        let mut halves = [Vec::new(), Vec::new()];
        for &Piece { bounds, primitive } in pieces {
            let (low, high) = (bounds.min[plane.axis], bounds.max[plane.axis]);
            if low < plane.position && high > plane.position {
                for (half, bounds) in halves.iter_mut().zip(self.0.cut(primitive, cells)) {
                    if !bounds.is_empty() {
                        half.push(Piece { bounds, primitive });
                    }
                }
            } else {
                let right = high > plane.position || (low == plane.position && !plane.flat_left);
                halves[usize::from(right)].push(Piece { bounds, primitive });
            }
        }
        halves
    }

    fn list(&self, pieces: &Vec<Piece>, out: &mut Vec<u32>) {
        out.extend(pieces.iter().map(|p| p.primitive));
    }
}

/// The best of the planes between bins.
fn best_of<const BINS: usize>(cell: &Bounds3, pieces: &[Piece]) -> Option<Plane> {
    let span = pieces.iter().fold(Bounds3::EMPTY, |b, p| b.union(p.bounds));
    let step = [0, 1, 2].map(|k| span.max[k] / BINS as f32 - span.min[k] / BINS as f32);
    let per_step = step.map(|s| if s > 0.0 && (1.0 / s).is_finite() { 1.0 / s } else { 0.0 });
    let (mut starts, mut ends) = ([[0_u32; BINS]; 3], [[0_u32; BINS]; 3]);
    for p in pieces {
        for k in 0..3 {
            let bin = |x: f32| (((x - span.min[k]) * per_step[k]) as usize).min(BINS - 1);
            starts[k][bin(p.bounds.min[k])] += 1;
            ends[k][bin(p.bounds.max[k])] += 1;
        }
    }
    let costs = PlaneCosts::new(cell);
    let mut best = None;
    for k in 0..3 {
        let (mut left, mut right) = (0, pieces.len());
        for i in 0..BINS {
            costs.offer(&mut best, k, span.min[k] + i as f32 * step[k], [left, 0, right]);
            left += starts[k][i] as usize;
            right -= ends[k][i] as usize;
        }
        costs.offer(&mut best, k, span.max[k], [left, 0, right]);
    }
    best
}
