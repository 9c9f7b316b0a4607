//! Adaptive sampling: blocks of pixels that are known well enough get no more samples.
//!
//! Decisions fall on blocks of 8x8 pixels of the whole image, when every pixel that still goes on has equally many samples, a
//! power of two. The error of a block is the root mean square, over its pixels and channels, of the standard error of the
//! pixel's mean, over the block's mean value or a sixteenth of the image's, whichever is greater. It is computed from the
//! film's integers alone, so threads, flocks, checkpoints and resumes give the same decisions. A block stops when it and its
//! eight neighbours are all below the target (or have stopped): light that few samples find is rarely missed by all nine.
//!
//! The samples that decide are also those that are shown, so the mean of many such images is not exactly that of images with
//! a fixed number of samples (Kirk & Arvo 1991, "Unbiased Sampling Techniques for Image Synthesis"): pixels that have missed
//! rare light stop sooner. The bias vanishes with the target.

use super::{Film, Tile};
use kirkas_scene::Params;

/// Edge of a block in pixels.
pub const BLOCK: u32 = 8;

/// Blocks darker than this part of the image's mean are held to that.
const FLOOR: f64 = 1.0 / 16.0;

/// When a block has samples enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorTarget {
    /// The greatest error, as defined above.
    pub error: f64,
    /// No decision before so many samples.
    pub min_samples: u32,
}

impl ErrorTarget {
    /// From a sampler's parameters; `None` where none is asked for.
    pub fn new(p: &Params) -> Option<Self> {
        let is_offered = p.spec().params.iter().any(|row| row.name == "error");
        let error = if is_offered { p.number("error") } else { 0.0 };
        (error > 0.0).then(|| ErrorTarget { error, min_samples: p.integer("min_samples") as u32 })
    }

    /// True when decisions fall at so many samples.
    pub fn is_round(&self, samples: u32) -> bool {
        samples.is_power_of_two() && samples >= self.min_samples
    }

    /// The number of samples above `samples` at which decisions fall next.
    pub fn next_round(&self, samples: u32) -> u32 {
        let power = |n: u32| n.checked_next_power_of_two().unwrap_or(u32::MAX);
        power(samples.saturating_add(1)).max(power(self.min_samples))
    }
}

/// How far an adaptive film has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Blocks of the image.
    pub blocks: u32,
    /// Blocks that go on.
    pub open: u32,
    /// Samples per pixel, on the average.
    pub mean_samples: f64,
}

impl Film {
    /// The fewest and the most samples that a pixel which goes on has taken; `None` when all have stopped.
    pub fn going_on(&self) -> Option<(u32, u32)> {
        let counts = || self.tiles.iter().flat_map(|t| &t.counts).filter(|c| !c.is_stopped).map(|c| c.taken);
        Some((counts().min()?, counts().max()?))
    }

    /// Stop the blocks that have samples enough. To be called when all pixels that go on have equally many.
    pub fn judge(&mut self, target: &ErrorTarget) {
        // Sum up each block.
        let columns = self.layout.size.0.div_ceil(BLOCK) as usize;
        let rows = self.layout.size.1.div_ceil(BLOCK) as usize;
        let block_of = |tile: &Tile, i: usize| {
            let (x, y) = tile.place(i);
            (y / BLOCK) as usize * columns + (x / BLOCK) as usize
        };
        let mut blocks = vec![Block::default(); columns * rows];
        for tile in &self.tiles {
            for i in 0..tile.counts.len() {
                blocks[block_of(tile, i)].add(tile, i);
            }
        }
        let (sum, pixels) = blocks.iter().fold((0.0, 0.0), |(s, n), b| (s + b.mean, n + b.pixels));
        let floor = FLOOR * sum / pixels;

        // Those below the target, and with none but such around them, stop.
        let is_quiet: Vec<bool> =
            blocks.iter().map(|b| b.is_stopped || b.error() <= target.error * b.scale(floor)).collect();
        let stops = |block: usize| {
            let (x, y) = (block % columns, block / columns);
            let near = |at: usize, most: usize| at.saturating_sub(1)..(at + 2).min(most);
            near(y, rows).all(|v| near(x, columns).all(|u| is_quiet[v * columns + u]))
        };
        let stopped: Vec<bool> = (0..blocks.len()).map(stops).collect();
        for tile in &mut self.tiles {
            for i in 0..tile.counts.len() {
                let block = block_of(tile, i);
                tile.counts[i].is_stopped |= stopped[block];
            }
        }
    }

    /// How many blocks have stopped, and what they took.
    pub fn convergence(&self) -> Convergence {
        let columns = self.layout.size.0.div_ceil(BLOCK);
        let rows = self.layout.size.1.div_ceil(BLOCK);
        let is_corner = |x: u32, y: u32| x.is_multiple_of(BLOCK) && y.is_multiple_of(BLOCK);
        let open = self.pixels().filter(|&(x, y, t, i)| is_corner(x, y) && !t.counts[i].is_stopped).count() as u32;
        let taken: u64 = self.tiles.iter().flat_map(|t| &t.counts).map(|c| u64::from(c.taken)).sum();
        Convergence { blocks: columns * rows, open, mean_samples: taken as f64 / self.layout.crop.area() as f64 }
    }
}

/// Sums over a block's pixels.
#[derive(Clone, Copy, Default)]
struct Block {
    pixels: f64,
    /// Of the mean of the channels.
    mean: f64,
    /// Of the mean, over the channels, of the variance of the pixel's mean.
    variance: f64,
    is_stopped: bool,
}

impl Block {
    fn add(&mut self, tile: &Tile, pixel: usize) {
        let (mean, variance) = tile.moments(pixel);
        self.pixels += 1.0;
        self.mean += (mean[0] + mean[1] + mean[2]) / 3.0;
        self.variance += (variance[0] + variance[1] + variance[2]) / 3.0;
        self.is_stopped |= tile.counts[pixel].is_stopped;
    }

    /// Root mean square of the standard errors.
    fn error(&self) -> f64 {
        (self.variance / self.pixels).sqrt()
    }

    /// What the error is relative to.
    fn scale(&self, floor: f64) -> f64 {
        (self.mean / self.pixels).max(floor).max(0.0)
    }
}
