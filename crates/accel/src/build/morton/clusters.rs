//! A grove: the leaves of a stretch of the curve, merged with their neighbours into fewer and larger clusters.

use super::codes::Key;
use super::leaves;
use crate::build::layout::{Cluster, Grove};
use crate::build::reference::{Box4, Reference};
use std::ops::Range;

/// How far along the curve a cluster looks for another.
const REACH: usize = 2;
/// Clusters left of each this many leaves.
const SHRINK: usize = 8;
/// Rounds of merging; each adds at most one level.
pub(super) const MAX_ROUNDS: usize = 20;

/// The grove over these keys, and those of its clusters that are in no other.
pub(super) fn grow(keys: &[Key], range: Range<usize>, references: &[Reference]) -> (Grove, Vec<u32>) {
    let mut order = Vec::with_capacity(range.len());
    let mut clusters = Vec::with_capacity(range.len() / 2);
    leaves::scan(keys, range, references, &mut order, &mut |order, run| {
        let around = order[run.clone()].iter().fold(Box4::EMPTY, |b, &i| b.union(references[i as usize].0));
        let parts = [run.start as u32, run.end as u32];
        clusters.push(Cluster { around, parts, references: run.len() as u32, leaves: 1 });
    });
    let mut roots: Vec<u32> = (0..clusters.len() as u32).collect();
    merge(&mut clusters, &mut roots);
    (Grove { order, clusters }, roots)
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
        for (area, other) in own.iter_mut().zip(&boxes[i + 1..]) {
            *area = boxes[i].union(*other).half_area();
        }
        // Places from the first within reach on, so that the first wins.
        let mut best = (f32::INFINITY, i);
        for k in (0..REACH).rev() {
            let area = ahead[k][k];
            if area < best.0 {
                best = (area, i - (k + 1));
            }
        }
        for (k, area) in own.into_iter().enumerate() {
            if area < best.0 {
                best = (area, i + k + 1);
            }
        }
        matches.push(best.1 as u32);
        ahead.rotate_right(1);
        ahead[0] = own;
    }
}
