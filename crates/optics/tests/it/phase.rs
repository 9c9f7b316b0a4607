//! Phase functions: they integrate to 1, samples follow them, and drops of water make the rainbow.

use crate::models::parse;
use crate::near;
use kirkas_geometry::Vec3;
use kirkas_optics::phase::droplet::{AIR_INDEX, water_index};
use kirkas_optics::phase::scattering_table::{BINS, ScatteringTable};
use kirkas_optics::phase::{PhaseFunction, SPECS};
use kirkas_optics::{ColorMode, Lanes, Light, Palette};
use kirkas_scene::{Catalog, Entity, Kind, Params, Value};
use kirkas_testkit::statistics::chi_square_tail;
use kirkas_testkit::{ChiSquare, Random, integrate_sphere, sidak};
use std::f64::consts::PI;

const EVEN: Light = Light([1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0]);

fn build(type_name: &str, pairs: &[(&str, Value)]) -> PhaseFunction {
    let catalog = Catalog { types: SPECS.iter().collect(), common: Vec::new() };
    let entity = Entity::new("it", type_name, parse(pairs));
    let params = Params::new(&entity, Kind::Phase, &catalog).expect("a listed phase function");
    PhaseFunction::prepare(&params, &Palette::RGB).expect("a listed phase function")
}

/// Every listed type: a new one fails here until it has its parameter sets.
fn smooth_cases() -> Vec<(String, f64, PhaseFunction)> {
    let mut cases = Vec::new();
    for spec in SPECS {
        match spec.name {
            "isotropic" | "rayleigh" => cases.push((spec.name.into(), 0.0, build(spec.name, &[]))),
            "henyey_greenstein" => {
                cases.extend([-0.9, -0.3, 0.0, 1e-4, 0.5, 0.95].map(|g| {
                    (format!("henyey_greenstein {g}"), g, build("henyey_greenstein", &[("g", Value::Float(g))]))
                }))
            }
            "droplet" => {}
            other => panic!("{other} has no parameter sets here"),
        }
    }
    cases
}

fn directions() -> [Vec3; 3] {
    [Vec3::Z, Vec3::new(0.6, 0.0, -0.8), Vec3::new(-0.3, 0.5, 0.1).normalize()]
}

#[test]
fn phase_functions_integrate_to_one_and_have_their_mean_cosine() {
    for (label, g, f) in smooth_cases() {
        for wo in directions() {
            let value = |wi: Vec3| f64::from(f.value(&Lanes::RGB, wo, wi)[1]);
            near(integrate_sphere(value), 1.0, 2e-4);
            let mean = integrate_sphere(|wi| value(wi) * f64::from(-wo.dot(wi)));
            assert!((mean - g).abs() < 2e-4, "{label}: mean cosine {mean}");
        }
    }
    // analytic.json, "HG mean cosine": the value straight on at g = 0.5.
    let half = build("henyey_greenstein", &[("g", Value::Float(0.5))]);
    near(half.value(&Lanes::RGB, Vec3::Z, -Vec3::Z)[0], 0.477464829275686, 1e-6);
}

#[test]
fn sampled_directions_follow_the_phase_function() {
    let cases = smooth_cases();
    let threshold = sidak(0.01, cases.len() * directions().len());
    for (seed, (label, _, f)) in cases.iter().enumerate() {
        for wo in directions() {
            let test = ChiSquare { rows: 12, columns: 24, samples: 40_000, seed: seed as u64 };
            let r = test
                .run(|u, v| f.sample(&Lanes::RGB, EVEN, wo, u, v).map(|s| s.wi), |wi| f.pdf(&Lanes::RGB, EVEN, wo, wi));
            assert!(r.p_value >= threshold, "{label} from {wo}: {r:?}");
        }
    }
}

#[test]
fn samples_say_what_the_phase_function_says_of_them() {
    let mut cases = smooth_cases();
    cases.push(("droplet".into(), 0.0, build("droplet", &[])));
    let last = 1.0 - f32::EPSILON / 2.0;
    let mut random = Random::new(3);
    for (label, _, f) in cases {
        for i in 0..3000 {
            let wo = directions()[i % 3];
            let shares = if i % 2 == 0 { EVEN } else { Light([0.1, 0.0, 0.9, 0.0]) };
            let (mut u, mut v) = (random.number(), random.pair());
            if i < 16 {
                (u, v) = (if i & 1 > 0 { last } else { 0.0 }, (if i & 2 > 0 { last } else { 0.0 }, v.1));
            }
            let s = f.sample(&Lanes::RGB, shares, wo, u, v).expect("shares with sense");
            assert!((s.wi.length() - 1.0).abs() < 1e-5, "{label}: {s:?}");
            assert_eq!(s.value, f.value(&Lanes::RGB, wo, s.wi));
            assert_eq!(s.pdf, f.pdf(&Lanes::RGB, shares, wo, s.wi));
            assert!(s.pdf > 0.0 && s.value.is_finite(), "{label}: {s:?}");
        }
        assert!(f.sample(&Lanes::RGB, Light::BLACK, Vec3::Z, 0.5, (0.5, 0.5)).is_none());
    }
}

