//! Files of measured reflectance from published fits: `fitted_material TABLE NAME FILE` reads the line NAME of a table of the shifted
//! gamma distribution (Bagher et al. 2012) and writes a MERL `.binary` or an RGL `.bsdf`, by FILE's ending.
//!
//! `scenes/matter/measured` holds such a table and files made of it.

use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::measured::fits::Sgd;
use kirkas_optics::measured::{RglGrid, write_merl, write_rgl};
use std::f32::consts::FRAC_PI_2;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [table, name, file] = &words[..] else { return Err("fitted_material TABLE NAME FILE".into()) };
    let text = std::fs::read_to_string(table).map_err(|e| format!("{table}: {e}"))?;
    let line = text.lines().find(|l| l.split('\t').next() == Some(name));
    let line = line.ok_or_else(|| format!("{table} has no line `{name}`"))?;
    let numbers: Result<Vec<f64>, _> = line.split('\t').skip(2).map(str::parse).collect();
    let fit =
        numbers.ok().and_then(|n| Sgd::of_numbers(&n)).ok_or_else(|| format!("line `{name}` of {table} is no fit"))?;
    let bytes = if file.ends_with(".bsdf") { bsdf(&fit) } else { write_merl(|wo, wi| fit.value(wo, wi)) };
    std::fs::write(file, bytes).map_err(|e| format!("{file}: {e}"))
}

/// Coarse: 110 kB.
fn bsdf(fit: &Sgd) -> Vec<u8> {
    let grid = RglGrid {
        phi_i: vec![0.0],
        theta_i: (0..8).map(|k| FRAC_PI_2 * k as f32 / 7.0).collect(),
        facets: 40,
        values: 20,
        wavelengths: None,
    };
    let wide = |v: Vec3| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z)).normalize();
    // Facets by what they send straight back (Dupuy & Jakob 2018, section 4.1), without their shadows.
    let facets = |m: Vec3| {
        let m = wide(Vec3::new(m.x, m.y, m.z.max(0.02)));
        (fit.value(m, m).iter().sum::<f64>() * m.z * m.z) as f32
    };
    write_rgl(&grid, facets, |i, o, c| fit.value(wide(i), wide(o))[c] as f32)
}
