//! One ray on its way through the tree, and the steps it takes. A step has no branch that depends on the data where it can be
//! helped, so that the steps of several rays overlap in the processor.

use super::arena::{self, Line};
use super::backend::{Backend, Keys, NO_KEY, key};
use super::node::{Block, List, Node, Place};
use super::{MAX_LEVELS, Tree};
use crate::prepared_ray::PreparedRay;
use crate::record::IS_INSTANCE;
use crate::search::{Enter, Level, Search};
use crate::{primitive, triangle};
use core::mem::MaybeUninit;
use kirkas_geometry::bounds::pad_far;

/// What the eight-wide tests need of a ray.
#[repr(C)]
pub(super) struct RayLanes {
    pub origin: [f32; 3],
    pub t_min: f32,
    pub inverse: [f32; 3],
    /// Byte offsets in a node of the planes that the ray meets first.
    pub first_plane: [u32; 3],
    /// Byte offsets in a block of corner 0's rows along the ray's axes.
    pub axis_row: [u32; 3],
    pub sheared_origin: [f32; 3],
    pub shear: [f32; 2],
}

impl RayLanes {
    #[inline(always)]
    fn new(ray: &PreparedRay) -> Self {
        let inverse = ray.inverse.to_array();
        RayLanes {
            origin: ray.clipped.origin.to_array(),
            t_min: ray.clipped.t_min,
            inverse,
            first_plane: Walker::<false>::first_plane(ray),
            axis_row: ray.axes.map(|k| 32 * (k as u32).min(2)),
            sheared_origin: ray.sheared_origin,
            shear: ray.shear,
        }
    }
}

/// A visited node with children left to visit.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Entry {
    keys: Keys,
    node: Place,
}

/// The nodes on the way down to where a ray is. Each visited node leaves at most one entry, so the tree's depth bounds it.
struct Stack {
    entries: [MaybeUninit<Entry>; MAX_LEVELS + 1],
    /// Entries in use; the first is a guard that is never culled and leads to the end.
    len: usize,
}

/// A ray, where it is, and what it has found.
pub(super) struct Walker<'a, const ANY: bool> {
    pub lanes: RayLanes,
    /// Boxes that are entered after this are culled.
    limit: f32,
    limit_key: u16,
    /// Where it is to step next.
    pub place: Place,
    pub search: Search<'a, ANY>,
    pub ray: PreparedRay,
    stack: Stack,
}

/// What a walk needs of its tree.
pub(super) struct Ground<'t> {
    pub tree: &'t Tree,
    pub lines: *const Line,
    pub level: Level<'t>,
}

impl<'a, const ANY: bool> Walker<'a, ANY> {
    /// A ray before its first step.
    #[inline(always)]
    pub fn start(
        slot: &mut MaybeUninit<Self>,
        ray: &PreparedRay,
        search: Search<'a, ANY>,
        ground: &Ground,
        enter: Enter<ANY>,
    ) {
        let w = slot.as_mut_ptr();
        // SAFETY: every field is written but the unused entries of the stack, which may stay uninitialised.
        let w = unsafe {
            (&raw mut (*w).lanes).write(RayLanes::new(ray));
            (&raw mut (*w).search).write(search);
            (&raw mut (*w).ray).write(*ray);
            (&raw mut (*w).place).write(ground.tree.root);
            (&raw mut (*w).limit).write(ray.clipped.t_max);
            (&raw mut (*w).limit_key).write(0);
            (&raw mut (*w).stack.len).write(1);
            let mut guard = Keys::NONE;
            guard.0[0] = 0;
            (&raw mut (*w).stack.entries[0]).write(MaybeUninit::new(Entry { keys: guard, node: Place::END }));
            &mut *w
        };
        for record in &ground.tree.unbounded {
            record.test(ground.level, &w.ray, &mut w.search, enter);
        }
        w.lower_limit(ground);
        if w.search.is_done() {
            w.place = Place::END;
        }
    }

    /// Byte offsets in a node of the planes that the ray meets first.
    #[inline(always)]
    pub fn first_plane(ray: &PreparedRay) -> [u32; 3] {
        let inverse = ray.inverse.to_array();
        [0, 1, 2].map(|k| 64 * k as u32 + 32 * u32::from(inverse[k].is_sign_negative()))
    }

    /// Boxes that are entered after this are culled.
    #[inline(always)]
    pub fn limit(&self) -> f32 {
        self.limit
    }

