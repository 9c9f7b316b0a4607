//! The door: build a structure over a scene, then ask it for hits.

use crate::hit::{Counters, Hit};
use crate::instance::{Entered, PlacedInstance};
use crate::path::InstancePath;
use crate::prepared_ray::PreparedRay;
use crate::query::Query;
use crate::scene_geometry::{Geometry, Instance, SceneGeometry};
use crate::search::{Enter, Level, Search};
use crate::structure::{Measures, Structure};
use crate::wide::Batch;
use crate::{AccelError, AccelKind, Executor, check, record};
use core::cell::RefCell;
use core::cmp::Ordering;
use core::mem::MaybeUninit;
use kirkas_geometry::{Bounds3, Ray};

/// A structure over a scene. Immutable, and shared by as many threads as the caller likes.
pub struct Accel {
    kind: AccelKind,
    pub(crate) scene: SceneGeometry,
    pub(crate) bounds: Bounds3,
    pub(crate) world: Built,
    pub(crate) aggregates: Vec<Built>,
}

/// The structure over the world or over an aggregate.
#[derive(Default)]
pub(crate) struct Built {
    pub structure: Structure,
    pub instances: Vec<PlacedInstance>,
}

/// What a structure looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Inner nodes, over all trees.
    pub nodes: usize,
    /// Primitives, each aggregate counted once.
    pub primitives: usize,
    /// Placed instances, those within an aggregate counted once.
    pub instances: usize,
    /// Memory of the structure, without the scene's own arrays.
    pub bytes: usize,
    /// Expected cost of a random ray through the world's tree (surface-area heuristic; the prices
    /// of tests and visits are those of its structure).
    pub sah_cost: f64,
    /// Levels of the deepest tree.
    pub depth: usize,
}

impl Accel {
    /// Build. The result does not depend on the executor.
    pub fn build(kind: AccelKind, scene: SceneGeometry, executor: &dyn Executor) -> Result<Accel, AccelError> {
        Self::assemble(kind, scene, |geometries, instances| Ok(Structure::build(kind, geometries, instances, executor)))
    }

    /// Put structures over all levels, aggregates after those they hold and the world last.
    pub(crate) fn assemble<E: From<AccelError>>(
        kind: AccelKind,
        scene: SceneGeometry,
        mut structure_over: impl FnMut(&[Geometry], &[PlacedInstance]) -> Result<Structure, E>,
    ) -> Result<Accel, E> {
        check::scene(&scene)?;
        let aggregates = &scene.aggregates;
        let mut whole = vec![Bounds3::EMPTY; aggregates.len()];
        let mut built: Vec<Built> = aggregates.iter().map(|_| Built::default()).collect();
        for i in check::build_order(&scene)?.order {
            let instances = place(&aggregates[i].instances, &whole, scene.shutter);
            let structure = structure_over(&aggregates[i].geometries, &instances)?;
            let each = || all_bounds(&aggregates[i].geometries, &instances).fold(Bounds3::EMPTY, Bounds3::union);
            whole[i] = structure.bounds().unwrap_or_else(each);
            built[i] = Built { structure, instances };
        }
        let instances = place(&scene.instances, &whole, scene.shutter);
        let structure = structure_over(&scene.world, &instances)?;
        let finite = || all_bounds(&scene.world, &instances).filter(Bounds3::is_finite);
        let bounds = structure.bounds().unwrap_or_else(|| finite().fold(Bounds3::EMPTY, Bounds3::union));
        Ok(Accel { kind, scene, bounds, world: Built { structure, instances }, aggregates: built })
    }

    /// This structure, answering with the code for any processor even where this one has AVX2: the same answers, later. The simple
    /// twin that tests the fast code.
    pub fn portable(mut self) -> Self {
        for built in self.aggregates.iter_mut().chain([&mut self.world]) {
            if let Structure::Bvh8(tree) = &mut built.structure {
                tree.forget_avx2();
            }
        }
        self
    }

    /// The nearest hit. `ray_index` is handed to the query's filter, and finds what this ray excludes.
    pub fn closest_hit(&self, ray: &Ray, query: Query, ray_index: usize, counters: &mut Counters) -> Option<Hit> {
        let mut search = Search::<false>::new(ray, ray_index, query);
        self.search(ray, &mut search);
        *counters += search.counters;
        search.best
    }

