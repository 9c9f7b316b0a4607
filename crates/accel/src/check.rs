//! What a scene must satisfy before a structure is built over it.

use crate::error::AccelError;
use crate::path::MAX_NESTING;
use crate::scene_geometry::{Geometry, Instance, SceneGeometry, Shape};
use kirkas_geometry::Vec3;
use kirkas_geometry::transform::is_invertible;

/// More primitives than this, in the world (with the instances) or in one aggregate, are refused.
pub(crate) const MAX_PRIMITIVES: u64 = (1 << 28) - 1;

/// The first fault of a scene, if it has one.
pub(crate) fn scene(scene: &SceneGeometry) -> Result<(), AccelError> {
    let (start, end) = scene.shutter;
    if !(start.is_finite() && end.is_finite() && start <= end) {
        return Err(AccelError::BadShutter { start, end });
    }
    level(&scene.world, None, scene.instances.len())?;
    for (i, aggregate) in scene.aggregates.iter().enumerate() {
        level(&aggregate.geometries, Some(i), aggregate.instances.len())?;
    }
    let count = scene.aggregates.len();
    placements(&scene.instances, None, count)?;
    for (i, aggregate) in scene.aggregates.iter().enumerate() {
        placements(&aggregate.instances, Some(i), count)?;
    }
    let levels = build_order(scene)?.levels;
    match scene.instances.iter().position(|i| levels[i.aggregate] >= MAX_NESTING) {
        Some(instance) => {
            let levels = levels[scene.instances[instance].aggregate] + 1;
            Err(AccelError::NestedTooDeep { instance, levels, limit: MAX_NESTING })
        }
        None => Ok(()),
    }
}

/// Aggregates sorted by what they hold.
pub(crate) struct BuildOrder {
    /// Every aggregate, after all that it places.
    pub order: Vec<usize>,
    /// How many instances stand in one another below each aggregate.
    pub levels: Vec<usize>,
}

/// The order in which aggregates can be built; the error is an aggregate that holds itself.
pub(crate) fn build_order(scene: &SceneGeometry) -> Result<BuildOrder, AccelError> {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let aggregates = &scene.aggregates;
    let mut marks = vec![Mark::New; aggregates.len()];
    let (mut order, mut levels) = (Vec::with_capacity(aggregates.len()), vec![0; aggregates.len()]);
    for start in 0..aggregates.len() {
        // Depth first, with a stack of its own: (aggregate, which of its instances comes next).
        let mut todo = vec![(start, 0)];
        while let Some((at, next)) = todo.pop() {
            if next == 0 && marks[at] != Mark::New {
                continue;
            }
            marks[at] = Mark::Open;
            match aggregates[at].instances.get(next).map(|i| i.aggregate) {
                Some(inner) if marks[inner] == Mark::Open => return Err(AccelError::Cycle { aggregate: inner }),
                Some(inner) => todo.extend([(at, next + 1), (inner, 0)]),
                None => {
                    marks[at] = Mark::Done;
                    levels[at] = aggregates[at].instances.iter().map(|i| levels[i.aggregate] + 1).max().unwrap_or(0);
                    order.push(at);
                }
            }
        }
    }
    Ok(BuildOrder { order, levels })
}

fn placements(instances: &[Instance], within: Option<usize>, aggregates: usize) -> Result<(), AccelError> {
    for (index, instance) in instances.iter().enumerate() {
        if instance.aggregate >= aggregates {
            let aggregate = instance.aggregate;
            return Err(AccelError::NoSuchAggregate { within, instance: index, aggregate, aggregates });
        }
        let m = &instance.outer_from_object;
        if let Some(time) = m.key_times().find(|&t| !t.is_finite() || !is_invertible(&m.at(t))) {
            return Err(AccelError::BadTransform { within, instance: index, time });
        }
    }
    Ok(())
}

fn level(geometries: &[Geometry], aggregate: Option<usize>, instances: usize) -> Result<(), AccelError> {
    let count = geometries.iter().map(|g| g.shape.len() as u64).sum::<u64>() + instances as u64;
    if count > MAX_PRIMITIVES || geometries.len() as u64 > MAX_PRIMITIVES {
        return Err(AccelError::TooManyPrimitives { aggregate, count, limit: MAX_PRIMITIVES });
    }
    geometries.iter().enumerate().try_for_each(|(g, geometry)| shape(&geometry.shape, aggregate, g))
}

