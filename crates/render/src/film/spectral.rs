//! Spectral bins: the light of a pixel by wavelength, beside its colour.
//!
//! A path carries four wavelengths, and each stands for a stretch of so many nm; what it brings goes to the bin that it lies in,
//! over the bin's width. So a bin's mean over the samples is the mean spectral radiance over the bin, per nm, and the bins
//! together hold the same light as the red, green and blue of the same samples. Layers are named as in A. Fichet, R. Pacanowski
//! & A. Wilkie, "An OpenEXR Layout for Spectral Images", JCGT 10(3), 2021.

use super::{Film, fixed};
use kirkas_images::{Attribute, ChannelData, Image};
use kirkas_optics::{Lanes, Light};
use std::fmt;

/// Bins of equal width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralBins {
    /// How many.
    pub count: u32,
    /// Where the first begins, nm.
    pub low: f64,
    /// Where the last ends, nm.
    pub high: f64,
}

impl SpectralBins {
    /// The most bins of a film.
    pub const MOST: u32 = 400;
    /// The wavelengths that there are, nm.
    pub const RANGE: [f64; 2] = [380.0, 780.0];

    /// Bins that exist: 1 to [`Self::MOST`] of them, within [`Self::RANGE`].
    pub fn new(count: u32, [low, high]: [f64; 2]) -> Option<Self> {
        let is_good =
            (1..=Self::MOST).contains(&count) && Self::RANGE[0] <= low && low < high && high <= Self::RANGE[1];
        is_good.then_some(SpectralBins { count, low, high })
    }

    /// `N` or `N:LO..HI`.
    pub fn parse(text: &str) -> Option<Self> {
        let (count, range) = match text.split_once(':') {
            None => (text, Self::RANGE),
            Some((count, range)) => {
                let (low, high) = range.split_once("..")?;
                (count, [low.trim().parse().ok()?, high.trim().parse().ok()?])
            }
        };
        Self::new(count.trim().parse().ok()?, range)
    }

    /// Of one bin, nm.
    pub fn width(&self) -> f64 {
        (self.high - self.low) / f64::from(self.count)
    }

    /// The wavelength in the middle of a bin, nm.
    pub fn center(&self, bin: u32) -> f64 {
        self.low + (f64::from(bin) + 0.5) * self.width()
    }

    /// The bin of a wavelength in nm; the last includes its end.
    pub fn bin(&self, nanometres: f64) -> Option<u32> {
        let is_within = self.low <= nanometres && nanometres <= self.high;
        is_within.then(|| (((nanometres - self.low) / self.width()) as u32).min(self.count - 1))
    }

    /// A bin's layer: total radiance (the first Stokes component) at the wavelength of its middle, with a decimal comma, to at
    /// least a thousandth of a bin.
    pub fn layer(&self, bin: u32) -> String {
        let (mut decimals, mut step) = (2, 0.01);
        while step > 0.002 * self.width() && decimals < 9 {
            (decimals, step) = (decimals + 1, step * 0.1);
        }
        let wavelength = format!("{:.decimals$}", self.center(bin)).replace('.', ",");
        format!("S0.{wavelength}nm")
    }
}

/// As [`SpectralBins::parse`] reads it.
impl fmt::Display for SpectralBins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}..{}", self.count, self.low, self.high)
    }
}

/// What one sample brings: its lanes keep their wavelengths from the camera to the last light.
#[derive(Clone, Copy, Debug)]
pub struct LaneSums {
    bins: [Option<u32>; 4],
    /// The nm that a lane stands for, over the width of its bin.
    weights: [f64; 4],
    sums: [i128; 4],
}

impl LaneSums {
    /// Nothing yet, of a path with these lanes.
    pub fn new(bins: &SpectralBins, lanes: &Lanes) -> Self {
        LaneSums {
            bins: lanes.wavelengths().map(|w| bins.bin(f64::from(w))),
            weights: lanes.nanometres().map(|nm| f64::from(nm) / bins.width()),
            sums: [0; 4],
        }
    }

    /// Round light once and add it. False, and nothing is added, where it is not finite or absurdly large.
    pub fn add(&mut self, light: Light, factor: f64) -> bool {
        let mut parts = [0; 4];
        for lane in 0..4 {
            match fixed::from_f64(f64::from(light.0[lane]) * self.weights[lane] * factor) {
                Some(part) => parts[lane] = part,
                None => return false,
            }
        }
        for lane in 0..4 {
            self.sums[lane] += parts[lane];
        }
        true
    }

    /// Onto a pixel's bins.
    pub(super) fn add_to(&self, pixel: &mut [i128]) {
        for (bin, sum) in self.bins.iter().zip(self.sums) {
            if let Some(bin) = bin {
                pixel[*bin as usize] += sum;
            }
        }
    }
}

impl Film {
    /// A bin's mean radiance in every pixel of the crop, per nm.
    pub fn spectral_bin(&self, bin: u32) -> Vec<f32> {
        self.plane(|t, i| t.bin_mean(i, bin as usize))
    }

    /// The layers of the bins, 32 bits wide, and what says what they are.
    pub(super) fn write_bins(&self, image: &mut Image) {
        let Some(bins) = self.layout.bins else { return };
        for bin in 0..bins.count {
            image.push(bins.layer(bin), ChannelData::F32(self.spectral_bin(bin)));
        }
        for (name, text) in [("spectralLayoutVersion", "1.0"), ("emissiveUnits", "W.m^-2.sr^-1")] {
            image.attributes.insert(name.into(), Attribute::Text(text.into()));
        }
    }
}

/// True of the names that [`SpectralBins::layer`] gives.
pub fn is_bin_layer(name: &str) -> bool {
    name.strip_prefix("S0.").is_some_and(|n| n.ends_with("nm"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_named_by_their_wavelength_with_a_decimal_comma() {
        let names = |text: &str| -> Vec<String> {
            let bins = SpectralBins::parse(text).unwrap();
            (0..bins.count).map(|b| bins.layer(b)).collect()
        };
        let forty = names("40");
        assert_eq!((forty[0].as_str(), forty[39].as_str()), ("S0.385,00nm", "S0.775,00nm"));
        assert!(forty.iter().all(|name| is_bin_layer(name)) && !is_bin_layer("S0.R"));
        assert_eq!(names("1:589.2..589.4"), ["S0.589,3000nm"]);
        assert_eq!(names("3:400..500"), ["S0.416,67nm", "S0.450,00nm", "S0.483,33nm"]);
        // Sorted by name is sorted by wavelength, and no two are the same.
        for text in ["400", "400:588..590", "7"] {
            assert!(names(text).windows(2).all(|n| n[0] < n[1]), "{text}");
        }
    }

    #[test]
    fn bins_are_read_as_they_are_written_and_nonsense_is_refused() {
        for text in ["40:380..780", "3:400.5..500", "400:589..590"] {
            assert_eq!(SpectralBins::parse(text).unwrap().to_string(), text);
        }
        for bad in
            ["", "0", "401", "-1", "1.5", "x", "4:", "4:500", "4:500..400", "4:500..500", "4:300..500", "4:nan..500"]
        {
            assert_eq!(SpectralBins::parse(bad), None, "{bad}");
        }
    }

    #[test]
    fn every_wavelength_of_the_range_is_in_one_bin() {
        let bins = SpectralBins::parse("3:400..700").unwrap();
        for (nm, bin) in
            [(399.9, None), (400.0, Some(0)), (499.9, Some(0)), (500.0, Some(1)), (700.0, Some(2)), (700.1, None)]
        {
            assert_eq!(bins.bin(nm), bin, "{nm}");
        }
    }
}