    /// True when anything is hit. `ray_index` is handed to the query's filter, and finds what this ray excludes.
    pub fn any_hit(&self, ray: &Ray, query: Query, ray_index: usize, counters: &mut Counters) -> bool {
        let mut search = Search::<true>::new(ray, ray_index, query);
        self.search(ray, &mut search);
        *counters += search.counters;
        search.best.is_some()
    }

    /// Every hit along the ray, nearest first, each once: those of equal `t` in the order of (path, geometry, primitive, `u`,
    /// `v`). A primitive is hit as often as the ray crosses it; crossings that round to the same `t`, `u` and `v` are one.
    /// `visit` returns true to stop. `ray_index` as for [`Accel::closest_hit`].
    pub fn all_hits(
        &self,
        ray: &Ray,
        query: Query,
        ray_index: usize,
        counters: &mut Counters,
        visit: &mut dyn FnMut(&Hit) -> bool,
    ) {
        let found = RefCell::new(Vec::new());
        let mut search = Search::<false>::new(ray, ray_index, query);
        search.all = Some(&found);
        self.search(ray, &mut search);
        *counters += search.counters;
        let mut hits = found.into_inner();
        // Of -0 and 0 neither is nearer.
        let by_t = |a: &Hit, b: &Hit| a.t.partial_cmp(&b.t).unwrap_or(Ordering::Equal);
        let by_weights = |a: &Hit, b: &Hit| a.u.total_cmp(&b.u).then(a.v.total_cmp(&b.v));
        hits.sort_by(|a, b| by_t(a, b).then(a.id().cmp(&b.id())).then_with(|| by_weights(a, b)));
        hits.dedup();
        let _ = hits.iter().any(visit);
    }

