//! A distribution over a latitude-longitude map whose density is the bilinear interpolation of the map's weights: the same
//! interpolation that the map is looked up with, so that even a sun of a single texel is sampled as it is seen.
//!
//! Texel centres lie at whole numbers plus a half. Columns go round; the top and bottom rows reach to the poles, where the
//! weight (which holds the sine of the polar angle) is 0. The cells between centres are chosen by the marginal of their
//! rows, then by their columns, then a point in the cell from the product of two linear densities.

/// See the head of this file.
#[derive(Clone, Debug)]
pub struct MapDistribution {
    columns: usize,
    rows: usize,
    /// At the texel centres, `rows * columns`.
    weights: Vec<f32>,
    /// Per row of cells (`rows + 1` of them) the cumulated probabilities of its cells, each row ending with 1.
    cell_sums: Vec<f32>,
    /// Cumulated probabilities of the rows of cells, ending with 1.
    row_sums: Vec<f32>,
    /// Where to look in each row of `cell_sums`, and in `row_sums`.
    cell_guides: Vec<u32>,
    row_guide: Vec<u32>,
}

/// A point of a map, in texels from the top left corner, with its density per square texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Column, `0 <= x < columns`.
    pub x: f64,
    /// Row, `0 <= y <= rows`.
    pub y: f64,
    /// Density per square texel.
    pub pdf: f64,
}

impl MapDistribution {
    /// For `weights` at the texel centres, row by row from the top; `None` if none is above 0 or their sum overflows.
    pub fn new(columns: usize, weights: Vec<f32>) -> Option<Self> {
        let rows = weights.len() / columns.max(1);
        let (cell_sums, row_sums, cell_guides, row_guide) = Default::default();
        let mut d = MapDistribution { columns, rows, weights, cell_sums, row_sums, cell_guides, row_guide };
        let mut row_weights = Vec::with_capacity(rows + 1);
        d.cell_sums.reserve((rows + 1) * columns);
        let mut cells = vec![0.0; columns];
        for row in 0..=rows {
            for (column, cell) in cells.iter_mut().enumerate() {
                let [[a, b], [c, e]] = d.corners(row, column);
                *cell = (a + b + c + e) * 0.25 * height(row, rows);
            }
            row_weights.push(cells.iter().sum());
            d.cell_sums.extend(cumulated(&cells));
        }
        let total: f64 = row_weights.iter().sum();
        d.row_sums = cumulated(&row_weights).collect();
        d.cell_guides = d.cell_sums.chunks(columns.max(1)).flat_map(guide).collect();
        d.row_guide = guide(&d.row_sums).collect();
        (total > 0.0 && total.is_finite()).then_some(d)
    }

    /// A point, from two numbers in `[0, 1)`.
    pub fn sample(&self, u: (f32, f32)) -> MapPoint {
        let (row, row_probability, v) = choose(&self.row_sums, &self.row_guide, f64::from(u.1));
        let cells = &self.cell_sums[row * self.columns..][..self.columns];
        let entries = self.cell_guides.len() / (self.rows + 1);
        let guide = &self.cell_guides[row * entries..][..entries];
        let (column, cell_probability, u) = choose(cells, guide, f64::from(u.0));
        let [[a, b], [c, d]] = self.corners(row, column);
        let t = sample_linear(a + b, c + d, v);
        let (left, right) = (a + (c - a) * t, b + (d - b) * t);
        let s = sample_linear(left, right, u);
        let x = column as f64 + 0.5 + s;
        let x = if x < self.columns as f64 { x } else { x - self.columns as f64 };
        let y = top(row) + t * height(row, self.rows);
        let density = row_probability * cell_probability / height(row, self.rows);
        MapPoint { x, y, pdf: density * relative(left, right, s, a + b + c + d) }
    }

    /// The density of [`MapDistribution::sample`] at a point of the map, per square texel.
    pub fn pdf(&self, x: f64, y: f64) -> f64 {
        let row = ((y + 0.5).max(0.0) as usize).min(self.rows);
        let t = ((y - top(row)) / height(row, self.rows)).clamp(0.0, 1.0);
        // The cell that crosses the seam is the last one.
        let x = if x < 0.5 { x - 0.5 + self.columns as f64 } else { x - 0.5 };
        let column = (x.max(0.0) as usize).min(self.columns - 1);
        let s = (x - column as f64).clamp(0.0, 1.0);
        let [[a, b], [c, d]] = self.corners(row, column);
        let (left, right) = (a + (c - a) * t, b + (d - b) * t);
        let cells = &self.cell_sums[row * self.columns..][..self.columns];
        let density = probability(&self.row_sums, row) * probability(cells, column) / height(row, self.rows);
        density * relative(left, right, s, a + b + c + d)
    }

