//! A node in 8 bytes.

use kirkas_geometry::Bounds3;

/// Inner: where the plane stands, its axis, and the right child (the left one follows at once). Leaf: a run of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub(super) struct Node {
    /// The bits of the plane's position, or the first index of the run.
    value: u32,
    /// In the two low bits the axis or `LEAF`; above them the right child's index, or the length of the run.
    link: u32,
}

const LEAF: u32 = 3;
/// Indices and lengths are below this.
pub(super) const MAX_LINK: usize = 1 << 30;

impl Node {
    /// The right child is set later.
    pub fn inner(axis: usize, position: f32) -> Self {
        debug_assert!(axis < 3);
        Node { value: position.to_bits(), link: axis as u32 }
    }

    pub fn leaf(first: usize, count: usize) -> Self {
        debug_assert!(first < MAX_LINK && count < MAX_LINK);
        Node { value: first as u32, link: (count as u32) << 2 | LEAF }
    }

    pub fn set_right(&mut self, right: usize) {
        debug_assert!(!self.is_leaf() && right < MAX_LINK);
        self.link = (right as u32) << 2 | self.link & 3;
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.link & 3 == LEAF
    }

    #[inline(always)]
    pub fn axis(self) -> usize {
        (self.link & 3) as usize
    }

    #[inline(always)]
    pub fn position(self) -> f32 {
        f32::from_bits(self.value)
    }

    #[inline(always)]
    pub fn right(self) -> usize {
        (self.link >> 2) as usize
    }

    /// The cells that the plane makes of one.
    pub fn halves(self, cell: &Bounds3) -> [Bounds3; 2] {
        let mut cells = [*cell; 2];
        (cells[0].max[self.axis()], cells[1].min[self.axis()]) = (self.position(), self.position());
        cells
    }

    /// First index and length of a leaf's run.
    #[inline(always)]
    pub fn run(self) -> (usize, usize) {
        (self.value as usize, (self.link >> 2) as usize)
    }

    /// The same node where the nodes start `nodes` later and the list `lists`.
    pub fn moved(self, nodes: usize, lists: usize) -> Self {
        if self.is_leaf() {
            let (first, count) = self.run();
            return Node::leaf(first + lists, count);
        }
        let mut moved = self;
        moved.set_right(self.right() + nodes);
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_bytes_hold_all() {
        assert_eq!(size_of::<Node>(), 8);
        let mut n = Node::inner(2, -0.75);
        n.set_right(MAX_LINK - 1);
        assert_eq!((n.is_leaf(), n.axis(), n.position(), n.right()), (false, 2, -0.75, MAX_LINK - 1));
        assert_eq!(n.moved(0, 9), n);
        let l = Node::leaf(7, 12345);
        assert_eq!((l.is_leaf(), l.run(), l.moved(5, 3).run()), (true, (7, 12345), (10, 12345)));
    }
}
