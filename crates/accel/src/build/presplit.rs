//! Cuts long triangles before the tree is built (Ernst & Greiner 2007, "Early Split Clipping for Bounding Volume Hierarchies"; budget and
//! planes after Karras & Aila 2013, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies", section 4.1).
//!
//! A ray tests references in proportion to the areas of their boxes. A long diagonal triangle fills little of its box: each time it is
//! halved, the areas of its parts together are half of what they were. `spatial_split` looks one cut ahead and does not find this, since the
//! first cut alone seldom pays. Here the cuts that take off most area are made, as many as there is room for, wherever they are. Cuts lie in the
//! planes that halve the scene's box, its halves, and so on: where the parts of one triangle end, so do those of others.

use super::clip::Polygon;
use super::reference::{Box4, MAX_ID, Reference};
use super::spatial_split::CornersOf;
use crate::triangle;
use kirkas_geometry::Bounds3;

/// A cut takes off this many times the area that each reference has if all boxes together cover the scene's once.
const LEAST_GAIN: f32 = 32.0;
/// A cut takes off at least this part of a box. A cut in the middle takes off half if the triangle is a thin diagonal, but a quarter if it is
/// half a rectangle, such as a wall: those are better left whole.
const LEAST_SHARE: f32 = 0.3;
/// The scene's box is halved this often along an axis, at most.
const LEVELS: u32 = 16;
/// A triangle is cut this often on the way to a part, at most.
const MAX_CUTS: u32 = 6;
const MOST_PARTS: usize = 1 << MAX_CUTS;
/// Of more references than this, one in [`STRIDE`] tells how many cuts have each gain.
const SAMPLE_ABOVE: usize = 1 << 14;
const STRIDE: usize = 7;

/// Replace long triangles by parts, at most `room` more than there are; returns how many more.
pub(crate) fn presplit(references: &mut Vec<Reference>, corners: CornersOf, room: usize) -> usize {
    let room = room.min((MAX_ID as usize).saturating_sub(references.len()));
    if room < MOST_PARTS {
        return 0;
    }
    let whole = references.iter().fold(Box4::EMPTY, |b, r| b.union(r.0));
    let mut cutter = Cutter { corners, whole, least_gain: LEAST_GAIN * whole.half_area() / references.len() as f32 };
    if !(cutter.least_gain > 0.0 && cutter.least_gain.is_finite()) {
        return 0;
    }
    // How much may be asked of a cut, by a sample of them.
    let stride = if references.len() > SAMPLE_ABOVE { STRIDE } else { 1 };
    let mut counts = Counts([0; OCTAVES * STEPS]);
    for r in references.iter().step_by(stride) {
        cutter.cut(r, &mut |gain| counts.add(gain / cutter.least_gain), &mut |_| {});
    }
    cutter.least_gain *= counts.least_gain(room / stride);
    let mut parts = Vec::new();
    for r in references.iter_mut() {
        let first = parts.len();
        if first + MOST_PARTS > room {
            break;
        }
        cutter.cut(r, &mut |_| {}, &mut |part| parts.push(part));
        *r = parts.swap_remove(first);
    }
    let more = parts.len();
    references.append(&mut parts);
    more
}

struct Cutter<'a> {
    corners: CornersOf<'a>,
    whole: Box4,
    /// Half area.
    least_gain: f32,
}

