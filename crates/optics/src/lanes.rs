//! What the four lanes of a path are, and how colours enter and leave them.
//!
//! In RGB mode the lanes are red, green, blue of linear Rec.709 and an idle one, which no colour fills. In spectral mode they
//! are four wavelengths (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"): the hero anywhere within 380-780 nm, the
//! others a quarter of the probability further each. Colours enter through [`Spectrum::at`](crate::Spectrum::at) or, from
//! textures, through [`Lanes::reflectance`], [`Lanes::unbounded`] and [`Lanes::illuminant`], and leave through
//! [`Lanes::to_film`]; all between is the same in both modes.
//!
//! **Densities.** Directions and lights are drawn with densities that are the same for every lane of a path, so each lane's
//! balance heuristic over the four (Wilkie et al., equation 9) has equal weights, and these are part of `to_film`. Where a
//! density depends on the wavelength either the hero decides alone ([`Lanes::alone`], dispersive refraction), or whoever draws
//! must divide by the mean of the lanes' densities (distances in a medium whose extinction is coloured).

use crate::Light;
use crate::spectrum::observer::{CELLS, Draw, observer};
use crate::spectrum::sigmoid;
use kirkas_scene::{ParamSpec, ParamType};

/// How a render carries colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMode {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// Wavelengths.
    Spectral,
}

/// The lanes of one path. Each path carries its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes {
    /// Which wavelengths, in the observer's cells.
    place: f32,
    wavelengths: [f32; 4],
    mode: ColorMode,
    draw: Draw,
    hero: u8,
    is_alone: bool,
}

/// Film red, green and blue of light, as weights of its lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmWeights([Light; 3]);

/// Wavelengths that stand for the primaries of Rec.709 where an index depends on the wavelength: their dominant ones, nm.
pub const PRIMARIES: [f32; 3] = [611.4, 549.1, 464.2];

impl ColorMode {
    /// Names as written.
    pub const NAMES: [&'static str; 2] = ["rgb", "spectral"];

    /// By its name.
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "rgb" => Some(ColorMode::Rgb),
            "spectral" => Some(ColorMode::Spectral),
            _ => None,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// The lanes of the path that `u` in `[0, 1)` stands for.
    pub fn lanes(self, u: f32) -> Lanes {
        match self {
            ColorMode::Rgb => Lanes { hero: ((u * 3.0) as u8).min(2), ..Lanes::RGB },
            ColorMode::Spectral => Lanes::spectral(u),
        }
    }
}

impl Lanes {
    /// Red, green, blue and an idle lane; green is the hero.
    pub const RGB: Self = Lanes {
        place: 0.0,
        wavelengths: [PRIMARIES[0], PRIMARIES[1], PRIMARIES[2], PRIMARIES[1]],
        mode: ColorMode::Rgb,
        draw: Draw::Color,
        hero: 1,
        is_alone: false,
    };

    /// Four wavelengths; `u` in `[0, 1)` places the hero.
    pub fn spectral(u: f32) -> Self {
        Self::drawn(Draw::Color, u)
    }

    /// The same where all wavelengths matter, not only what they do to the colour.
    pub fn of_spectrum(u: f32) -> Self {
        Self::drawn(Draw::Spectrum, u)
    }

    fn drawn(draw: Draw, u: f32) -> Self {
        let place = u * CELLS as f32;
        let wavelengths = Self::places(place).map(|p| observer().wavelength(draw, p).0);
        Lanes { place, wavelengths, mode: ColorMode::Spectral, draw, hero: 0, is_alone: false }
    }

    fn places(place: f32) -> [f32; 4] {
        let all = CELLS as f32;
        [0.0, 0.25, 0.5, 0.75].map(|share| {
            let p = place + share * all;
            if p < all { p } else { p - all }
        })
    }

    /// Of each lane, nm; in RGB mode those of [`PRIMARIES`].
    #[inline]
    pub fn wavelengths(&self) -> [f32; 4] {
        self.wavelengths
    }

    /// The nm that each lane stands for: light per nm times these, over all paths, is its integral over the wavelengths. In
    /// RGB mode 0.
    pub fn nanometres(&self) -> [f32; 4] {
        match self.mode {
            ColorMode::Rgb => [0.0; 4],
            ColorMode::Spectral => Self::places(self.place).map(|p| observer().wavelength(self.draw, p).1 * 0.25),
        }
    }

    /// How colour is carried.
    #[inline]
    pub fn mode(&self) -> ColorMode {
        self.mode
    }

    /// The lane that decides where lanes would part.
    #[inline]
    pub fn hero(&self) -> usize {
        usize::from(self.hero)
    }

    /// True when only the hero is left.
    #[inline]
    pub fn is_alone(&self) -> bool {
        self.is_alone
    }

    /// These lanes after all but the hero were given up.
    #[must_use]
    pub fn alone(self) -> Self {
        Lanes { is_alone: true, ..self }
    }

