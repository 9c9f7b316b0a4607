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

    /// The value of a cell; those beyond the edge are like the nearest.
    #[inline]
    pub fn get(&self, x: i64, y: i64, z: i64) -> f32 {
        let clamp = |i: i64, n: usize| i.clamp(0, n as i64 - 1) as usize;
        let [nx, ny, nz] = self.size;
        self.values[(clamp(z, nz) * ny + clamp(y, ny)) * nx + clamp(x, nx)]
    }

    /// The value at a point of the unit cube, linear along each axis between centres.
    #[inline]
    pub fn at(&self, point: DVec3) -> f32 {
        let place = |x: f64, n: usize| {
            let x = x * n as f64 - 0.5;
            let low = x.floor();
            (low as i64, (x - low) as f32)
        };
        let (x, fx) = place(point.x, self.size[0]);
        let (y, fy) = place(point.y, self.size[1]);
        let (z, fz) = place(point.z, self.size[2]);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let row = |y: i64, z: i64| mix(self.get(x, y, z), self.get(x + 1, y, z), fx);
        let sheet = |z: i64| mix(row(y, z), row(y + 1, z), fy);
        mix(sheet(z), sheet(z + 1), fz)
    }
}
