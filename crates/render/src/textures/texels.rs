//! A decoded picture and its smaller copies: linear colour and, last, the number it means as a mask.
//!
//! Williams 1983, "Pyramidal Parametrics" (mip maps). Each level has half the columns and rows of the one before, rounded up, and
//! each of its texels is the exact mean of what it covers, also where sizes are odd.

use super::mean;
use kirkas_geometry::elementary::floor;
use kirkas_images::srgb::{srgb_to_linear, srgb8_to_linear};
use kirkas_images::{DecodedImage, Pixels};
use std::sync::OnceLock;

/// How numbers mean light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Encoding {
    /// As the file's kind has it.
    Auto,
    Srgb,
    Linear,
}

/// What lies beyond a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wrap {
    Repeat,
    Clamp,
    Mirror,
    Black,
}

/// A picture.
#[derive(Debug)]
pub(super) struct Texels {
    has_alpha: bool,
    /// Its numbers were decoded by the sRGB curve.
    pub(super) is_srgb: bool,
    whole: Level,
    /// From half the size down to one texel.
    smaller: OnceLock<Vec<Level>>,
}

/// A picture at one size.
#[derive(Debug)]
pub(super) struct Level {
    pub(super) width: u32,
    pub(super) height: u32,
    data: TexelData,
}

#[derive(Debug)]
enum TexelData {
    /// A quarter of the memory: decoded by table when looked up.
    Codes {
        codes: Vec<[u8; 4]>,
        linear_from_code: Box<[f32; 256]>,
    },
    /// Means of codes, linear, in steps of 1 / 65535.
    Means(Vec<[u16; 4]>),
    Floats(Vec<[f32; 4]>),
}

impl Texels {
    pub(super) fn new(image: DecodedImage, encoding: Encoding) -> Self {
        let (width, height) = (image.width, image.height);
        let is_linear = image.is_linear();
        let is_srgb = match encoding {
            Encoding::Auto => !is_linear,
            Encoding::Srgb => true,
            Encoding::Linear => false,
        };
        let data = match image.pixels {
            Pixels::Srgb8(codes) => {
                let linear_from_code = Box::new(std::array::from_fn(|code| match is_srgb {
                    false => code as f32 / 255.0,
                    true => srgb8_to_linear(code as u8),
                }));
                TexelData::Codes { codes, linear_from_code }
            }
            pixels @ Pixels::Srgb16(_) => {
                let image = DecodedImage { pixels, says_linear: !is_srgb, ..image };
                TexelData::Floats(image.linear())
            }
            Pixels::Linear(mut pixels) => {
                pixels.iter_mut().for_each(|pixel| clean(pixel, is_srgb));
                TexelData::Floats(pixels)
            }
        };
        let has_alpha = match &data {
            TexelData::Codes { codes, .. } => codes.iter().any(|code| code[3] != 255),
            TexelData::Floats(pixels) => pixels.iter().any(|pixel| pixel[3] != 1.0),
            TexelData::Means(_) => false,
        };
        Texels { has_alpha, is_srgb, whole: Level { width, height, data }, smaller: OnceLock::new() }
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.whole.width, self.whole.height)
    }

    /// Make the smaller copies now.
    pub(super) fn prepare_levels(&self) {
        self.smaller.get_or_init(|| {
            let mut levels: Vec<Level> = Vec::new();
            loop {
                let last = levels.last().unwrap_or(&self.whole);
                if last.width == 1 && last.height == 1 {
                    return levels;
                }
                levels.push(last.halved());
            }
        });
    }

    /// Level 0 is the picture itself.
    pub(super) fn level(&self, number: usize) -> &Level {
        match (number, self.smaller.get()) {
            (0, _) | (_, None) => &self.whole,
            (n, Some(levels)) => levels.get(n - 1).or(levels.last()).unwrap_or(&self.whole),
        }
    }

    /// The number of the smallest level.
    pub(super) fn last_level(&self) -> usize {
        self.smaller.get().map_or(0, Vec::len)
    }

    /// A looked-up value as a texture gives it: with the mean of the colour as mask where the picture has no alpha.
    pub(super) fn finish(&self, [r, g, b, a]: [f32; 4]) -> [f32; 4] {
        [r, g, b, if self.has_alpha { a } else { mean([r, g, b]) }]
    }

    /// One texel of the picture, row by row from the top.
    pub(super) fn color(&self, index: usize) -> [f32; 3] {
        let [r, g, b, _] = self.whole.get(index);
        [r, g, b]
    }
}

impl Level {
    fn get(&self, index: usize) -> [f32; 4] {
        match &self.data {
            TexelData::Codes { codes, linear_from_code } => {
                let [r, g, b, a] = codes[index];
                let linear = |code: u8| linear_from_code[usize::from(code)];
                [linear(r), linear(g), linear(b), f32::from(a) / 255.0]
            }
            TexelData::Means(codes) => codes[index].map(|code| f32::from(code) * (1.0 / 65535.0)),
            TexelData::Floats(pixels) => pixels[index],
        }
    }

    /// The texel at `uv`.
    pub(super) fn nearest(&self, wrap: Wrap, uv: [f64; 2]) -> [f32; 4] {
        let (x, y) = (self.place(wrap, uv[0], self.width), self.place(wrap, uv[1], self.height));
        match (wrap.apply(whole(x), self.width), wrap.apply(whole(y), self.height)) {
            (Some(x), Some(up)) => self.get(self.index(x, up)),
            _ => [0.0; 4],
        }
    }

