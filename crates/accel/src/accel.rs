//! The door: build a structure over a scene, then ask it for hits.

use crate::hit::{Counters, Hit, HitFilter, NO_INSTANCE};
use crate::instance::PlacedInstance;
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::{Geometry, SceneGeometry};
use crate::search::{Level, Search};
use crate::structure::{Measures, Structure};
use crate::{AccelError, AccelKind, Executor, check, primitive};
use kirkas_geometry::{Bounds3, Ray};

/// A structure over a scene. Immutable, and shared by as many threads as the caller likes.
pub struct Accel {
    kind: AccelKind,
    scene: SceneGeometry,
    instances: Vec<PlacedInstance>,
    bounds: Bounds3,
    /// Over the world, and over each aggregate.
    world: Structure,
    aggregates: Vec<Structure>,
}

/// What a structure looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Inner nodes, over all trees.
    pub nodes: usize,
    /// Primitives, each aggregate counted once.
    pub primitives: usize,
    /// Placed instances.
    pub instances: usize,
    /// Memory of the structure, without the scene's own arrays.
    pub bytes: usize,
    /// Expected cost of a random ray through the world's tree (surface-area heuristic; a primitive test costs 1, a node visit 2).
    pub sah_cost: f64,
    /// Levels of the deepest tree.
    pub depth: usize,
}

impl Accel {
    /// Build. The result does not depend on the executor.
    pub fn build(kind: AccelKind, scene: SceneGeometry, executor: &dyn Executor) -> Result<Accel, AccelError> {
        check::scene(&scene)?;
        let build = |a: &Vec<Geometry>| Structure::build(kind, a, &[], executor);
        let aggregates: Vec<Structure> = scene.aggregates.iter().map(build).collect();
        let object_bounds: Vec<Bounds3> = scene.aggregates.iter().map(|a| whole_bounds(a)).collect();
        let place = |i: &crate::Instance| PlacedInstance::new(i, &object_bounds[i.aggregate], scene.shutter);
        let instances: Vec<PlacedInstance> = scene.instances.iter().map(place).collect();
        let world = Structure::build(kind, &scene.world, &instances, executor);
        let placed = instances.iter().map(|i| i.bounds).filter(Bounds3::is_finite);
        let bounds = placed.fold(finite_bounds(&scene.world), Bounds3::union);
        Ok(Accel { kind, scene, instances, bounds, world, aggregates })
    }

    /// The nearest hit. `ray_index` is handed to the filter.
    pub fn closest_hit(
        &self,
        ray: &Ray,
        filter: Option<&dyn HitFilter>,
        ray_index: usize,
        counters: &mut Counters,
    ) -> Option<Hit> {
        let mut search = Search::<false>::new(ray, ray_index, filter, counters);
        self.search(ray, &mut search);
        search.best
    }

    /// True when anything is hit. `ray_index` is handed to the filter.
    pub fn any_hit(
        &self,
        ray: &Ray,
        filter: Option<&dyn HitFilter>,
        ray_index: usize,
        counters: &mut Counters,
    ) -> bool {
        let mut search = Search::<true>::new(ray, ray_index, filter, counters);
        self.search(ray, &mut search);
        search.best.is_some()
    }

    /// The nearest hit of each ray, as [`Accel::closest_hit`] gives it. The slices must be of one length.
    pub fn closest_hits(
        &self,
        rays: &[Ray],
        filter: Option<&dyn HitFilter>,
        hits: &mut [Option<Hit>],
        counters: &mut Counters,
    ) {
        assert_eq!(rays.len(), hits.len(), "as many answers as rays");
        for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
            *hit = self.closest_hit(ray, filter, i, counters);
        }
    }

    /// Whether each ray hits anything, as [`Accel::any_hit`] tells. The slices must be of one length.
    pub fn any_hits(
        &self,
        rays: &[Ray],
        filter: Option<&dyn HitFilter>,
        occluded: &mut [bool],
        counters: &mut Counters,
    ) {
        assert_eq!(rays.len(), occluded.len(), "as many answers as rays");
        for (i, (ray, answer)) in rays.iter().zip(occluded).enumerate() {
            *answer = self.any_hit(ray, filter, i, counters);
        }
    }

    /// The box around all finite geometry, over the whole shutter.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// The kind it was built as.
    pub fn kind(&self) -> AccelKind {
        self.kind
    }

    /// What it was built over.
    pub fn scene_geometry(&self) -> &SceneGeometry {
        &self.scene
    }

    /// Size and quality.
    pub fn statistics(&self) -> Statistics {
        let count = |g: &[Geometry]| g.iter().map(|g| g.shape.len()).sum::<usize>();
        let all: Vec<Measures> = self.aggregates.iter().chain([&self.world]).map(Structure::measures).collect();
        Statistics {
            nodes: all.iter().map(|m| m.nodes).sum(),
            primitives: count(&self.scene.world) + self.scene.aggregates.iter().map(|a| count(a)).sum::<usize>(),
            instances: self.instances.len(),
            bytes: all.iter().map(|m| m.bytes).sum::<usize>() + self.instances.len() * size_of::<PlacedInstance>(),
            sah_cost: all.last().map_or(0.0, |world| world.sah_cost),
            depth: all.iter().map(|m| m.depth).max().unwrap_or(0),
        }
    }

    /// Check every invariant of the trees: each primitive in exactly one leaf, each box around all below it, depth within
    /// the stack. Says what is wrong first.
    pub fn validate(&self) -> Result<(), String> {
        self.world.validate(&self.scene.world, &self.instances).map_err(|e| format!("world: {e}"))?;
        for (i, (tree, geometries)) in self.aggregates.iter().zip(&self.scene.aggregates).enumerate() {
            tree.validate(geometries, &[]).map_err(|e| format!("aggregate {i}: {e}"))?;
        }
        Ok(())
    }

    fn search<const ANY: bool>(&self, ray: &Ray, search: &mut Search<ANY>) {
        let Some(ray) = PreparedRay::new(ray) else { return };
        let instances = self.instances.len() as u32;
        let level = Level { geometries: &self.scene.world, instances, instance: NO_INSTANCE };
        self.world.search(level, &ray, search, &mut |search, index| self.search_instance(index, &ray, search));
    }

    fn search_instance<const ANY: bool>(&self, index: u32, ray: &PreparedRay, search: &mut Search<ANY>) {
        if search.is_done() {
            return;
        }
        let placed = &self.instances[index as usize];
        let Some(ray) = placed.enter(ray) else { return };
        let geometries = &self.scene.aggregates[placed.aggregate];
        let level = Level { geometries, instances: 0, instance: index };
        self.aggregates[placed.aggregate].search(level, &ray, search, &mut |_, _| {});
    }
}

/// The box around every primitive, unbounded ones too.
fn whole_bounds(geometries: &[Geometry]) -> Bounds3 {
    all_bounds(geometries).fold(Bounds3::EMPTY, Bounds3::union)
}

/// The box around the bounded primitives.
fn finite_bounds(geometries: &[Geometry]) -> Bounds3 {
    all_bounds(geometries).filter(Bounds3::is_finite).fold(Bounds3::EMPTY, Bounds3::union)
}

fn all_bounds(geometries: &[Geometry]) -> impl Iterator<Item = Bounds3> + '_ {
    geometries
        .iter()
        .flat_map(|g| (0..g.shape.len() as u32).map(|p| primitive::bounds(&g.shape, p)))
        .filter(|b| !b.is_empty())
}
