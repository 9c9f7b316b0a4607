//! Values of a material as plain numbers: by channel, or by wavelength.

use super::angles::direction;
use super::material::Matter;
use kirkas_optics::{ColorMode, Lanes, LobeSet, Mode};

/// Where light arrives from and leaves to, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Arrives: from the normal.
    pub theta_i: f64,
    /// Arrives: around it.
    pub phi_i: f64,
    /// Leaves: from the normal.
    pub theta_o: f64,
    /// Leaves: around it.
    pub phi_o: f64,
}

/// The numbers that light is told in: red, green and blue, or one for each wavelength.
pub struct Channels {
    /// What a column is called: `r`, `550nm`.
    pub names: Vec<String>,
    lanes: Vec<Lanes>,
}

/// What is known of one pair.
pub struct Value {
    /// Without the cosine, 1/sr; delta lobes left out.
    pub f: Vec<f64>,
    /// The density per solid angle with which the arriving direction is drawn for the leaving one.
    pub pdf: f64,
}

impl Channels {
    /// In this mode; `wavelengths` (nm) count in spectral mode only.
    pub fn new(mode: ColorMode, wavelengths: &[f64]) -> Self {
        match mode {
            ColorMode::Rgb => Channels { names: ["r", "g", "b"].map(String::from).to_vec(), lanes: vec![Lanes::RGB] },
            ColorMode::Spectral => Channels {
                names: wavelengths.iter().map(|w| format!("{w}nm")).collect(),
                lanes: wavelengths.iter().map(|&w| lanes_at(w)).collect(),
            },
        }
    }

    /// All channels, and the density.
    pub fn value(&self, matter: &Matter, pair: Pair) -> Value {
        let (wi, wo) = (direction(pair.theta_i, pair.phi_i), direction(pair.theta_o, pair.phi_o));
        let (mut f, mut pdf) = (Vec::new(), 0.0);
        for (i, lanes) in self.lanes.iter().enumerate() {
            let bsdf = matter.at(lanes);
            f.extend(self.of_lanes(bsdf.eval(wo, wi, LobeSet::ALL, Mode::Radiance).0));
            if i == 0 {
                pdf = f64::from(bsdf.pdf(wo, wi, LobeSet::ALL, Mode::Radiance));
            }
        }
        Value { f, pdf }
    }

    /// The lanes of every channel in turn, and how to read numbers out of them.
    pub fn lanes(&self) -> &[Lanes] {
        &self.lanes
    }

    /// The channels in four lanes.
    pub fn of_lanes(&self, light: [f32; 4]) -> Vec<f64> {
        let count = self.names.len() / self.lanes.len();
        light[..count].iter().map(|&x| f64::from(x)).collect()
    }
}

/// Lanes whose first is at this wavelength, to a thousandth of a nm.
fn lanes_at(wavelength: f64) -> Lanes {
    let (mut low, mut high) = (0.0_f64, 1.0 - 1e-7);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let is_below = f64::from(Lanes::of_spectrum(middle as f32).wavelengths()[0]) < wavelength;
        (low, high) = if is_below { (middle, high) } else { (low, middle) };
    }
    Lanes::of_spectrum(high as f32).alone()
}

/// Luminance of linear Rec.709.
pub fn luminance(rgb: &[f64]) -> f64 {
    match rgb {
        [r, g, b] => 0.2126 * r + 0.7152 * g + 0.0722 * b,
        other => other.iter().sum::<f64>() / other.len().max(1) as f64,
    }
}

/// A number for people: six digits, no noise.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        return "0".into();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{x:.5e}");
    }
    let digits = (5.0 - size.log10().floor()).max(0.0) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people_have_six_digits() {
        let texts = [0.0, 0.31830987, 12.5, 123456.7, 2.5e-7, 3e9, -0.125].map(short);
        assert_eq!(texts, ["0", "0.31831", "12.5", "123457", "2.50000e-7", "3.00000e9", "-0.125"]);
    }

    #[test]
    fn lanes_are_found_by_their_wavelength() {
        for nm in [380.5, 450.0, 555.0, 633.0, 779.0] {
            let found = f64::from(lanes_at(nm).wavelengths()[0]);
            assert!((found - nm).abs() < 2e-3, "{nm} {found}");
        }
    }
}
