//! How the tree lies in memory: one arena of 64-byte lines, in which nodes take 4 lines, nodes of what moves 7, and leaf blocks 5.

use super::numbers::Numbers;
use crate::scene_geometry::{Geometry, Shape, Sphere};
use kirkas_geometry::{Bounds3, Vec3};

/// Children of a node, and triangles of a leaf block.
pub(super) const WIDTH: usize = 8;
/// Lines of a [`Node`].
pub(super) const NODE_LINES: usize = size_of::<Node>() / 64;
/// Lines of a [`MotionNode`].
pub(super) const MOTION_LINES: usize = size_of::<MotionNode>() / 64;
/// Lines of a [`Block`].
pub(super) const BLOCK_LINES: usize = size_of::<Block>() / 64;
/// Lines of a [`List`].
pub(super) const LIST_LINES: usize = size_of::<List>() / 64;

/// An inner node: the boxes of up to 8 children.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// `[2 * axis + (0 = low, 1 = high)][child]`. An empty slot has an empty box.
    pub planes: [[f32; WIDTH]; 6],
    /// Where the children are.
    pub children: [Place; WIDTH],
    /// The order in which a search for any hit looks at the children, most promising first; all ones for an empty slot.
    pub order: [u16; WIDTH],
    /// All ones for an empty slot, else 0.
    pub empty: [u16; WIDTH],
}

/// An inner node whose boxes change linearly in time.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct MotionNode {
    /// The node, with the boxes at the moment when the shutter opens. It comes first, so that the children are found alike.
    pub node: Node,
    /// The planes when the shutter closes.
    pub close: [[f32; WIDTH]; 6],
}

/// Up to 8 triangles, as a structure of arrays.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Block {
    /// `[3 * corner + axis][triangle]`.
    pub corners: [[f32; WIDTH]; 9],
    /// Their numbers within the level.
    pub numbers: [u32; WIDTH],
}

/// Spheres that a [`List`] holds itself.
pub(super) const BALLS: usize = 2;

/// Up to 8 primitives of any type, by number.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct List {
    /// Numbers within the level.
    pub numbers: [u32; WIDTH],
    /// Centre and radius of those of the first that are spheres: they are tested without a look elsewhere. Else zeros.
    pub balls: [[f32; 4]; BALLS],
}

/// Where a node or a leaf is: its type and size in the top 4 bits, its first line in the others. 28 bits of lines
/// address 16 GB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Place(pub u32);

/// Lines that a [`Place`] can address.
pub(super) const MAX_LINES: usize = 1 << 28;
const BLOCK: u32 = 1 << 31;
const LIST: u32 = 1 << 28;
const END: u32 = 2 << 28;
const MOTION: u32 = 3 << 28;
const LINE: u32 = (1 << 28) - 1;

impl Place {
    /// Nowhere: the ray is through.
    pub const END: Place = Place(END);

    /// An inner node.
    pub fn node(line: usize) -> Self {
        debug_assert!(line < MAX_LINES);
        Place(line as u32)
    }

    /// An inner node whose boxes move.
    pub fn motion(line: usize) -> Self {
        debug_assert!(line < MAX_LINES);
        Place(MOTION | line as u32)
    }

    /// The same at another line.
    pub fn moved_to(self, line: usize) -> Self {
        debug_assert!(line < MAX_LINES);
        Place(self.0 & !LINE | line as u32)
    }

    /// A block of `count` triangles.
    pub fn block(line: usize, count: usize) -> Self {
        debug_assert!(line < MAX_LINES && (1..=WIDTH).contains(&count));
        Place(BLOCK | (count as u32 - 1) << 28 | line as u32)
    }

    /// A list of primitives; how many it holds, it says itself.
    pub fn list(line: usize) -> Self {
        debug_assert!(line < MAX_LINES);
        Place(LIST | line as u32)
    }

    #[inline(always)]
    pub fn is_node(self) -> bool {
        self.0 < LIST
    }

    #[inline(always)]
    pub fn is_block(self) -> bool {
        self.0 & BLOCK != 0
    }

    /// An inner node whose boxes move. It is stepped on in the way of leaves, of which it is the rarest.
    #[inline(always)]
    pub fn is_motion(self) -> bool {
        self.0 >> 28 == MOTION >> 28
    }

    /// Lines of the leaf.
    pub fn leaf_lines(self) -> usize {
        if self.is_block() { BLOCK_LINES } else { LIST_LINES }
    }

    /// A list of primitives.
    pub fn is_list(self) -> bool {
        self.0 >> 28 == LIST >> 28
    }

    #[inline(always)]
    pub fn is_end(self) -> bool {
        self.0 == END
    }

    /// Triangles in the block.
    #[inline(always)]
    pub fn count(self) -> usize {
        (self.0 >> 28 & 7) as usize + 1
    }

    /// First line.
    #[inline(always)]
    pub fn line(self) -> usize {
        (self.0 & LINE) as usize
    }
}

impl Node {
    /// A node without children.
    pub const EMPTY: Node = Node {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        children: [Place::END; WIDTH],
        order: [u16::MAX; WIDTH],
        empty: [u16::MAX; WIDTH],
    };

    /// Put a box into a slot.
    pub fn set_bounds(&mut self, slot: usize, b: &Bounds3) {
        self.empty[slot] = 0;
        for k in 0..3 {
            self.planes[2 * k][slot] = b.min[k];
            self.planes[2 * k + 1][slot] = b.max[k];
        }
    }

    /// The box in a slot.
    pub fn bounds(&self, slot: usize) -> Bounds3 {
        let corner = |side: usize| Vec3::from([0, 1, 2].map(|k| self.planes[2 * k + side][slot]));
        Bounds3 { min: corner(0), max: corner(1) }
    }
}

impl Block {
    pub const EMPTY: Block = Block { corners: [[0.0; WIDTH]; 9], numbers: [List::NONE; WIDTH] };

    /// The corners of one triangle.
    #[inline(always)]
    pub fn triangle(&self, lane: usize) -> [[f32; 3]; 3] {
        let lane = lane & (WIDTH - 1);
        let c = &self.corners;
        [
            [c[0][lane], c[1][lane], c[2][lane]],
            [c[3][lane], c[4][lane], c[5][lane]],
            [c[6][lane], c[7][lane], c[8][lane]],
        ]
    }
}

impl List {
    /// Fills what is not used.
    pub const NONE: u32 = u32::MAX;
    pub const EMPTY: List = List { numbers: [List::NONE; WIDTH], balls: [[0.0; 4]; BALLS] };

    /// The sphere in a place, if it is held here.
    #[inline(always)]
    pub fn ball(&self, place: usize) -> Option<Sphere> {
        let &[x, y, z, radius] = self.balls.get(place)?;
        (radius > 0.0).then_some(Sphere { center: Vec3::new(x, y, z), radius })
    }

    /// Take note of the spheres as they are.
    pub fn set_balls(&mut self, numbers: &Numbers, geometries: &[Geometry]) {
        for (ball, &number) in self.balls.iter_mut().zip(&self.numbers).filter(|(_, n)| **n != List::NONE) {
            let (geometry, index) = numbers.ids(number);
            *ball = match geometries.get(geometry as usize).map(|g| &g.shape) {
                Some(Shape::Spheres(spheres)) => {
                    let Sphere { center, radius } = spheres[index as usize];
                    [center.x, center.y, center.z, radius]
                }
                _ => [0.0; 4],
            };
        }
    }
}
