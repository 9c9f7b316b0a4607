//! A grove: the leaves of a stretch of the curve, merged with their neighbours into fewer and larger clusters.

use super::codes::Key;
use super::leaves;
use crate::build::reference::{Box4, Reference};
use std::ops::Range;

/// How far along the curve a cluster looks for another.
const REACH: usize = 2;
/// Clusters left of each this many leaves.
const SHRINK: usize = 8;
/// Rounds of merging; each adds at most one level.
pub(super) const MAX_ROUNDS: usize = 20;

/// A leaf, or two clusters merged.
#[derive(Clone, Copy)]
pub(super) struct Cluster {
    pub around: Box4,
    /// The leaf's run in the order of its grove, begin and end; or the two clusters.
    pub parts: [u32; 2],
    /// References below.
    pub references: u32,
    /// Leaves below; one for a leaf.
    pub leaves: u32,
}

pub(super) struct Grove {
    keys: Range<usize>,
    /// Indices of references.
    pub order: Vec<u32>,
    /// Leaves first.
    pub clusters: Vec<Cluster>,
    /// Those that are in no other.
    pub roots: Vec<u32>,
}

impl Grove {
    /// To grow over these keys.
    pub fn new(keys: Range<usize>) -> Self {
        Grove { keys, order: Vec::new(), clusters: Vec::new(), roots: Vec::new() }
    }

    pub fn grow(&mut self, keys: &[Key], references: &[Reference]) {
        let Grove { keys: range, order, clusters, roots } = self;
        order.reserve_exact(range.len());
        clusters.reserve(range.len() / 2);
        leaves::scan(keys, range.clone(), references, order, &mut |order, run| {
            let around = order[run.clone()].iter().fold(Box4::EMPTY, |b, &i| b.union(references[i as usize].0));
            let parts = [run.start as u32, run.end as u32];
            clusters.push(Cluster { around, parts, references: run.len() as u32, leaves: 1 });
        });
        roots.extend(0..clusters.len() as u32);
        merge(clusters, roots);
    }
}

/// Merge clusters that are each other's best match, again and again.
fn merge(clusters: &mut Vec<Cluster>, roots: &mut Vec<u32>) {
    let enough = roots.len().div_ceil(SHRINK);
    let mut boxes: Vec<Box4> = clusters.iter().map(|c| c.around).collect();
    let mut matches: Vec<u32> = Vec::with_capacity(boxes.len());
    for _ in 0..MAX_ROUNDS {
        if roots.len() <= enough {
            break;
        }
        best_matches(&boxes, &mut matches);
        let mut kept = 0;
        for i in 0..roots.len() {
            let j = matches[i] as usize;
            let (around, root) = if matches[j] as usize != i {
                (boxes[i], roots[i])
            } else if i < j {
                let parts = [roots[i], roots[j]];
                let [a, b] = parts.map(|p| clusters[p as usize]);
                let around = boxes[i].union(boxes[j]);
                let (references, leaves) = (a.references + b.references, a.leaves + b.leaves);
                clusters.push(Cluster { around, parts, references, leaves });
                (around, clusters.len() as u32 - 1)
            } else {
                continue;
            };
            (boxes[kept], roots[kept]) = (around, root);
            kept += 1;
        }
        boxes.truncate(kept);
        roots.truncate(kept);
    }
}

/// For each box the one within reach with which it makes the smallest; the first of several. Of all pairs within reach the
/// smallest, and among equals the first, match each other, so a round merges some.
fn best_matches(boxes: &[Box4], matches: &mut Vec<u32>) {
    matches.clear();
    // `ahead[b][k]`: the area of the box `b + 1` places back with the one `k + 1` places after it.
    let mut ahead = [[f32::INFINITY; REACH]; REACH];
    for i in 0..boxes.len() {
        let mut own = [f32::INFINITY; REACH];
        for k in 0..REACH {
            if let Some(other) = boxes.get(i + k + 1) {
                own[k] = boxes[i].union(*other).half_area();
            }
        }
        // Places from the first within reach on, so that the first wins.
        let mut best = (f32::INFINITY, i);
        for k in (0..REACH).rev() {
            let area = ahead[k][k];
            if area < best.0 {
                best = (area, i - (k + 1));
            }
        }
        for k in 0..REACH {
            if own[k] < best.0 {
                best = (own[k], i + k + 1);
            }
        }
        matches.push(best.1 as u32);
        ahead.rotate_right(1);
        ahead[0] = own;
    }
}
