//! `bvh8`: a tree of boxes, eight children to a node and eight triangles to a leaf, for processors that test eight at once.
//!
//! It is asked in three ways, each its own file: one ray (`single`), a batch with many rays in flight (`in_flight`), and
//! packets of camera rays (`packet`). The arithmetic is in `backend`, for any processor, and in `avx2`, with the same bits.

mod arena;
#[cfg(target_arch = "x86_64")]
mod avx2;
mod backend;
mod box_ray;
mod closest;
mod emit;
mod in_flight;
mod motion;
mod node;
mod numbers;
mod packet;
mod refit;
mod saved;
mod single;
mod validate;
mod walker;

pub(crate) use in_flight::Batch;

use crate::Executor;
use crate::build::binary::MAX_DEPTH;
use crate::build::costs::Costs;
use crate::build::reference::Reference;
use crate::build::reinsertion::{self, Effort};
use crate::build::{binned_sah, morton, presplit, pure_leaves, spatial_split};
use crate::gather::{Gathered, gather};
use crate::instance::PlacedInstance;
use crate::primitive;
use crate::record::Record;
use crate::scene_geometry::{Geometry, Shape};
use arena::Line;
use kirkas_geometry::Bounds3;
use kirkas_geometry::rounding::UNIT_ROUNDOFF;
use node::Place;
use numbers::Numbers;

/// Levels of nodes: no more than the binary tree had.
const MAX_LEVELS: usize = MAX_DEPTH;

/// What a build spends for the rays to come.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quality {
    /// The least time: along a Morton curve.
    Fast,
    /// By the surface-area heuristic.
    Default,
    /// With spatial splits, and then improved.
    Best,
    /// The least memory: leaves hold numbers instead of corners.
    Compact,
}

/// A tree over one level: the world with its instances, or one aggregate.
pub(crate) struct Tree {
    lines: Vec<Line>,
    root: Place,
    numbers: Numbers,
    /// What no box holds; tested by every ray.
    unbounded: Vec<Record>,
    bounds: Bounds3,
    /// No coordinate of a box is larger.
    reach: f32,
    /// True when a primitive may be in several leaves, in parts.
    is_split: bool,
    /// True when there may be nodes of what moves.
    is_moving: bool,
    has_avx2: bool,
}

impl Tree {
    /// Build over a level.
    pub fn build(
        quality: Quality,
        geometries: &[Geometry],
        instances: &[PlacedInstance],
        executor: &dyn Executor,
    ) -> Self {
        let Gathered { mut references, bounds, unbounded } = gather(geometries, instances, executor);
        let (count, costs) = (references.len(), costs(geometries, instances));
        let is_moving = motion::is_moving(geometries);
        if is_moving {
            motion::take_middles(&mut references, geometries);
        }
        let corners = |r: &Reference| {
            let (geometry, index) = r.ids();
            match &geometries.get(geometry as usize)?.shape {
                Shape::Triangles { positions, indices } => Some(primitive::corners(positions, indices[index as usize])),
                _ => None,
            }
        };
        // Long triangles first.
        let room = match quality {
            Quality::Best => 0.8,
            Quality::Default => 0.2,
            Quality::Fast | Quality::Compact => 0.0,
        };
        let room = (count as f32 * room) as usize;
        let parts = presplit::presplit(&mut references, &corners, room, executor);
        let binary = match quality {
            // Where many were long, further cuts take long to find and gain nothing.
            Quality::Best if 4 * parts > room => {
                reinsertion::improve(binned_sah::build(references, &costs, executor), Effort::BEST, executor)
            }
            Quality::Fast => morton::build(references, executor),
            Quality::Default | Quality::Compact => binned_sah::build(references, &costs, executor),
            Quality::Best => {
                let split = spatial_split::build(references, &corners, &costs, executor);
                reinsertion::improve(split, Effort::BEST, executor)
            }
        };
        let is_triangle = |r: &Reference| {
            geometries.get(r.ids().0 as usize).is_some_and(|g| matches!(g.shape, Shape::Triangles { .. }))
        };
        let is_mixed = binary.references.iter().any(is_triangle) && !binary.references.iter().all(is_triangle);
        let binary = if is_mixed { pure_leaves::part(binary, &is_triangle) } else { binary };
        let is_compact = quality == Quality::Compact;
        let is_split = binary.references.len() > count;
        let numbers = Numbers::new(geometries);
        let (lines, root) =
            emit::emit(&binary, &bounds, (geometries, instances), &numbers, is_compact, costs.leaf, executor);
        let mut tree =
            Tree { lines, root, numbers, unbounded, bounds, reach: 0.0, is_split, is_moving, has_avx2: has_avx2() };
        if is_moving {
            tree.set_in_motion(geometries, instances);
        }
        tree.reach = tree.find_reach();
        tree
    }

    /// A number that no coordinate of a box exceeds.
    fn find_reach(&self) -> f32 {
        let of = |b: Bounds3| if b.is_empty() { 0.0 } else { b.min.abs().max(b.max.abs()).max_element() };
        let around = self.root_bounds();
        // What is interpolated may be rounded beyond both ends.
        let room = if around.is_moving { 1.0 + 8.0 * UNIT_ROUNDOFF } else { 1.0 };
        of(self.bounds).max(of(around.open)).max(of(around.close)) * room
    }

    /// Answer with the code for any processor, as if this one had no AVX2.
    pub fn forget_avx2(&mut self) {
        self.has_avx2 = false;
    }

    /// Around all that is held; `None` when something has no box.
    pub fn bounds(&self) -> Option<Bounds3> {
        self.unbounded.is_empty().then_some(self.bounds)
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.lines) + self.numbers.bytes() + size_of_val(&*self.unbounded)
    }
}

/// The prices for what most of a level is made of.
fn costs(geometries: &[Geometry], instances: &[PlacedInstance]) -> Costs {
    let is_block = |g: &&Geometry| matches!(g.shape, Shape::Triangles { .. });
    let triangles: usize = geometries.iter().filter(is_block).map(|g| g.shape.len()).sum();
    let others: usize = geometries.iter().filter(|g| !is_block(g)).map(|g| g.shape.len()).sum();
    if instances.len() > triangles + others {
        Costs::INSTANCES
    } else if others > triangles {
        Costs::BVH2
    } else {
        Costs::WIDE
    }
}

fn has_avx2() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}