/// Where a shape stands, for its errors.
#[derive(Clone, Copy)]
struct Place {
    aggregate: Option<usize>,
    geometry: usize,
}

fn shape(shape: &Shape, aggregate: Option<usize>, geometry: usize) -> Result<(), AccelError> {
    let place = Place { aggregate, geometry };
    match shape {
        Shape::Triangles { positions, indices } => {
            place.positions(positions)?;
            place.indices("triangle", indices, positions.len())
        }
        Shape::MovingTriangles { keys, indices } => {
            let vertices = keys.first().map_or(0, Vec::len);
            if keys.len() < 2 || keys.iter().any(|k| k.len() != vertices) {
                let lengths = keys.iter().map(Vec::len).collect();
                return Err(AccelError::BadKeys { aggregate, geometry, lengths });
            }
            keys.iter().try_for_each(|k| place.positions(k))?;
            place.indices("triangle", indices, vertices)
        }
        Shape::Quads { positions, indices } => {
            place.positions(positions)?;
            place.indices("quad", indices, positions.len())
        }
        Shape::Spheres(spheres) => place.each(spheres, "sphere", |s| (s.center.is_finite(), s.radius)),
        Shape::Disks(disks) => {
            place.each(disks, "disk", |d| (d.center.is_finite() && d.normal.is_finite(), d.radius))?;
            match disks.iter().position(|d| d.normal == Vec3::ZERO) {
                Some(primitive) => Err(place.fault("disk", primitive, "a normal of length 0")),
                None => Ok(()),
            }
        }
        Shape::Cylinders(all) => {
            place.each(all, "cylinder", |c| (c.ends[0].is_finite() && c.ends[1].is_finite(), c.radius))
        }
        Shape::Curves { points, segments } => {
            place.each(points, "curve point", |p| (p.position.is_finite(), p.radius))?;
            // A segment ends at the point after its first.
            let ends: Vec<[u32; 2]> = segments.iter().map(|&s| [s, s.saturating_add(1)]).collect();
            place.indices("curve segment", &ends, points.len())
        }
        Shape::User(user) => {
            let broken = |i: &usize| {
                let b = user.bounds(*i as u32);
                b.min.is_nan() || b.max.is_nan()
            };
            (0..user.len()).find(broken).map_or(Ok(()), |i| Err(place.not_finite("user shape", i)))
        }
    }
}

impl Place {
    fn positions(self, positions: &[Vec3]) -> Result<(), AccelError> {
        positions.iter().position(|p| !p.is_finite()).map_or(Ok(()), |i| Err(self.not_finite("vertex", i)))
    }

    fn indices<const N: usize>(self, what: &'static str, all: &[[u32; N]], vertices: usize) -> Result<(), AccelError> {
        let Place { aggregate, geometry } = self;
        for (element, one) in all.iter().enumerate() {
            if let Some(&index) = one.iter().find(|&&i| i as usize >= vertices) {
                return Err(AccelError::IndexOutOfRange { aggregate, geometry, what, element, index, vertices });
            }
        }
        Ok(())
    }

    /// Round things: whether all but the radius is finite, and the radius.
    fn each<T>(self, all: &[T], what: &'static str, of: impl Fn(&T) -> (bool, f32)) -> Result<(), AccelError> {
        for (element, one) in all.iter().enumerate() {
            let (is_finite, radius) = of(one);
            if !(is_finite && radius.is_finite()) {
                return Err(self.not_finite(what, element));
            }
            if radius < 0.0 {
                return Err(self.fault(what, element, "a negative radius"));
            }
        }
        Ok(())
    }

    fn not_finite(self, what: &'static str, element: usize) -> AccelError {
        AccelError::NotFinite { aggregate: self.aggregate, geometry: self.geometry, element, what }
    }

    fn fault(self, what: &'static str, element: usize, fault: &'static str) -> AccelError {
        AccelError::BadPrimitive { aggregate: self.aggregate, geometry: self.geometry, element, what, fault }
    }
}