/// Each lane sees the bow of its own wavelength, and draws from it.
#[test]
fn wavelengths_have_bows_of_their_own() {
    let catalog = Catalog { types: SPECS.iter().collect(), common: Vec::new() };
    let entity = Entity::new("it", "droplet", parse(&[]));
    let params = Params::new(&entity, Kind::Phase, &catalog).expect("a listed phase function");
    let f = PhaseFunction::prepare(&params, &Palette::new(ColorMode::Spectral)).expect("a listed phase function");
    let lanes = Lanes::spectral(0.3);
    let mut random = Random::new(5);
    for (lane, wavelength) in lanes.wavelengths().into_iter().enumerate() {
        let at = |antisolar: f64| {
            let angle = antisolar.to_radians();
            let (s, c) = (kirkas_geometry::elementary::sin(angle), kirkas_geometry::elementary::cos(angle));
            f64::from(f.value(&lanes, Vec3::Z, Vec3::new(s as f32, 0.0, c as f32))[lane])
        };
        let table = ScatteringTable::of_ball(water_index(f64::from(wavelength)) / AIR_INDEX, 5);
        let steps = (0..=2000).map(|i| 39.0 + 5.0 * f64::from(i) / 2000.0);
        let brightest = steps.max_by(|a, b| at(*a).total_cmp(&at(*b))).expect("some");
        near(brightest, bow(&table, (35.0, 45.0)), 0.1);
        // Samples of this lane alone: the part that lies within 60 degrees of the way back, like the table's.
        let mut alone = Light::BLACK;
        alone.0[lane] = 1.0;
        let mut draw = || f.sample(&lanes, alone, Vec3::Z, random.number(), random.pair()).expect("shares with sense");
        let back = (0..40_000).filter(|_| draw().wi.z > 0.5).count() as f64 / 40_000.0;
        let total: f64 = table.masses().iter().sum();
        near(back, table.masses()[BINS * 2 / 3..].iter().sum::<f64>() / total, 5e-3);
    }
}

/// Bins of 0.02 degrees are too fine for a grid over the sphere: counts over the angle alone, uneven steps.
#[test]
fn sampled_angles_of_droplets_follow_their_table() {
    let f = build("droplet", &[]);
    let wo = directions()[2];
    let place = |degrees: f64| (degrees * 2.0) as usize;
    let wi_at = |angle: f64| {
        let frame = kirkas_geometry::Frame::from_z(-wo);
        let (s, c) = (kirkas_geometry::elementary::sin(angle), kirkas_geometry::elementary::cos(angle));
        frame.to_world(Vec3::new(s as f32, 0.0, c as f32))
    };
    for (lane, shares) in [Light([1.0, 0.0, 0.0, 0.0]), Light([0.0, 0.0, 1.0, 0.0]), EVEN].into_iter().enumerate() {
        let mut expected = vec![0.0; 360];
        for bin in 0..BINS {
            let (low, high) = (ScatteringTable::angle(bin).to_radians(), ScatteringTable::angle(bin + 1).to_radians());
            let solid = 2.0 * PI * (kirkas_geometry::elementary::cos(low) - kirkas_geometry::elementary::cos(high));
            let middle = 0.5 * (low + high);
            expected[place(middle.to_degrees())] += f64::from(f.pdf(&Lanes::RGB, shares, wo, wi_at(middle))) * solid;
        }
        near(expected.iter().sum::<f64>(), 1.0, 1e-4);
        const N: u32 = 200_000;
        let mut random = Random::new(lane as u64);
        let mut seen = vec![0_u32; 360];
        for _ in 0..N {
            let s = f.sample(&Lanes::RGB, shares, wo, random.number(), random.pair()).expect("shares with sense");
            let cos = f64::from(-wo.dot(s.wi)).clamp(-1.0, 1.0);
            seen[place(kirkas_geometry::elementary::acos(cos).to_degrees()).min(359)] += 1;
        }
        let (mut statistic, mut degrees) = (0.0, 0);
        for (o, e) in seen.iter().zip(&expected).filter(|(_, e)| **e * f64::from(N) > 20.0) {
            let e = e * f64::from(N);
            statistic += (f64::from(*o) - e) * (f64::from(*o) - e) / e;
            degrees += 1;
        }
        let p = chi_square_tail(statistic, degrees - 1);
        assert!(degrees > 200 && p > sidak(0.01, 3), "lane {lane}: p {p}, {statistic} of {degrees}");
    }
}

