//! RGL files: the real ones load and are drawn as they say, damaged ones are refused in words, and what is written is read back.

use crate::merl::variances;
use crate::models::{Case, build, build_with, parse};
use crate::near;
use crate::samples::{brushed, data, facets, file, measurements};
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::square_to_cosine_hemisphere;
use kirkas_optics::measured::fits::Sgd;
use kirkas_optics::measured::rgl::RglTable;
use kirkas_optics::measured::warp::{Blend, Warp};
use kirkas_optics::measured::{MeasuredData, RglGrid, tensor_file, write_rgl};
use kirkas_optics::{ColorMode, Lanes, LobeSet, Mode, Palette};
use kirkas_scene::{Span, Value};
use kirkas_testkit::furnace::directions_above;
use kirkas_testkit::{ChiSquare, Random, albedo_by_quadrature, albedo_by_sampling, reciprocity_error, sidak};
use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// A file as a material.
fn case(name: &str, bytes: &[u8]) -> Case {
    let mut palette = Palette::RGB;
    let data = MeasuredData::read(bytes, ColorMode::Rgb).unwrap_or_else(|e| panic!("{name}: {e}"));
    palette.add_measured(Span::NONE, name, Arc::new(data));
    build_with(&palette, Lanes::RGB, "measured", &parse(&[("file", Value::from(name))]), 1.0)
}

/// Every file of the folder, by name.
fn real_files() -> Vec<(String, Vec<u8>)> {
    let Some(folder) = measurements("rgl-epfl") else { return Vec::new() };
    let paths = std::fs::read_dir(folder).unwrap().flatten().map(|e| e.path());
    let mut paths: Vec<_> = paths.filter(|p| p.extension().is_some_and(|e| e == "bsdf")).collect();
    paths.sort();
    paths
        .into_iter()
        .map(|p| (p.file_stem().unwrap().to_string_lossy().into_owned(), std::fs::read(p).unwrap()))
        .collect()
}

#[test]
fn the_sampled_furnace_of_every_real_file_meets_the_quadrature_of_its_data() {
    for (name, bytes) in real_files() {
        let case = case(&name, &bytes);
        for (k, wo) in directions_above(4, 0.1).into_iter().enumerate() {
            let lane = k % 3;
            let truth =
                albedo_by_quadrature(|wi| f64::from(case.bsdf.eval(wo, wi, LobeSet::ALL, Mode::Radiance)[lane]));
            let sampled = albedo_by_sampling(60_000, 3, |u, v| {
                let s = case.bsdf.sample(wo, u, v, LobeSet::ALL, Mode::Radiance);
                s.map_or(0.0, |s| f64::from(s.weight()[lane]))
            });
            let off = sampled.mean / truth - 1.0;
            println!("{name}, cosine {:.2}, lane {lane}: {truth:.4}, sampled {:+.3} %", wo.z, 100.0 * off);
            assert!(off.abs() < 0.01, "{name} from {wo}, lane {lane}: {truth}, sampled {sampled:?}");
            assert!(truth <= 1.0, "{name} from {wo}, lane {lane}: {truth}");
        }
        let f = |a, b| f64::from(case.bsdf.eval(a, b, LobeSet::ALL, Mode::Radiance)[1]);
        let above = |v: Vec3| v.z.abs() > 0.2;
        let error = reciprocity_error(2000, 1, 0.02, |a, b| if above(a) && above(b) { f(a, b) } else { 0.0 });
        println!("{name}: swapping directions changes at most {:.0} % (within 78 degrees)", 100.0 * error);
    }
}

#[test]
fn real_files_are_drawn_as_their_density_says_and_better_than_by_the_cosine() {
    let files = real_files();
    let threshold = sidak(0.01, files.len().max(1) * 2);
    for (name, bytes) in &files {
        let case = case(name, bytes);
        for (seed, wo) in directions_above(2, 0.3).into_iter().enumerate() {
            let test = ChiSquare { rows: 12, columns: 24, samples: 40_000, seed: seed as u64 };
            let sample = |u, v| case.bsdf.sample(wo, u, v, LobeSet::ALL, Mode::Radiance).map(|s| s.wi);
            let r = test.run(sample, |wi| case.bsdf.pdf(wo, wi, LobeSet::ALL, Mode::Radiance));
            assert!(r.p_value >= threshold && r.total < 1.001, "{name} from {wo}: {r:?}");
            let (own, cosine) = variances(&case.bsdf, wo);
            println!("{name} at cosine {:.2}: cosine / own variance = {:.1}", wo.z, cosine / own);
            // Those whose highlights show.
            if ["chm_light_blue_rgb", "irid_flake_paint2_rgb", "vch_dragon_eye_red_rgb"].contains(&&name[..]) {
                assert!(cosine / own >= 5.0, "{name} from {wo}: {}", cosine / own);
            }
        }
    }
}