    /// The nearest hit of each ray, as [`Accel::closest_hit`] gives it. The slices must be of one length.
    pub fn closest_hits(&self, rays: &[Ray], query: Query, hits: &mut [Option<Hit>], counters: &mut Counters) {
        assert_eq!(rays.len(), hits.len(), "as many answers as rays");
        if let Structure::Bvh8(tree) = &self.world.structure {
            let batch = Batch { rays, query, level: self.world_level() };
            let enter: Enter<false> = &|ray, search, index| self.search_instance(index, ray, search);
            return tree.search_batch(&batch, enter, counters, |i, hit| hits[i] = hit);
        }
        for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
            *hit = self.closest_hit(ray, query, i, counters);
        }
    }

    /// [`Accel::closest_hits`] for rays that run close together, such as those of a camera, where neighbours in the slice are
    /// neighbours in space. The same answers, sooner.
    pub fn closest_hits_coherent(&self, rays: &[Ray], query: Query, hits: &mut [Option<Hit>], counters: &mut Counters) {
        assert_eq!(rays.len(), hits.len(), "as many answers as rays");
        let Structure::Bvh8(tree) = &self.world.structure else {
            return self.closest_hits(rays, query, hits, counters);
        };
        let batch = Batch { rays, query, level: self.world_level() };
        let enter: Enter<false> = &|ray, search, index| self.search_instance(index, ray, search);
        tree.search_packets(&batch, enter, counters, hits);
    }

    /// Whether each ray hits anything, as [`Accel::any_hit`] tells. The slices must be of one length.
    pub fn any_hits(&self, rays: &[Ray], query: Query, occluded: &mut [bool], counters: &mut Counters) {
        assert_eq!(rays.len(), occluded.len(), "as many answers as rays");
        if let Structure::Bvh8(tree) = &self.world.structure {
            let batch = Batch { rays, query, level: self.world_level() };
            let enter: Enter<true> = &|ray, search, index| self.search_instance(index, ray, search);
            return tree.search_batch(&batch, enter, counters, |i, hit| occluded[i] = hit.is_some());
        }
        for (i, (ray, answer)) in rays.iter().zip(occluded).enumerate() {
            *answer = self.any_hit(ray, query, i, counters);
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
        let built = || self.aggregates.iter().chain([&self.world]);
        let all: Vec<Measures> = built().map(|b| b.structure.measures()).collect();
        let instances = built().map(|b| b.instances.len()).sum::<usize>();
        let in_aggregates = self.scene.aggregates.iter().map(|a| count(&a.geometries)).sum::<usize>();
        Statistics {
            nodes: all.iter().map(|m| m.nodes).sum(),
            primitives: count(&self.scene.world) + in_aggregates,
            instances,
            bytes: all.iter().map(|m| m.bytes).sum::<usize>() + instances * size_of::<PlacedInstance>(),
            sah_cost: all.last().map_or(0.0, |world| world.sah_cost),
            depth: all.iter().map(|m| m.depth).max().unwrap_or(0),
        }
    }

    /// Check every invariant of the trees: each primitive where rays look for it, all bounds around what is below them,
    /// depth within the stack. Says what is wrong first.
    pub fn validate(&self) -> Result<(), String> {
        let world = &self.world;
        world.structure.validate(&self.scene.world, &world.instances).map_err(|e| format!("world: {e}"))?;
        for (i, (built, a)) in self.aggregates.iter().zip(&self.scene.aggregates).enumerate() {
            let valid = built.structure.validate(&a.geometries, &built.instances);
            valid.map_err(|e| format!("aggregate {i}: {e}"))?;
        }
        Ok(())
    }

    #[inline(always)]
    fn search<const ANY: bool>(&self, ray: &Ray, search: &mut Search<ANY>) {
        let mut place = MaybeUninit::uninit();
        if !PreparedRay::prepare(&mut place, ray, (ray.t_min, ray.t_max)) {
            return;
        }
        // SAFETY: prepared.
        let ray = unsafe { place.assume_init_ref() };
        self.world
            .structure
            .search(self.world_level(), ray, search, &|ray, search, index| self.search_instance(index, ray, search));
    }

    pub(crate) fn world_level(&self) -> Level<'_> {
        self.level(&self.scene.world, &self.world, InstancePath::WORLD)
    }

    pub(crate) fn level<'a>(&self, geometries: &'a [Geometry], built: &Built, instance: InstancePath) -> Level<'a> {
        Level { geometries, instances: built.instances.len() as u32, instance, shutter: self.scene.shutter }
    }

    /// Search an instance of the world.
    fn search_instance<const ANY: bool>(&self, index: u32, ray: &PreparedRay, search: &mut Search<ANY>) {
        if search.is_done() {
            return;
        }
        let placed = &self.world.instances[index as usize];
        let Some(ray) = placed.enter(ray) else { return };
        let instance = InstancePath::WORLD.then(index);
        let built = &self.aggregates[placed.aggregate];
        if built.instances.is_empty() {
            let level = self.level(&self.scene.aggregates[placed.aggregate].geometries, built, instance);
            built.structure.search(level, &ray, search, &|_, _, _| {});
        } else {
            let world_from_object = placed.place(&self.scene.instances[index as usize], search.ray.time);
            self.search_aggregate(placed.aggregate, instance, &Entered { ray, world_from_object }, search);
        }
    }

    /// Search an aggregate that holds instances.
    fn search_aggregate<const ANY: bool>(
        &self,
        aggregate: usize,
        instance: InstancePath,
        entered: &Entered,
        search: &mut Search<ANY>,
    ) {
        let (built, held) = (&self.aggregates[aggregate], &self.scene.aggregates[aggregate]);
        let level = self.level(&held.geometries, built, instance);
        built.structure.search(level, &entered.ray, search, &|_, search, index| {
            let placed = &built.instances[index as usize];
            if search.is_done() {
                return;
            }
            if let Some(inner) = placed.enter_from(&held.instances[index as usize], entered, search.ray) {
                self.search_aggregate(placed.aggregate, instance.then(index), &inner, search);
            }
        });
    }
}

/// Instances at their places; `whole` are the bounds of the aggregates.
pub(crate) fn place(instances: &[Instance], whole: &[Bounds3], shutter: (f64, f64)) -> Vec<PlacedInstance> {
    instances.iter().map(|i| PlacedInstance::new(i, &whole[i.aggregate], shutter)).collect()
}

/// The boxes of all that a level holds and that is not empty, unbounded ones too.
fn all_bounds<'a>(
    geometries: &'a [Geometry],
    instances: &'a [PlacedInstance],
) -> impl Iterator<Item = Bounds3> + use<'a> {
    record::all_references(geometries, instances).map(|(bounds, ..)| bounds).filter(|b| !b.is_empty())
}
