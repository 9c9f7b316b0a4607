//! The sRGB transfer function and the tone curves.

use kirkas_images::srgb::{linear_to_srgb8, linear_to_srgb16, srgb8_to_linear, srgb16_to_linear};
use kirkas_images::*;

#[test]
fn known_values_of_srgb() {
    // IEC 61966-2-1: the linear segment, the join, the middle and the ends.
    for (coded, linear) in [(0.0, 0.0), (0.02, 0.02 / 12.92), (0.5, 0.214_041_14), (0.8, 0.603_827_4), (1.0, 1.0f32)] {
        assert!((srgb_to_linear(coded) - linear).abs() <= 6e-8, "{coded}");
        assert!((linear_to_srgb(linear) - coded).abs() <= 1.2e-7, "{linear}");
    }
}

#[test]
fn codes_survive_decoding_and_encoding() {
    for code in 0..=255 {
        assert_eq!(linear_to_srgb8(srgb8_to_linear(code)), code);
        // The table starts from code / 255 in f64, the function from the same rounded to f32.
        let [table, function] = [srgb8_to_linear(code), srgb_to_linear(f32::from(code) / 255.0)];
        assert!((table - function).abs() <= 2.5e-7 * table, "{code}: {table} and {function}");
    }
    for code in 0..=65535 {
        assert_eq!(linear_to_srgb16(srgb16_to_linear(code)), code);
    }
}

#[test]
fn the_search_equals_its_simple_twin() {
    for i in 0..200_000 {
        let linear = i as f32 / 199_999.0 * 1.02 - 0.01;
        let coded = f64::from(linear_to_srgb(linear.clamp(0.0, 1.0))) * 255.0;
        let code = f64::from(linear_to_srgb8(linear));
        assert!((code - coded).abs() <= 0.5 + 3e-5, "{linear} gave {code}, not {coded}");
    }
    assert_eq!([f32::NAN, -1.0, f32::NEG_INFINITY, 2.0, f32::INFINITY].map(linear_to_srgb8), [0, 0, 0, 255, 255]);
    assert_eq!([f32::NAN, -1.0, f32::NEG_INFINITY, 2.0, f32::INFINITY].map(linear_to_srgb16), [0, 0, 0, 65535, 65535]);
}

#[test]
fn the_bits_of_srgb_are_pinned() {
    // Same bits everywhere: this sum is the same natively, as wasm and on other processors.
    let sum = |values: &mut dyn Iterator<Item = u32>| values.fold(0u32, |sum, bits| sum.rotate_left(5) ^ bits);
    assert_eq!(sum(&mut (0..=255).map(|code| srgb8_to_linear(code).to_bits())), PINNED[0]);
    assert_eq!(sum(&mut (0..4096).map(|i| linear_to_srgb(i as f32 / 4095.0).to_bits())), PINNED[1]);
}
const PINNED: [u32; 2] = [2_742_031_500, 3_267_123_164];

#[test]
fn tone_curves_rise_from_black_to_white() {
    for curve in ToneCurve::ALL {
        assert_eq!(curve.apply(0.0), 0.0, "{curve:?}");
        assert_eq!(curve.apply(f32::INFINITY), 1.0, "{curve:?}");
        assert_eq!(curve.apply(f32::NAN), 0.0, "{curve:?}");
        assert_eq!(curve.apply(-3.0), 0.0, "{curve:?}");
        let values: Vec<f32> = (0..2000).map(|i| curve.apply(i as f32 * 0.01)).collect();
        assert!(values.windows(2).all(|pair| pair[0] <= pair[1]), "{curve:?} falls");
        assert!(values.iter().all(|value| (0.0..=1.0).contains(value)), "{curve:?} leaves [0, 1]");
        assert_eq!(ToneCurve::from_name(curve.name()), Some(curve));
    }
    assert_eq!(ToneCurve::from_name("Filmic"), None);
}

#[test]
fn tone_curves_meet_their_papers() {
    // Hable 2010: ((x(Ax+CB)+DE)/(x(Ax+B)+DF))-E/F at x = 2, over the same at 11.2, worked out by hand in f64.
    assert!((ToneCurve::Filmic.apply(1.0) - 0.492_918_55).abs() < 1e-5, "{}", ToneCurve::Filmic.apply(1.0));
    // Narkowicz 2016 at x = 1: 2.54 / 3.16.
    assert!((ToneCurve::Aces.apply(1.0) - 2.54 / 3.16).abs() < 1e-6);
    assert_eq!(ToneCurve::Linear.apply(0.3), 0.3);
}

#[test]
fn exposure_counts_stops() {
    let grey = |value: f32| RgbImage { width: 1, height: 1, pixels: vec![[value; 3]] };
    let codes = |value, stops| to_srgb8(&grey(value), stops, ToneCurve::Linear);
    assert_eq!(codes(0.1, 2.0), codes(0.4, 0.0));
    assert_eq!(codes(0.8, -3.0), codes(0.1, 0.0));
    assert_eq!(to_srgb8(&grey(f32::NAN), 0.0, ToneCurve::Linear), [0, 0, 0]);
    assert_eq!(to_srgb16(&grey(1.0), 0.0, ToneCurve::Linear), [65535; 3]);
}