/// What is written is what was asked, between the places that were looked at too.
#[test]
fn a_written_model_is_read_back() {
    let grid = RglGrid {
        phi_i: (0..17).map(|k| -PI + PI * k as f32 / 16.0).collect(),
        theta_i: (0..16).map(|k| FRAC_PI_2 * k as f32 / 15.0).collect(),
        facets: 128,
        values: 32,
        wavelengths: None,
    };
    let bytes = write_rgl(&grid, |m| facets(0.3, 0.5, m), |i, o, c| brushed(0.3, 0.5, i, o, c));
    let case = case("fine", &bytes);
    let mut random = Random::new(3);
    let mut off: Vec<f32> = (0..4000)
        .map(|_| {
            let (u, v) = (random.pair(), random.pair());
            let w = |z: f32, p: f32| {
                let (z, p) = (0.3 + 0.7 * z, 2.0 * PI * p);
                Vec3::new((1.0 - z * z).sqrt() * p.cos(), (1.0 - z * z).sqrt() * p.sin(), z)
            };
            let (i, o) = (w(u.0, u.1), w(v.0, v.1));
            let expected = brushed(0.3, 0.5, i, o, 1);
            (case.bsdf.eval(i, o, LobeSet::ALL, Mode::Radiance)[1] - expected).abs() / expected
        })
        .collect();
    off.sort_by(f32::total_cmp);
    println!("median {:.4}, 99 % below {:.4}", off[2000], off[3960]);
    assert!(off[2000] < 0.01 && off[3960] < 0.1, "{} {}", off[2000], off[3960]);
}

/// A material measured over half a turn, or a quarter, is the same in the others.
#[test]
fn what_was_measured_over_a_part_of_a_turn_holds_all_round() {
    let turns: [(&str, &[(f32, f32)]); 2] =
        [("brushed.bsdf", &[(-1.0, -1.0)]), ("brushed_spectral.bsdf", &[(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0)])];
    for (name, signs) in turns {
        let bsdf = build("measured", &parse(&[("file", Value::from(name))]), 1.0).bsdf;
        let mut random = Random::new(8);
        for _ in 0..500 {
            let mut w = || square_to_cosine_hemisphere(random.pair());
            let (a, b) = (w(), w());
            let f = bsdf.eval(a, b, LobeSet::ALL, Mode::Radiance)[0];
            for &(x, y) in signs {
                let turn = |v: Vec3| Vec3::new(x * v.x, y * v.y, v.z);
                let g = bsdf.eval(turn(a), turn(b), LobeSet::ALL, Mode::Radiance)[0];
                near(g, f, 1e-4 * f64::from(f.max(0.01)));
            }
        }
        // It is not isotropic: brushed along y.
        let across = bsdf.eval(Vec3::new(0.5, 0.0, 0.866), Vec3::new(0.0, 0.0, 1.0), LobeSet::ALL, Mode::Radiance)[0];
        let along = bsdf.eval(Vec3::new(0.0, 0.5, 0.866), Vec3::new(0.0, 0.0, 1.0), LobeSet::ALL, Mode::Radiance)[0];
        assert!(along > 1.5 * across, "{name}: {along} {across}");
    }
}

