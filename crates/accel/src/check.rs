//! What a scene must satisfy before a structure is built over it.

use crate::error::AccelError;
use crate::scene_geometry::{Geometry, Instance, SceneGeometry, Shape};
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
        level(aggregate, Some(i), 0)?;
    }
    scene.instances.iter().enumerate().try_for_each(|(i, instance)| placement(i, instance, scene.aggregates.len()))
}

fn placement(index: usize, instance: &Instance, aggregates: usize) -> Result<(), AccelError> {
    if instance.aggregate >= aggregates {
        return Err(AccelError::NoSuchAggregate { instance: index, aggregate: instance.aggregate, aggregates });
    }
    let m = &instance.world_from_object;
    let broken = m.key_times().find(|&t| !t.is_finite() || !is_invertible(&m.at(t)));
    broken.map_or(Ok(()), |time| Err(AccelError::BadTransform { instance: index, time }))
}

fn level(geometries: &[Geometry], aggregate: Option<usize>, instances: usize) -> Result<(), AccelError> {
    let count = geometries.iter().map(|g| g.shape.len() as u64).sum::<u64>() + instances as u64;
    if count > MAX_PRIMITIVES || geometries.len() as u64 > MAX_PRIMITIVES {
        return Err(AccelError::TooManyPrimitives { aggregate, count, limit: MAX_PRIMITIVES });
    }
    geometries.iter().enumerate().try_for_each(|(g, geometry)| shape(&geometry.shape, aggregate, g))
}

fn shape(shape: &Shape, aggregate: Option<usize>, geometry: usize) -> Result<(), AccelError> {
    let not_finite = |element, what| Err(AccelError::NotFinite { aggregate, geometry, element, what });
    match shape {
        Shape::Triangles { positions, indices } => {
            if let Some(i) = positions.iter().position(|p| !p.is_finite()) {
                return not_finite(i, "vertex");
            }
            let vertices = positions.len();
            for (triangle, t) in indices.iter().enumerate() {
                if let Some(&index) = t.iter().find(|&&i| i as usize >= vertices) {
                    return Err(AccelError::IndexOutOfRange { aggregate, geometry, triangle, index, vertices });
                }
            }
        }
        Shape::Spheres(spheres) => {
            let sound = |s: &crate::Sphere| s.center.is_finite() && s.radius.is_finite() && s.radius >= 0.0;
            if let Some(i) = spheres.iter().position(|s| !sound(s)) {
                return not_finite(i, "sphere");
            }
        }
        Shape::User(user) => {
            for i in 0..user.len() {
                let b = user.bounds(i as u32);
                if b.min.is_nan() || b.max.is_nan() {
                    return not_finite(i, "user shape");
                }
            }
        }
    }
    Ok(())
}
