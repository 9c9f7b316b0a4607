//! Files of measured reflectance, made in memory.

use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::measured::fits::{Abc, Sgd};
use kirkas_optics::measured::{MeasuredData, RglGrid, write_merl, write_rgl};
use kirkas_optics::{ColorMode, Palette};
use kirkas_scene::Span;
use std::collections::BTreeMap;
use std::f32::consts::{FRAC_PI_2, PI};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Those that every test of all models runs over.
pub const LISTED: [&str; 4] = ["grey.binary", "varnish.binary", "grey.bsdf", "brushed.bsdf"];
/// All of them.
const FILES: [&str; 7] =
    [LISTED[0], LISTED[1], LISTED[2], LISTED[3], "paint.binary", "plastic.binary", "brushed_spectral.bsdf"];

/// A dull paint, darker in one channel.
pub const PAINT: Abc = Abc { k_d: [0.3, 0.2, 0.05], a: [2.0, 1.8, 1.5], b: 60.0, c: 1.2, ior: 1.5 };
/// A semi-gloss varnish.
pub const VARNISH: Abc = Abc { k_d: [0.2, 0.1, 0.02], a: [12.0, 12.0, 12.0], b: 400.0, c: 1.3, ior: 1.6 };
/// A glossy plastic: the ABC fit of "blue-acrylic" in rounder numbers.
pub const PLASTIC: Abc = Abc { k_d: [0.01, 0.03, 0.12], a: [300.0, 280.0, 260.0], b: 20_000.0, c: 1.3, ior: 1.5 };

/// A file, by its name.
pub fn file(name: &str) -> Vec<u8> {
    match name {
        "grey.binary" => write_merl(|_, _| [0.25 / f64::from(PI); 3]),
        "paint.binary" => write_merl(|wo, wi| PAINT.value(wo, wi)),
        "varnish.binary" => write_merl(|wo, wi| VARNISH.value(wo, wi)),
        "plastic.binary" => write_merl(|wo, wi| PLASTIC.value(wo, wi)),
        "grey.bsdf" => write_rgl(&rgl_grid(1), |m| facets(0.3, 0.3, m), |i, o, _| brushed(0.3, 0.3, i, o, 0)),
        "brushed.bsdf" => write_rgl(&rgl_grid(9), |m| facets(0.2, 0.5, m), |i, o, c| brushed(0.2, 0.5, i, o, c)),
        "brushed_spectral.bsdf" => {
            let waves =
                RglGrid { wavelengths: Some((0..14).map(|k| 380.0 + 30.0 * k as f32).collect()), ..rgl_grid(5) };
            write_rgl(&waves, |m| facets(0.2, 0.5, m), |i, o, c| brushed(0.2, 0.5, i, o, c))
        }
        other => panic!("no sample `{other}`"),
    }
}

/// Coarse, over a point, a half or a quarter of a turn.
fn rgl_grid(longitudes: usize) -> RglGrid {
    let part = if longitudes == 9 { PI } else { FRAC_PI_2 };
    RglGrid {
        phi_i: (0..longitudes).map(|k| -PI + part * k as f32 / (longitudes - 1).max(1) as f32).collect(),
        theta_i: (0..8).map(|k| FRAC_PI_2 * k as f32 / 7.0).collect(),
        facets: 40,
        values: 16,
        wavelengths: None,
    }
}

/// GGX's density of facets, rougher along y.
pub fn facets(ax: f32, ay: f32, m: Vec3) -> f32 {
    let s = (m.x / ax) * (m.x / ax) + (m.y / ay) * (m.y / ay) + m.z * m.z;
    1.0 / (PI * ax * ay * s * s)
}

/// Brushed metal over a little dust, with Torrance and Sparrow's shadows; each channel is brighter than the one before.
pub fn brushed(ax: f32, ay: f32, i: Vec3, o: Vec3, channel: usize) -> f32 {
    let m = (i + o).normalize();
    let g = (2.0 * m.z * i.z.min(o.z) / i.dot(m)).min(1.0);
    let tint = 0.25 + 0.02 * channel as f32;
    tint * facets(ax, ay, m) * g / (4.0 * i.z * o.z) + 0.08 / PI
}

/// Any of them, read. Each is made once.
pub fn data(name: &str, mode: ColorMode) -> Arc<MeasuredData> {
    static ALL: [[OnceLock<Arc<MeasuredData>>; FILES.len()]; 2] =
        [const { [const { OnceLock::new() }; FILES.len()] }; 2];
    let i = FILES.iter().position(|f| *f == name).expect("a sample");
    // Colour by wavelength makes no difference to files of colours.
    let mode = if name.ends_with("spectral.bsdf") { mode } else { ColorMode::Rgb };
    let read = || Arc::new(MeasuredData::read(&file(name), mode).expect("a sound file"));
    ALL[mode as usize][i].get_or_init(read).clone()
}

/// A palette that knows them all.
pub fn palette(mode: ColorMode) -> Palette {
    let mut palette = Palette::new(mode);
    for name in FILES {
        palette.add_measured(Span::NONE, name, data(name, mode));
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
        let sgd = Sgd::of_numbers(&v).expect("all its numbers");
        let v = &abc[&name];
        let abc = Abc { k_d: three(v, 0), a: three(v, 1), b: v[6], c: v[7], ior: v[8] };
        (name, (sgd, abc))
    });
    Some(both.collect())
}
