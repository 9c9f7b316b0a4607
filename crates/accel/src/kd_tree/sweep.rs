//! Chooses among all planes at sides of primitives, in O(n log n) for the whole tree (Wald & Havran 2006, "On building fast
//! kd-Trees for Ray Tracing, and on doing that in O(N log N)"): sides are sorted once for each axis, and a split keeps the
//! order. Only primitives that are cut get new sides ("perfect splits"), to be sorted and merged.
//!
//! Deviation: a triangle is cut as its plane within its bounds, not as a polygon; see the head of `cells`.

use super::Primitives;
use super::build::{Plane, PlaneCosts, Splitter};
use kirkas_geometry::Bounds3;

pub(super) struct Sweep<'a>(pub Primitives<'a>);

/// The events of a cell's primitives, sorted, for each axis.
#[derive(Default)]
pub(super) struct Events {
    count: usize,
    axes: [Vec<Event>; 3],
}

/// A side of a primitive: in order of position, then kind, then primitive.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Event(u64);

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    End,
    Flat,
    Start,
}

impl Event {
    fn new(position: f32, side: Side, primitive: u32) -> Self {
        // Bits that are in the order of the numbers; -0 is 0.
        let bits = (position + 0.0).to_bits();
        let ordered = if bits >> 31 == 1 { !bits } else { bits | 1 << 31 };
        Event(u64::from(ordered) << 32 | (side as u64) << 30 | u64::from(primitive))
    }

    #[inline(always)]
    fn position(self) -> f32 {
        let ordered = (self.0 >> 32) as u32;
        f32::from_bits(if ordered >> 31 == 1 { ordered & !(1 << 31) } else { !ordered })
    }

    #[inline(always)]
    fn side(self) -> Side {
        match self.0 >> 30 & 3 {
            0 => Side::End,
            1 => Side::Flat,
            _ => Side::Start,
        }
    }

    #[inline(always)]
    fn primitive(self) -> usize {
        (self.0 & ((1 << 30) - 1)) as usize
    }
}

impl Events {
    fn push(&mut self, primitive: u32, b: &Bounds3) {
        self.count += 1;
        for (k, events) in self.axes.iter_mut().enumerate() {
            if b.min[k] == b.max[k] {
                events.push(Event::new(b.min[k], Side::Flat, primitive));
            } else {
                events.push(Event::new(b.min[k], Side::Start, primitive));
                events.push(Event::new(b.max[k], Side::End, primitive));
            }
        }
    }

    fn sort(&mut self) {
        self.axes.iter_mut().for_each(|events| events.sort_unstable());
    }
}

/// Where a primitive goes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Goes {
    Left,
    Right,
    /// It is cut: its events are made anew.
    Both,
}

impl Splitter for Sweep<'_> {
    type Pieces = Events;
    type Scratch = Vec<Goes>;

    fn all(&self) -> Events {
        let mut events = Events::default();
        for (i, r) in self.0.references.iter().enumerate() {
            events.push(i as u32, &r.bounds());
        }
        events.sort();
        events
    }

    fn scratch(&self) -> Vec<Goes> {
        vec![Goes::Both; self.0.references.len()]
    }

    fn count(&self, events: &Events) -> usize {
        events.count
    }

    fn best_plane(&self, cell: &Bounds3, events: &Events) -> Option<Plane> {
        let costs = PlaneCosts::new(cell);
        let mut best = None;
        for (axis, events_here) in events.axes.iter().enumerate() {
            let (mut left, mut right) = (0, events.count);
            let mut rest = events_here.iter().peekable();
            while let Some(position) = rest.peek().map(|e| e.position()) {
                let mut sides = [0_usize; 3];
                while let Some(e) = rest.next_if(|e| e.position() == position) {
                    sides[e.side() as usize] += 1;
                }
                let [ends, flat, starts] = sides;
                right -= ends + flat;
                costs.offer(&mut best, axis, position, [left, flat, right]);
                left += starts + flat;
            }
        }
        best
    }

    fn divide(&self, events: &Events, plane: &Plane, cells: &[Bounds3; 2], goes: &mut Vec<Goes>) -> [Events; 2] {
        // Classify.
        let along = &events.axes[plane.axis];
        along.iter().for_each(|e| goes[e.primitive()] = Goes::Both);
        let mut counts = [0; 2];
        for e in along {
            let p = e.position();
            let side = match e.side() {
                Side::End if p <= plane.position => Goes::Left,
                Side::Start if p >= plane.position => Goes::Right,
                Side::Flat if p < plane.position || (p == plane.position && plane.flat_left) => Goes::Left,
                Side::Flat => Goes::Right,
                _ => continue,
            };
            goes[e.primitive()] = side;
            counts[usize::from(side == Goes::Right)] += 1;
        }

        // Cut what goes both ways.
        let mut fresh = [Events::default(), Events::default()];
        for e in along.iter().filter(|e| e.side() == Side::Start && goes[e.primitive()] == Goes::Both) {
            let primitive = e.primitive() as u32;
            for (events, part) in fresh.iter_mut().zip(self.0.cut(primitive, cells)) {
                if !part.is_empty() {
                    events.push(primitive, &part);
                }
            }
        }
        fresh.iter_mut().for_each(Events::sort);

        // Merge with what keeps its order.
        let half = |i: usize, side: Goes| {
            let fresh = &fresh[i];
            let axes = [0, 1, 2].map(|k| {
                let kept = events.axes[k].iter().filter(|e| goes[e.primitive()] == side).copied();
                merged(kept, &fresh.axes[k])
            });
            Events { count: counts[i] + fresh.count, axes }
        };
        [half(0, Goes::Left), half(1, Goes::Right)]
    }

    fn list(&self, events: &Events, out: &mut Vec<u32>) {
        out.extend(events.axes[0].iter().filter(|e| e.side() != Side::End).map(|e| e.primitive() as u32));
    }
}

/// Two sorted sequences as one.
fn merged(kept: impl Iterator<Item = Event>, fresh: &[Event]) -> Vec<Event> {
    let mut all = Vec::new();
    let mut fresh = fresh.iter().copied().peekable();
    for event in kept {
        while let Some(earlier) = fresh.next_if(|f| *f < event) {
            all.push(earlier);
        }
        all.push(event);
    }
    all.extend(fresh);
    all
}