/// Between two wavelengths of a file lies the straight line; and a flat spectrum is grey in RGB renders.
#[test]
fn spectral_files_answer_by_wavelength_and_in_colours() {
    let (wo, wi) = (Vec3::new(0.3, 0.1, 0.9486833), Vec3::new(-0.2, 0.0, 0.9797959));
    let spectral = data("brushed_spectral.bsdf", ColorMode::Spectral);
    for place in 0..20 {
        let lanes = Lanes::spectral((place as f32 + 0.5) / 20.0);
        let got = spectral.value(wo, wi, &lanes);
        // The channels of `brushed` rise evenly, 30 nm each.
        let at = |c: f32| 0.25 + 0.02 * c;
        let shape = (got[0] - 0.08 / PI) / at((lanes.wavelengths()[0] - 380.0) / 30.0);
        for (lane, nm) in lanes.wavelengths().into_iter().enumerate() {
            let expected = 0.08 / PI + shape * at(((nm - 380.0) / 30.0).min(13.0));
            near(got[lane], expected, 2e-2 * f64::from(expected));
        }
    }
    let grid = RglGrid {
        phi_i: vec![0.0],
        theta_i: vec![0.0, 0.4, 0.8, 1.2, FRAC_PI_2],
        facets: 64,
        values: 32,
        wavelengths: Some(vec![400.0, 500.0, 600.0, 700.0]),
    };
    let flat = write_rgl(&grid, |m| facets(0.5, 0.5, m), |_, _, _| 0.5 / PI);
    let found = MeasuredData::read(&flat, ColorMode::Rgb).unwrap().value(wo, wi, &Lanes::RGB);
    for lane in 0..3 {
        near(found[lane], found[1], 1e-4 * f64::from(found[1]));
    }
    near(found[1], 0.5 / PI, 0.02);
}

/// Points follow the density, and undoing the warp gives the numbers back.
#[test]
fn warps_invert_themselves() {
    let mut random = Random::new(2);
    let (w, h) = (9, 6);
    let values: Vec<f32> = (0..3 * w * h).map(|_| random.number() * random.number()).collect();
    let warp = Warp::new(w, h, values);
    for (y, weights) in [(0.0, [1.0, 0.0, 0.0]), (0.3, [0.7, 0.3, 0.0]), (2.5, [0.0, 0.0, 1.0])] {
        let blend = Blend::between(&[0.0], 5.0, &[0.0, 1.0, 2.0], y);
        for (slice, weight) in blend.iter() {
            near(weight, weights[slice], 1e-6);
        }
        let mut total = 0.0;
        for i in 0..200 * 200 {
            let u = ((i % 200) as f32 / 200.0 + 0.0025, (i / 200) as f32 / 200.0 + 0.0025);
            total += f64::from(warp.density(&blend, u)) / 40_000.0;
            let p = warp.sample(&blend, u);
            let (back, density) = warp.invert(&blend, p);
            near(back.0, u.0, 2e-5);
            near(back.1, u.1, 2e-5);
            assert_eq!(density, warp.density(&blend, p));
        }
        near(total, 1.0, 1e-3);
    }
    // One cell whose density is 2 y: v = y^2.
    let ramp = Warp::new(2, 2, vec![0.0, 0.0, 7.0, 7.0]);
    let p = ramp.sample(&Blend::only(0), (0.25, 0.49));
    near(p.0, 0.25, 1e-6);
    near(p.1, 0.7, 1e-6);
    near(ramp.density(&Blend::only(0), (0.3, 0.6)), 1.2, 1e-6);
}

/// A small sound file.
fn small() -> Vec<u8> {
    let grid = RglGrid {
        phi_i: vec![0.0],
        theta_i: vec![0.0, FRAC_PI_2],
        facets: 8,
        values: 3,
        wavelengths: Some(vec![450.0, 650.0]),
    };
    write_rgl(&grid, |m| facets(0.5, 0.5, m), |i, o, c| brushed(0.5, 0.5, i, o, c))
}

/// Cut anywhere it is refused; with any byte changed it is refused or answers; nothing panics.
#[test]
fn damaged_files_are_refused_or_harmless() {
    let whole = small();
    assert!(RglTable::read(&whole, ColorMode::Rgb).is_ok());
    for length in 0..whole.len() {
        let error = RglTable::read(&whole[..length], ColorMode::Rgb).expect_err("a part");
        assert!(error.starts_with("it"), "{error}");
    }
    let table = (0..whole.len()).take(600).flat_map(|at| [0x01, 0x80, 0xFF].map(|flip| (at, flip)));
    let mut random = Random::new(4);
    let data = (0..1000).map(|_| ((random.number() * whole.len() as f32) as usize, 1 << (random.bits() % 8)));
    let (mut refused, mut read) = (0, 0);
    for (at, flip) in table.chain(data) {
        let mut damaged = whole.clone();
        damaged[at.min(whole.len() - 1)] ^= flip;
        for mode in [ColorMode::Rgb, ColorMode::Spectral] {
            match MeasuredData::read(&damaged, mode) {
                Err(why) => {
                    refused += 1;
                    assert!(!why.is_empty() && !why.contains('\n'), "{why}");
                }
                Ok(found) => {
                    read += 1;
                    let lanes = mode.lanes(0.3);
                    for wo in directions_above(3, 0.01) {
                        let _ = found.value(wo, Vec3::new(0.6, 0.0, 0.8), &lanes);
                        let _ = found.density(wo, Vec3::new(0.6, 0.0, 0.8));
                    }
                }
            }
        }
    }
    println!("{refused} refused, {read} read");
    assert!(refused > 1000 && read > 500);
}