    /// Between the four texels around `uv`.
    pub(super) fn bilinear(&self, wrap: Wrap, uv: [f64; 2]) -> [f32; 4] {
        let x = self.place(wrap, uv[0], self.width) - 0.5;
        let y = self.place(wrap, uv[1], self.height) - 0.5;
        let (i, j) = (whole(x), whole(y));
        let (s, t) = ((x - floor(x)) as f32, (y - floor(y)) as f32);
        let columns = [wrap.apply(i, self.width), wrap.apply(i + 1, self.width)];
        let rows = [wrap.apply(j, self.height), wrap.apply(j + 1, self.height)];
        let texel = |column: Option<usize>, row: Option<usize>| match (column, row) {
            (Some(x), Some(up)) => self.get(self.index(x, up)),
            _ => [0.0; 4],
        };
        let row = |row| lerp(texel(columns[0], row), texel(columns[1], row), s);
        lerp(row(rows[0]), row(rows[1]), t)
    }

    /// `up` counts rows from the bottom.
    fn index(&self, x: usize, up: usize) -> usize {
        (self.height as usize - 1 - up) * self.width as usize + x
    }

    /// In texels, from the left or from below.
    fn place(&self, wrap: Wrap, at: f64, texels: u32) -> f64 {
        // What repeats is brought near first: then hardly any texel needs a division.
        let near = if wrap == Wrap::Repeat { at - floor(at) } else { at };
        let at = near * f64::from(texels);
        if at.is_finite() { at } else { 0.0 }
    }

    /// Half as large, rounded up.
    fn halved(&self) -> Level {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let (columns, rows) = (shares(self.width, width), shares(self.height, height));
        let mean = |(x, y): (u32, u32)| {
            let mut sum = [0.0_f32; 4];
            for &(row, by_row) in rows[y as usize].iter() {
                for &(column, by_column) in columns[x as usize].iter() {
                    let texel = self.get(row * self.width as usize + column);
                    sum = std::array::from_fn(|i| sum[i] + texel[i] * (by_row * by_column));
                }
            }
            sum
        };
        let means = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(mean);
        let data = match self.data {
            TexelData::Floats(_) => TexelData::Floats(means.collect()),
            _ => TexelData::Means(means.map(|m| m.map(|c| (c.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16)).collect()),
        };
        Level { width, height, data }
    }
}

/// For each of `fewer` places the columns of `more` that it covers, and the part of it that each makes.
fn shares(more: u32, fewer: u32) -> Vec<Vec<(usize, f32)>> {
    let ratio = f64::from(more) / f64::from(fewer);
    let share = |i: u32| {
        let (start, end) = (f64::from(i) * ratio, f64::from(i + 1) * ratio);
        let covered = |column: u32| (end.min(f64::from(column + 1)) - start.max(f64::from(column))) / ratio;
        let columns = (start as u32)..more.min(end as u32 + 1);
        columns.map(|c| (c as usize, covered(c) as f32)).filter(|(_, part)| *part > 1e-6).collect()
    };
    (0..fewer).map(share).collect()
}

impl Wrap {
    /// The column or row of the picture that is seen at `i`, of `n`.
    #[inline]
    fn apply(self, i: i64, n: u32) -> Option<usize> {
        let n = i64::from(n);
        if (0..n).contains(&i) {
            return Some(i as usize);
        }
        let inside = match self {
            Wrap::Repeat => i.rem_euclid(n),
            Wrap::Clamp => i.clamp(0, n - 1),
            Wrap::Mirror => {
                let k = i.rem_euclid(2 * n);
                if k < n { k } else { 2 * n - 1 - k }
            }
            Wrap::Black => return None,
        };
        Some(inside as usize)
    }
}

/// The largest whole number not above `x`, far from the ends of `i64`.
fn whole(x: f64) -> i64 {
    const FAR: f64 = (1_i64 << 52) as f64;
    floor(x).clamp(-FAR, FAR) as i64
}

pub(super) fn lerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|lane| a[lane] * (1.0 - t) + b[lane] * t)
}

/// Make a float pixel finite, not multiplied by its alpha, and linear.
fn clean(pixel: &mut [f32; 4], is_srgb: bool) {
    let alpha = pixel[3];
    for lane in &mut pixel[..3] {
        if alpha > 0.0 && alpha < 1.0 {
            *lane /= alpha;
        }
        if is_srgb {
            *lane = srgb_to_linear(*lane);
        }
    }
    for lane in pixel {
        *lane = if lane.is_finite() { *lane } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> Texels {
        let pixels =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| [value(x, y), 0.0, 0.0, 1.0]);
        let pixels = Pixels::Linear(pixels.collect());
        let texels = Texels::new(
            DecodedImage { width, height, pixels, texts: Default::default(), says_linear: false },
            Encoding::Auto,
        );
        texels.prepare_levels();
        texels
    }

    #[test]
    fn every_level_of_any_size_keeps_the_mean() {
        for (width, height) in [(8, 8), (7, 5), (1, 9), (13, 1), (6, 11)] {
            let t = picture(width, height, |x, y| ((x * 31 + y * 17) % 11) as f32);
            let mean = |level: &Level| {
                let n = (level.width * level.height) as usize;
                (0..n).map(|i| f64::from(level.get(i)[0])).sum::<f64>() / n as f64
            };
            let truth = mean(t.level(0));
            for number in 1..=t.last_level() {
                assert!((mean(t.level(number)) - truth).abs() < 1e-5 * truth, "{width} x {height} at {number}");
            }
            let last = t.level(t.last_level());
            assert_eq!((last.width, last.height), (1, 1));
        }
    }

    #[test]
    fn a_level_of_an_even_picture_is_the_mean_of_four_texels() {
        let t = picture(4, 2, |x, y| (4 * y + x) as f32);
        assert_eq!(t.level(1).get(0)[0], (0.0 + 1.0 + 4.0 + 5.0) / 4.0);
        assert_eq!(t.level(1).get(1)[0], (2.0 + 3.0 + 6.0 + 7.0) / 4.0);
    }
}
