//! Warps of the unit square: densities that are bilinear between the vertices of a grid, to draw from and to undo.
//!
//! First y is drawn by the integrals of the rows, then x within the row that lies there; both by inverting the (piecewise
//! quadratic) cumulative distribution, so that neighbouring points stay neighbours. Several such densities, the *slices*, may
//! be mixed with weights ([`Blend`]): rows, cumulative distributions and densities are all linear in the slices.
//!
//! J. Dupuy, W. Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", TOG 37(6), 2018,
//! section 4.3; inverting a piecewise linear density: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th
//! edition, section A.4.1.

/// A grid of vertices over the unit square, x fastest, at least two each way.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Vertices along x.
    pub width: usize,
    /// Vertices along y.
    pub height: usize,
    /// One value per vertex.
    pub values: Vec<f32>,
}

/// Which slices count how much.
#[derive(Clone, Copy, Debug)]
pub struct Blend {
    slices: [(usize, f32); 4],
    count: usize,
}

/// Bilinear densities, one per slice.
#[derive(Clone, Debug, PartialEq)]
pub struct Warp {
    width: usize,
    height: usize,
    /// Densities at the vertices, by slice, y and x.
    density: Vec<f32>,
    /// Integral of each row from its beginning to a vertex, as `density`.
    along: Vec<f32>,
    /// Integral of all rows up to a vertex's, by slice and y.
    rows: Vec<f32>,
}

/// A place between two vertices: the first of them and the way to the next.
pub(super) fn split(x: f32, vertices: usize) -> (usize, f32) {
    let place = (x.max(0.0) * (vertices - 1) as f32).min((vertices - 1) as f32);
    let i = (place as usize).min(vertices - 2);
    (i, place - i as f32)
}

/// How far into a step whose density rises evenly from `a` to `b` lies the part `q` of its integral, in 0..1.
fn invert_line(a: f32, b: f32, q: f32) -> f32 {
    let root = (a * a + 2.0 * (b - a) * q).max(0.0).sqrt();
    if a + root > 0.0 { (2.0 * q / (a + root)).min(1.0) } else { 0.5 }
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}

impl Grid {
    /// The value between the vertices.
    pub fn at(&self, (x, y): (f32, f32)) -> f32 {
        let ((x, dx), (y, dy)) = (split(x, self.width), split(y, self.height));
        let row = |y: usize| {
            let at = y * self.width + x;
            lerp(self.values[at], self.values[at + 1], dx)
        };
        lerp(row(y), row(y + 1), dy)
    }
}

impl Blend {
    /// Between the nodes of two axes: slices count along the second faster.
    pub fn between(first: &[f32], x: f32, second: &[f32], y: f32) -> Self {
        let mut blend = Blend { slices: [(0, 0.0); 4], count: 0 };
        for (i, wi) in bracket(first, x) {
            for (j, wj) in bracket(second, y) {
                if wi * wj > 0.0 {
                    blend.slices[blend.count] = (i * second.len() + j, wi * wj);
                    blend.count += 1;
                }
            }
        }
        blend
    }

    /// One slice alone.
    pub fn only(slice: usize) -> Self {
        Blend { slices: [(slice, 1.0); 4], count: 1 }
    }

    /// Slices and their weights.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.slices[..self.count].iter().copied()
    }

    /// The mean of something over the slices.
    #[inline]
    fn mean(&self, of: impl Fn(usize) -> f32) -> f32 {
        self.iter().map(|(slice, weight)| weight * of(slice)).sum()
    }
}

/// The nodes around `x` and their weights; the first or the last beyond the ends.
fn bracket(nodes: &[f32], x: f32) -> [(usize, f32); 2] {
    let next = nodes.partition_point(|&n| n <= x);
    if next == 0 || next == nodes.len() {
        let end = next.saturating_sub(1);
        return [(end, 1.0), (end, 0.0)];
    }
    let share = (x - nodes[next - 1]) / (nodes[next] - nodes[next - 1]);
    [(next - 1, 1.0 - share), (next, share)]
}

