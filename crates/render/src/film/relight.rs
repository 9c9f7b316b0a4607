//! Light is linear: an image lit by lamps of other brightness and colour is a weighted sum of its light groups.

use super::{Film, fixed};

impl Film {
    /// The image with the light of group `g` multiplied by `scales[g]` per channel, in the integers: each sum is multiplied and
    /// rounded once to the film's unit, so factors of 1 change no bit. Second moments and spectral bins, which do not know
    /// of groups, are gone.
    pub fn relit(mut self, scales: &[[f64; 3]]) -> Film {
        for tile in &mut self.tiles {
            for sums in tile.sums.chunks_mut(scales.len()) {
                for (sum, scale) in sums.iter_mut().zip(scales) {
                    *sum = std::array::from_fn(|c| fixed::scaled(sum[c], scale[c]));
                }
            }
            tile.squares.fill([0; 3]);
            tile.bins.clear();
        }
        self.layout.bins = None;
        self
    }
}
