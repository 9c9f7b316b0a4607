//! Refractive indices against published numbers, and files that must be refused.

use crate::near;
use kirkas_optics::index::formula::Formula;
use kirkas_optics::index::{Index, MetalCurves, file, known};
use kirkas_optics::{ColorMode, Interface, Lanes, fresnel};

fn index(name: &str, nanometres: f64) -> f64 {
    known::constants(name).unwrap().n.at(nanometres)
}

#[test]
fn glasses_have_their_published_indices() {
    // Computed with 50 digits from SCHOTT's Sellmeier coefficients at the F, d and C lines.
    for (glass, f, d, c) in
        [("N-BK7", 1.52237628973, 1.5168000345, 1.51432234726), ("N-SF11", 1.80651274401, 1.78471994231, 1.77595511128)]
    {
        near(index(glass, 486.1327), f, 1e-9);
        near(index(glass, 587.5618), d, 1e-9);
        near(index(glass, 656.2725), c, 1e-9);
        // Lines between samples every 5 nm lose little.
        let curve = Index::Curve(known::constants(glass).unwrap().n.curve());
        near(curve.at_d_line(), d, 2e-5);
    }
    near(index("F2", 587.5618), 1.62004, 1e-5);
    near(index("SF10", 587.5618), 1.72825, 1e-5);
    near(index("N-BAK4", 587.5618), 1.56883, 1e-5);
    near(index("water", 589.3), 1.33334906, 1e-6);
    near(index("diamond", 589.3), 2.4173, 5e-4);
    near(index("fused_silica", 587.6), 1.45846, 2e-5);
    near(index("sapphire", 589.3), 1.7681, 5e-4);
    near(index("salt", 589.3), 1.5443, 5e-4);
    near(index("fluorite", 589.3), 1.43384, 5e-4);
    near(index("ice", 589.3), 1.3098, 1e-3);
}

#[test]
fn every_known_material_has_its_constants_by_both_names() {
    for (name, other) in known::NAMES {
        assert!(known::constants(name).is_some() && known::constants(name) == known::constants(other), "{name}");
    }
    assert!(known::constants("unobtainium").is_none());
}

#[test]
fn every_formula_is_what_it_says() {
    let f = |number, c: &[f64]| Formula::new(number, c.to_vec()).unwrap().at(0.5);
    near(f(1, &[0.1, 1.0, 0.1]), (1.0 + 0.1 + 0.25 / (0.25 - 0.01_f64)).sqrt(), 1e-12);
    near(f(2, &[0.1, 1.0, 0.1]), (1.0 + 0.1 + 0.25 / (0.25 - 0.1_f64)).sqrt(), 1e-12);
    near(f(3, &[2.0, 0.1, -2.0, 0.2, 2.0]), (2.0 + 0.4 + 0.05_f64).sqrt(), 1e-12);
    let four = [2.0, 0.1, 2.0, 0.3, 2.0, 0.2, 0.0, 0.1, 1.0, 0.3, 2.0];
    near(f(4, &four), (2.0 + 0.025 / (0.25 - 0.09) + 0.2 / (0.25 - 0.1) + 0.075_f64).sqrt(), 1e-12);
    near(f(5, &[1.5, 0.01, -2.0]), 1.54, 1e-12);
    near(f(6, &[1e-4, 0.05, 200.0]), 1.0 + 1e-4 + 0.05 / (200.0 - 4.0), 1e-12);
    let p: f64 = 1.0 / (0.25 - 0.028);
    near(f(7, &[1.5, 0.01, 0.001, 0.1]), 1.5 + 0.01 * p + 0.001 * p * p + 0.025, 1e-12);
    let x: f64 = 0.2 + 0.1 * 0.25 / (0.25 - 0.02) + 0.01 * 0.25;
    near(f(8, &[0.2, 0.1, 0.02, 0.01]), ((1.0 + 2.0 * x) / (1.0 - x)).sqrt(), 1e-12);
    near(f(9, &[2.0, 0.01, 0.03, 0.1, 0.4, 0.5]), (2.0 + 0.01 / 0.22 + 0.1 * 0.1 / (0.01 + 0.5_f64)).sqrt(), 1e-12);
    near(Formula::cauchy(&[1.5, 0.01, 0.001]).at(0.5), 1.5 + 0.04 + 0.016, 1e-12);
    for (number, c) in [(0, &[1.0][..]), (10, &[1.0]), (1, &[1.0, 2.0]), (4, &[1.0; 7]), (8, &[1.0; 3]), (9, &[1.0; 5])]
    {
        assert!(Formula::new(number, c.to_vec()).is_err(), "{number}");
    }
}

const GLASS: &str = "REFERENCES: |\n    A. Smith: data: 1\nDATA:\n  - type: formula 5\n    wavelength_range: 0.3 1.0\n    \
                     coefficients: 1.5 0.01 -2\n  - type: tabulated k\n    data: |\n        0.4 1e-7\n        0.7 2e-7\n";
const METAL: &str = "# CC0\nDATA:\n  - type: tabulated nk\n    data: |\n        0.3 1.0 2.0\n        0.5 0.5 2.5\n        \
                     0.9 0.2 5.0\nCONDITIONS:\n    temperature: 293\n";

