//! The closed list of structures over one level: the world with its instances, or one aggregate.

use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::instance::PlacedInstance;
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Geometry;
use crate::search::{Enter, Level, Search};
use crate::{AccelKind, Executor, brute_force, bvh2, grid, kd_tree, sphere_hierarchy, wide};
use kirkas_geometry::Bounds3;

/// A structure over one level.
#[derive(Default)]
pub(crate) enum Structure {
    #[default]
    BruteForce,
    Bvh2(bvh2::Tree),
    Bvh8(wide::Tree),
    SphereHierarchy(sphere_hierarchy::Tree),
    KdTree(kd_tree::Tree),
    Grid(grid::Grid),
}

/// What a structure looks like.
#[derive(Clone, Copy, Default)]
pub(crate) struct Measures {
    /// Inner nodes, or cells.
    pub nodes: usize,
    /// Memory.
    pub bytes: usize,
    /// Expected cost of a random ray.
    pub sah_cost: f64,
    /// Levels of inner nodes.
    pub depth: usize,
}

impl Structure {
    /// Build over a level.
    pub fn build(
        kind: AccelKind,
        geometries: &[Geometry],
        instances: &[PlacedInstance],
        executor: &dyn Executor,
    ) -> Self {
        let bvh8 = |quality| Structure::Bvh8(wide::Tree::build(quality, geometries, instances, executor));
        let kd_tree = |planes| Structure::KdTree(kd_tree::Tree::build(planes, geometries, instances, executor));
        match kind {
            AccelKind::BruteForce => Structure::BruteForce,
            AccelKind::Bvh2 => Structure::Bvh2(bvh2::Tree::build(geometries, instances, executor)),
            AccelKind::Bvh8Fast => bvh8(wide::Quality::Fast),
            AccelKind::Bvh8 => bvh8(wide::Quality::Default),
            AccelKind::Bvh8Best => bvh8(wide::Quality::Best),
            AccelKind::Bvh8Compact => bvh8(wide::Quality::Compact),
            AccelKind::SphereHierarchy => {
                Structure::SphereHierarchy(sphere_hierarchy::Tree::build(geometries, instances, executor))
            }
            AccelKind::KdTree => kd_tree(kd_tree::Planes::All),
            AccelKind::KdTreeFast => kd_tree(kd_tree::Planes::Some),
            AccelKind::Grid => Structure::Grid(grid::Grid::build(geometries, instances)),
        }
    }

    /// Search all that the level holds; `enter` searches the instance of this index.
    #[inline]
    pub fn search<const ANY: bool>(
        &self,
        level: Level,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        enter: Enter<ANY>,
    ) {
        match self {
            Structure::BruteForce => brute_force::search(level, ray, search, enter),
            Structure::Bvh2(tree) => tree.search(level, ray, search, enter),
            Structure::Bvh8(tree) => tree.search(level, ray, search, enter),
            Structure::SphereHierarchy(tree) => tree.search(level, ray, search, enter),
            Structure::KdTree(tree) => tree.search(level, ray, search, enter),
            Structure::Grid(grid) => grid.search(level, ray, search, enter),
        }
    }

    /// Look for the closest point of all that the level holds; `enter` looks into the instance of this index.
    pub fn closest_point(&self, level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
        match self {
            Structure::BruteForce => brute_force::closest_point(level, space, search, enter),
            Structure::Bvh2(tree) => tree.closest_point(level, space, search, enter),
            Structure::Bvh8(tree) => tree.closest_point(level, space, search, enter),
            Structure::SphereHierarchy(tree) => tree.closest_point(level, space, search, enter),
            Structure::KdTree(tree) => tree.closest_point(level, space, search, enter),
            Structure::Grid(grid) => grid.closest_point(level, space, search, enter),
        }
    }

    /// Around all that is held, where that is known without asking each primitive.
    pub fn bounds(&self) -> Option<Bounds3> {
        match self {
            Structure::Bvh2(tree) => tree.bounds(),
            Structure::Bvh8(tree) => tree.bounds(),
            _ => None,
        }
    }

    /// Size and quality.
    pub fn measures(&self) -> Measures {
        match self {
            Structure::BruteForce => Measures::default(),
            Structure::Bvh2(t) => {
                Measures { nodes: t.node_count(), bytes: t.bytes(), sah_cost: t.sah_cost(), depth: t.depth() }
            }
            Structure::Bvh8(t) => {
                Measures { nodes: t.node_count(), bytes: t.bytes(), sah_cost: t.sah_cost(), depth: t.depth() }
            }
            Structure::SphereHierarchy(t) => {
                Measures { nodes: t.node_count(), bytes: t.bytes(), sah_cost: t.sah_cost(), depth: t.depth() }
            }
            Structure::KdTree(t) => {
                Measures { nodes: t.node_count(), bytes: t.bytes(), sah_cost: t.sah_cost(), depth: t.depth() }
            }
            Structure::Grid(g) => {
                Measures { nodes: g.cell_count(), bytes: g.bytes(), sah_cost: g.sah_cost(), depth: 1 }
            }
        }
    }

    /// Check every invariant; says what is wrong first.
    pub fn validate(&self, geometries: &[Geometry], instances: &[PlacedInstance]) -> Result<(), String> {
        match self {
            Structure::BruteForce => Ok(()),
            Structure::Bvh2(tree) => tree.validate(geometries, instances),
            Structure::Bvh8(tree) => tree.validate(geometries, instances),
            Structure::SphereHierarchy(tree) => tree.validate(geometries, instances),
            Structure::KdTree(tree) => tree.validate(geometries, instances),
            Structure::Grid(grid) => grid.validate(geometries, instances),
        }
    }
}
