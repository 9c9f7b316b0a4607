//! MERL files: every byte where it belongs, whatever else refused; values between the cells; and the fits.

use crate::models::{build, build_with, parse};
use crate::near;
use crate::samples::{self, PAINT, data, direction, file};
use kirkas_geometry::warp::square_to_uniform_cone;
use kirkas_geometry::{DVec3, Frame, Vec3};
use kirkas_optics::measured::fits::{Abc, Sgd};
use kirkas_optics::measured::half::HalfAngles;
use kirkas_optics::measured::merl::{MerlTable, SCALES, index, theta_h_at};
use kirkas_optics::measured::{MeasuredData, write_merl};
use kirkas_optics::{ColorMode, Lanes, LobeSet, Mode, Palette};
use kirkas_scene::{Span, Value};
use kirkas_testkit::{Estimate, Random};
use std::f64::consts::PI;
use std::sync::Arc;

/// A file whose cells say their own numbers.
fn numbered() -> Vec<u8> {
    let mut bytes = file("grey.binary");
    for i in 0..1_458_000 {
        for c in 0..3 {
            let value = (i + 1) as f64 * [1.0, 2.0, 3.0][c];
            bytes[12 + 8 * (c * 1_458_000 + i)..][..8].copy_from_slice(&value.to_le_bytes());
        }
    }
    bytes
}

/// Written out from the definition, not through the crate's own index.
#[test]
fn every_cell_is_read_from_its_place_with_its_scale() {
    let bytes = numbered();
    assert_eq!(bytes.len(), 34_992_012);
    assert_eq!(&bytes[..12], &[90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0]);
    let table = MerlTable::read(&bytes).unwrap();
    assert_eq!(SCALES, [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0]);
    let mut random = Random::new(1);
    for _ in 0..20_000 {
        let u = |r: &mut Random| f64::from(r.number());
        let angles = [u(&mut random) * PI / 2.0, u(&mut random) * PI / 2.0, (2.0 * u(&mut random) - 1.0) * PI];
        let at = HalfAngles { theta_h: angles[0] as f32, theta_d: angles[1] as f32, phi_d: angles[2] as f32 };
        // The half vector's angle goes by its square root, half a turn of phi_d stands for the whole.
        let (theta_h, theta_d, phi_d) = (f64::from(at.theta_h), f64::from(at.theta_d), f64::from(at.phi_d));
        let places = [
            90.0 * (theta_h / (PI / 2.0)).sqrt(),
            90.0 * theta_d / (PI / 2.0),
            180.0 * if phi_d < 0.0 { phi_d + PI } else { phi_d } / PI,
        ];
        if places.iter().any(|p| (p - p.round()).abs() < 1e-3) {
            continue;
        }
        let [h, d, p] = places.map(|p| p.floor() as usize);
        let number = p + 180 * (d + 90 * h);
        assert_eq!(index(h, d, p), number);
        let expected = [1.0, 2.0 * 1.15, 3.0 * 1.66].map(|s| ((number + 1) as f64 * s / 1500.0) as f32);
        let got = table.nearest(&at);
        assert!((0..3).all(|c| (got[c] - expected[c]).abs() <= 1e-6 * expected[c]), "{at:?}: {got:?} {expected:?}");
        assert_eq!(table.cell(h, d, p), Some(got));
    }
}

#[test]
fn truncated_and_foreign_files_are_refused_with_one_error() {
    let whole = file("grey.binary");
    let refused = |bytes: &[u8]| MerlTable::read(bytes).unwrap_err();
    for length in [0, 1, 11] {
        assert_eq!(refused(&whole[..length]), format!("it is only {length} bytes long"));
    }
    for length in [12, 13, 20, 34_992_000, 34_992_011] {
        assert_eq!(refused(&whole[..length]), format!("a MERL file has 34992012 bytes, this one {length}"));
    }
    let mut longer = whole.clone();
    longer.push(0);
    assert_eq!(refused(&longer), "a MERL file has 34992012 bytes, this one 34992013");
    let mut foreign = whole.clone();
    foreign[4] = 91;
    assert_eq!(refused(&foreign), "it is no MERL file: it begins with [90, 91, 180] instead of [90, 90, 180]");
    assert!(refused(b"\x89PNG\r\n\x1a\n and so on").starts_with("it is no MERL file"));
    for bad in [f64::NAN, f64::INFINITY, -1e300] {
        let mut broken = whole.clone();
        broken[12 + 8 * 5..][..8].copy_from_slice(&bad.to_le_bytes());
        assert_eq!(refused(&broken), format!("value 5 is {bad}"));
    }
    let empty = write_merl(|_, _| [-1.0; 3]);
    assert_eq!(refused(&empty), "no cell of it was measured");
}

