//! A binary tree of boxes. (Stub: every primitive is tested.)
use crate::instance::PlacedInstance;
use crate::prepared_ray::PreparedRay;
use crate::scene_geometry::Geometry;
use crate::search::{Level, Search};
use crate::{Executor, brute_force};

#[derive(Default)]
pub(crate) struct Tree {
    instances: usize,
}

impl Tree {
    pub fn build(_: &[Geometry], instances: &[PlacedInstance], _: &dyn Executor) -> Self {
        Tree { instances: instances.len() }
    }
    pub fn search<const ANY: bool>(
        &self,
        level: Level,
        ray: &PreparedRay,
        search: &mut Search<ANY>,
        mut enter: impl FnMut(&mut Search<ANY>, u32),
    ) {
        brute_force::search(level, ray, search);
        for i in 0..self.instances {
            enter(search, i as u32);
        }
    }
    pub fn node_count(&self) -> usize {
        0
    }
    pub fn bytes(&self) -> usize {
        0
    }
    pub fn sah_cost(&self) -> f64 {
        0.0
    }
    pub fn depth(&self) -> usize {
        0
    }
    pub fn validate(&self, _: &[Geometry], _: &[PlacedInstance]) -> Result<(), String> {
        Ok(())
    }
}
