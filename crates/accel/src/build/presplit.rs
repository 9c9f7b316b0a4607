//! Cuts long triangles before the tree is built (Ernst & Greiner 2007, "Early Split Clipping for Bounding Volume Hierarchies"; budget and
//! planes after Karras & Aila 2013, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies", section 4.1).
//!
//! A ray tests references in proportion to the areas of their boxes. A long diagonal triangle fills little of its box: each time it is
//! halved, the areas of its parts together are half of what they were. `spatial_split` looks one cut ahead and does not find this, since the
//! first cut alone seldom pays. Here the cuts that take off most area are made, as many as there is room for, wherever they are. Cuts lie in the
//! planes that halve the scene's box, its halves, and so on: where the parts of one triangle end, so do those of others.

use super::clip::Polygon;
use super::parallel::for_each;
use super::partition::CHUNK;
use super::reference::{Box4, MAX_ID, Reference};
use super::spatial_split::CornersOf;
use crate::{Executor, triangle};
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
pub(crate) fn presplit(
    references: &mut Vec<Reference>,
    corners: CornersOf,
    room: usize,
    executor: &dyn Executor,
) -> usize {
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
    let mut counts: Vec<_> = references.chunks(CHUNK * stride).map(|of| (of, Counts([0; OCTAVES * STEPS]))).collect();
    for_each(&mut counts, executor, &|(of, counts)| {
        for r in of.iter().step_by(stride) {
            cutter.cut(r, &mut |gain| counts.add(gain / cutter.least_gain), &mut |_| {});
        }
    });
    let mut all = Counts([0; OCTAVES * STEPS]);
    counts.iter().for_each(|(_, counts)| all.merge(counts));
    cutter.least_gain *= all.least_gain(room / stride);
    if cutter.least_gain == f32::INFINITY {
        return 0;
    }
    let mut cuts: Vec<_> = references.chunks(CHUNK).map(|of| (of, Cuts::default())).collect();
    for_each(&mut cuts, executor, &|(of, cuts)| {
        for (i, r) in of.iter().enumerate() {
            cuts.begin(i);
            cutter.cut(r, &mut |_| {}, &mut |part| cuts.parts.push(part));
            cuts.end();
        }
    });
    let cuts: Vec<Cuts> = cuts.into_iter().map(|(_, cuts)| cuts).collect();
    let before = references.len();
    references.reserve(cuts.iter().map(|c| c.parts.len()).sum::<usize>().min(room));
    for (chunk, cuts) in cuts.iter().enumerate() {
        for (i, parts) in cuts.of_each() {
            if references.len() - before + parts.len() - 1 > room {
                return references.len() - before;
            }
            references[chunk * CHUNK + i] = parts[0];
            references.extend_from_slice(&parts[1..]);
        }
    }
    references.len() - before
}

/// The parts of those that were cut.
#[derive(Default)]
struct Cuts {
    parts: Vec<Reference>,
    /// Which was cut, and where its parts begin.
    begins: Vec<(usize, usize)>,
}

impl Cuts {
    /// What follows are parts of this one.
    fn begin(&mut self, index: usize) {
        self.begins.push((index, self.parts.len()));
    }

    /// A single part is no cut.
    fn end(&mut self) {
        if self.begins.last().is_some_and(|(_, begin)| begin + 1 == self.parts.len()) {
            self.begins.pop();
            self.parts.pop();
        }
    }

    fn of_each(&self) -> impl Iterator<Item = (usize, &[Reference])> {
        let ends = self.begins.iter().skip(1).map(|(_, begin)| *begin).chain([self.parts.len()]);
        self.begins.iter().zip(ends).map(|((index, begin), end)| (*index, &self.parts[*begin..end]))
    }
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
        let area = r.0.half_area();
        let plane = if 0.5 * area < self.least_gain || cuts == MAX_CUTS { None } else { self.plane(r) };
        let Some((axis, at)) = plane else { return part(*r) };
        let polygons = polygon.halves(axis, at);
        let Some(parts) = parts(of, r, &polygons) else { return part(*r) };
        let took_off = area - parts[0].0.half_area() - parts[1].0.half_area();
        if !(took_off >= self.least_gain && took_off >= LEAST_SHARE * area) {
            return part(*r);
        }
        // No cut counts more than the one that must come before it.
        let took_off = took_off.min(most);
        gain(took_off);
        for (r, polygon) in parts.iter().zip(&polygons) {
            self.cut_part(of, r, polygon, (cuts + 1, took_off), gain, part);
        }
    }

    /// The plane across the longest side, through its middle half, that halves the largest part of the scene's box.
    fn plane(&self, r: &Reference) -> Option<(usize, f32)> {
        let size = r.0.hi.minus(r.0.lo).0;
        let axis = (0..3).fold(0, |longest, k| if size[k] > size[longest] { k } else { longest });
        let (low, whole) = (self.whole.lo.0[axis], self.whole.hi.0[axis] - self.whole.lo.0[axis]);
        let steps = (1u32 << LEVELS) as f32 / whole;
        let (a, b) = ((r.0.lo.0[axis] - low) * steps, (r.0.hi.0[axis] - low) * steps);
        // The last of the finest planes is the one wanted, but for its low bits: those that a plane before the first has as well.
        let (before, last) = ((0.75 * a + 0.25 * b) as u32, (0.25 * a + 0.75 * b) as u32);
        let level = (before ^ last).checked_ilog2()?;
        let at = last & (u32::MAX << level);
        Some((axis, low + whole * (at as f32 / (1u32 << LEVELS) as f32)))
    }
}

/// The halves of a part; `None` where one is empty, as far as can be told.
fn parts(of: &Triangle, r: &Reference, polygons: &[Polygon; 2]) -> Option<[Reference; 2]> {
    let around = r.bounds();
    let parts = [0, 1].map(|side| {
        let b = polygons[side].bounds(of.growth);
        Bounds3 { min: b.min.max(around.min), max: b.max.min(around.max) }
    });
    let is_there = |b: &Bounds3| b.min.cmple(b.max).all();
    parts.iter().all(is_there).then(|| parts.map(|b| Reference::new(&b, of.ids.0, of.ids.1)))
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
    fn merge(&mut self, other: &Counts) {
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own += other);
    }

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
    use crate::Serial;
    use crate::build::testing::Backwards;
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
        presplit(references, &|r| Some(triangles[r.ids().1 as usize]), room, &Serial)
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
    fn the_parts_are_the_same_whatever_the_executor() {
        let triangles = triangles(2000, 3 * SAMPLE_ABOVE);
        let [a, b]: [&dyn Executor; 2] = [&Serial, &Backwards];
        let [a, b] = [a, b].map(|executor| {
            let mut parts = references(&triangles);
            let more = presplit(&mut parts, &|r| Some(triangles[r.ids().1 as usize]), 6000, executor);
            assert!((3000..=6000).contains(&more), "{more}");
            parts
        });
        let bits = |r: &Reference| {
            (r.ids(), r.bounds().min.to_array().map(f32::to_bits), r.bounds().max.to_array().map(f32::to_bits))
        };
        assert!(a.iter().map(bits).eq(b.iter().map(bits)));
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
