//! Heat maps: errors as colours, from black over purple and orange to pale yellow.
//!
//! The colours are 17 samples of matplotlib's `magma` by S. van der Walt and N. Smith (public domain, CC0,
//! <https://bids.github.io/colormap/>), joined by straight lines; they stay within 0.01 of the original.

use crate::Texts;
use crate::error::Result;
use crate::metrics::Difference;
use crate::png_file::write_png8;

const MAGMA: [[u8; 3]; 17] = [
    [0, 0, 4],
    [10, 8, 34],
    [29, 17, 70],
    [54, 16, 106],
    [80, 18, 124],
    [105, 28, 129],
    [130, 38, 129],
    [156, 46, 127],
    [182, 55, 121],
    [207, 65, 112],
    [230, 81, 99],
    [245, 105, 92],
    [251, 135, 97],
    [254, 165, 113],
    [254, 195, 135],
    [253, 224, 162],
    [252, 253, 191],
];

/// The sRGB code of a value; what lies outside `[0, 1]` goes to its ends, NaN to the upper one.
pub fn magma(value: f32) -> [u8; 3] {
    let position = if value.is_nan() { 1.0 } else { value.clamp(0.0, 1.0) } * 16.0;
    let below = (position as usize).min(15);
    let t = position - below as f32;
    std::array::from_fn(|lane| {
        let [a, b] = [MAGMA[below][lane], MAGMA[below + 1][lane]].map(f32::from);
        (a + t * (b - a) + 0.5) as u8
    })
}

/// A PNG of the errors of a comparison, the error `white` (above 0) and larger ones in the brightest colour.
pub fn write_heat_png(difference: &Difference, white: f32) -> Result<Vec<u8>> {
    let codes: Vec<u8> = difference.map.iter().flat_map(|&error| magma(error / white)).collect();
    write_png8(difference.width, difference.height, &codes, &Texts::new())
}
