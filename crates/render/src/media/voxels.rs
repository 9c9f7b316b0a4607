//! Samples of a quantity on a regular grid over the unit cube, and what lies between them.

use kirkas_geometry::DVec3;

/// Samples at the centres of cells; x runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Voxels {
    size: [usize; 3],
    values: Vec<f32>,
}

impl Voxels {
    /// Values for `size[0] * size[1] * size[2]` cells; `None` if they are not that many, or none, or one is no finite number
    /// of 0 or more.
    pub fn new(size: [usize; 3], values: Vec<f32>) -> Option<Self> {
        let count = size[0].checked_mul(size[1])?.checked_mul(size[2])?;
        let is_sane = count > 0 && count == values.len() && values.iter().all(|v| *v >= 0.0 && v.is_finite());
        is_sane.then_some(Voxels { size, values })
    }

    /// Cells along each axis.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// The least and the greatest value in a box of cells, `low` and `high` included; what lies beyond the edge is left out.
    pub fn range(&self, low: [i64; 3], high: [i64; 3]) -> (f32, f32) {
        let [nx, ny, _] = self.size;
        let cells = |axis: usize| {
            let last = self.size[axis] as i64 - 1;
            low[axis].clamp(0, last) as usize..high[axis].clamp(0, last) as usize + 1
        };
        let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
        for z in cells(2) {
            for y in cells(1) {
                let row = (z * ny + y) * nx;
                for &value in &self.values[row..row + nx][cells(0)] {
                    least = least.min(value);
                    most = most.max(value);
                }
            }
        }
        (least, most)
    }

    /// The value at a point of the unit cube, linear along each axis between centres; beyond the outermost centres it is like
    /// the nearest.
    #[inline]
    pub fn at(&self, point: DVec3) -> f32 {
        let place = |x: f64, n: usize| {
            let x = (x * n as f64 - 0.5).max(0.0).min((n - 1) as f64);
            let low = (x as usize).min(n.saturating_sub(2));
            (low, (x - low as f64) as f32)
        };
        let [nx, ny, nz] = self.size;
        let ((x, fx), (y, fy), (z, fz)) = (place(point.x, nx), place(point.y, ny), place(point.z, nz));
        // To the next cell along each axis, if there is one.
        let (dx, dy, dz) = (usize::from(nx > 1), if ny > 1 { nx } else { 0 }, if nz > 1 { nx * ny } else { 0 });
        let first = (z * ny + y) * nx + x;
        let cells = &self.values[first..=first + dx + dy + dz];
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let row = |at: usize| mix(cells[at], cells[at + dx], fx);
        let sheet = |at: usize| mix(row(at), row(at + dy), fy);
        mix(sheet(0), sheet(dz), fz)
    }
}
