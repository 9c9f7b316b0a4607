//! Parts of triangles, in boxes that lose no hit: where a triangle is hit, so is the box of one of its parts.
//!
//! The test of a hit may move a point of the triangle sideways by as much as [`triangle::bounds`] grows the whole, and so
//! is each part's box grown.

use crate::triangle::{self, Corners};
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use kirkas_geometry::{Bounds3, DVec3, Vec3};

/// A triangle cut by the 6 faces of a box and a plane has 10 corners at most, and by the planes of `presplit` 9; the rest is for roundings.
const MAX_CORNERS: usize = 16;

/// A part of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Polygon {
    corners: [DVec3; MAX_CORNERS],
    len: usize,
}

/// What of a triangle lies within `around` and below, and above, `plane` of the axis.
pub(crate) fn split(corners: &Corners, around: &Bounds3, axis: usize, plane: f32) -> [Bounds3; 2] {
    let mut whole = Polygon::new(corners);
    for k in 0..3 {
        whole = whole.cut(k, around.min[k], false);
        whole = whole.cut(k, around.max[k], true);
    }
    let growth = triangle::growth(corners);
    [true, false].map(|below| {
        let part = whole.cut(axis, plane, below).bounds(growth);
        let (min, max) = (part.min.max(around.min), part.max.min(around.max));
        if min.cmple(max).all() {
            return Bounds3 { min, max };
        }
        // Nothing of it, as far as f64 can tell: what of the box lies on that side.
        let mut side = *around;
        let pad = growth + plane.abs() * (4.0 * UNIT_ROUNDOFF);
        match below {
            true => side.max[axis] = side.max[axis].min(plane + pad).max(side.min[axis]),
            false => side.min[axis] = side.min[axis].max(plane - pad).min(side.max[axis]),
        }
        side
    })
}

impl Polygon {
    pub fn new(corners: &Corners) -> Self {
        let mut whole = Polygon { corners: [DVec3::ZERO; MAX_CORNERS], len: 3 };
        for (own, c) in whole.corners.iter_mut().zip(corners) {
            *own = Vec3::from_array(*c).as_dvec3();
        }
        whole
    }

    /// What lies at the plane and to one side of it.
    pub fn cut(&self, axis: usize, plane: f32, below: bool) -> Polygon {
        let plane = f64::from(plane);
        let is_in = |p: &DVec3| if below { p[axis] <= plane } else { p[axis] >= plane };
        let own = &self.corners[..self.len];
        if own.iter().all(is_in) {
            return *self;
        }
        let mut part = Polygon { corners: [DVec3::ZERO; MAX_CORNERS], len: 0 };
        for (i, p) in own.iter().enumerate() {
            let q = &own[(i + 1) % own.len()];
            if is_in(p) {
                part.push(*p);
            }
            if is_in(p) != is_in(q) {
                part.push(crossing(p, q, axis, plane));
            }
        }
        part
    }

    /// What lies at the plane and below, and what lies at it and above.
    pub fn halves(&self, axis: usize, plane: f32) -> [Polygon; 2] {
        let plane = f64::from(plane);
        let mut halves = [Polygon { corners: [DVec3::ZERO; MAX_CORNERS], len: 0 }; 2];
        let own = &self.corners[..self.len];
        let mut p = match own.last() {
            Some(p) => *p,
            None => return halves,
        };
        for q in own {
            let (before, now) = (p[axis] - plane, q[axis] - plane);
            if (before < 0.0 && now > 0.0) || (before > 0.0 && now < 0.0) {
                let crossing = crossing(&p, q, axis, plane);
                halves[0].push(crossing);
                halves[1].push(crossing);
            }
            if now <= 0.0 {
                halves[0].push(*q);
            }
            if now >= 0.0 {
                halves[1].push(*q);
            }
            p = *q;
        }
        halves
    }

    fn push(&mut self, corner: DVec3) {
        if self.len < MAX_CORNERS {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }

    /// Grown, and by the rounding to f32 and of the growth itself.
    pub fn bounds(&self, growth: f32) -> Bounds3 {
        let mut b = Bounds3::EMPTY;
        for p in &self.corners[..self.len] {
            b.min = b.min.min(p.as_vec3());
            b.max = b.max.max(p.as_vec3());
        }
        let pad = |x: Vec3| Vec3::splat(growth) + x.abs() * (4.0 * UNIT_ROUNDOFF);
        Bounds3 { min: b.min - pad(b.min), max: b.max + pad(b.max) }
    }
}

/// Where an edge meets the plane: from its lower end, so that both sides' parts meet in one point.
fn crossing(p: &DVec3, q: &DVec3, axis: usize, plane: f64) -> DVec3 {
    let (low, high) = if p[axis] < q[axis] { (p, q) } else { (q, p) };
    let mut crossing = *low + (*high - *low) * ((plane - low[axis]) / (high[axis] - low[axis]));
    crossing[axis] = plane;
    crossing
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::hash::{combine, unit_f32};

    /// Slivers, tiny and huge triangles, cut again and again.
    #[test]
    fn the_parts_of_a_triangle_cover_it_with_its_growth() {
        let mut k = 0;
        let mut unit = || {
            k += 1;
            unit_f32(combine(3, k) as u32)
        };
        for case in 0..1000 {
            let scale = 10_f32.powi(case % 13 - 6);
            let thin = 10_f32.powi(-(case % 7));
            let mut point = || Vec3::new(unit(), unit(), unit()) * 2.0 - 1.0;
            let (a, b) = (point() * scale, point() * scale);
            let c = a.lerp(b, 0.3) + point() * scale * thin;
            let offset = if case % 3 == 0 { point() * 100.0 * scale } else { Vec3::ZERO };
            let corners = [a, b, c].map(|p| (p + offset).to_array());
            let mut parts = vec![triangle::bounds(&corners)];
            for _ in 0..5 {
                let axis = (unit() * 3.0) as usize;
                let at = unit();
                parts =
                    parts.iter().flat_map(|b| split(&corners, b, axis, b.min[axis] + b.extent()[axis] * at)).collect();
            }
            let growth = f64::from(triangle::growth(&corners));
            let [a, b, c] = corners.map(|c| Vec3::from_array(c).as_dvec3());
            for _ in 0..100 {
                let (u, v) = (f64::from(unit()), f64::from(unit()));
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let p = a + (b - a) * u + (c - a) * v;
                let side = |x: f32| if x < 0.5 { -growth } else { growth } * 0.99;
                let moved = p + DVec3::new(side(unit()), side(unit()), side(unit()));
                let holds = |b: &Bounds3| moved.cmpge(b.min.as_dvec3()).all() && moved.cmple(b.max.as_dvec3()).all();
                assert!(parts.iter().any(holds), "{moved} of {corners:?} is in none of {parts:?}");
            }
        }
    }
}
