//! What particles of one pass bring to every pixel, as integers: in whatever order they come, the sums are the same.

use crate::film::filter::Filter;
use crate::film::fixed;
use crate::integrators::Landed;
use crate::render::Renderer;
use rayon::prelude::*;

/// Light that reached the film.
#[derive(Clone, Copy, Debug)]
pub struct Splat {
    /// Where, in pixels from the top left.
    pub film: (f64, f64),
    /// Film colour, per pixel squared.
    pub rgb: [f32; 3],
    /// Light group.
    pub group: u32,
}

/// The sums of one pass.
pub struct Splatted {
    width: usize,
    planes: usize,
    sums: Vec<[i128; 3]>,
    is_invalid: Vec<bool>,
}

/// Rows of pixels that one thread adds up.
const BAND: usize = 16;

impl Splatted {
    /// Nothing yet.
    pub fn new(r: &Renderer) -> Self {
        let (width, height) = (r.resolution.0 as usize, r.resolution.1 as usize);
        let pixels = width * height;
        Splatted { width, planes: r.planes, sums: vec![[0; 3]; pixels * r.planes], is_invalid: vec![false; pixels] }
    }

    /// Spread each splat over the pixels for which it counts. `shift` moves the pixels, x right, y down.
    pub fn add(&mut self, splats: &[Splat], filter: &Filter, shift: [f64; 2]) {
        let (width, planes) = (self.width, self.planes);
        let bands = self.sums.par_chunks_mut(BAND * width * planes).zip(self.is_invalid.par_chunks_mut(BAND * width));
        let reach = f64::from(filter.radius()) + 1.0;
        bands.enumerate().for_each(|(band, (sums, is_invalid))| {
            let (top, rows) = ((band * BAND) as i64, (is_invalid.len() / width) as i64);
            let (mut across, mut down) = (Vec::new(), Vec::new());
            for s in splats {
                let (x, y) = (s.film.0 - shift[0], s.film.1 - shift[1]);
                if y < top as f64 - reach || y > (top + rows) as f64 + reach {
                    continue;
                }
                let (left, up) = (filter.footprint(x, &mut across), filter.footprint(y, &mut down) - top);
                let plane = if planes > 1 { s.group as usize } else { 0 };
                for (row, v) in (up..).zip(&down).filter(|(row, _)| (0..rows).contains(row)) {
                    for (column, u) in (left..).zip(&across).filter(|(column, _)| (0..width as i64).contains(column)) {
                        let pixel = row as usize * width + column as usize;
                        match s.rgb.map(|c| fixed::from_f64(f64::from(c) * (u * v))) {
                            [Some(r), Some(g), Some(b)] => {
                                let sum = &mut sums[pixel * planes + plane];
                                *sum = [sum[0] + r, sum[1] + g, sum[2] + b];
                            }
                            _ => is_invalid[pixel] = true,
                        }
                    }
                }
            }
        });
    }

    /// What a pixel got.
    pub fn at(&self, x: u32, y: u32) -> Landed<'_> {
        let pixel = y as usize * self.width + x as usize;
        Landed { sums: &self.sums[pixel * self.planes..][..self.planes], is_invalid: self.is_invalid[pixel] }
    }
}
