//! Several places along the ellipse that a sample covers, for patterns whose own filter knows only widths along their axes.
//!
//! McCormack et al. 1999, "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping": lookups in a line along the longer axis,
//! here with the weights of a tent.

/// Places along an ellipse in `N` dimensions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taps<const N: usize> {
    count: u32,
    long: [f64; N],
    width: [f64; N],
    /// Length of the shorter axis.
    short: f64,
}

impl<const N: usize> Taps<N> {
    /// As many as the ellipse is longer than wide, up to `most`.
    pub(super) fn along([a, b]: [[f64; N]; 2], most: u32) -> Self {
        let square = |v: [f64; N]| v.iter().map(|x| x * x).sum::<f64>();
        let (a2, b2) = (square(a), square(b));
        let (long, short, long2, short2) = if a2 >= b2 { (a, b, a2, b2) } else { (b, a, b2, a2) };
        let most = f64::from(most);
        let is_round = !(long2 > 1.5 * 1.5 * short2);
        let count = if is_round { 1.0 } else { (2.0 * (long2 / short2).sqrt()).ceil().min(most) };
        // Alone, a place covers all of it; together, each what lies between it and the next.
        let share = if is_round { 1.0 } else { 2.0 / count };
        let width = std::array::from_fn(|i| long[i].abs() * share + short[i].abs());
        Taps { count: count as u32, long, width, short: short2.sqrt() }
    }

    /// How far along axis `i` any of it looks.
    pub(super) fn reach(&self, i: usize) -> f64 {
        match self.count {
            1 => self.width[i],
            n => self.long[i].abs() * (1.0 - 1.0 / f64::from(n)) + self.width[i],
        }
    }

    /// About the width of the filter at each place, along any direction.
    pub(super) fn widest(&self) -> f64 {
        let share = if self.count == 1 { 1.0 } else { 2.0 / f64::from(self.count) };
        let long = self.long.iter().map(|x| x * x).sum::<f64>().sqrt() * share;
        long.max(self.short)
    }

    /// The width of the filter at each place, along axis `i`.
    pub(super) fn width(&self, i: usize) -> f64 {
        self.width[i]
    }

    /// The mean of `value` at each place and under a filter of this width along each axis.
    pub(super) fn mean(&self, place: [f64; N], value: impl Fn([f64; N], [f64; N]) -> f64) -> f64 {
        if self.count <= 1 {
            return value(place, self.width);
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for i in 0..self.count {
            let along = (2.0 * f64::from(i) + 1.0) / f64::from(self.count) - 1.0;
            let weight = 1.0 - along.abs();
            sum += weight * value(std::array::from_fn(|i| place[i] + self.long[i] * along), self.width);
            weights += weight;
        }
        sum / weights
    }
}
