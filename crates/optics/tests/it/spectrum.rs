//! The observer, illuminants, and colours that become spectra and come back.

use crate::near;
use kirkas_optics::spectrum::curve::{Curve, FIRST, LAST, SAMPLES};
use kirkas_optics::spectrum::file::read_pairs;
use kirkas_optics::spectrum::illuminants::{NAMES, blackbody, illuminant};
use kirkas_optics::spectrum::observer::observer;
use kirkas_optics::{ColorMode, Lanes, Light, Palette, Spectrum};

/// CIE x and y of linear Rec.709.
fn xy(rgb: [f64; 3]) -> (f64, f64) {
    let [r, g, b] = rgb;
    let x = 0.412391 * r + 0.357584 * g + 0.180481 * b;
    let y = 0.212639 * r + 0.715169 * g + 0.072192 * b;
    let z = 0.019331 * r + 0.119195 * g + 0.950532 * b;
    (x / (x + y + z), y / (x + y + z))
}

/// What many paths, their heroes evenly spread, see of light whose lanes `f` says.
fn seen(f: impl Fn(&Lanes) -> Light) -> [f64; 3] {
    const COUNT: u32 = 4096;
    let mut sum = [0.0; 3];
    for i in 0..COUNT {
        let lanes = Lanes::spectral((i as f32 + 0.5) / COUNT as f32);
        let rgb = lanes.to_film(f(&lanes));
        (0..3).for_each(|c| sum[c] += f64::from(rgb[c]) / f64::from(COUNT));
    }
    sum
}

#[track_caller]
fn all_near(a: [f64; 3], b: [f64; 3], tolerance: f64) {
    assert!((0..3).all(|c| (a[c] - b[c]).abs() <= tolerance), "{a:?} is not {b:?} within {tolerance}");
}

#[test]
fn illuminants_have_their_published_chromaticities() {
    // CIE 015:2018, table 11 and the head of table 10.
    let published = [
        ("A", 0.44758, 0.40745),
        ("D50", 0.34567, 0.35851),
        ("D65", 0.31272, 0.32903),
        ("F2", 0.37208, 0.37529),
        ("F7", 0.31292, 0.32933),
        ("F11", 0.38052, 0.37713),
        ("E", 1.0 / 3.0, 1.0 / 3.0),
    ];
    for (name, x, y) in published {
        let got = xy(observer().color_of_light(illuminant(name).unwrap().samples()));
        assert!((got.0 - x).abs() < 4e-4 && (got.1 - y).abs() < 4e-4, "{name}: {got:?}");
    }
    assert!(NAMES.iter().all(|n| illuminant(n).is_some()) && illuminant("D66").is_none());
}

#[test]
fn black_bodies_run_along_plancks_locus() {
    // Wyszecki & Stiles 1982, table 1(3.11.1) (c2 rescaled): 2856 K is illuminant A; 6500 K and 10000 K.
    for (kelvin, x, y) in [(2855.54, 0.44758, 0.40745), (6500.0, 0.31352, 0.32363), (10000.0, 0.28063, 0.28829)] {
        let got = xy(observer().color_of_light(blackbody(kelvin).samples()));
        assert!((got.0 - x).abs() < 5e-4 && (got.1 - y).abs() < 5e-4, "{kelvin}: {got:?}");
    }
}

#[test]
fn equal_energy_has_the_area_under_y_bar() {
    // CIE 015:2018: 106.857 (5 nm, 380-780 nm).
    let [r, g, b] = observer().color_of_light(&[1.0; SAMPLES]);
    near(0.212639 * r + 0.715169 * g + 0.072192 * b, 106.857, 0.02);
}

#[test]
fn white_light_is_white_and_paths_integrate_exactly_what_sums_do() {
    let palette = Palette::new(ColorMode::Spectral);
    let white = palette.illuminant([1.0; 3]);
    all_near(seen(|l| white.at(l)), [1.0; 3], 2e-4);
    for name in ["A", "F11"] {
        let curve = illuminant(name).unwrap();
        let truth = observer().color_of_light(curve.samples());
        let got = seen(|l| curve.at(l));
        all_near(got.map(|x| x / truth[1]), truth.map(|x| x / truth[1]), 2e-3);
    }
}

#[test]
fn heroes_reach_the_whole_range_and_lanes_never_coincide() {
    let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
    for i in 0..10_000 {
        let w = Lanes::spectral(i as f32 / 10_000.0).wavelengths();
        least = least.min(w[0]);
        most = most.max(w[0]);
        for a in 0..4 {
            assert!((FIRST as f32..=LAST as f32).contains(&w[a]));
            assert!((0..a).all(|b| w[a] != w[b]), "{w:?}");
        }
    }
    assert!(least < 382.0 && most > 777.0, "{least}..{most}");
}