impl Cutter<'_> {
    /// Cut a reference as long as that takes off enough: what each cut takes off, and at last the parts.
    fn cut(&self, r: &Reference, gain: &mut impl FnMut(f32), part: &mut impl FnMut(Reference)) {
        // No cut takes off more than half.
        let corners = if 0.5 * r.0.half_area() < self.least_gain { None } else { (self.corners)(r) };
        let Some(corners) = corners else { return part(*r) };
        let of = Triangle { ids: r.ids(), growth: triangle::growth(&corners) };
        self.cut_part(&of, r, &Polygon::new(&corners), (0, f32::INFINITY), gain, part);
    }

    fn cut_part(
        &self,
        of: &Triangle,
        r: &Reference,
        polygon: &Polygon,
        (cuts, most): (u32, f32),
        gain: &mut impl FnMut(f32),
        part: &mut impl FnMut(Reference),
    ) {
        let Some((parts, polygons, took_off)) = self.best_cut(of, r, polygon, cuts) else { return part(*r) };
        // No cut counts more than the one that must come before it.
        let took_off = took_off.min(most);
        gain(took_off);
        for (r, polygon) in parts.iter().zip(&polygons) {
            self.cut_part(of, r, polygon, (cuts + 1, took_off), gain, part);
        }
    }

    /// Across the longest side, if that takes off enough.
    fn best_cut(
        &self,
        of: &Triangle,
        r: &Reference,
        polygon: &Polygon,
        cuts: u32,
    ) -> Option<([Reference; 2], [Polygon; 2], f32)> {
        let area = r.0.half_area();
        if 0.5 * area < self.least_gain || cuts == MAX_CUTS {
            return None;
        }
        let size = r.0.hi.minus(r.0.lo).0;
        let axis = (0..3).fold(0, |longest, k| if size[k] > size[longest] { k } else { longest });
        let at = self.plane(r, axis)?;
        let polygons = [true, false].map(|below| polygon.cut(axis, at, below));
        let around = r.bounds();
        let parts = polygons.map(|p| {
            let b = p.bounds(of.growth);
            Bounds3 { min: b.min.max(around.min), max: b.max.min(around.max) }
        });
        if !parts.iter().all(|b| b.min.cmple(b.max).all()) {
            return None;
        }
        let parts = parts.map(|b| Reference::new(&b, of.ids.0, of.ids.1));
        let gain = area - parts[0].0.half_area() - parts[1].0.half_area();
        (gain >= self.least_gain && gain >= LEAST_SHARE * area).then_some((parts, polygons, gain))
    }

    /// The plane through the middle half of the reference that halves the largest part of the scene's box.
    fn plane(&self, r: &Reference, axis: usize) -> Option<f32> {
        let (low, size) = (self.whole.lo.0[axis], self.whole.hi.0[axis] - self.whole.lo.0[axis]);
        let (a, b) = ((r.0.lo.0[axis] - low) / size, (r.0.hi.0[axis] - low) / size);
        let (from, to) = (0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b);
        (1..=LEVELS).find_map(|level| {
            let parts = (1u32 << level) as f32;
            let at = (from * parts).ceil() / parts;
            (at <= to).then_some(low + size * at)
        })
    }
}

/// What all parts of a triangle share.
struct Triangle {
    ids: (u32, u32),
    growth: f32,
}

/// Gains, as multiples of the least, are counted in this many steps to the double.
const STEPS: usize = 8;
/// Gains of this many doublings and more are counted as one.
const OCTAVES: usize = 24;
/// Bits of the fraction that do not tell the step.
const SHIFT: u32 = 23 - STEPS.trailing_zeros();

/// How many cuts have each gain.
struct Counts([usize; OCTAVES * STEPS]);

impl Counts {
    fn add(&mut self, gain: f32) {
        let step = gain.to_bits().saturating_sub(1.0_f32.to_bits()) >> SHIFT;
        self.0[(step as usize).min(OCTAVES * STEPS - 1)] += 1;
    }

