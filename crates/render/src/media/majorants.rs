//! Bounds of the density in the cells of a coarse grid, from above and from below, and the walk of a ray through them (Amanatides & Woo 1987, "A Fast
//! Voxel Traversal Algorithm for Ray Tracing"). Where a cell is thin or empty, rays cross it in few steps or in one.

use super::voxels::Voxels;
use kirkas_geometry::DVec3;
use rayon::prelude::*;

/// Bounds for blocks of samples.
#[derive(Clone, Debug)]
pub struct Majorants {
    size: [usize; 3],
    /// Edges of a cell in the unit cube.
    edge: [f64; 3],
    /// The least and the most density in each cell.
    bounds: Vec<(f32, f32)>,
}

/// Rounding between centres may go as much beyond them as this part of the greatest of them.
const ROUNDING: f32 = 1e-5;

impl Majorants {
    /// For blocks of `block` samples along each axis.
    pub fn new(voxels: &Voxels, block: usize) -> Self {
        let samples = voxels.size();
        let size = samples.map(|n| n.div_ceil(block));
        let edge = samples.map(|n| block as f64 / n as f64);
        let cell = |at: usize| {
            let cell = [at % size[0], at / size[0] % size[1], at / size[0] / size[1]];
            // What lies in a block is mixed from its samples and one more on each side.
            let low = cell.map(|i| (i * block) as i64 - 1);
            let high = cell.map(|i| ((i + 1) * block) as i64);
            let (least, most) = voxels.range(low, high);
            let rounding = if least < most { most * ROUNDING } else { 0.0 };
            ((least - rounding).max(0.0), most + rounding)
        };
        let bounds = (0..size[0] * size[1] * size[2]).into_par_iter().map(cell).collect();
        Majorants { size, edge, bounds }
    }

    /// The greatest bound.
    pub fn most(&self) -> f32 {
        self.bounds.iter().fold(0.0, |m, b| m.max(b.1))
    }

    /// The stretches of a ray between `from` and `to` within the unit cube, in order.
    pub fn walk(&self, origin: DVec3, direction: DVec3, from: f64, to: f64) -> Walk<'_> {
        let (o, d) = (origin.to_array(), direction.to_array());
        let (mut from, mut to) = (from, to);
        for axis in 0..3 {
            let (a, b) = ((0.0 - o[axis]) / d[axis], (1.0 - o[axis]) / d[axis]);
            if d[axis] != 0.0 {
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            } else if !(0.0..1.0).contains(&o[axis]) {
                to = f64::NEG_INFINITY;
            }
        }
        let mut walk = Walk {
            majorants: self,
            cell: [0; 3],
            step: [0; 3],
            next: [f64::INFINITY; 3],
            delta: [0.0; 3],
            t: from,
            to,
        };
        for axis in 0..3 {
            let last = self.size[axis] as i64 - 1;
            let cell = (((o[axis] + d[axis] * from) / self.edge[axis]) as i64).clamp(0, last);
            walk.cell[axis] = cell;
            if d[axis] != 0.0 {
                let is_up = d[axis] > 0.0;
                let plane = (cell + i64::from(is_up)) as f64 * self.edge[axis];
                walk.step[axis] = if is_up { 1 } else { -1 };
                walk.next[axis] = (plane - o[axis]) / d[axis];
                walk.delta[axis] = self.edge[axis] / d[axis].abs();
            }
        }
        walk
    }
}

/// A ray on its way through the cells.
pub struct Walk<'a> {
    majorants: &'a Majorants,
    cell: [i64; 3],
    step: [i64; 3],
    /// Where the next plane across each axis is met.
    next: [f64; 3],
    /// Between two such planes.
    delta: [f64; 3],
    t: f64,
    to: f64,
}

/// A stretch of a ray and the bounds that hold there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Start.
    pub from: f64,
    /// End.
    pub to: f64,
    /// Density is nowhere below this.
    pub least: f32,
    /// Density is nowhere above this.
    pub most: f32,
}

impl Iterator for Walk<'_> {
    type Item = Stretch;

    fn next(&mut self) -> Option<Stretch> {
        if !(self.t < self.to) {
            return None;
        }
        let size = self.majorants.size;
        let [x, y, z] = self.next;
        let axis = if x <= y && x <= z {
            0
        } else if y <= z {
            1
        } else {
            2
        };
        let index = (self.cell[2] as usize * size[1] + self.cell[1] as usize) * size[0] + self.cell[0] as usize;
        let from = self.t;
        let end = self.next[axis].min(self.to).max(from);
        self.t = end;
        self.next[axis] += self.delta[axis];
        self.cell[axis] += self.step[axis];
        if !(0..size[axis] as i64).contains(&self.cell[axis]) {
            self.to = f64::NEG_INFINITY;
        }
        let (least, most) = self.majorants.bounds[index];
        Some(Stretch { from, to: end, least, most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::hash::{combine, unit_f32};

    fn voxels(size: [usize; 3], seed: u64) -> Voxels {
        let count = size[0] * size[1] * size[2];
        let value = |i: usize| unit_f32((combine(seed, i as u64) >> 32) as u32);
        Voxels::new(size, (0..count).map(value).collect()).unwrap()
    }

    /// Along any ray the stretches join without a gap, cover the cube, and their bounds hold.
    #[test]
    fn a_walk_covers_the_cube_and_no_density_is_outside_its_bounds() {
        let mut seed = 0;
        let mut random = || {
            seed += 1;
            f64::from(unit_f32((combine(9, seed) >> 32) as u32))
        };
        for (size, block) in [([20, 9, 33], 8), ([5, 5, 5], 5), ([16, 16, 16], 4), ([1, 3, 2], 8)] {
            let voxels = voxels(size, 1);
            let majorants = Majorants::new(&voxels, block);
            for case in 0..300 {
                let inside = DVec3::new(random(), random(), random());
                let mut direction = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
                if case % 5 == 0 {
                    direction = [DVec3::X, -DVec3::Y, DVec3::Z][case % 3];
                }
                let origin = inside - direction * 3.0;
                let stretches: Vec<Stretch> = majorants.walk(origin, direction, 0.0, 10.0).collect();
                assert!(stretches.windows(2).all(|w| w[0].to == w[1].from));
                let (first, last) = (stretches[0].from, stretches[stretches.len() - 1].to);
                assert!(first <= 3.0 + 1e-9 && last >= 3.0 - 1e-9);
                let edge = |t: f64| {
                    let p = (origin + direction * t).to_array();
                    p.iter().any(|x| x.abs() < 1e-6 || (x - 1.0).abs() < 1e-6)
                };
                assert!(edge(first) && edge(last), "{stretches:?}");
                for s in &stretches {
                    for i in 1..8 {
                        let p = origin + direction * (s.from + (s.to - s.from) * f64::from(i) / 8.0);
                        assert!((s.least..=s.most).contains(&voxels.at(p)), "{s:?}");
                    }
                }
            }
            let miss = majorants.walk(DVec3::new(2.0, 0.5, 0.5), DVec3::Y, 0.0, 10.0);
            assert_eq!(miss.count(), 0);
        }
    }
}
