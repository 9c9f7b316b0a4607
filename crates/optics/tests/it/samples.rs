//! Files of measured reflectance, made in memory.

use kirkas_geometry::DVec3;
use kirkas_optics::measured::fits::{Abc, Sgd};
use kirkas_optics::measured::{MeasuredData, write_merl};
use kirkas_optics::{ColorMode, Palette};
use kirkas_scene::Span;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Those that every test of all models runs over.
pub const LISTED: [&str; 3] = ["grey.binary", "paint.binary", "varnish.binary"];
/// All of them.
const FILES: [&str; 4] = ["grey.binary", "paint.binary", "varnish.binary", "plastic.binary"];

/// A dull paint, darker in one channel.
pub const PAINT: Abc = Abc { k_d: [0.3, 0.2, 0.05], a: [2.0, 1.8, 1.5], b: 60.0, c: 1.2, ior: 1.5 };
/// A semi-gloss varnish.
pub const VARNISH: Abc = Abc { k_d: [0.2, 0.1, 0.02], a: [12.0, 12.0, 12.0], b: 400.0, c: 1.3, ior: 1.6 };
/// A glossy plastic: the ABC fit of "blue-acrylic" in rounder numbers.
pub const PLASTIC: Abc = Abc { k_d: [0.01, 0.03, 0.12], a: [300.0, 280.0, 260.0], b: 20_000.0, c: 1.3, ior: 1.5 };

/// A MERL file, by its name.
pub fn file(name: &str) -> Vec<u8> {
    match name {
        "grey.binary" => write_merl(|_, _| [0.25 / std::f64::consts::PI; 3]),
        "paint.binary" => write_merl(|wo, wi| PAINT.value(wo, wi)),
        "varnish.binary" => write_merl(|wo, wi| VARNISH.value(wo, wi)),
        "plastic.binary" => write_merl(|wo, wi| PLASTIC.value(wo, wi)),
        other => panic!("no sample `{other}`"),
    }
}

/// Any of them, read. Each is made once.
pub fn data(name: &str) -> Arc<MeasuredData> {
    static ALL: [OnceLock<Arc<MeasuredData>>; FILES.len()] = [const { OnceLock::new() }; FILES.len()];
    let i = FILES.iter().position(|f| *f == name).expect("a sample");
    ALL[i].get_or_init(|| Arc::new(MeasuredData::read(&file(name)).expect("a sound file"))).clone()
}

/// A palette that knows them all.
pub fn palette(mode: ColorMode) -> Palette {
    let mut palette = Palette::new(mode);
    for name in FILES {
        palette.add_measured(Span::NONE, name, data(name));
    }
    palette
}

/// Unit vectors for numbers in -1..1 and a longitude.
pub fn direction(z: f64, phi: f64) -> DVec3 {
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// A folder of the data that others measured; says so where it is not there.
pub fn measurements(folder: &str) -> Option<PathBuf> {
    let found = std::env::var_os("KIRKAS_DATA").map(|data| PathBuf::from(data).join("brdf").join(folder));
    let found = found.filter(|folder| folder.is_dir());
    if found.is_none() {
        println!("skipped: KIRKAS_DATA has no brdf/{folder}");
    }
    found
}

/// The published fits to the MERL materials, by name.
pub fn published_fits() -> Option<BTreeMap<String, (Sgd, Abc)>> {
    let folder = measurements("merl-fit-tables")?;
    let rows = |file: &str, words: usize| {
        let text = std::fs::read_to_string(folder.join(file)).expect("a table");
        let lines = text.lines().filter(|l| !l.starts_with('#')).skip(1);
        let row = |line: &str| {
            let mut cells = line.split('\t').map(String::from);
            let name = cells.by_ref().take(words).next().expect("a name");
            (name, line.split('\t').skip(words).map(|x| x.parse().expect("a number")).collect::<Vec<f64>>())
        };
        lines.map(row).collect::<BTreeMap<_, _>>()
    };
    let (sgd, abc) = (rows("sgd.tsv", 2), rows("abc.tsv", 1));
    let three = |v: &[f64], i: usize| [v[3 * i], v[3 * i + 1], v[3 * i + 2]];
    let both = sgd.into_iter().map(|(name, v)| {
        let t = |i| three(&v, i);
        let sgd = Sgd {
            rho_d: t(0),
            rho_s: t(1),
            alpha: t(2),
            p: t(3),
            f0: t(4),
            f1: t(5),
            kappa: t(6),
            lambda: t(7),
            c: t(8),
            k: t(9),
            theta0: t(10),
        };
        let v = &abc[&name];
        let abc = Abc { k_d: three(v, 0), a: three(v, 1), b: v[6], c: v[7], ior: v[8] };
        (name, (sgd, abc))
    });
    Some(both.collect())
}