    /// Weights at the corners of a cell: `[[top left, top right], [bottom left, bottom right]]`.
    fn corners(&self, row: usize, column: usize) -> [[f64; 2]; 2] {
        let next = if column + 1 == self.columns { 0 } else { column + 1 };
        let at = |row: usize| {
            let texels = &self.weights[row * self.columns..][..self.columns];
            [f64::from(texels[column]), f64::from(texels[next])]
        };
        [if row == 0 { [0.0; 2] } else { at(row - 1) }, if row == self.rows { [0.0; 2] } else { at(row) }]
    }
}

/// Where a row of cells begins, in texels.
fn top(row: usize) -> f64 {
    if row == 0 { 0.0 } else { row as f64 - 0.5 }
}

/// How high it is: the first and the last reach from a centre to a pole.
fn height(row: usize, rows: usize) -> f64 {
    if row == 0 || row == rows { 0.5 } else { 1.0 }
}

/// The bilinear density in a cell, relative to its mean (a quarter of the sum of its corners).
fn relative(left: f64, right: f64, s: f64, sum: f64) -> f64 {
    if sum > 0.0 { 4.0 * (left + (right - left) * s) / sum } else { 0.0 }
}

/// Running sums as parts of the whole, ending with 1; all 1 where the whole is 0.
fn cumulated(weights: &[f64]) -> impl Iterator<Item = f32> {
    let total: f64 = weights.iter().sum();
    let last = weights.iter().rposition(|w| *w > 0.0);
    let mut sum = 0.0;
    weights.iter().enumerate().map(move |(i, w)| {
        sum += w;
        if last.is_none_or(|last| i >= last) { 1.0 } else { (sum / total) as f32 }
    })
}

/// The probability of an entry, exactly as [`choose`] has it.
fn probability(sums: &[f32], i: usize) -> f64 {
    f64::from(sums[i]) - if i == 0 { 0.0 } else { f64::from(sums[i - 1]) }
}

/// The entry that `u` falls into, its probability, and where in it, in `[0, 1]`. The guide (Chen & Asau 1974) leaves a few entries to
/// look through, wherever most of the probability lies.
fn choose(sums: &[f32], guide: &[u32], u: f64) -> (usize, f64, f64) {
    let k = ((u * (guide.len() - 1) as f64) as usize).min(guide.len() - 2);
    let (first, end) = (guide[k] as usize, guide[k + 1] as usize);
    let i = (first + sums[first..end].partition_point(|s| f64::from(*s) <= u)).min(sums.len() - 1);
    let before = if i == 0 { 0.0 } else { f64::from(sums[i - 1]) };
    let p = f64::from(sums[i]) - before;
    (i, p, if p > 0.0 { ((u - before) / p).clamp(0.0, 1.0) } else { 0.5 })
}

/// For each of n equal stretches of `[0, 1)`, n a power of two so that their ends are exact, the first entry that reaches beyond its
/// start; and the number of all.
fn guide(sums: &[f32]) -> impl Iterator<Item = u32> {
    let stretches = (sums.len().next_power_of_two() / 4).max(1);
    let start = move |k: usize| k as f64 / stretches as f64;
    let first = move |k: usize| sums.partition_point(|s| f64::from(*s) <= start(k)) as u32;
    (0..stretches).map(first).chain([sums.len() as u32])
}