    /// So that there is room for all cuts with at least this gain.
    fn least_gain(&self, mut room: usize) -> f32 {
        let mut least = OCTAVES * STEPS;
        while least > 0 && self.0[least - 1] <= room {
            least -= 1;
            room -= self.0[least];
        }
        // Those that were counted as one are let in together or not at all.
        if least == OCTAVES * STEPS {
            f32::INFINITY
        } else {
            f32::from_bits(1.0_f32.to_bits() + ((least as u32) << SHIFT))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangle::Corners;
    use kirkas_geometry::hash::{combine, unit_f32};
    use kirkas_geometry::{DVec3, Vec3};

    /// Thin diagonals through a cube, and a mesh of small triangles.
    fn triangles(diagonals: usize, small: usize) -> Vec<Corners> {
        let at = |i: usize, k: u64| unit_f32(combine(i as u64, k) as u32);
        let point = |i: usize, k: u64| Vec3::new(at(i, k), at(i, k + 1), at(i, k + 2));
        let sign = |i: usize, k: u64| if at(i, k) < 0.5 { -1.0 } else { 1.0 };
        let diagonal = |i: usize| {
            let along = Vec3::new(sign(i, 1), sign(i, 2), sign(i, 3)) * (0.5 + point(i, 4)) * 0.3;
            let (middle, across) = (point(i, 7), along.any_orthogonal_vector() * 1e-3);
            [middle - along, middle + along, middle - along + across].map(|p| p.to_array())
        };
        let tiny = |i: usize| {
            let p = point(i, 10);
            [p, p + point(i, 13) * 0.01, p + point(i, 16) * 0.01].map(|p| p.to_array())
        };
        (0..diagonals).map(diagonal).chain((0..small).map(tiny)).collect()
    }

    fn references(triangles: &[Corners]) -> Vec<Reference> {
        let of = |(i, t): (usize, &Corners)| Reference::new(&triangle::bounds(t), 0, i as u32);
        triangles.iter().enumerate().map(of).collect()
    }

    fn area(references: &[Reference]) -> f32 {
        references.iter().map(|r| r.0.half_area()).sum()
    }

    fn presplit_all(triangles: &[Corners], references: &mut Vec<Reference>, room: usize) -> usize {
        presplit(references, &|r| Some(triangles[r.ids().1 as usize]), room)
    }

    #[test]
    fn the_room_for_parts_is_used_and_never_exceeded() {
        let triangles = triangles(100, 4000);
        let whole = area(&references(&triangles));
        let mut last = whole;
        for room in [0, 100, 200, 300] {
            let mut parts = references(&triangles);
            let more = presplit_all(&triangles, &mut parts, room);
            assert!(more <= room && more * 2 >= room.saturating_sub(2 * MOST_PARTS), "{more} of {room}");
            assert_eq!(parts.len(), triangles.len() + more);
            let now = area(&parts);
            assert!(if room == 0 { now == last } else { now < last }, "{now} after {last}");
            last = now;
        }
        assert!(last < 0.5 * whole, "{last} of {whole}");
    }

    #[test]
    fn small_triangles_and_walls_are_left_whole() {
        let mut triangles = triangles(0, 1000);
        triangles.push([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]);
        triangles.push([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
        assert_eq!(presplit_all(&triangles, &mut references(&triangles), 1000), 0);
    }

    #[test]
    fn each_point_of_a_triangle_lies_in_one_of_its_parts() {
        let triangles = triangles(100, 4000);
        let mut parts = references(&triangles);
        presplit_all(&triangles, &mut parts, 800);
        for (i, corners) in triangles.iter().enumerate().take(100) {
            let own: Vec<_> = parts.iter().filter(|r| r.ids() == (0, i as u32)).map(|r| r.bounds()).collect();
            let growth = f64::from(triangle::growth(corners)) * 0.99;
            let [a, b, c] = corners.map(|c| Vec3::from_array(c).as_dvec3());
            for k in 0..200 {
                let number = |n: u64| f64::from(unit_f32(combine(combine(i as u64, k), n) as u32));
                let (u, v) = (number(20), number(21));
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let side = |n: u64| if number(n) < 0.5 { -growth } else { growth };
                let p = a + (b - a) * u + (c - a) * v + DVec3::new(side(22), side(23), side(24));
                let holds = |b: &Bounds3| p.cmpge(b.min.as_dvec3()).all() && p.cmple(b.max.as_dvec3()).all();
                assert!(own.iter().any(holds), "{p} of {corners:?}");
            }
        }
    }
}