#[test]
fn files_of_refractiveindex_info_are_read() {
    let glass = file::read(GLASS).unwrap();
    near(glass.n.at(500.0), 1.54, 1e-12);
    near(glass.k.unwrap().at(550.0), 1.5e-7, 1e-12);
    let metal = file::read(METAL).unwrap();
    near(metal.n.at(400.0), 0.75, 1e-12);
    near(metal.k.unwrap().at(700.0), 3.75, 1e-12);
    // Some measured tables are out of order.
    let turned = METAL.replace("0.3 1.0 2.0", "0.9 0.2 5.0").replacen("0.9 0.2 5.0\nCOND", "0.3 1.0 2.0\nCOND", 1);
    assert_eq!(file::read(&turned), file::read(METAL));
}

#[test]
fn bad_files_are_refused_with_the_reason() {
    for (text, problem) in [
        (String::new(), "no `DATA:`"),
        ("DATA:\n  - type: tabulated k\n    data: |\n        0.5 1\n        0.6 1\n".into(), "no refractive index"),
        (GLASS.replace("formula 5", "formula 12"), "no formula 12"),
        (GLASS.replace("formula 5", "spline"), "not known"),
        (GLASS.replace("1.5 0.01 -2", "1.5 0.01"), "pairs"),
        (GLASS.replace("1.5 0.01 -2", "1.5 x"), "line 6"),
        (GLASS.replace("1.5 0.01 -2", "-1.5"), "no refractive index"),
        (GLASS.replace("0.3 1.0", "2 3"), "outside the visible"),
        (GLASS.replace("0.3 1.0", "1.0 0.3"), "two rising"),
        (METAL.replace("0.5 0.5 2.5", "0.5 0.5"), "lacks a number"),
        (METAL.replace("0.5 0.5 2.5", "0.5 a 2.5"), "line 6"),
    ] {
        let error = file::read(&text).unwrap_err();
        assert!(error.contains(problem), "{problem:?}: {error}\n{text}");
    }
}

#[test]
fn every_real_file_is_read_or_refused_in_words() {
    let Ok(data) = std::env::var("KIRKAS_DATA") else {
        println!("skipped: KIRKAS_DATA is not set");
        return;
    };
    let mut folders = vec![std::path::PathBuf::from(data).join("refractiveindex")];
    let (mut read, mut refused) = (0, Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten().map(|e| e.path()) {
            if entry.is_dir() {
                folders.push(entry);
            } else if entry.extension().is_some_and(|e| e == "yml") && !entry.ends_with("about.yml") {
                match file::read(&std::fs::read_to_string(&entry).unwrap()) {
                    Ok(_) => read += 1,
                    Err(e) => refused.push(format!("{}: {e}", entry.display())),
                }
            }
        }
    }
    let expected = ["outside the visible", "no refractive index"];
    let odd: Vec<_> = refused.iter().filter(|r| !expected.iter().any(|e| r.contains(e))).collect();
    println!("{read} read, {} refused", refused.len());
    assert!(read > 100 && odd.is_empty(), "{odd:#?}");
}

#[test]
fn metals_reflect_as_fresnel_says() {
    // Gold at 600 nm, n = 0.18, k = 3.43, at normal incidence.
    let (n, k) = (0.18_f64, 3.43_f64);
    near(fresnel::conductor(1.0, 0.18, 3.43), ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k), 1e-6);
    for cos in [0.05, 0.3, 0.7, 1.0] {
        near(fresnel::conductor(cos, 1.5, 0.0), fresnel::dielectric(cos, 1.0, 1.5), 1e-6);
    }
    near(fresnel::conductor(0.0, 0.2, 3.0), 1.0, 1e-6);
}

#[test]
fn named_metals_have_their_colour_in_both_modes() {
    // Warm gold and copper, white silver and aluminium: reflectance at normal incidence, as film colours.
    for (name, warm) in [("gold", true), ("copper", true), ("silver", false), ("aluminium", false)] {
        let metal = MetalCurves::new(&known::constants(name).unwrap()).unwrap();
        let (n, k) = metal.at(&Lanes::RGB);
        let rgb: [f64; 3] = core::array::from_fn(|c| f64::from(fresnel::conductor(1.0, n[c], k[c])));
        assert_eq!(rgb[0] - rgb[2] > 0.3, warm, "{name}: {rgb:?}");
        let mut sum = [0.0; 3];
        for i in 0..1024 {
            let lanes = Lanes::spectral((i as f32 + 0.5) / 1024.0);
            let (n, k) = metal.at(&lanes);
            let white = lanes.illuminant([1.0; 3]);
            let light = kirkas_optics::Light(core::array::from_fn(|l| fresnel::conductor(1.0, n[l], k[l]) * white[l]));
            let film = lanes.to_film(light);
            (0..3).for_each(|c| sum[c] += f64::from(film[c]) / 1024.0);
        }
        (0..3).for_each(|c| near(rgb[c], sum[c].min(0.999), 4e-3));
    }
}

#[test]
fn only_indices_that_differ_by_lane_part_them() {
    let glass = Index::Curve(known::constants("N-SF11").unwrap().n.curve());
    let lanes = ColorMode::Spectral.lanes(0.4);
    assert!(Interface::between(&lanes, &Index::Even(1.0), &glass).disperses());
    assert!(!Interface::between(&lanes, &glass, &glass).disperses());
    assert!(!Interface::between(&lanes, &Index::Even(1.0), &Index::Even(1.5)).disperses());
    assert!(!Interface::between(&lanes.alone(), &Index::Even(1.0), &glass).disperses());
}