/// A number in `[0, 1]` with density linear from `a` to `b` (up to scale), by inversion in the form that does not cancel.
fn sample_linear(a: f64, b: f64, u: f64) -> f64 {
    let sum = a + b;
    if !(sum > 0.0) {
        return u;
    }
    let root = (a * a * (1.0 - u) + b * b * u).sqrt();
    if a + root > 0.0 { (u * sum / (a + root)).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_testkit::Random;
    use kirkas_testkit::statistics::chi_square_tail;

    fn hostile() -> MapDistribution {
        let mut random = Random::new(5);
        let mut weights: Vec<f32> = (0..7 * 5).map(|_| random.number()).collect();
        weights[12] = 40.0;
        weights[20..24].fill(0.0);
        weights[27] = 7.0;
        MapDistribution::new(7, weights).unwrap()
    }

    /// Midpoint rule, exact for bilinear cells when its points are spread evenly in each half texel.
    fn integral(d: &MapDistribution, x: (f64, f64), y: (f64, f64)) -> f64 {
        const N: usize = 16;
        let at = |r: (f64, f64), i: usize| r.0 + (r.1 - r.0) * (i as f64 + 0.5) / N as f64;
        let sum: f64 = (0..N * N).map(|k| d.pdf(at(x, k % N), at(y, k / N))).sum();
        sum * (x.1 - x.0) * (y.1 - y.0) / (N * N) as f64
    }

    #[test]
    fn the_density_integrates_to_one() {
        let d = hostile();
        let total: f64 = (0..14 * 10)
            .map(|k| ((k % 14) as f64 * 0.5, (k / 14) as f64 * 0.5))
            .map(|(x, y)| integral(&d, (x, x + 0.5), (y, y + 0.5)))
            .sum();
        assert!((total - 1.0).abs() < 1e-6, "{total}");
    }

    #[test]
    fn samples_follow_the_density_and_know_it() {
        let d = hostile();
        let n = 200_000;
        let mut random = Random::new(1);
        let mut seen = vec![0.0; 14 * 10];
        for _ in 0..n {
            let p = d.sample(random.pair());
            assert!((p.pdf - d.pdf(p.x, p.y)).abs() <= 1e-9 * p.pdf, "{p:?}");
            seen[((p.y * 2.0) as usize).min(9) * 14 + ((p.x * 2.0) as usize).min(13)] += 1.0;
        }
        let mut statistic = 0.0;
        let mut degrees = 0;
        for (k, seen) in seen.iter().enumerate() {
            let (x, y) = ((k % 14) as f64 * 0.5, (k / 14) as f64 * 0.5);
            let expected = f64::from(n) * integral(&d, (x, x + 0.5), (y, y + 0.5));
            assert!(expected > 0.0 || *seen == 0.0);
            if expected > 5.0 {
                statistic += (seen - expected) * (seen - expected) / expected;
                degrees += 1;
            }
        }
        assert!(chi_square_tail(statistic, degrees - 1) > 0.001, "{statistic} of {degrees}");
    }

    #[test]
    fn the_guide_leads_to_the_entry_that_a_whole_search_finds() {
        let mut random = Random::new(3);
        for length in [1, 2, 3, 7, 64, 100] {
            let weights: Vec<f64> =
                (0..length).map(|i| if i % 3 == 1 { 0.0 } else { f64::from(random.number()) }).collect();
            let sums: Vec<f32> = cumulated(&weights).collect();
            let guide: Vec<u32> = guide(&sums).collect();
            let ends = sums.iter().map(|s| f64::from(*s)).filter(|s| *s < 1.0);
            for u in ends.chain((0..1000).map(|_| f64::from(random.number()))).chain([0.0]) {
                let simple = sums.partition_point(|s| f64::from(*s) <= u).min(length - 1);
                assert_eq!(choose(&sums, &guide, u).0, simple, "{u} of {length}");
            }
        }
    }

    #[test]
    fn nothing_comes_of_nothing() {
        assert!(MapDistribution::new(4, vec![0.0; 8]).is_none());
        assert!(MapDistribution::new(0, Vec::new()).is_none());
        assert!(MapDistribution::new(2, vec![f32::INFINITY; 4]).is_none());
    }

    #[test]
    fn one_texel_alone_is_hit_by_every_sample() {
        let mut weights = vec![0.0; 64 * 32];
        weights[10 * 64] = 1e6;
        let d = MapDistribution::new(64, weights).unwrap();
        for u in [(0.0, 0.0), (0.5, 0.5), (0.999_999_9, 0.999_999_9), (0.1, 0.9)] {
            let p = d.sample(u);
            assert!((p.y - 10.5).abs() <= 1.0 && (p.x - 0.5).abs().min(64.5 - p.x) <= 1.0, "{p:?}");
        }
    }
}
