//! What the tests of the builders share.

use super::reference::Reference;
use crate::Executor;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Bounds3, Vec3};

/// Boxes of many sizes in a cube; the primitive's id is the index.
pub(crate) fn random_boxes(count: usize, seed: u64) -> Vec<Reference> {
    let at = |i: usize, k: u64| unit_f32(combine(combine(seed, i as u64), k) as u32);
    let of = |i: usize| {
        let low = Vec3::new(at(i, 0), at(i, 1), at(i, 2));
        let size = Vec3::new(at(i, 3), at(i, 4), at(i, 5)) * at(i, 6) * at(i, 6) * 0.1;
        Reference::new(&Bounds3 { min: low, max: low + size }, 0, i as u32)
    };
    (0..count).map(of).collect()
}

/// A new thread for one of each two jobs.
pub(crate) struct Threads;

impl Executor for Threads {
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        std::thread::scope(|s| {
            s.spawn(b);
            a();
        });
    }
}
