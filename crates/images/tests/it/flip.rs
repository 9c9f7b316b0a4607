//! FLIP against the authors' own program.
//!
//! The numbers below were printed by (`pip install flip-evaluator`, version 1.7, on Linux):
//!
//! ```python
//! import numpy as np, flip_evaluator
//! def image(f):
//!     return np.array([[[v / 255 for v in f(x, y)] for x in range(64)] for y in range(48)], np.float32)
//! m, mean, _ = flip_evaluator.evaluate(image(reference), image(test), "LDR", applyMagma=False, parameters={"ppd": 30})
//! m = np.array(m).reshape(48, 64, -1)[:, :, 0]
//! print(mean, m[0, 0], m[20, 30], m[47, 63], m[5, 17])
//! ```
//!
//! with the pictures of the functions here (Python's `^`, `%` and `//` for Rust's `^`, `%` and `/`) and, where
//! `ppd` is the default, without `parameters`.

use crate::samples::smooth_rgb;
use kirkas_images::metrics::{DEFAULT_PIXELS_PER_DEGREE, flip};
use kirkas_images::srgb::srgb8_to_linear;
use kirkas_images::*;

type Codes = fn(u32, u32) -> [u32; 3];

const SMOOTH: Codes = |x, y| [x * 4 % 256, y * 5 % 256, (x + y) * 2 % 256];
const BUSY: Codes = |x, y| [(x * 7 + y * 3) % 256, (x * x + 2 * y * y) / 16 % 256, (x ^ y) * 4 % 256];
const SHIFTED: Codes = |x, y| BUSY(x + 1, y);
const NOISY: Codes = |x, y| {
    let hash = (u64::from(x) * 73_856_093) ^ (u64::from(y) * 19_349_663);
    SMOOTH(x, y).map(|code| 255.min(code + (hash % 97 / 3) as u32))
};
const DISK: Codes = |x, y| if in_disk(x, y) { [230, 200, 40] } else { [40, 60, 90] };
const RECOLOURED: Codes = |x, y| if in_disk(x, y) { [200, 220, 60] } else { [40, 60, 90] };
const BLACK: Codes = |_, _| [0, 0, 0];
const WHITE: Codes = |_, _| [255, 255, 255];
const GREEN: Codes = |_, _| [0, 255, 0];
const BLUE: Codes = |_, _| [0, 0, 255];

fn in_disk(x: u32, y: u32) -> bool {
    (x as i32 - 30).pow(2) + (y as i32 - 20).pow(2) < 150
}

fn picture(codes: Codes) -> RgbImage {
    RgbImage::from_fn(64, 48, |x, y| codes(x, y).map(|code| srgb8_to_linear(code as u8)))
}

/// `expected`: the mean, then the pixels (0, 0), (30, 20), (63, 47) and (17, 5).
#[track_caller]
fn check(reference: Codes, test: Codes, pixels_per_degree: f64, expected: [f64; 5]) {
    let found = flip(&picture(test), &picture(reference), pixels_per_degree).unwrap();
    let at = |x: usize, y: usize| f64::from(found.map[y * 64 + x]);
    let values = [found.score, at(0, 0), at(30, 20), at(63, 47), at(17, 5)];
    for (value, expected) in values.into_iter().zip(expected) {
        assert!((value - expected).abs() < 1e-4, "{values:?} for {expected}");
    }
}

const DEFAULT: f64 = DEFAULT_PIXELS_PER_DEGREE;

#[test]
fn noise() {
    check(SMOOTH, NOISY, DEFAULT, [0.2822196, 0.0861248, 0.2733526, 0.3645105, 0.3166896])
}

#[test]
fn a_shift_by_one_pixel() {
    check(BUSY, SHIFTED, DEFAULT, [0.2298718, 0.0393878, 0.2892475, 0.7618936, 0.1369028])
}

#[test]
fn another_colour() {
    check(DISK, RECOLOURED, DEFAULT, [0.1008618, 0.0000000, 0.4917946, 0.0000000, 0.0023026])
}

#[test]
fn black_on_white() {
    check(BLACK, WHITE, DEFAULT, [0.9673883; 5])
}

#[test]
fn the_farthest_colours() {
    check(GREEN, BLUE, DEFAULT, [1.0; 5])
}

#[test]
fn two_pictures_with_nothing_in_common() {
    check(SMOOTH, BUSY, DEFAULT, [0.7898135, 0.0228920, 0.5413568, 0.9770340, 0.6062258]);
}

#[test]
fn nearer_to_the_screen() {
    check(BUSY, SHIFTED, 30.0, [0.2448324, 0.0369050, 0.4685635, 0.7058389, 0.1437891])
}

#[test]
fn farther_from_the_screen() {
    check(SMOOTH, NOISY, 120.0, [0.2913594, 0.1214709, 0.2807372, 0.3515103, 0.2995621])
}

#[test]
fn it_is_symmetric_and_knows_its_range() {
    let [a, b] = [picture(SMOOTH), picture(BUSY)];
    assert_eq!(flip(&a, &b, 67.0).unwrap(), flip(&b, &a, 67.0).unwrap());
    for wrong in [0.0, -1.0, f64::NAN, 1e9] {
        let message = flip(&a, &b, wrong).unwrap_err().to_string();
        assert!(message.ends_with("it must be from 1 to 1000"), "{message}");
    }
    let one = smooth_rgb(1, 1);
    assert_eq!(flip(&one, &one, 1000.0).unwrap().score, 0.0);
}