    /// The weight with which the hero goes on when the others are given up: how many lanes it then stands for, and 0 in the
    /// others. Every lane is the hero equally often, so the mean stays.
    pub fn hero_weight(&self) -> Light {
        let count = match (self.is_alone, self.mode) {
            (true, _) => 1.0,
            (false, ColorMode::Rgb) => 3.0,
            (false, ColorMode::Spectral) => 4.0,
        };
        let mut weight = Light::BLACK;
        weight.0[self.hero()] = count;
        weight
    }

    /// A weight of 1 in every lane in use: what a path starts with.
    pub fn one(&self) -> Light {
        self.even(1.0)
    }

    /// The same in every lane in use.
    #[inline]
    pub fn even(&self, x: f32) -> Light {
        match self.mode {
            ColorMode::Rgb => Light([x, x, x, 0.0]),
            ColorMode::Spectral => Light::splat(x),
        }
    }

    /// A colour that reflects or transmits; clamped to 0..1, NaN is 0.
    pub fn reflectance(&self, rgb: [f32; 3]) -> Light {
        let rgb = rgb.map(|x| x.max(0.0).min(1.0));
        match self.mode {
            ColorMode::Rgb => Light([rgb[0], rgb[1], rgb[2], 0.0]),
            ColorMode::Spectral => self.smooth(rgb),
        }
    }

    /// A colour-like quantity without upper bound (absorption, the classics' coefficients); negative and NaN are 0.
    pub fn unbounded(&self, rgb: [f32; 3]) -> Light {
        let rgb = rgb.map(|x| x.max(0.0));
        match self.mode {
            ColorMode::Rgb => Light([rgb[0], rgb[1], rgb[2], 0.0]),
            ColorMode::Spectral => {
                let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
                if scale > 0.0 { self.smooth(rgb.map(|x| x / scale)) * scale } else { Light::BLACK }
            }
        }
    }

    /// The colour of something that shines; negative and NaN are 0.
    pub fn illuminant(&self, rgb: [f32; 3]) -> Light {
        match self.mode {
            ColorMode::Rgb => self.unbounded(rgb),
            ColorMode::Spectral => self.unbounded(rgb) * self.white(),
        }
    }

    /// Daylight D65 of luminance 1, the white of the film.
    #[inline]
    pub(crate) fn white(&self) -> Light {
        let observer = observer();
        Light(self.wavelengths.map(|w| observer.white(w)))
    }

    /// The spectrum of a colour within 0..1, from the table.
    fn smooth(&self, rgb: [f32; 3]) -> Light {
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return Light::splat(rgb[0]);
        }
        let c = sigmoid::from_table(rgb);
        Light(self.wavelengths.map(|w| sigmoid::at_wavelength(&c, w)))
    }

    /// An evaluated parameter, as the models take it, by its table row: colours as [`Lanes::reflectance`] where the
    /// row's range ends at 1, else [`Lanes::unbounded`]; numbers (the mean of `rgb`) clamped into the range, in every lane; vectors as they are.
    pub fn parameter(&self, row: &ParamSpec, rgb: [f32; 3]) -> Light {
        let (low, high) = (row.range.0 as f32, row.range.1 as f32);
        match row.ty {
            ParamType::NumberTexture | ParamType::Number => {
                Light::splat(((rgb[0] + rgb[1] + rgb[2]) / 3.0).max(low).min(high))
            }
            ParamType::VectorTexture => {
                let [x, y, z] = rgb.map(|c| c.max(low).min(high));
                Light([x, y, z, 0.0])
            }
            _ if high <= 1.0 => self.reflectance(rgb),
            _ => self.unbounded(rgb),
        }
    }

    /// What makes film RGB of light in these lanes.
    pub fn film_weights(&self) -> FilmWeights {
        match self.mode {
            ColorMode::Rgb => {
                FilmWeights([Light([1.0, 0.0, 0.0, 0.0]), Light([0.0, 1.0, 0.0, 0.0]), Light([0.0, 0.0, 1.0, 0.0])])
            }
            ColorMode::Spectral => {
                let mut weights = [Light::BLACK; 3];
                for (lane, nanometres) in self.nanometres().into_iter().enumerate() {
                    for (c, bar) in observer().film(self.wavelengths[lane]).into_iter().enumerate() {
                        weights[c].0[lane] = bar * nanometres;
                    }
                }
                FilmWeights(weights)
            }
        }
    }

    /// Light as film RGB (linear Rec.709).
    pub fn to_film(&self, light: Light) -> [f32; 3] {
        self.film_weights().apply(light)
    }
}

impl FilmWeights {
    /// Light as film RGB (linear Rec.709). In spectral mode a single sample may be negative in a channel.
    #[inline]
    pub fn apply(&self, light: Light) -> [f32; 3] {
        let l = light.0;
        self.0.map(|Light(w)| w[0] * l[0] + w[1] * l[1] + w[2] * l[2] + w[3] * l[3])
    }
}
