//! Partial opacity: surfaces that are there for some rays and not for others, by a coin for each.

use super::Scene;
use crate::sampler::Sampler;
use kirkas_accel::{Hit, HitFilter};
use kirkas_geometry::Ray;
use kirkas_geometry::hash::{combine, of_name, unit_f32};

/// Decides the coin of partial opacity: hash(sample, branch, pane) < alpha.
pub struct AlphaFilter<'a, K> {
    /// Where surfaces are looked up.
    pub scene: &'a Scene,
    /// Per ray, by its place in the batch: the hash of its sample and branch.
    pub key: K,
}

impl AlphaFilter<'_, ()> {
    /// The key of a shadow ray: not its path's, since what let that one pass must not let this one pass as well.
    pub fn shadow_key(sampler: &Sampler, branch: u64) -> u64 {
        combine(combine(sampler.key(), branch), SHADOW)
    }
}

const SHADOW: u64 = of_name("shadow");

impl<K: Fn(usize) -> u64 + Sync> HitFilter for AlphaFilter<'_, K> {
    fn accept(&self, ray_index: usize, ray: &Ray, hit: &Hit) -> bool {
        let alpha = self.scene.alpha(ray, hit);
        let place = u64::from(hit.instance.outermost()) << 32 | u64::from(hit.geometry);
        let pane = self.scene.part(hit).surface.pane(hit.primitive);
        let coin = combine(combine((self.key)(ray_index), place), u64::from(pane));
        unit_f32((coin >> 32) as u32) < alpha
    }
}