/// A cell is as good as none if any channel of it is negative.
#[test]
fn cells_that_were_not_measured_have_no_weight() {
    let mut bytes = file("grey.binary");
    let (h, d, p) = (20, 10, 30);
    bytes[12 + 8 * (1_458_000 + index(h, d, p))..][..8].copy_from_slice(&(-1.0_f64).to_le_bytes());
    let table = MerlTable::read(&bytes).unwrap();
    let middle =
        HalfAngles { theta_h: theta_h_at(20.5) as f32, theta_d: 10.5_f32.to_radians(), phi_d: 30.5_f32.to_radians() };
    assert_eq!((table.cell(h, d, p), table.nearest(&middle)), (None, [0.0; 3]));
    // A little aside, the neighbours take its part.
    let aside = HalfAngles { phi_d: 30.6_f32.to_radians(), ..middle };
    near(table.rgb(&aside)[1], 0.25 / PI, 1e-6);
    // Beyond the horizon there is nothing at all.
    assert_eq!(table.rgb(&HalfAngles { theta_h: 1.55, theta_d: 1.5, phi_d: 0.1 }), [0.0; 3]);
}

/// Straight lines between the centres: a table that is linear along each axis comes back exactly, turned round and at the ends.
#[test]
fn values_between_cells_lie_on_straight_lines() {
    let mut bytes = file("grey.binary");
    for (h, d, p) in (0..90).flat_map(|h| (0..90).flat_map(move |d| (0..180).map(move |p| (h, d, p)))) {
        let value = 1500.0 * (1.0 + h as f64 + 100.0 * d as f64 + 10_000.0 * p as f64);
        for c in 0..3 {
            bytes[12 + 8 * (c * 1_458_000 + index(h, d, p))..][..8].copy_from_slice(&value.to_le_bytes());
        }
    }
    let table = MerlTable::read(&bytes).unwrap();
    let at = |h: f64, d: f64, p: f64| {
        let angles = HalfAngles {
            theta_h: theta_h_at(h) as f32,
            theta_d: (PI / 180.0 * d) as f32,
            phi_d: (PI / 180.0 * p) as f32,
        };
        f64::from(table.rgb(&angles)[0])
    };
    near(at(10.5, 20.5, 30.5), 1.0 + 10.0 + 2000.0 + 300_000.0, 0.2);
    near(at(10.75, 20.5, 30.5), 1.0 + 10.25 + 2000.0 + 300_000.0, 0.2);
    near(at(10.5, 20.9, 30.5), 1.0 + 10.0 + 2040.0 + 300_000.0, 0.3);
    near(at(10.5, 20.5, 31.25), 1.0 + 10.0 + 2000.0 + 307_500.0, 0.3);
    // The ends of the first two axes are flat; the third goes round, and turns by half with the directions swapped.
    near(at(0.1, 20.5, 0.5), 2001.0, 0.1);
    near(at(89.9, 20.5, 0.5), 2090.0, 0.1);
    near(at(10.5, 0.2, 30.5), 300_011.0, 0.3);
    near(at(10.5, 20.5, 180.0), 2011.0 + 0.5 * 1_790_000.0, 2.0);
    near(at(10.5, 20.5, -180.0 + 30.5), 302_011.0, 1.0);
}

