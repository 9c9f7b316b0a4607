//! Primitives of a level, numbered through: geometry by geometry, then the instances. The order of the numbers is the order in
//! which ties are won.

use crate::record::IS_INSTANCE;
use crate::scene_geometry::Geometry;

/// The first number of each geometry, and after them that of the first instance.
#[derive(Default)]
pub(super) struct Numbers(Vec<u32>);

impl Numbers {
    pub fn new(geometries: &[Geometry]) -> Self {
        let mut next = 0;
        let mut first = vec![0];
        for g in geometries {
            next += g.shape.len() as u32;
            first.push(next);
        }
        Numbers(first)
    }

    /// The number of a primitive or instance.
    pub fn of(&self, geometry: u32, index: u32) -> u32 {
        let geometry = if geometry == IS_INSTANCE { self.0.len() - 1 } else { geometry as usize };
        self.0[geometry] + index
    }

    /// Geometry and primitive of a number; for an instance [`IS_INSTANCE`] and its index.
    #[inline(always)]
    pub fn ids(&self, number: u32) -> (u32, u32) {
        if self.0.len() == 2 && number < self.0[1] {
            return (0, number);
        }
        self.find(number)
    }

    #[inline(never)]
    fn find(&self, number: u32) -> (u32, u32) {
        // Of a few, counting is quicker than searching.
        let geometry = if self.0.len() <= 32 {
            self.0.iter().map(|&first| usize::from(first <= number)).sum::<usize>() - 1
        } else {
            self.0.partition_point(|&first| first <= number) - 1
        };
        let index = number - self.0[geometry];
        if geometry + 1 == self.0.len() { (IS_INSTANCE, index) } else { (geometry as u32, index) }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}