#[test]
fn what_is_wrong_is_said() {
    let told = |floats: &[(&str, &[usize], &[f32])], bytes: &[(&str, &[u8])]| {
        RglTable::read(&tensor_file::write(floats, bytes), ColorMode::Rgb).expect_err("a wrong file")
    };
    let one: (&str, &[usize], &[f32]) = ("phi_i", &[1], &[0.0]);
    let two: (&str, &[usize], &[f32]) = ("theta_i", &[2], &[0.0, 1.5]);
    assert_eq!(told(&[], &[]), "it has no field `phi_i`");
    assert_eq!(told(&[one], &[]), "it has no field `theta_i`");
    assert_eq!(told(&[one, ("theta_i", &[2], &[1.0, 1.0])], &[]), "its field `theta_i` does not rise");
    assert_eq!(told(&[one, ("theta_i", &[2], &[0.0, f32::NAN])], &[]), "value 1 of its field `theta_i` is NaN");
    assert_eq!(
        told(&[one, ("theta_i", &[1, 2], &[0.0, 1.0])], &[]),
        "its field `theta_i` is of kind 10 with 2 dimensions"
    );
    let flat = [1.0; 16];
    let vndf: (&str, &[usize], &[f32]) = ("vndf", &[1, 3, 2, 2], &flat[..12]);
    let luminance: (&str, &[usize], &[f32]) = ("luminance", &[1, 2, 2, 2], &flat[..8]);
    let sizes = "its field `vndf` has the sizes [1, 3, 2, 2], which do not go with the others";
    assert_eq!(told(&[one, two, vndf, luminance], &[("jacobian", &[0])]), sizes);
    let mut newer = small();
    newer[12] = 2;
    assert_eq!(RglTable::read(&newer, ColorMode::Rgb).unwrap_err(), "it is of version 2.0; only 1.0 is known");
    let foreign = MeasuredData::read(&file("grey.binary")[1..], ColorMode::Rgb).unwrap_err();
    assert_eq!(foreign, "it is neither a MERL `.binary` nor an RGL `.bsdf`");
}

/// The files of the gallery's wall are their fits, as nearly as so few measurements tell.
#[test]
fn the_files_beside_the_scenes_are_their_fits() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/matter/measured");
    let table = std::fs::read_to_string(format!("{folder}/fits.tsv")).unwrap();
    let lines: Vec<&str> = table.lines().filter(|l| !l.starts_with('#')).skip(1).collect();
    assert_eq!(lines.len(), 8);
    for line in lines {
        let cells: Vec<&str> = line.split('\t').collect();
        let numbers: Vec<f64> = cells[2..].iter().map(|x| x.parse().unwrap()).collect();
        let fit = Sgd::of_numbers(&numbers).unwrap();
        let bytes = std::fs::read(format!("{folder}/{}.bsdf", cells[0])).unwrap();
        let data = MeasuredData::read(&bytes, ColorMode::Rgb).unwrap();
        let mut random = Random::new(12);
        let mut off: Vec<f64> = (0..1000)
            .map(|_| {
                let mut w = || square_to_cosine_hemisphere(random.pair());
                let (wo, wi) = (w(), w());
                let expected = fit.value(wo.as_dvec3(), wi.as_dvec3())[1];
                (f64::from(data.value(wo, wi, &Lanes::RGB)[1]) - expected).abs() / expected.max(0.02)
            })
            .collect();
        off.sort_by(f64::total_cmp);
        println!("{}: median {:.3}, 90 % below {:.3}", cells[0], off[500], off[900]);
        assert!(off[500] < 0.02 && off[900] < 0.15, "{}: {} {}", cells[0], off[500], off[900]);
    }
}