impl Warp {
    /// For values of `width` x `height` vertices per slice; negative ones count 0, and a slice of nothing is even.
    pub fn new(width: usize, height: usize, values: Vec<f32>) -> Self {
        let slices = values.len() / (width * height);
        let mut warp = Warp { width, height, density: values, along: Vec::new(), rows: Vec::new() };
        let (step_x, step_y) = (1.0 / (width - 1) as f64, 1.0 / (height - 1) as f64);
        for slice in 0..slices {
            let own = &mut warp.density[slice * width * height..][..width * height];
            own.iter_mut().for_each(|v| *v = v.max(0.0));
            if own.iter().all(|&v| v == 0.0) {
                own.fill(1.0);
            }
            let mut along = vec![0.0; width * height];
            let mut rows = vec![0.0; height];
            for y in 0..height {
                for x in 1..width {
                    let at = y * width + x;
                    along[at] = along[at - 1] + 0.5 * step_x * (f64::from(own[at - 1]) + f64::from(own[at]));
                }
                if y > 0 {
                    let (before, here) = (along[y * width - 1], along[(y + 1) * width - 1]);
                    rows[y] = rows[y - 1] + 0.5 * step_y * (before + here);
                }
            }
            let total = rows[height - 1];
            own.iter_mut().for_each(|v| *v = (f64::from(*v) / total) as f32);
            warp.along.extend(along.iter().map(|v| (v / total) as f32));
            warp.rows.extend(rows.iter().map(|v| (v / total) as f32));
        }
        warp
    }

    fn at(&self, slice: usize, y: usize, x: usize) -> usize {
        (slice * self.height + y) * self.width + x
    }

    /// Density at the vertices `(x, y)` and `(x, y + 1)`, mixed along y.
    fn density_at(&self, blend: &Blend, x: usize, y: usize, dy: f32) -> f32 {
        blend.mean(|s| lerp(self.density[self.at(s, y, x)], self.density[self.at(s, y + 1, x)], dy))
    }

    /// Integral of the row at `y + dy` up to the vertex `x`.
    fn along_at(&self, blend: &Blend, x: usize, y: usize, dy: f32) -> f32 {
        blend.mean(|s| lerp(self.along[self.at(s, y, x)], self.along[self.at(s, y + 1, x)], dy))
    }

    /// Integral of the rows up to the vertex `y`.
    fn rows_at(&self, blend: &Blend, y: usize) -> f32 {
        blend.mean(|s| self.rows[s * self.height + y])
    }

    /// Integral of the row of vertices `y`.
    fn row_at(&self, blend: &Blend, y: usize) -> f32 {
        blend.mean(|s| self.along[self.at(s, y, self.width - 1)])
    }

    /// The density at a point.
    pub fn density(&self, blend: &Blend, (x, y): (f32, f32)) -> f32 {
        let ((x, dx), (y, dy)) = (split(x, self.width), split(y, self.height));
        lerp(self.density_at(blend, x, y, dy), self.density_at(blend, x + 1, y, dy), dx)
    }

    /// A point drawn by the density.
    pub fn sample(&self, blend: &Blend, (u, v): (f32, f32)) -> (f32, f32) {
        // The row.
        let y = last_at_most(self.height - 1, v, |y| self.rows_at(blend, y));
        let steps_y = (self.height - 1) as f32;
        let q = (v - self.rows_at(blend, y)) * steps_y;
        let dy = invert_line(self.row_at(blend, y), self.row_at(blend, y + 1), q.max(0.0));
        // The place in it.
        let u = u * self.along_at(blend, self.width - 1, y, dy);
        let x = last_at_most(self.width - 1, u, |x| self.along_at(blend, x, y, dy));
        let steps_x = (self.width - 1) as f32;
        let q = (u - self.along_at(blend, x, y, dy)) * steps_x;
        let (a, b) = (self.density_at(blend, x, y, dy), self.density_at(blend, x + 1, y, dy));
        ((x as f32 + invert_line(a, b, q.max(0.0))) / steps_x, (y as f32 + dy) / steps_y)
    }

    /// The numbers from which [`Warp::sample`] makes a point, and the density there.
    pub fn invert(&self, blend: &Blend, (x, y): (f32, f32)) -> ((f32, f32), f32) {
        let ((x, dx), (y, dy)) = (split(x, self.width), split(y, self.height));
        let step = |a: f32, b: f32, t: f32| t * (a + 0.5 * t * (b - a));
        let v = step(self.row_at(blend, y), self.row_at(blend, y + 1), dy) / (self.height - 1) as f32;
        let (a, b) = (self.density_at(blend, x, y, dy), self.density_at(blend, x + 1, y, dy));
        let u = self.along_at(blend, x, y, dy) + step(a, b, dx) / (self.width - 1) as f32;
        let row = self.along_at(blend, self.width - 1, y, dy);
        let u = if row > 0.0 { u / row } else { 0.5 };
        ((u.min(1.0), (self.rows_at(blend, y) + v).min(1.0)), lerp(a, b, dx))
    }
}

/// The last of `0..count` at which a rising function is at most `x`, or the first.
fn last_at_most(count: usize, x: f32, f: impl Fn(usize) -> f32) -> usize {
    let (mut low, mut high) = (0, count);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if f(middle) <= x { low = middle } else { high = middle }
    }
    low
}
