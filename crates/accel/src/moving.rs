//! Triangles that move: at each moment of the shutter those whose corners lie on the straight lines between the keys.

use crate::triangle::{self, Corners};
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use kirkas_geometry::{Bounds3, Vec3};

/// A ray's time as a part of the shutter: 0 when it opens, 1 when it closes.
pub(crate) fn moment(time: f32, (open, close): (f64, f64)) -> f32 {
    if open >= close {
        return 0.0;
    }
    (((f64::from(time) - open) / (close - open)) as f32).clamp(0.0, 1.0)
}

/// The corners at a moment between 0 and 1. Each corner depends on its own vertex only, so a closed mesh stays closed.
pub fn corners(keys: &[Vec<Vec3>], index: [u32; 3], moment: f32) -> Corners {
    let last = keys.len() - 1;
    let at = moment * last as f32;
    // NaN starts at the first key and stays NaN.
    let key = (at as usize).min(last.saturating_sub(1));
    let part = at - key as f32;
    index.map(|i| {
        let (before, after) = (keys[key][i as usize], keys[(key + 1).min(last)][i as usize]);
        (before * (1.0 - part) + after * part).to_array()
    })
}

/// The bounds that are part of the definition of a hit at a moment.
pub fn bounds_at(keys: &[Vec<Vec3>], index: [u32; 3], moment: f32) -> Bounds3 {
    triangle::bounds(&corners(keys, index, moment))
}

/// A box that holds the triangle's bounds at every moment.
pub fn bounds(keys: &[Vec<Vec3>], index: [u32; 3]) -> Bounds3 {
    let at_keys = key_bounds(keys, index).map(|(_, b)| b);
    grown(at_keys.fold(Bounds3::EMPTY, Bounds3::union))
}

/// Two boxes, when the shutter opens and when it closes: those on the straight lines between them hold the triangle's bounds
/// at every moment.
pub fn linear_bounds(keys: &[Vec<Vec3>], index: [u32; 3]) -> [Bounds3; 2] {
    let all: Vec<(f32, Bounds3)> = key_bounds(keys, index).collect();
    let (open, close) = (all[0].1, all[all.len() - 1].1);
    // Shift both ends alike by what the keys in between stand out.
    let (mut below, mut above) = (Vec3::ZERO, Vec3::ZERO);
    for (moment, b) in &all {
        let at = |a: Vec3, b: Vec3| a * (1.0 - moment) + b * *moment;
        below = below.max(at(open.min, close.min) - b.min);
        above = above.max(b.max - at(open.max, close.max));
    }
    // Where a corner is far away at one end, the lines in between carry its rounding.
    let size = |b: Bounds3| b.min.abs().max(b.max.abs());
    let slack = size(open).max(size(close)).max(below).max(above) * (16.0 * UNIT_ROUNDOFF);
    [open, close].map(|b| Bounds3 { min: b.min - below - slack, max: b.max + above + slack })
}

/// The bounds at each key, with its moment.
fn key_bounds(keys: &[Vec<Vec3>], index: [u32; 3]) -> impl Iterator<Item = (f32, Bounds3)> + '_ {
    let last = (keys.len() - 1).max(1) as f32;
    keys.iter().enumerate().map(move |(k, positions)| {
        let corners = index.map(|i| positions[i as usize].to_array());
        (k as f32 / last, triangle::bounds(&corners))
    })
}

/// By what the corners in between, and the bounds around them, may be rounded.
fn grown(b: Bounds3) -> Bounds3 {
    let grow = b.min.abs().max(b.max.abs()) * (8.0 * UNIT_ROUNDOFF);
    Bounds3 { min: b.min - grow, max: b.max + grow }
}
