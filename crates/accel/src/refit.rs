//! [`Accel::refit`]: the same primitives, elsewhere.

use crate::accel::place;
use crate::instance::PlacedInstance;
use crate::record::all_references;
use crate::scene_geometry::{Geometry, Instance, SceneGeometry, Shape};
use crate::structure::Structure;
use crate::{Accel, AccelError, AccelKind, check};
use core::fmt;
use kirkas_geometry::Bounds3;

/// Why a structure cannot be fitted to a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum RefitError {
    /// Structures of this kind are built anew.
    NotRefittable(AccelKind),
    /// The scene does not hold the same primitives in the same order.
    OtherTopology {
        /// Where; `None` is the world itself.
        aggregate: Option<usize>,
        /// What is another.
        what: &'static str,
    },
    /// What is wrong with the scene.
    Scene(AccelError),
}

impl fmt::Display for RefitError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::NotRefittable(kind) => {
                write!(f, "a {} cannot be refitted; brute_force and the bvh8 kinds can", kind.name())
            }
            Self::OtherTopology { aggregate, what } => {
                let place = aggregate.map_or("the world".to_string(), |a| format!("aggregate {a}"));
                write!(f, "{what} of {place} changed; build anew")
            }
            Self::Scene(e) => write!(f, "{e}"),
        }
    }
}

impl std::error::Error for RefitError {}

impl From<AccelError> for RefitError {
    fn from(e: AccelError) -> Self {
        Self::Scene(e)
    }
}

impl Accel {
    /// Fit the structure to a scene of the same topology (the same primitives over the same indices, instances of the same
    /// aggregates) whose vertices, balls, places, keys or shutter are others: in a fraction of the time of a build, and with the
    /// answers of one. The further things move against each other, the slower rays become, until it is built anew. The boxes of
    /// triangles that `bvh8` and `bvh8_best` have in several leaves, in parts, become those of whole triangles. After an error all is
    /// as before.
    ///
    /// ```
    /// # use kirkas_accel::*;
    /// # use kirkas_geometry::{Ray, Vec3};
    /// # use std::sync::Arc;
    /// let scene = |x: f32| {
    ///     let balls = (0..100).map(|i| Sphere { center: Vec3::new(x, i as f32, 0.0), radius: 0.4 }).collect();
    ///     let shape = Shape::Spheres(Arc::new(balls));
    ///     SceneGeometry { world: vec![Geometry { shape, opaque: true, mask: u32::MAX }], ..Default::default() }
    /// };
    /// let mut accel = Accel::build(AccelKind::Bvh8, scene(0.0), &Serial)?;
    /// accel.refit(scene(7.0))?;
    /// let ray = Ray::new(Vec3::new(7.0, 42.0, 9.0), -Vec3::Z);
    /// assert_eq!(accel.closest_hit(&ray, Query::ALL, 0, &mut Counters::default()).unwrap().primitive, 42);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn refit(&mut self, scene: SceneGeometry) -> Result<(), RefitError> {
        if !matches!(self.world.structure, Structure::Bvh8(_) | Structure::BruteForce) {
            return Err(RefitError::NotRefittable(self.kind()));
        }
        check::scene(&scene)?;
        if self.scene.aggregates.len() != scene.aggregates.len() {
            return Err(RefitError::OtherTopology { aggregate: None, what: "the number of aggregates" });
        }
        let mut whole = vec![Bounds3::EMPTY; scene.aggregates.len()];
        let mut fits: Vec<Option<Fit>> = whole.iter().map(|_| None).collect();
        for i in check::build_order(&scene)?.order {
            let (old, new) = (&self.scene.aggregates[i], &scene.aggregates[i]);
            let level = Change {
                old: (&old.geometries, &old.instances, &self.aggregates[i].instances),
                new: (&new.geometries, &new.instances, place(&new.instances, &whole, scene.shutter)),
            };
            let fit = level.fit().map_err(|what| RefitError::OtherTopology { aggregate: Some(i), what })?;
            whole[i] = fit.whole;
            fits[i] = Some(fit);
        }
        let level = Change {
            old: (&self.scene.world, &self.scene.instances, &self.world.instances),
            new: (&scene.world, &scene.instances, place(&scene.instances, &whole, scene.shutter)),
        };
        let fit = level.fit().map_err(|what| RefitError::OtherTopology { aggregate: None, what })?;

        // Nothing is changed before it is known that all can be.
        self.bounds = fit.bounded;
        let aggregates = self.aggregates.iter_mut().zip(&scene.aggregates);
        let aggregates = aggregates.zip(fits).filter_map(|((b, a), fit)| Some((b, &a.geometries, fit?)));
        for (built, geometries, fit) in aggregates.chain([(&mut self.world, &scene.world, fit)]) {
            if let Structure::Bvh8(tree) = &mut built.structure {
                tree.refit(fit.bounded, geometries, &fit.instances);
            }
            built.instances = fit.instances;
        }
        self.scene = scene;
        Ok(())
    }
}

/// A level before and after.
struct Change<'a> {
    old: (&'a [Geometry], &'a [Instance], &'a [PlacedInstance]),
    new: (&'a [Geometry], &'a [Instance], Vec<PlacedInstance>),
}

/// A level as it will be.
struct Fit {
    instances: Vec<PlacedInstance>,
    /// Around all that is bounded.
    bounded: Bounds3,
    /// Around everything.
    whole: Bounds3,
}

impl Change<'_> {
    /// What to fit to; or what is another.
    fn fit(self) -> Result<Fit, &'static str> {
        let ((old, old_instances, old_placed), (new, new_instances, placed)) = (self.old, self.new);
        if old.len() != new.len() {
            return Err("the number of geometries");
        }
        if !old.iter().zip(new).all(|(a, b)| same_primitives(&a.shape, &b.shape)) {
            return Err("the primitives");
        }
        if !old_instances.iter().map(|i| i.aggregate).eq(new_instances.iter().map(|i| i.aggregate)) {
            return Err("the instances");
        }
        let (mut bounded, mut whole) = (Bounds3::EMPTY, Bounds3::EMPTY);
        for ((before, ..), (now, ..)) in all_references(old, old_placed).zip(all_references(new, &placed)) {
            if before.is_empty() != now.is_empty() || before.is_finite() != now.is_finite() {
                return Err("what has bounds");
            }
            if !now.is_empty() {
                whole = whole.union(now);
                bounded = if now.is_finite() { bounded.union(now) } else { bounded };
            }
        }
        Ok(Fit { instances: placed, bounded, whole })
    }
}

/// The same type, the same number, the same indices.
fn same_primitives(a: &Shape, b: &Shape) -> bool {
    match (a, b) {
        (Shape::Triangles { indices: a, .. }, Shape::Triangles { indices: b, .. })
        | (Shape::MovingTriangles { indices: a, .. }, Shape::MovingTriangles { indices: b, .. }) => a == b,
        (Shape::Quads { indices: a, .. }, Shape::Quads { indices: b, .. }) => a == b,
        (Shape::Curves { segments: a, .. }, Shape::Curves { segments: b, .. }) => a == b,
        (Shape::Disks(_), Shape::Disks(_))
        | (Shape::Cylinders(_), Shape::Cylinders(_))
        | (Shape::Spheres(_), Shape::Spheres(_))
        | (Shape::User(_), Shape::User(_)) => a.len() == b.len(),
        _ => false,
    }
}
