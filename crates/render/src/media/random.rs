//! Random numbers where nobody knows how many will be needed: a counter, hashed with the key of the sample and its branch.

use kirkas_geometry::elementary::ln_f32;
use kirkas_geometry::hash::{combine, unit_f32};

/// A stream of random numbers: a function of its key alone.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    key: u64,
    count: u64,
}

impl Stream {
    /// The stream that `key` names.
    pub fn new(key: u64) -> Self {
        Stream { key, count: 0 }
    }

    /// The next number in `[0, 1)`.
    pub fn number(&mut self) -> f32 {
        self.count += 1;
        unit_f32((combine(self.key, self.count) >> 32) as u32)
    }

    /// An optical depth until the next event.
    pub fn depth(&mut self) -> f32 {
        depth(self.number())
    }
}

/// The optical depth until the next event that `u` in `[0, 1)` stands for: exponentially distributed.
pub fn depth(u: f32) -> f32 {
    -ln_f32(1.0 - u)
}
