//! The pixelwise metrics against numbers worked out by hand, and the heat map.

use crate::samples::smooth_rgb;
use kirkas_images::heat::{magma, write_heat_png};
use kirkas_images::metrics::*;
use kirkas_images::*;

fn pair() -> [RgbImage; 2] {
    let image = |pixels: [[f32; 3]; 2]| RgbImage { width: 2, height: 1, pixels: pixels.to_vec() };
    [image([[1.0, 0.5, 0.0], [3.0, 0.0, 0.25]]), image([[0.5, 0.5, 0.5], [1.0, 0.0, 0.0]])]
}

#[test]
fn scores_worked_out_by_hand() {
    let [test, reference] = pair();
    // Differences: 0.5, 0, 0.5 and 2, 0, 0.25.
    let squares = 0.25 + 0.25 + 4.0 + 0.0625;
    let relative = 0.25 / 0.26 + 0.25 / 0.26 + 4.0 / 1.01 + 0.0625 / 0.01;
    let expected = [
        (Metric::Mae, 3.25 / 6.0),
        (Metric::Mse, squares / 6.0),
        (Metric::Rmse, f64::sqrt(squares / 6.0)),
        (Metric::Mrse, relative / 6.0),
    ];
    for (metric, score) in expected {
        let found = metric.compare(&test, &reference).unwrap();
        assert!((found.score - score).abs() < 1e-12, "{metric:?}: {} for {score}", found.score);
        assert_eq!((found.width, found.height, found.map.len()), (2, 1, 2));
    }
    assert_eq!(Metric::Mae.compare(&test, &reference).unwrap().map, [1.0 / 3.0, 0.75]);
    assert_eq!(max_difference(&test, &reference).unwrap(), 2.0);
}

#[test]
fn equal_pictures_score_zero() {
    let mut image = smooth_rgb(20, 10);
    image.pixels[3] = [f32::NAN, f32::INFINITY, -0.0];
    for metric in Metric::ALL {
        assert_eq!(metric.compare(&image, &image).unwrap().score, 0.0, "{metric:?}");
        assert_eq!(Metric::from_name(metric.name()), Some(metric));
    }
}

#[test]
fn no_broken_pixel_passes() {
    let good = smooth_rgb(20, 10);
    for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut bad = good.clone();
        bad.pixels[7][1] = broken;
        for metric in Metric::ALL {
            for (a, b) in [(&good, &bad), (&bad, &good)] {
                let found = metric.compare(a, b).unwrap();
                assert_eq!((found.score, found.map[7]), (f64::INFINITY, f32::INFINITY), "{metric:?} of {broken}");
            }
        }
        assert_eq!(max_difference(&good, &bad).unwrap(), f64::INFINITY);
    }
}

#[test]
fn sizes_must_agree() {
    for metric in Metric::ALL {
        let message = metric.compare(&smooth_rgb(2, 3), &smooth_rgb(3, 2)).unwrap_err().to_string();
        assert_eq!(message, "pictures of 2 x 3 and 3 x 2 pixels cannot be compared; render or crop them to one size");
    }
    let liar = RgbImage { width: 5, ..smooth_rgb(2, 3) };
    assert!(Metric::Flip.compare(&liar, &liar).is_err());
    assert!(Metric::Flip.compare(&RgbImage::default(), &RgbImage::default()).unwrap().map.is_empty());
}

#[test]
fn pixels_within_a_tolerance_are_counted() {
    let a = [10, 10, 10, 20, 20, 20, 0, 0, 255, 0, 0, 0];
    let b = [13, 7, 10, 20, 24, 20, 0, 0, 255, 0, 0, 1];
    let fraction = |tolerance| fraction_within(&a, &b, tolerance).unwrap();
    assert_eq!([0, 1, 3, 4].map(fraction), [0.25, 0.5, 0.75, 1.0]);
    assert_eq!(max_difference8(&a, &b), Ok(4));
    assert!(fraction_within(&a, &b[..3], 1).is_err());
    assert!(fraction_within(&a[..4], &b[..4], 1).is_err());
}

#[test]
fn heat_rises_in_brightness() {
    let brightness = |i: i32| magma(i as f32 / 64.0).iter().map(|&code| u32::from(code)).sum::<u32>();
    assert!((0..64).all(|i| brightness(i) <= brightness(i + 1)));
    assert_eq!(magma(0.0), [0, 0, 4]);
    assert_eq!([magma(1.0), magma(7.0), magma(f32::NAN)], [[252, 253, 191]; 3]);
    // matplotlib.colormaps["magma"](0.3)
    let expected = [0.390384f32, 0.100379, 0.501864].map(|v| (v * 255.0 + 0.5) as u8);
    assert!(magma(0.3).iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 3), "{:?} {expected:?}", magma(0.3));

    let [test, reference] = pair();
    let found = Metric::Mae.compare(&test, &reference).unwrap();
    let png = decode(&write_heat_png(&found, 0.75).unwrap(), None).unwrap();
    let Pixels::Srgb8(pixels) = png.pixels else { panic!("not 8 bit") };
    assert_eq!(pixels[1], [252, 253, 191, 255]);
}
