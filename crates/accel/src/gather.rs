//! Gathers the boxes of a level, for a builder to sort.

use crate::Executor;
use crate::build::parallel::for_each;
use crate::build::reference::{Box4, Reference};
use crate::instance::PlacedInstance;
use crate::record::{IS_INSTANCE, Record, all_references};
use crate::scene_geometry::{Geometry, Shape};
use crate::{memory, primitive, triangle};
use kirkas_geometry::Bounds3;
use std::mem::MaybeUninit;

/// References that a job makes at once.
const CHUNK: usize = 1 << 13;

/// What a level holds, before a structure is built over it.
pub(crate) struct Gathered {
    pub references: Vec<Reference>,
    /// Around all references.
    pub bounds: Bounds3,
    /// What no box holds; to be tested by every ray.
    pub unbounded: Vec<Record>,
}

/// Gather the boxes of a level; what is empty is left out.
pub(crate) fn gather(geometries: &[Geometry], instances: &[PlacedInstance], executor: &dyn Executor) -> Gathered {
    let count = geometries.iter().map(|g| g.shape.len()).sum::<usize>() + instances.len();
    let mut references = memory::with_capacity(count);
    let mut pieces = Vec::new();
    let mut room = &mut references.spare_capacity_mut()[..count];
    let shapes = (0..).zip(geometries).map(|(i, geometry)| (i, Some(&geometry.shape), geometry.shape.len()));
    for (geometry, shape, len) in shapes.chain([(IS_INSTANCE, None, instances.len())]) {
        for first in (0..len).step_by(CHUNK) {
            let (own, rest) = room.split_at_mut(CHUNK.min(len - first));
            room = rest;
            pieces.push(Piece { geometry, shape, first, room: own, around: Box4::EMPTY, is_full: false });
        }
    }
    assert!(room.is_empty());
    for_each(&mut pieces, executor, &|piece| piece.fill(instances));
    if !pieces.iter().all(|piece| piece.is_full) {
        return gather_what_is_bounded(geometries, instances);
    }
    let bounds = pieces.iter().fold(Box4::EMPTY, |b, piece| b.union(piece.around)).to_bounds();
    // SAFETY: the pieces have all of the room between them (asserted), and each says that it is full.
    unsafe { references.set_len(count) };
    Gathered { references, bounds, unbounded: Vec::new() }
}

/// Primitives of one geometry, or instances, and where their references go.
struct Piece<'a> {
    geometry: u32,
    /// `None` for instances.
    shape: Option<&'a Shape>,
    first: usize,
    room: &'a mut [MaybeUninit<Reference>],
    around: Box4,
    /// All of the room is filled with finite boxes that are not empty.
    is_full: bool,
}

impl Piece<'_> {
    fn fill(&mut self, instances: &[PlacedInstance]) {
        let first = self.first;
        match self.shape {
            None => self.fill_with(|i| instances[first + i].bounds),
            // A loop of its own for what there is most of.
            Some(Shape::Triangles { positions, indices }) => {
                let indices = &indices[first..first + self.room.len()];
                self.fill_with(|i| triangle::bounds(&primitive::corners(positions, indices[i])));
            }
            Some(shape) => self.fill_with(|i| primitive::bounds(shape, (first + i) as u32)),
        }
    }

    #[inline(always)]
    fn fill_with(&mut self, bounds: impl Fn(usize) -> Bounds3) {
        let mut around = Box4::EMPTY;
        let mut is_full = true;
        for (i, slot) in self.room.iter_mut().enumerate() {
            let b = bounds(i);
            is_full &= b.is_finite() & !b.is_empty();
            let reference = Reference::new(&b, self.geometry, (self.first + i) as u32);
            around = around.union(reference.0);
            slot.write(reference);
        }
        (self.around, self.is_full) = (around, is_full);
    }
}

fn gather_what_is_bounded(geometries: &[Geometry], instances: &[PlacedInstance]) -> Gathered {
    let mut all = Gathered { references: Vec::new(), bounds: Bounds3::EMPTY, unbounded: Vec::new() };
    for (bounds, geometry, index) in all_references(geometries, instances) {
        if bounds.is_empty() {
            continue;
        }
        if bounds.is_finite() {
            all.references.push(Reference::new(&bounds, geometry, index));
            all.bounds = all.bounds.union(bounds);
        } else {
            all.unbounded.push(Record::new(geometries, geometry, index));
        }
    }
    all
}

/// What no box holds.
pub(crate) fn gather_unbounded(geometries: &[Geometry], instances: &[PlacedInstance]) -> Vec<Record> {
    let unbounded = all_references(geometries, instances).filter(|(b, ..)| !b.is_empty() && !b.is_finite());
    unbounded.map(|(_, geometry, index)| Record::new(geometries, geometry, index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Serial;
    use crate::build::testing::Backwards;
    use crate::scene_geometry::Sphere;
    use kirkas_geometry::Vec3;
    use std::sync::Arc;

    fn geometry(shape: Shape) -> Geometry {
        Geometry { shape, opaque: true, mask: u32::MAX }
    }

    fn level() -> Vec<Geometry> {
        let positions: Vec<Vec3> = (0..1000).map(|i| Vec3::new(i as f32, (i % 7) as f32, (i % 31) as f32)).collect();
        let indices = (0..2 * CHUNK as u32 + 5).map(|i| [i % 1000, (i * 3) % 1000, (i * 7 + 1) % 1000]).collect();
        let spheres = (0..10).map(|i| Sphere { center: Vec3::splat(i as f32), radius: 1.0 }).collect();
        let triangles = Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) };
        vec![geometry(triangles), geometry(Shape::Spheres(Arc::new(spheres)))]
    }

    fn bits(g: &Gathered) -> String {
        let ids: Vec<_> = g.references.iter().map(|r| (r.ids(), r.bounds())).collect();
        format!("{ids:?} {:?} {}", g.bounds, g.unbounded.len())
    }

    #[test]
    fn in_pieces_and_one_by_one_the_same_is_gathered() {
        let level = level();
        let expected = bits(&gather_what_is_bounded(&level, &[]));
        assert!(bits(&gather(&level, &[], &Serial)) == expected);
        assert!(bits(&gather(&level, &[], &Backwards)) == expected);
    }

    /// Corners so far out that the box is infinite.
    #[test]
    fn what_has_no_finite_box_is_kept_apart() {
        let mut level = level();
        let far = vec![Vec3::ZERO, Vec3::X * f32::MAX, Vec3::Y];
        level.push(geometry(Shape::Triangles { positions: Arc::new(far), indices: Arc::new(vec![[0, 1, 2]]) }));
        let g = gather(&level, &[], &Serial);
        assert_eq!((g.references.len(), g.unbounded.len()), (2 * CHUNK + 15, 1));
        assert!(g.bounds.is_finite());
    }
}
