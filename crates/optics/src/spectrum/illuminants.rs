//! Light sources by name: CIE illuminants and black bodies, as relative powers by wavelength.

use super::curve::Curve;
use super::tables;
use kirkas_geometry::elementary::exp;

/// Names of illuminants.
pub const NAMES: [&str; 16] =
    ["A", "D50", "D65", "E", "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12"];

/// An illuminant of CIE 015:2018 by its name; `E` has equal power everywhere.
pub fn illuminant(name: &str) -> Option<Curve> {
    let samples = match name {
        // The definition itself: Planck's law with an old value of c2.
        "A" => return Some(Curve::of(|w| planck(w, 2848.0, 1.435e7) / planck(560.0, 2848.0, 1.435e7))),
        "E" => return Some(Curve::of(|_| 1.0)),
        "D50" => &tables::D50,
        "D65" => &tables::D65,
        "F1" => &tables::F1,
        "F2" => &tables::F2,
        "F3" => &tables::F3,
        "F4" => &tables::F4,
        "F5" => &tables::F5,
        "F6" => &tables::F6,
        "F7" => &tables::F7,
        "F8" => &tables::F8,
        "F9" => &tables::F9,
        "F10" => &tables::F10,
        "F11" => &tables::F11,
        "F12" => &tables::F12,
        _ => return None,
    };
    Some(Curve::new(samples.map(|x| x as f32)))
}

/// A black body of this temperature in K; power at 560 nm is 1.
pub fn blackbody(kelvin: f64) -> Curve {
    /// Second radiation constant, nm K (CODATA 2018).
    const C2: f64 = 1.438_776_877e7;
    let middle = planck(560.0, kelvin, C2);
    Curve::of(|w| planck(w, kelvin, C2) / middle)
}

/// Planck's law without its constant factor.
fn planck(nanometres: f64, kelvin: f64, c2: f64) -> f64 {
    let x = 560.0 / nanometres;
    x * x * x * x * x / (exp(c2 / (nanometres * kelvin)) - 1.0)
}