    /// Take note of what was found.
    #[inline(always)]
    fn lower_limit(&mut self, ground: &Ground) {
        let found = if self.search.limit < self.ray.clipped.t_max { self.search.limit } else { self.ray.clipped.t_max };
        self.limit = if ground.tree.is_split { pad_far(found) } else { found };
        self.limit_key = if ANY { NO_KEY - 1 } else { key(self.limit) };
    }

    /// Test the boxes of the node where the ray is, and go to the nearest child or back up.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a node of the ground's tree.
    #[inline(always)]
    pub unsafe fn step_node<B: Backend>(&mut self, ground: &Ground) {
        self.search.counters.nodes_visited += 1;
        // SAFETY: the tree's places lead to what they say; the stack has room for a node on each level.
        unsafe {
            let node: *const Node = arena::get(ground.lines, self.place.line());
            let keys = B::boxes::<ANY>(node, &self.lanes, self.limit);
            let (least, _) = B::least(&keys);
            // Written in any case, kept if there is something in it.
            *self.stack.entries.get_unchecked_mut(self.stack.len) = MaybeUninit::new(Entry { keys, node: self.place });
            self.stack.len += usize::from(least != NO_KEY);
            self.next::<B>(ground);
        }
    }

    /// Go to the nearest place that is left and not culled.
    ///
    /// # Safety
    /// As [`Walker::step_node`].
    #[inline(always)]
    unsafe fn next<B: Backend>(&mut self, ground: &Ground) {
        // SAFETY: the guard at the bottom of the stack is never passed.
        unsafe {
            loop {
                let entry = self.stack.entries.get_unchecked_mut(self.stack.len - 1).assume_init_mut();
                let (least, place) = B::least(&entry.keys);
                if least > self.limit_key {
                    self.stack.len -= 1;
                    continue;
                }
                let (rest, is_empty) = B::without(&entry.keys, place);
                if self.stack.len == 1 {
                    self.place = Place::END;
                    return;
                }
                entry.keys = rest;
                self.stack.len -= usize::from(is_empty);
                let node: *const Node = arena::get(ground.lines, entry.node.line());
                self.place = *(*node).children.get_unchecked(place);
                return;
            }
        }
    }

    /// Test what is in the leaf where the ray is, and go on.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a leaf of the ground's tree.
    #[inline(always)]
    pub unsafe fn step_leaf<B: Backend>(&mut self, ground: &Ground, enter: Enter<ANY>) {
        // SAFETY: the caller promises as much.
        unsafe {
            self.test_leaf::<B>(ground, self.place, enter);
            if self.search.is_done() {
                self.place = Place::END;
            } else {
                self.next::<B>(ground);
            }
        }
    }

    /// Test what is in a leaf.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a leaf of the ground's tree.
    #[inline(always)]
    pub unsafe fn test_leaf<B: Backend>(&mut self, ground: &Ground, place: Place, enter: Enter<ANY>) {
        // SAFETY: the tree's places lead to what they say.
        unsafe {
            if place.is_block() {
                let block: *const Block = arena::get(ground.lines, place.line());
                let count = place.count();
                self.search.counters.primitives_tested += count as u64;
                let mut passing = B::edges(block, &self.lanes) & ((1 << count) - 1);
                while passing != 0 {
                    let lane = passing.trailing_zeros() as usize;
                    passing &= passing - 1;
                    self.meet(&*block, lane, ground);
                }
            } else {
                let list: *const List = arena::get(ground.lines, place.line());
                self.test_list(&*list, ground, enter);
            }
        }
    }

    /// The full test of one triangle.
    #[inline(always)]
    fn meet(&mut self, block: &Block, lane: usize, ground: &Ground) {
        if let Some(crossing) = triangle::intersect(&block.triangle(lane), &self.ray) {
            let (geometry, index) = ground.tree.numbers.ids(block.numbers[lane]);
            self.search.offer(ground.level, geometry, index, crossing);
            self.lower_limit(ground);
        }
    }

    #[inline(never)]
    fn test_list(&mut self, list: &List, ground: &Ground, enter: Enter<ANY>) {
        for &number in list.numbers.iter().take_while(|n| **n != List::NONE) {
            let (geometry, index) = ground.tree.numbers.ids(number);
            if geometry == IS_INSTANCE {
                enter(&self.ray, &mut self.search, index);
            } else {
                self.search.counters.primitives_tested += 1;
                let shape = &ground.level.geometries[geometry as usize].shape;
                let offer = |t, u, v| self.search.offer(ground.level, geometry, index, (t, u, v));
                primitive::intersect(shape, index, &self.ray, ground.level.shutter, offer);
            }
        }
        self.lower_limit(ground);
    }
}
