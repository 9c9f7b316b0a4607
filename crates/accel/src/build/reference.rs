//! What builders sort: a primitive's box with its ids.

use super::lanes::Lanes;
use kirkas_geometry::{Bounds3, Vec3};

/// Sizes are capped at this, so that their products stay finite.
pub(crate) const MAX_SIZE: f32 = 1e18;

/// A box in the making. The fourth lanes carry the ids of a [`Reference`] and nothing otherwise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Box4 {
    pub lo: Lanes,
    pub hi: Lanes,
}

impl Box4 {
    pub const EMPTY: Box4 = Box4 { lo: Lanes([f32::INFINITY; 4]), hi: Lanes([f32::NEG_INFINITY; 4]) };

    #[inline(always)]
    pub fn union(self, o: Box4) -> Box4 {
        Box4 { lo: self.lo.min(o.lo), hi: self.hi.max(o.hi) }
    }

    /// Half the surface area, finite.
    #[inline(always)]
    pub fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|k| (self.hi.0[k] - self.lo.0[k]).min(MAX_SIZE));
        x * y + (y + x) * z
    }

    pub fn to_bounds(self) -> Bounds3 {
        let v = |l: Lanes| Vec3::new(l.0[0], l.0[1], l.0[2]);
        Bounds3 { min: v(self.lo), max: v(self.hi) }
    }
}

/// A primitive's box and ids.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference(pub Box4);

/// Ids ride in the fourth lanes as the bits of normal numbers: arithmetic on subnormal ones is hundreds of cycles slow.
const AS_NUMBER: u32 = 0x4000_0000;
/// Ids are at most this.
pub(crate) const MAX_ID: u32 = (1 << 28) - 1;

impl Reference {
    pub fn new(b: &Bounds3, geometry: u32, primitive: u32) -> Self {
        debug_assert!(geometry <= MAX_ID && primitive <= MAX_ID);
        let lanes = |v: Vec3, id: u32| Lanes([v.x, v.y, v.z, f32::from_bits(AS_NUMBER | id)]);
        Reference(Box4 { lo: lanes(b.min, geometry), hi: lanes(b.max, primitive) })
    }

    /// Geometry and primitive.
    pub fn ids(&self) -> (u32, u32) {
        (self.0.lo.0[3].to_bits() & MAX_ID, self.0.hi.0[3].to_bits() & MAX_ID)
    }

    pub fn bounds(&self) -> Bounds3 {
        self.0.to_bounds()
    }

    /// The center, without overflow.
    #[inline(always)]
    pub fn center(&self) -> Lanes {
        let half = Lanes::splat(0.5);
        self.0.lo.times(half).plus(self.0.hi.times(half))
    }
}