/// The file of a smooth model is the model, between its cells too; the plain cell is what interpolation is the better of.
#[test]
fn a_written_model_is_read_back() {
    let table = data("paint.binary", ColorMode::Rgb);
    let MeasuredData::Merl(table) = &*table else { panic!("a MERL file") };
    let mut random = Random::new(3);
    let (mut worst, mut plain) = (0.0_f64, 0.0_f64);
    for _ in 0..20_000 {
        let (u, v) = (random.pair(), random.pair());
        let z = |x: f32| 0.2 + 0.8 * f64::from(x);
        let (wo, wi) = (direction(z(u.0), 7.0 * f64::from(u.1)), direction(z(v.0), 7.0 * f64::from(v.1)));
        let expected = PAINT.value(wo, wi)[0];
        let at = HalfAngles::of(wo.as_vec3(), wi.as_vec3());
        let off = |x: f32| (f64::from(x) - expected).abs() / expected;
        worst = worst.max(off(table.rgb(&at)[0]));
        plain = plain.max(off(table.nearest(&at)[0]));
    }
    println!("paint.binary is off by {worst:.5} interpolated, by {plain:.5} at the plain cell");
    assert!(worst < 0.01 && plain > 5.0 * worst, "{worst} {plain}");
}

#[test]
fn half_angles_and_directions_are_inverse() {
    let mut random = Random::new(4);
    for _ in 0..1000 {
        let (a, b) = (random.pair(), random.pair());
        let (h, d, p) = (f64::from(a.0) * 1.5, f64::from(a.1) * 1.5 + 0.01, (f64::from(b.0) - 0.5) * 6.0);
        let (wo, wi) = HalfAngles::directions(h, d, p);
        let turn = |v: DVec3| {
            let (s, c) = (f64::from(b.1) * 6.0).sin_cos();
            Vec3::new((v.x * c - v.y * s) as f32, (v.x * s + v.y * c) as f32, v.z as f32)
        };
        let (at, swapped) = (HalfAngles::of(turn(wo), turn(wi)), HalfAngles::of(turn(wi), turn(wo)));
        near(at.theta_h, h, 1e-5);
        near(at.theta_d, d, 1e-5);
        near((f64::from(at.phi_d) - p).sin(), 0.0, 1e-3);
        near((f64::from(swapped.phi_d) - f64::from(at.phi_d)).abs(), PI, 1e-3);
    }
}

/// The narrow peak of a sharp table, which sums over the whole sphere would miss: as many directions fall into cones about it
/// as the density says.
#[test]
fn a_sharp_table_is_drawn_as_its_density_says() {
    let bsdf = build("measured", &parse(&[("file", Value::from("plastic.binary"))]), 1.0).bsdf;
    for wo in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.3, 0.9, 0.3162278)] {
        let mirrored = Frame::from_z(Vec3::new(-wo.x, -wo.y, wo.z));
        for degrees in [0.1_f64, 0.5, 2.0, 8.0] {
            let one_minus_cos = 1.0 - degrees.to_radians().cos();
            let mut random = Random::new(6);
            let inside = Estimate::of((0..400_000).map(|_| {
                let s = bsdf.sample(wo, random.number(), random.pair(), LobeSet::ALL, Mode::Radiance);
                let miss = s.map_or(2.0, |s| 0.5 * (s.wi - mirrored.to_world(Vec3::Z)).length_squared());
                f64::from(u8::from(f64::from(miss) < one_minus_cos))
            }));
            const STEPS: usize = 1200;
            let density = (0..STEPS * STEPS).map(|i| {
                let (a, b) = ((i / STEPS) as f32 + 0.5, (i % STEPS) as f32 + 0.5);
                let wi = square_to_uniform_cone((a / STEPS as f32, b / STEPS as f32), one_minus_cos as f32);
                f64::from(bsdf.pdf(wo, mirrored.to_world(wi), LobeSet::ALL, Mode::Radiance))
            });
            let expected = density.sum::<f64>() / (STEPS * STEPS) as f64 * 2.0 * PI * one_minus_cos;
            assert!(inside.z(expected) < 4.5, "{wo}, {degrees} degrees: {inside:?}, density {expected}");
        }
    }
}

