//! Independent random numbers from a counter: for statistics, where the renderer's well-spread points would be too good.

use kirkas_geometry::hash::{combine, mix64, unit_f32};

/// A stream of numbers in `[0, 1)`.
#[derive(Clone, Debug)]
pub struct Random {
    seed: u64,
    count: u64,
}

impl Random {
    /// The stream that `seed` names.
    pub fn new(seed: u64) -> Self {
        Random { seed: mix64(seed), count: 0 }
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.count += 1;
        combine(self.seed, self.count)
    }

    /// One number.
    pub fn number(&mut self) -> f32 {
        unit_f32((self.bits() >> 32) as u32)
    }

    /// Two numbers.
    pub fn pair(&mut self) -> (f32, f32) {
        (self.number(), self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_has_the_moments_of_the_unit_interval() {
        let mut r = Random::new(1);
        let n = 100_000;
        let (mut sum, mut squares, mut lagged, mut last) = (0.0, 0.0, 0.0, 0.5);
        for _ in 0..n {
            let x = f64::from(r.number());
            assert!((0.0..1.0).contains(&x));
            sum += x;
            squares += x * x;
            lagged += (x - 0.5) * (last - 0.5);
            last = x;
        }
        let n = f64::from(n);
        assert!((sum / n - 0.5).abs() < 0.004 && (squares / n - 1.0 / 3.0).abs() < 0.004 && (lagged / n).abs() < 0.002);
    }
}
