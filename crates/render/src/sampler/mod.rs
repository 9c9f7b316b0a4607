//! Samplers: a sample is a pure function of (pixel, sample index, dimension, seed), whatever the image size and the final
//! count. A dimension is a hash of the branch of the ray tree and the purpose, so no effect shifts another's numbers.
//!
//! Every frame of a film has a seed of its own ([`frame_seed`]): noise that stood still while the picture moves would look
//! like dirt on the lens, and noise that changes averages out over frames.

mod halton;
mod independent;
mod sobol;
mod stratified;

use kirkas_geometry::hash::{combine, of_name};
use kirkas_scene::{Params, TypeSpec};

/// Every sampler type.
pub const SAMPLERS: &[&TypeSpec] = &[&sobol::SPEC, &halton::SPEC, &stratified::SPEC, &independent::SPEC];

/// Which sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerKind {
    /// Owen-scrambled Sobol' pairs.
    Sobol,
    /// Owen-scrambled Halton pairs.
    Halton,
    /// Multi-jittered samples.
    Stratified {
        /// How many there are, for each pixel.
        samples: u32,
    },
    /// Independent random numbers.
    Independent,
}

impl SamplerKind {
    /// By the name of one of [`SAMPLERS`], for so many samples per pixel.
    pub fn from_name(name: &str, samples: u32) -> Option<Self> {
        match name {
            "sobol" => Some(SamplerKind::Sobol),
            "halton" => Some(SamplerKind::Halton),
            "stratified" => Some(SamplerKind::Stratified { samples }),
            "independent" => Some(SamplerKind::Independent),
            _ => None,
        }
    }

    /// From its parameters.
    pub fn new(p: &Params) -> Self {
        Self::from_name(p.spec().name, p.integer("samples") as u32).unwrap_or(SamplerKind::Sobol)
    }

    /// The number of samples per pixel that it is made for, if it cannot give more.
    pub fn limit(self) -> Option<u32> {
        match self {
            SamplerKind::Stratified { samples } => Some(samples),
            SamplerKind::Sobol | SamplerKind::Halton | SamplerKind::Independent => None,
        }
    }
}

/// The seed of the numbers of frame `frame`; that of a single picture is `seed` itself.
pub fn frame_seed(seed: u64, frame: Option<u32>) -> u64 {
    frame.map_or(seed, |n| combine(combine(seed, FRAME), u64::from(n)))
}

const FRAME: u64 = of_name("frame");

/// The numbers of one sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    kind: SamplerKind,
    pixel_seed: u64,
    index: u32,
}

impl Sampler {
    /// Sample `index` of the pixel at `(x, y)` in the whole image.
    pub fn new(kind: SamplerKind, seed: u64, x: u32, y: u32, index: u32) -> Self {
        let pixel_seed = combine(combine(seed, 0x6b69_726b), u64::from(y) << 32 | u64::from(x));
        Sampler { kind, pixel_seed, index }
    }

    /// Two numbers in `[0, 1)` for `purpose`.
    pub fn pair(&self, purpose: u64) -> (f32, f32) {
        self.pair_of(purpose, 0, 1)
    }

    /// Pair `i` of `count` that this sample uses for `purpose`: together a longer stretch of the same sequence, so that they
    /// are stratified among themselves and with the other samples' pairs.
    pub fn pair_of(&self, purpose: u64, i: u32, count: u32) -> (f32, f32) {
        let index = self.index.wrapping_mul(count).wrapping_add(i);
        let seed = combine(self.pixel_seed, purpose);
        match self.kind {
            SamplerKind::Sobol => sobol::pair(index, seed),
            SamplerKind::Halton => halton::pair(index, seed),
            SamplerKind::Stratified { samples } => {
                let (total, index) = (u64::from(samples) * u64::from(count), u64::from(self.index));
                stratified::pair((index * u64::from(count) + u64::from(i)) % total, total, seed)
            }
            SamplerKind::Independent => independent::pair(index, seed),
        }
    }

    /// One number in `[0, 1)` for `purpose`.
    pub fn one(&self, purpose: u64) -> f32 {
        match self.kind {
            SamplerKind::Sobol => sobol::one(self.index, combine(self.pixel_seed, purpose)),
            _ => self.pair(purpose).0,
        }
    }

    /// A hash that names this sample: for decisions that are no sequence (opacity).
    pub fn key(&self) -> u64 {
        combine(self.pixel_seed, u64::from(self.index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_sampler_has_a_kind() {
        assert!(SAMPLERS.iter().all(|s| SamplerKind::from_name(s.name, 4).is_some()));
    }

    #[test]
    fn sixteen_sobol_samples_fall_in_sixteen_cells_and_split_pairs_do_too() {
        for (samples, split) in [(16_u32, 1_u32), (4, 4)] {
            let mut seen = [false; 16];
            for s in 0..samples {
                for i in 0..split {
                    let (x, y) = Sampler::new(SamplerKind::Sobol, 0, 3, 4, s).pair_of(of_name("lens"), i, split);
                    seen[(x * 4.0) as usize + 4 * (y * 4.0) as usize] = true;
                }
            }
            assert!(seen.iter().all(|&s| s));
        }
    }

    #[test]
    fn pixels_purposes_and_seeds_differ() {
        let a = |seed, x, purpose| Sampler::new(SamplerKind::Independent, seed, x, 0, 0).pair(purpose);
        assert_ne!(a(0, 0, 1), a(0, 0, 2));
        assert_ne!(a(0, 0, 1), a(0, 1, 1));
        assert_ne!(a(0, 0, 1), a(1, 0, 1));
    }

    #[test]
    fn frames_of_all_seeds_have_seeds_of_their_own() {
        assert_eq!(frame_seed(7, None), 7);
        let mut seeds: Vec<u64> =
            (0..20).flat_map(|s| (0..50).map(move |n| frame_seed(s, Some(n)))).chain(0..20).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 20 * 50 + 20);
    }
}
