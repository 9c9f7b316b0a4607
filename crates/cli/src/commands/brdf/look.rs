//! One number or three for what a material does with a pair of directions: what plots show and comparisons compare.

use super::material::Matter;
use super::numbers::luminance;
use kirkas_geometry::Vec3;
use kirkas_optics::{Bsdf, ColorMode, Lanes, Light, LobeSet, Mode};

/// Which number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Channel {
    /// 0.2126 R + 0.7152 G + 0.0722 B
    #[default]
    Luminance,
    /// Red
    R,
    /// Green
    G,
    /// Blue
    B,
}

impl Channel {
    /// Out of three.
    pub fn of(self, rgb: [f64; 3]) -> f64 {
        match self {
            Channel::Luminance => luminance(&rgb),
            Channel::R => rgb[0],
            Channel::G => rgb[1],
            Channel::B => rgb[2],
        }
    }

    /// What is said of it on an axis: nothing of luminance.
    pub fn words(self) -> &'static str {
        match self {
            Channel::Luminance => "",
            Channel::R => ", red",
            Channel::G => ", green",
            Channel::B => ", blue",
        }
    }
}

/// Wavelengths that stand for all of them.
const PATHS: u32 = 32;

/// A material that is ready to be asked often.
pub struct Look {
    ways: Vec<(Lanes, Bsdf)>,
}

impl Look {
    /// Of this material.
    pub fn new(matter: &Matter) -> Self {
        let lanes: Vec<Lanes> = match matter.lanes().mode() {
            ColorMode::Rgb => vec![Lanes::RGB],
            mode => (0..PATHS).map(|i| mode.lanes((i as f32 + 0.5) / PATHS as f32)).collect(),
        };
        Look { ways: lanes.into_iter().map(|l| (l, matter.at(&l))).collect() }
    }

    /// The value (1/sr, without the cosine) of the lobes asked for, as linear Rec.709.
    pub fn rgb(&self, wi: Vec3, wo: Vec3, lobes: LobeSet) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (lanes, bsdf) in &self.ways {
            let Light(light) = bsdf.eval(wo, wi, lobes, Mode::Radiance);
            // Of white light, what comes back: in wavelengths white is not 1 in every lane.
            let white = lanes.illuminant([1.0; 3]);
            let rgb = lanes.to_film(Light(light) * white);
            sum.iter_mut().zip(rgb).for_each(|(s, c)| *s += f64::from(c));
        }
        sum.map(|s| s / self.ways.len() as f64)
    }

    /// The lobes that have values.
    pub fn lobes(&self) -> LobeSet {
        self.ways[0].1.lobes().without(LobeSet::DELTA)
    }

    /// True when some of its values are below the surface.
    pub fn goes_through(&self) -> bool {
        self.lobes().intersects(LobeSet::TRANSMISSION)
    }
}
