//! A choice with fixed shares.

/// Shares of 1, summed up: found by halving, and neighbours in `u` stay neighbours.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Shares of the first, of the first two, ...; the last is 1.
    sums: Vec<f32>,
}

impl Table {
    pub(super) fn new(shares: impl Iterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let mut sums: Vec<f32> = shares.map(|s| (sum += s, sum as f32).1).collect();
        if let Some(last) = sums.last_mut() {
            *last = 1.0;
        }
        Table { sums }
    }

    pub(super) fn pick(&self, u: f32) -> (u32, f32) {
        let light = self.sums.partition_point(|&s| s <= u).min(self.sums.len() - 1) as u32;
        (light, self.probability(light))
    }

    /// As the rounded sums have it, so that it is exactly what `pick` does.
    pub(super) fn probability(&self, light: u32) -> f32 {
        let before = |n: usize| n.checked_sub(1).map_or(0.0, |n| self.sums[n]);
        self.sums.get(light as usize).map_or(0.0, |s| s - before(light as usize))
    }
}
