//! Where a ray is on its way through the tree, and the steps it takes. A step has no branch that depends on the data where it can be
//! helped, so that the steps of several rays overlap in the processor.

use super::arena::{self, Line};
use super::backend::{Backend, Keys, NO_KEY, Weights, key};
use super::box_ray::BoxRay;
use super::node::{Block, List, MotionNode, Node, Place, WIDTH};
use super::{MAX_LEVELS, Tree};
use crate::prepared_ray::PreparedRay;
use crate::record::IS_INSTANCE;
use crate::search::{Enter, Level, Search};
use crate::{moving, primitive, sphere};
use core::mem::MaybeUninit;
use kirkas_geometry::bounds::pad_far;

/// A visited node with children left to visit.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Entry {
    keys: Keys,
    /// The node's.
    children: *const [Place; WIDTH],
}

/// Where the guard leads: whoever takes it has nothing left to visit.
static NOWHERE: [Place; WIDTH] = [Place::END; WIDTH];

/// The nodes on the way down to where a ray is. Each visited node leaves at most one entry, so the tree's depth bounds it.
#[repr(C)]
struct Stack {
    /// Entries in use; the first is a guard that is never culled and leads to the end.
    len: usize,
    entries: [MaybeUninit<Entry>; MAX_LEVELS + 1],
}

/// Where a ray is. What each step touches comes first.
#[repr(C, align(64))]
pub(super) struct Walker {
    lanes: BoxRay,
    /// Boxes that are entered after this are culled.
    limit: f32,
    limit_key: u16,
    /// Where it is to step next.
    pub place: Place,
    stack: Stack,
}

/// What a walk needs of its tree.
pub(super) struct Ground<'t, 'e, const ANY: bool> {
    pub tree: &'t Tree,
    pub lines: *const Line,
    pub level: Level<'t>,
    pub enter: Enter<'e, ANY>,
}

impl<const ANY: bool> Ground<'_, '_, ANY> {
    /// Boxes that are entered after this are culled.
    #[inline(always)]
    pub fn limit(&self, ray: &PreparedRay, search: &Search<ANY>) -> f32 {
        let found = if search.limit < ray.clipped.t_max { search.limit } else { ray.clipped.t_max };
        if self.tree.is_split { pad_far(found) } else { found }
    }
}

impl Walker {
    /// A ray before its first step.
    #[inline(always)]
    pub fn start<'w, const ANY: bool>(
        slot: &'w mut MaybeUninit<Self>,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        ground: &Ground<ANY>,
    ) -> &'w mut Self {
        let w = slot.as_mut_ptr();
        let mut guard = Keys::NONE;
        guard.0[0] = 0;
        // SAFETY: every field is written but the unused entries of the stack, which may stay uninitialised.
        let w = unsafe {
            BoxRay::prepare(&mut *(&raw mut (*w).lanes).cast(), ray, ground.tree.reach);
            (&raw mut (*w).place).write(ground.tree.root);
            (&raw mut (*w).limit).write(0.0);
            (&raw mut (*w).limit_key).write(0);
            (&raw mut (*w).stack.len).write(1);
            (&raw mut (*w).stack.entries[0])
                .write(MaybeUninit::new(Entry { keys: guard, children: &raw const NOWHERE }));
            &mut *w
        };
        if !ground.tree.unbounded.is_empty() {
            for record in &ground.tree.unbounded {
                record.test(ground.level, ray, search, ground.enter);
            }
            if search.is_done() {
                w.place = Place::END;
            }
        }
        w.lower_limit(ray, search, ground);
        w
    }

    /// Take note of what was found.
    #[inline(always)]
    fn lower_limit<const ANY: bool>(&mut self, ray: &PreparedRay, search: &Search<ANY>, ground: &Ground<ANY>) {
        self.limit = ground.limit(ray, search);
        self.limit_key = if ANY { NO_KEY - 1 } else { key(self.limit) };
    }

    /// Test the boxes of the node where the ray is, and go to the nearest child or back up.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a node of the ground's tree.
    #[inline(always)]
    pub unsafe fn step_node<B: Backend, const ANY: bool>(&mut self, ground: &Ground<ANY>) {
        // SAFETY: the tree's places lead to what they say; the stack has room for a node on each level.
        unsafe {
            let node: *const Node = arena::get(ground.lines, self.place.line());
            let keys = B::boxes::<ANY>(node, &self.lanes, self.limit);
            self.descend::<B>(keys, ground.lines);
        }
    }

    /// Go to the nearest place that is left and not culled.
    ///
    /// # Safety
    /// As [`Walker::step_node`].
    #[inline(always)]
    unsafe fn next<B: Backend>(&mut self) {
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
                entry.keys = rest;
                self.stack.len -= usize::from(is_empty);
                self.place = *(*entry.children).get_unchecked(place);
                return;
            }
        }
    }

    /// [`Walker::step_node`] where boxes move: on the node as it is at the ray's moment.
    ///
    /// # Safety
    /// As [`Walker::step_node`], of a node of what moves.
    #[inline(never)]
    unsafe fn step_motion<B: Backend, const ANY: bool>(
        &mut self,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        ground: &Ground<ANY>,
    ) {
        search.counters.nodes_visited += 1;
        let moment = moving::moment(ray.clipped.time, ground.level.shutter);
        // SAFETY: as in `step_node`; a node of what moves begins with a node.
        unsafe {
            let node = &*arena::get::<MotionNode>(ground.lines, self.place.line());
            let keys = B::boxes::<ANY>(&node.at(moment), &self.lanes, self.limit);
            self.descend::<B>(keys, ground.lines);
        }
    }

    /// Go to the nearest of these children of the node where the ray is, or back up.
    ///
    /// # Safety
    /// As [`Walker::step_node`]; the keys are those of the node at `place`.
    #[inline(always)]
    unsafe fn descend<B: Backend>(&mut self, keys: Keys, lines: *const Line) {
        // SAFETY: the tree's places lead to what they say; the stack has room for a node on each level.
        unsafe {
            let (least, child) = B::least(&keys);
            if least == NO_KEY {
                return self.next::<B>();
            }
            // Written in any case, kept if there is something in it.
            let (keys, is_empty) = B::without(&keys, child);
            let node: *const Node = arena::get(lines, self.place.line());
            let children = &raw const (*node).children;
            *self.stack.entries.get_unchecked_mut(self.stack.len) = MaybeUninit::new(Entry { keys, children });
            self.stack.len += usize::from(!is_empty);
            self.place = *(*children).get_unchecked(child);
        }
    }

    /// [`Walker::step_node`] for one of many rays: what it finds goes through the stack in any case, so that nothing hangs on
    /// whether it finds anything.
    ///
    /// # Safety
    /// As [`Walker::step_node`].
    #[inline(always)]
    pub unsafe fn step_node_in_flight<B: Backend, const ANY: bool>(&mut self, ground: &Ground<ANY>) {
        // SAFETY: the tree's places lead to what they say; the stack has room for a node on each level.
        unsafe {
            let node: *const Node = arena::get(ground.lines, self.place.line());
            let keys = B::boxes::<ANY>(node, &self.lanes, self.limit);
            let entry = Entry { keys, children: &raw const (*node).children };
            *self.stack.entries.get_unchecked_mut(self.stack.len) = MaybeUninit::new(entry);
            self.stack.len += usize::from(!B::is_empty(&keys));
            self.next::<B>();
        }
    }

    /// Go on from a block that was tested; from any other leaf, test what is in it first.
    ///
    /// # Safety
    /// As [`Walker::step_leaf`], or the end of the way.
    #[inline(always)]
    pub unsafe fn after_leaf<B: Backend, const ANY: bool>(
        &mut self,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        ground: &Ground<ANY>,
    ) {
        // SAFETY: the caller promises as much.
        unsafe {
            if !self.place.is_block() {
                if !self.place.is_end() {
                    self.step_leaf::<B, ANY>(ray, search, ground);
                }
                return;
            }
            self.lower_limit(ray, search, ground);
            if search.is_done() {
                self.place = Place::END;
            } else {
                self.next::<B>();
            }
        }
    }

    /// Test what is in the leaf where the ray is, and go on; or step on a node of what moves.
    ///
    /// # Safety
    /// The CPU has what `B` needs; `place` is a leaf of the ground's tree, or a node of what moves.
    #[inline(always)]
    pub unsafe fn step_leaf<B: Backend, const ANY: bool>(
        &mut self,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        ground: &Ground<ANY>,
    ) {
        if self.place.is_motion() {
            // SAFETY: the caller promises as much.
            return unsafe { self.step_motion::<B, ANY>(ray, search, ground) };
        }
        // SAFETY: the caller promises as much.
        unsafe {
            test_leaf::<B, ANY>(self.place, ray, search, ground);
            self.lower_limit(ray, search, ground);
            if search.is_done() {
                self.place = Place::END;
            } else {
                self.next::<B>();
            }
        }
    }
}