/// Against numbers computed apart from this code, in double precision.
#[test]
fn the_fits_meet_their_equations() {
    let bronze = Sgd {
        rho_d: [0.0478786, 0.0313514, 0.0200638],
        rho_s: [0.0364976, 0.664975, 0.268836],
        alpha: [0.014832, 0.0300126, 0.0490339],
        p: [0.459076, 0.450056, 0.529272],
        f0: [6.05524, 0.235756, 0.580647],
        f1: [5.05524, 0.182842, 0.476088],
        kappa: [46.3841, 24.5961, 14.8261],
        lambda: [2.60672, 2.97371, 2.7827],
        c: [1.12717e-07, 1.06401e-07, 5.27952e-08],
        k: [47.783, 36.2767, 31.6066],
        theta0: [0.205635, 0.066289, -0.0661091],
    };
    let paint = Abc {
        k_d: [0.00377, 0.00103, 0.009177],
        a: [0.495104, 0.469843, 1.097868],
        b: 48.57206,
        c: 1.70252,
        ior: 9.024582,
    };
    let wo = DVec3::new(0.6, 0.0, 0.8);
    let aside = DVec3::new(0.0, 0.8, 0.6);
    let opposite = DVec3::new(-0.56, 0.0, (1.0_f64 - 0.56 * 0.56).sqrt());
    let check = |got: [f64; 3], expected: [f64; 3]| {
        for c in 0..3 {
            near(got[c], expected[c], 1e-9 * expected[c]);
        }
    };
    check(bronze.value(wo, aside), [0.015240231716639551, 0.009979467501903138, 0.006389239187251384]);
    check(bronze.value(wo, opposite), [1.805275960892513, 0.8068035709188958, 0.4914849456464161]);
    check(paint.value(wo, aside), [0.00532823273209826, 0.004245436032596246, 0.012075213766241625]);
    check(paint.value(wo, opposite), [0.14904960978268056, 0.14063391796281038, 0.3307700754110045]);
}

/// At the same number of samples the table's own directions beat the cosine's by far where there is gloss.
#[test]
fn sampling_by_the_table_beats_the_cosine() {
    for (name, least) in [("paint.binary", 0.5), ("plastic.binary", 5.0)] {
        let bsdf = build("measured", &parse(&[("file", Value::from(name))]), 1.0).bsdf;
        for wo in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.3, 0.9, 0.3162278)] {
            let (own, cosine) = variances(&bsdf, wo);
            println!("{name} from {wo}: cosine / own variance = {:.1}", cosine / own);
            assert!(cosine / own >= least, "{name} from {wo}: {}", cosine / own);
        }
    }
}

/// Of the estimate of what a furnace shows, all channels together: by the model's sampling and by the cosine's.
pub fn variances(bsdf: &kirkas_optics::Bsdf, wo: Vec3) -> (f64, f64) {
    const SAMPLES: usize = 100_000;
    let mut random = Random::new(5);
    let own = Estimate::of((0..SAMPLES).map(|_| {
        let s = bsdf.sample(wo, random.number(), random.pair(), LobeSet::ALL, Mode::Radiance);
        s.map_or(0.0, |s| s.weight().sum())
    }));
    let cosine = Estimate::of((0..SAMPLES).map(|_| {
        let wi = kirkas_geometry::warp::square_to_cosine_hemisphere(random.pair());
        bsdf.eval(wo, wi, LobeSet::ALL, Mode::Radiance).sum() * PI
    }));
    (own.standard_error * own.standard_error, cosine.standard_error * cosine.standard_error)
}

/// The published fits of real glossy materials, as files: at least five times less variance than by the cosine.
#[test]
fn real_gloss_is_sampled_at_least_five_times_better_than_by_the_cosine() {
    let Some(fits) = samples::published_fits() else { return };
    let glossy =
        ["chrome", "alum-bronze", "blue-metallic-paint", "gold-paint", "specular-red-phenolic", "violet-acrylic"];
    for name in glossy {
        let (sgd, abc) = &fits[name];
        for (kind, bytes) in
            [("SGD", write_merl(|wo, wi| sgd.value(wo, wi))), ("ABC", write_merl(|wo, wi| abc.value(wo, wi)))]
        {
            let mut palette = Palette::RGB;
            palette.add_measured(Span::NONE, name, Arc::new(MeasuredData::read(&bytes, ColorMode::Rgb).unwrap()));
            let bsdf = build_with(&palette, Lanes::RGB, "measured", &parse(&[("file", Value::from(name))]), 1.0).bsdf;
            for wo in [Vec3::new(0.1, 0.0, 0.99498744), Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.3, 0.9, 0.3162278)] {
                let (own, cosine) = variances(&bsdf, wo);
                println!("{name} ({kind}) at cosine {:.2}: cosine / own variance = {:.1}", wo.z, cosine / own);
                assert!(cosine / own >= 5.0, "{name} ({kind}) from {wo}: {}", cosine / own);
            }
        }
    }
}
