//! A primitive as a leaf holds it, and its test: what the structures that keep no blocks of their own share.

use crate::build::reference::MAX_ID;
use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::instance::PlacedInstance;
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::{Geometry, Shape, Sphere};
use crate::search::{Enter, Level, Search};
use crate::triangle::Corners;
use crate::{primitive, sphere, triangle};
use kirkas_geometry::{Bounds3, Vec3};

/// The geometry field of a reference to an instance.
pub(crate) const IS_INSTANCE: u32 = MAX_ID;

/// Every primitive and instance of a level with its bounds.
pub(crate) fn all_references<'a>(
    geometries: &'a [Geometry],
    instances: &'a [PlacedInstance],
) -> impl Iterator<Item = (Bounds3, u32, u32)> + 'a {
    let primitives = geometries.iter().enumerate().flat_map(|(g, geometry)| {
        (0..geometry.shape.len() as u32).map(move |p| (primitive::bounds(&geometry.shape, p), g as u32, p))
    });
    primitives.chain(instances.iter().enumerate().map(|(i, instance)| (instance.bounds, IS_INSTANCE, i as u32)))
}

/// Whether a structure's records are those of each primitive and instance, once.
pub(crate) fn check_complete<'a>(
    held: impl Iterator<Item = &'a Record>,
    geometries: &[Geometry],
    instances: &[PlacedInstance],
) -> Result<(), String> {
    let mut held: Vec<(u32, u32)> = held.map(Record::ids).collect();
    held.sort_unstable();
    let mut wanted: Vec<(u32, u32)> =
        all_references(geometries, instances).filter(|(b, ..)| !b.is_empty()).map(|(_, g, p)| (g, p)).collect();
    wanted.sort_unstable();
    if held == wanted { Ok(()) } else { Err("the leaves do not hold each primitive once".into()) }
}

/// A primitive as a leaf holds it: everything its test needs, without following an index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    /// A triangle's corners; a sphere's center and, in `[1][0]`, radius; otherwise unused.
    pub corners: Corners,
    /// Index of the geometry; for an instance unused.
    pub geometry: u32,
    /// Index of the primitive, or of the instance.
    pub primitive: u32,
    pub kind: RecordKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum RecordKind {
    Triangle,
    Sphere,
    /// Of any other shape: the test looks it up.
    Other,
    Instance,
}

impl Record {
    /// The record of a primitive or, with [`IS_INSTANCE`], of an instance.
    pub fn new(geometries: &[Geometry], geometry: u32, primitive: u32) -> Self {
        let (kind, corners) = match geometries.get(geometry as usize).map(|g| &g.shape) {
            None => (RecordKind::Instance, [[0.0; 3]; 3]),
            Some(Shape::Triangles { positions, indices }) => {
                (RecordKind::Triangle, primitive::corners(positions, indices[primitive as usize]))
            }
            Some(Shape::Spheres(spheres)) => {
                let s = &spheres[primitive as usize];
                (RecordKind::Sphere, [s.center.to_array(), [s.radius, 0.0, 0.0], [0.0; 3]])
            }
            Some(_) => (RecordKind::Other, [[0.0; 3]; 3]),
        };
        Record { corners, geometry, primitive, kind }
    }

    /// Geometry and primitive; of an instance [`IS_INSTANCE`] and its index.
    pub fn ids(&self) -> (u32, u32) {
        (if self.kind == RecordKind::Instance { IS_INSTANCE } else { self.geometry }, self.primitive)
    }

    /// Test it; `enter` searches an instance.
    #[inline(always)]
    pub fn test<const ANY: bool>(&self, level: Level, ray: &PreparedRay, search: &mut Search<ANY>, enter: Enter<ANY>) {
        let (geometry, index) = (self.geometry, self.primitive);
        match self.kind {
            RecordKind::Triangle => {
                search.counters.primitives_tested += 1;
                if let Some(crossing) = triangle::intersect(&self.corners, ray) {
                    search.offer(level, geometry, index, crossing);
                }
            }
            RecordKind::Sphere => {
                search.counters.primitives_tested += 1;
                sphere::intersect(&self.sphere(), ray, |t| search.offer(level, geometry, index, (t, 0.0, 0.0)));
            }
            RecordKind::Other => {
                search.counters.primitives_tested += 1;
                test_other(level, geometry, index, ray, search);
            }
            RecordKind::Instance => enter(ray, search, index),
        }
    }

    /// Look for the closest point on it; `enter` looks into an instance.
    pub fn consider(&self, level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
        match self.kind {
            RecordKind::Instance => enter(search, self.primitive),
            _ => search.consider(level, space, self.geometry, self.primitive),
        }
    }

    #[inline]
    pub fn sphere(&self) -> Sphere {
        Sphere { center: Vec3::from_array(self.corners[0]), radius: self.corners[1][0] }
    }
}

#[inline(never)]
fn test_other<const ANY: bool>(level: Level, geometry: u32, index: u32, ray: &PreparedRay, search: &mut Search<ANY>) {
    let shape = &level.geometries[geometry as usize].shape;
    let offer = |t, u, v| search.offer(level, geometry, index, (t, u, v));
    primitive::intersect(shape, index, ray, level.shutter, offer);
}
