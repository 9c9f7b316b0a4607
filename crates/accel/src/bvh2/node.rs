//! How the tree lies in memory: nodes of 64 bytes with the boxes of both children, leaves as runs of 48-byte records.

use crate::prepared_ray::PreparedRay;
use crate::triangle::Corners;
use kirkas_geometry::Bounds3;
use kirkas_geometry::bounds::pad_far;

/// An inner node.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// `planes[axis][0 = low, 1 = high][child]`.
    pub planes: [[[f32; 2]; 2]; 3],
    pub children: [Child; 2],
}

/// Where a child is: an inner node's index, or a leaf's run of records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(u32);

/// A leaf's run.
pub(crate) const MAX_LEAF: usize = 8;
const LEAF: u32 = 1 << 31;
const FIRST: u32 = (1 << 28) - 1;

impl Child {
    pub fn node(index: usize) -> Self {
        debug_assert!(index < LEAF as usize);
        Child(index as u32)
    }

    pub fn leaf(first: usize, count: usize) -> Self {
        debug_assert!((1..=MAX_LEAF).contains(&count) && first <= FIRST as usize);
        Child(LEAF | ((count - 1) as u32) << 28 | first as u32)
    }

    #[inline]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    /// Index of an inner node.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// First record and number of records of a leaf.
    #[inline]
    pub fn run(self) -> (usize, usize) {
        ((self.0 & FIRST) as usize, (self.0 >> 28 & 7) as usize + 1)
    }

    /// As a number.
    #[inline]
    pub fn bits(self) -> u32 {
        self.0
    }

    /// The child that [`Child::bits`] gave.
    #[inline]
    pub fn from_bits(bits: u32) -> Self {
        Child(bits)
    }

    /// The same child in an array where the nodes start `by` later.
    pub fn moved(self, by: usize) -> Self {
        if self.is_leaf() { self } else { Child::node(self.index() + by) }
    }
}

/// What the box test of both children needs of a ray.
#[derive(Clone, Copy)]
pub(crate) struct NodeRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// 1 where the direction is negative: the high plane is met first.
    first: [usize; 3],
    t_min: f32,
}

impl NodeRay {
    pub fn new(ray: &PreparedRay) -> Self {
        let inverse = ray.inverse.to_array();
        NodeRay {
            origin: ray.clipped.origin.to_array(),
            inverse,
            first: inverse.map(|i| usize::from(i.is_sign_negative())),
            t_min: ray.clipped.t_min,
        }
    }
}

impl Node {
    pub fn new(boxes: [&Bounds3; 2], children: [Child; 2]) -> Self {
        let plane = |k: usize| [boxes.map(|b| b.min[k]), boxes.map(|b| b.max[k])];
        Node { planes: [plane(0), plane(1), plane(2)], children }
    }

    /// The box of one child.
    pub fn child_bounds(&self, child: usize) -> Bounds3 {
        let corner = |side: usize| [0, 1, 2].map(|k| self.planes[k][side][child]).into();
        Bounds3 { min: corner(0), max: corner(1) }
    }

    /// `Bounds3::intersect` for both children at once: when the ray enters, and whether it does before `limit`.
    #[inline(always)]
    pub fn intersect(&self, ray: &NodeRay, limit: f32) -> ([f32; 2], [bool; 2]) {
        let mut near = [ray.t_min; 2];
        let mut far = [f32::INFINITY; 2];
        for k in 0..3 {
            let side = ray.first[k] & 1;
            let (enter, leave) = (self.planes[k][side], self.planes[k][side ^ 1]);
            for c in 0..2 {
                let e = (enter[c] - ray.origin[k]) * ray.inverse[k];
                let l = (leave[c] - ray.origin[k]) * ray.inverse[k];
                // NaN, a ray within a face, loses both comparisons.
                near[c] = if e > near[c] { e } else { near[c] };
                far[c] = if l < far[c] { l } else { far[c] };
            }
        }
        let far = far.map(pad_far).map(|f| if limit < f { limit } else { f });
        (near, [near[0] <= far[0], near[1] <= far[1]])
    }
}

/// A primitive as a leaf holds it: everything its test needs, without following an index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    /// A triangle's corners; a sphere's center and, in `[1][0]`, radius; otherwise unused.
    pub corners: Corners,
    /// Index of the geometry; for an instance unused.
    pub geometry: u32,
    /// Index of the primitive, or of the instance.
    pub primitive: u32,
    pub kind: RecordKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum RecordKind {
    Triangle,
    Sphere,
    User,
    Instance,
}
