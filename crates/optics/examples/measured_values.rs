//! What a file of measured reflectance says, for checks against other programs.
//!
//! `measured_values FILE [NM]` reads pairs of directions (six numbers a line, `wo wi`) from standard input and writes for each the
//! reflectance (red, green and blue; or, with a wavelength in nm, there alone) and the density of sampling, in 1/sr.
//! `measured_values write_anisotropic FILE`, `... write_spectral FILE` make `.bsdf` files to ask about.

use kirkas_geometry::Vec3;
use kirkas_optics::measured::{MeasuredData, RglGrid, write_rgl};
use kirkas_optics::{ColorMode, Lanes};
use std::f32::consts::{FRAC_PI_2, PI};
use std::io::{BufRead, Write};

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["write_anisotropic", file] => write(file, PI, None),
        ["write_spectral", file] => write(file, FRAC_PI_2, Some((0..14).map(|k| 380.0 + 30.0 * k as f32).collect())),
        [file] => values(file, None),
        [file, nm] => values(file, Some(nm.parse().map_err(|_| format!("{nm} is no wavelength"))?)),
        _ => Err("measured_values FILE [NM] | write_anisotropic FILE | write_spectral FILE".into()),
    }
}

fn values(file: &str, wavelength: Option<f32>) -> Result<(), String> {
    let mode = if wavelength.is_some() { ColorMode::Spectral } else { ColorMode::Rgb };
    let bytes = std::fs::read(file).map_err(|e| format!("{file}: {e}"))?;
    let data = MeasuredData::read(&bytes, mode).map_err(|e| format!("{file}: {e}"))?;
    // The lane whose wavelength comes closest.
    let miss = |lanes: &Lanes, nm: f32| lanes.wavelengths().map(|w| (w - nm).abs());
    let lanes = wavelength.map_or(Lanes::RGB, |nm| {
        let all = (0..100_000).map(|i| Lanes::of_spectrum(i as f32 / 100_000.0));
        all.min_by(|a, b| miss(a, nm)[0].total_cmp(&miss(b, nm)[0])).unwrap_or(Lanes::RGB)
    });
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        let line = line.map_err(|e| e.to_string())?;
        let n: Vec<f32> = line.split_whitespace().filter_map(|x| x.parse().ok()).collect();
        let [ox, oy, oz, ix, iy, iz] = n[..] else { return Err(format!("{line:?} are not six numbers")) };
        let (wo, wi) = (Vec3::new(ox, oy, oz), Vec3::new(ix, iy, iz));
        let (f, pdf) = (data.value(wo, wi, &lanes), data.density(wo, wi));
        let shown = if wavelength.is_some() { format!("{}", f[0]) } else { format!("{} {} {}", f[0], f[1], f[2]) };
        writeln!(out, "{shown} {pdf}").map_err(|e| e.to_string())?;
    }
    Ok(())
}

/// Brushed metal with a coloured base, looked at over a part of a turn (radians) and the same in the others.
fn write(file: &str, part: f32, wavelengths: Option<Vec<f32>>) -> Result<(), String> {
    let (ax, ay) = (0.15_f32, 0.4_f32);
    let facets = |m: Vec3| {
        let s = (m.x / ax) * (m.x / ax) + (m.y / ay) * (m.y / ay) + m.z * m.z;
        1.0 / (PI * ax * ay * s * s)
    };
    let grid = RglGrid {
        phi_i: (0..9).map(|k| -PI + part * k as f32 / 8.0).collect(),
        theta_i: (0..8).map(|k| FRAC_PI_2 * k as f32 / 7.0).collect(),
        facets: 64,
        values: 24,
        wavelengths,
    };
    let reflectance = |i: Vec3, o: Vec3, c: usize| {
        let m = (i + o).normalize();
        let tint = 0.3 + 0.6 * (c as f32 / 3.0).fract();
        tint * facets(m) * (i.z * o.z).sqrt() / (4.0 * (i.z * o.z).max(1e-3)) + 0.1 / PI
    };
    std::fs::write(file, write_rgl(&grid, facets, reflectance)).map_err(|e| format!("{file}: {e}"))
}