#[test]
fn colours_come_back_under_white() {
    let palette = Palette::new(ColorMode::Spectral);
    for rgb in [[0.8, 0.2, 0.1], [0.1, 0.9, 0.3], [0.02, 0.05, 0.6], [0.5, 0.5, 0.1], [0.9, 0.9, 0.95], [0.3; 3]] {
        let truth = rgb.map(f64::from);
        let (white, surface) = (palette.illuminant([1.0; 3]), palette.reflectance(rgb));
        all_near(seen(|l| white.at(l) * surface.at(l)), truth, 1e-3);
        all_near(seen(|l| white.at(l) * l.reflectance(rgb)), truth, 4e-3);
        // What shines in a colour has it as well, however bright.
        let bright = rgb.map(|c| 30.0 * c);
        all_near(seen(|l| palette.illuminant(bright).at(l)).map(|c| c / 30.0), truth, 1e-3);
        all_near(seen(|l| l.illuminant(bright)).map(|c| c / 30.0), truth, 4e-3);
        for u in [0.1, 0.6] {
            let at = surface.at(&Lanes::spectral(u));
            assert!(at.0.iter().all(|x| (0.0..=1.0).contains(x)), "{at:?}");
        }
    }
}

#[test]
fn greys_are_the_same_in_every_lane() {
    let palette = Palette::new(ColorMode::Spectral);
    let lanes = Lanes::spectral(0.3);
    for x in [0.0, 0.25, 1.0] {
        assert_eq!(palette.reflectance([x; 3]).at(&lanes), Light::splat(x));
        assert_eq!(lanes.reflectance([x; 3]), Light::splat(x));
    }
    assert_eq!(palette.unbounded([7.5; 3]).at(&lanes), Light::splat(7.5));
    assert_eq!(palette.unbounded([-1.0, f32::NAN, 0.0]).at(&lanes), Light::BLACK);
    assert_eq!(lanes.one(), Light::splat(1.0));
}

#[test]
fn rgb_lanes_see_the_numbers_themselves() {
    let palette = Palette::new(ColorMode::Spectral);
    let of = |s: Spectrum| s.at(&Lanes::RGB);
    assert_eq!(of(palette.illuminant([0.25, 1.5, -0.5])), Light([0.25, 1.5, 0.0, 0.0]));
    assert_eq!(of(palette.reflectance([0.25, 1.5, -0.5])), Light([0.25, 1.0, 0.0, 0.0]));
}

#[test]
fn a_hero_alone_stands_for_all() {
    let spectrum = Palette::new(ColorMode::Spectral).illuminant([0.9, 0.4, 0.2]);
    all_near(seen(|l| spectrum.at(l) * l.hero_weight()), [0.9, 0.4, 0.2].map(f64::from), 2e-3);
    let lanes = ColorMode::Rgb.lanes(0.9);
    assert_eq!((lanes.hero(), lanes.hero_weight()), (2, Light([0.0, 0.0, 3.0, 0.0])));
    assert_eq!(lanes.alone().hero_weight(), Light([0.0, 0.0, 1.0, 0.0]));
    let heroes = [0.0, 0.34, 0.67].map(|u| ColorMode::Rgb.lanes(u).hero());
    assert_eq!(heroes, [0, 1, 2]);
}

#[test]
fn narrow_lines_keep_their_power() {
    // Sodium light, 589.3 nm, one unit of power.
    let line = Curve::of_pairs(&[(589.0, 0.0), (589.3, 1.0 / 0.3), (589.6, 0.0)], false);
    let power: f32 = line.samples().iter().sum::<f32>() * 5.0;
    near(power, 1.0, 0.05);
}

#[test]
fn spectra_are_read_from_two_columns() {
    assert_eq!(
        read_pairs("# lamp\nnm, power\n400, 1\n500;2\n600\t3.5\n").unwrap(),
        [(400.0, 1.0), (500.0, 2.0), (600.0, 3.5)]
    );
    assert_eq!(read_pairs("0.4 1\n0.5 2\n").unwrap()[1].0, 500.0);
    for (text, problem) in [
        ("", "no pairs"),
        ("400 1\n400 2\n", "rise"),
        ("400\n", "two numbers"),
        ("400 -1\n", "negative"),
        ("400 nan\n", "two numbers"),
        ("900 1\n1000 2\n", "nothing between"),
    ] {
        let error = read_pairs(text).unwrap_err();
        assert!(error.contains(problem), "{text:?}: {error}");
    }
}