/// Angle from the point opposite the sun, in degrees, of the brightest bin (per solid angle) within a range of such angles.
fn bow(table: &ScatteringTable, range: (f64, f64)) -> f64 {
    let from_antisolar = |bin: usize| 180.0 - ScatteringTable::angle(bin) - 0.01;
    let brightness =
        |bin: usize| table.masses()[bin] / kirkas_geometry::elementary::sin(from_antisolar(bin).to_radians());
    (0..BINS)
        .filter(|&b| (range.0..range.1).contains(&from_antisolar(b)))
        .max_by(|&a, &b| brightness(a).total_cmp(&brightness(b)))
        .map(from_antisolar)
        .expect("a range within the circle")
}

/// analytic.json, "rainbow": wavelength (nm), index, primary, secondary bow (degrees).
const RAINBOW: [(f64, f64, f64, f64); 6] = [
    (400.0, 1.34355668, 40.56742301, 53.61979716),
    (434.0, 1.34071933, 40.96869862, 52.89370966),
    (486.1, 1.33749356, 41.42912567, 52.06165715),
    (550.0, 1.33468333, 41.83394806, 51.33101518),
    (589.3, 1.33334906, 42.02737432, 50.98221206),
    (700.0, 1.33051759, 42.44047747, 50.23791239),
];

#[test]
fn bows_stand_at_their_angles_for_each_wavelength() {
    for (wavelength, index, primary, secondary) in RAINBOW {
        near(water_index(wavelength), index, 1e-8);
        let table = ScatteringTable::of_ball(index, 5);
        near(bow(&table, (35.0, 45.0)), primary, 0.021);
        near(bow(&table, (48.0, 58.0)), secondary, 0.021);
    }
    // "rainbow_in_air" at 589.3 nm: 42.08 degrees.
    let table = ScatteringTable::of_ball(water_index(589.3) / AIR_INDEX, 5);
    near(bow(&table, (35.0, 45.0)), 42.08107, 0.021);
    near(bow(&table, (48.0, 58.0)), 50.8854177, 0.021);
}

#[test]
fn drops_lose_no_energy_and_a_ball_of_air_bends_nothing() {
    let sum = |n, k| ScatteringTable::of_ball(n, k).masses().iter().sum::<f64>();
    near(sum(1.333, 40), 1.0, 2e-5);
    assert!(sum(1.333, 1) < sum(1.333, 2) && sum(1.333, 2) < sum(1.333, 5));
    near(sum(1.333, 5), 1.0, 2e-3);
    near(ScatteringTable::of_ball(1.0, 3).masses()[0], 1.0, 1e-6);
    // What is reflected outside, "diffuse Fresnel ext n=1.333", goes evenly by 2 i; the whole falls behind 90 degrees only
    // with what was reflected inside.
    let outside_and_through = ScatteringTable::of_ball(1.333, 0);
    let behind: f64 = outside_and_through.masses()[BINS / 2..].iter().sum();
    assert!(behind > 0.0 && behind < 0.0664057647830795 / 2.0, "{behind}");
}

#[test]
fn the_rainbow_is_red_outside_and_the_band_between_the_bows_is_dark() {
    let f = build("droplet", &[]);
    let at = |antisolar: f64| {
        let angle = antisolar.to_radians();
        let (s, c) = (kirkas_geometry::elementary::sin(angle), kirkas_geometry::elementary::cos(angle));
        f.value(&Lanes::RGB, Vec3::Z, Vec3::new(s as f32, 0.0, c as f32))
    };
    let brightest = |lane: usize, low: f64, high: f64| {
        let steps = (0..=1000).map(|i| low + (high - low) * f64::from(i) / 1000.0);
        steps.max_by(|a, b| at(*a)[lane].total_cmp(&at(*b)[lane])).expect("some")
    };
    let [red, green, blue] = [0, 1, 2].map(|lane| brightest(lane, 39.0, 44.0));
    assert!(red > green + 0.2 && green > blue + 0.2, "primary {red} {green} {blue}");
    assert!((41.9..42.6).contains(&red) && (40.5..41.5).contains(&blue), "primary {red} {blue}");
    let [red, green, blue] = [0, 1, 2].map(|lane| brightest(lane, 49.0, 55.0));
    assert!(red < green - 0.2 && green < blue - 0.2, "secondary {red} {green} {blue}");
    for lane in 0..3 {
        let (inside, band, outside) = (at(35.0)[lane], at(47.0)[lane], at(58.0)[lane]);
        let bow = at(brightest(lane, 39.0, 44.0))[lane];
        assert!(band < 0.35 * inside && band < 0.8 * outside && band < 0.06 * bow, "{inside} {bow} {band} {outside}");
    }
}