/// Test what is in a leaf.
///
/// # Safety
/// The CPU has what `B` needs; `place` is a leaf of the ground's tree.
#[inline(always)]
pub unsafe fn test_leaf<B: Backend, const ANY: bool>(
    place: Place,
    ray: &PreparedRay,
    search: &mut Search<ANY>,
    ground: &Ground<ANY>,
) {
    // SAFETY: the tree's places lead to what they say.
    unsafe {
        if !place.is_block() {
            test_list(&*arena::get(ground.lines, place.line()), ray, search, ground);
            return;
        }
        let block: *const Block = arena::get(ground.lines, place.line());
        let count = place.count();
        search.counters.primitives_tested += count as u64;
        let mut weights = MaybeUninit::<Weights>::uninit();
        let mut passing = B::edges(block, ray, &mut weights) & ((1 << count) - 1);
        while passing != 0 {
            let lane = passing.trailing_zeros() as usize & 7;
            passing &= passing - 1;
            if let Some(crossing) = B::crossing(block, lane, ray, weights.assume_init_ref()) {
                let (geometry, index) = ground.tree.numbers.ids((&(*block).numbers)[lane]);
                search.offer(ground.level, geometry, index, crossing);
            }
        }
    }
}

#[inline(never)]
fn test_list<const ANY: bool>(list: &List, ray: &PreparedRay, search: &mut Search<ANY>, ground: &Ground<ANY>) {
    for (place, &number) in list.numbers.iter().take_while(|n| **n != List::NONE).enumerate() {
        if let Some(ball) = list.ball(place) {
            search.counters.primitives_tested += 1;
            sphere::intersect(&ball, ray, |t| {
                let (geometry, index) = ground.tree.numbers.ids(number);
                search.offer(ground.level, geometry, index, (t, 0.0, 0.0))
            });
            continue;
        }
        let (geometry, index) = ground.tree.numbers.ids(number);
        if geometry == IS_INSTANCE {
            (ground.enter)(ray, search, index);
        } else {
            search.counters.primitives_tested += 1;
            let shape = &ground.level.geometries[geometry as usize].shape;
            let offer = |t, u, v| search.offer(ground.level, geometry, index, (t, u, v));
            primitive::intersect(shape, index, ray, ground.level.shutter, offer);
        }
    }
}
