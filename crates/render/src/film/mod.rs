//! The film: integer sums per pixel, light group and AOV. It adds; it never divides until an image is asked for.

pub mod adaptive;
pub mod aov;
pub mod filter;
pub mod fixed;
pub mod image;
pub mod part;
pub mod relight;
pub mod spectral;

use crate::observe::SampleId;
pub use aov::{AovSample, AovSet};
use kirkas_optics::ColorMode;
use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, TypeSpec, spec::ANY, spec::NOT_NEGATIVE};
use spectral::LaneSums;
pub use spectral::SpectralBins;

/// The table of `[film]`.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Film,
    name: "image",
    doc: "Size, filter and display of the image.",
    params: &[
        ParamSpec::integer("width", 640, (1.0, 65_536.0), "Width of the whole image.").unit("pixels"),
        ParamSpec::integer("height", 480, (1.0, 65_536.0), "Height of the whole image.").unit("pixels"),
        ParamSpec::choice(
            "filter",
            &["gaussian", "box", "tent", "mitchell", "blackman_harris", "point"],
            "Reconstruction filter; `point` puts every sample at the pixel's centre (no antialiasing).",
        ),
        ParamSpec::new("filter_radius", ParamType::Number, Fallback::Absent, "Half width; absent = the filter's own.")
            .unit("pixels")
            .range((0.0, 32.0)),
        ParamSpec::new(
            "shift",
            ParamType::Vector2,
            Fallback::Vector2([0.0, 0.0]),
            "Moves every sample on the film, x right, y down; the course's programs sampled the lower left corner: [-0.5, 0.5].",
        )
        .unit("pixels")
        .range((-16.0, 16.0)),
        ParamSpec::number("exposure", 0.0, "Brightness of PNG output; EXR is not touched.").unit("stops").range(ANY),
        ParamSpec::choice(
            "tone",
            &["linear", "filmic", "aces", "raw"],
            "Tone curve of PNG output; `raw` writes the number times 255, without the sRGB curve.",
        ),
        ParamSpec::new("camera", ParamType::Reference(Kind::Camera), Fallback::Absent, "Camera to use; absent = the first."),
        ParamSpec::number("frames_per_second", 24.0, "`render --frames` opens the shutter for frame n at n over this, in seconds.")
            .unit("1/s")
            .range((0.001, 100_000.0)),
        ParamSpec::choice(
            "color",
            &ColorMode::NAMES,
            "Light as red, green and blue, or as wavelengths: dispersion, true colours of lamps and metals.",
        ),
        ParamSpec::integer(
            "spectral_bins",
            0,
            (0.0, SpectralBins::MOST as f64),
            "Also keep the mean radiance per nm in so many bins of wavelength, as EXR layers; for `color = \"spectral\"`.",
        ),
        ParamSpec::new(
            "spectral_range",
            ParamType::Vector2,
            Fallback::Vector2(SpectralBins::RANGE),
            "Wavelengths that the bins share out.",
        )
        .unit("nm")
        .range((SpectralBins::RANGE[0], SpectralBins::RANGE[1])),
        ParamSpec::bool("light_groups", false, "Also keep one layer per light group; `kirkas relight` mixes them anew."),
        ParamSpec::number("texture_footprint", 0.7, "Half width of the tent that textures are filtered under, as seen by the camera; 0 = not filtered.")
            .unit("pixels")
            .range((0.0, 1000.0)),
        ParamSpec::number("clamp", 0.0, "Firefly clamp: the most that one contribution to a sample may bring; 0 = no clamp. It darkens.")
            .unit("radiance")
            .range(NOT_NEGATIVE),
    ],
};

/// Pixels `x0 <= x < x1`, `y0 <= y < y1` of the whole image, from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Left.
    pub x0: u32,
    /// Top.
    pub y0: u32,
    /// One past the right.
    pub x1: u32,
    /// One past the bottom.
    pub y1: u32,
}

impl Rect {
    /// Columns.
    pub fn width(&self) -> u32 {
        self.x1 - self.x0
    }
    /// Rows.
    pub fn height(&self) -> u32 {
        self.y1 - self.y0
    }
    /// Pixels.
    pub fn area(&self) -> usize {
        self.width() as usize * self.height() as usize
    }
}

/// What a film holds.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmLayout {
    /// The whole image.
    pub size: (u32, u32),
    /// The part that is rendered.
    pub crop: Rect,
    /// Names of light groups with a plane each; empty = one plane for all light.
    pub groups: Vec<String>,
    /// Extra quantities of the first hit.
    pub aovs: AovSet,
    /// Light by wavelength as well.
    pub bins: Option<SpectralBins>,
}

/// Edge of a tile in pixels.
pub const TILE: u32 = 32;

/// One pixel's sums.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Samples taken.
    pub taken: u32,
    /// Samples left out because a contribution was not finite or absurdly large.
    pub invalid: u32,
    /// Adaptive sampling: it gets no more.
    pub is_stopped: bool,
}

/// A rectangle of film; the unit of parallel work.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Where.
    pub rect: Rect,
    /// Per pixel and plane: sums of red, green, blue, unit 2^-64.
    pub sums: Vec<[i128; 3]>,
    /// Per pixel: sums of squares of the sample's red, green, blue, unit 2^-64, at most `i128::MAX`.
    pub squares: Vec<[i128; 3]>,
    /// Per pixel and spectral bin: sums of radiance per nm, unit 2^-64. Of all light groups together.
    pub bins: Vec<i128>,
    /// Per pixel.
    pub counts: Vec<Counts>,
    /// AOVs, if any are kept.
    pub aovs: Option<aov::AovTile>,
    /// The first samples that were left out: where to look.
    pub invalid: Vec<SampleId>,
}

/// The film.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// What it holds.
    pub layout: FilmLayout,
    /// All tiles of the crop, row by row.
    pub tiles: Vec<Tile>,
}

/// What one finished sample brings.
pub struct FinishedSample<'a> {
    /// Per plane.
    pub sums: &'a [[i128; 3]],
    /// By wavelength, where the film has bins.
    pub lanes: Option<&'a LaneSums>,
    /// True when a contribution was not finite or absurd.
    pub is_invalid: bool,
    /// First hit.
    pub aov: AovSample,
}

impl FilmLayout {
    /// Planes of light.
    pub fn planes(&self) -> usize {
        self.groups.len().max(1)
    }

    /// Spectral bins of a pixel.
    fn bin_count(&self) -> usize {
        self.bins.map_or(0, |b| b.count as usize)
    }
}

impl Film {
    /// An empty film.
    pub fn new(layout: FilmLayout) -> Self {
        let mut tiles = Vec::new();
        let c = layout.crop;
        for y0 in (c.y0..c.y1).step_by(TILE as usize) {
            for x0 in (c.x0..c.x1).step_by(TILE as usize) {
                let rect = Rect { x0, y0, x1: (x0 + TILE).min(c.x1), y1: (y0 + TILE).min(c.y1) };
                tiles.push(Tile {
                    rect,
                    sums: vec![[0; 3]; rect.area() * layout.planes()],
                    squares: vec![[0; 3]; rect.area()],
                    bins: vec![0; rect.area() * layout.bin_count()],
                    counts: vec![Counts::default(); rect.area()],
                    aovs: (!layout.aovs.is_empty()).then(|| aov::AovTile::new(rect.area())),
                    invalid: Vec::new(),
                });
            }
        }
        Film { layout, tiles }
    }

    /// Samples left out, over all pixels.
    pub fn invalid_samples(&self) -> u64 {
        self.tiles.iter().flat_map(|t| &t.counts).map(|c| u64::from(c.invalid)).sum()
    }

    /// Walk over all pixels: `(x, y, tile, index in tile)`.
    pub fn pixels(&self) -> impl Iterator<Item = (u32, u32, &Tile, usize)> {
        self.tiles.iter().flat_map(|t| {
            (0..t.rect.area()).map(move |i| {
                let (x, y) = t.place(i);
                (x, y, t, i)
            })
        })
    }
}

impl Tile {
    /// Where pixel number `pixel` of this tile is in the image.
    pub fn place(&self, pixel: usize) -> (u32, u32) {
        let width = self.rect.width();
        (self.rect.x0 + pixel as u32 % width, self.rect.y0 + pixel as u32 / width)
    }

    /// Add one sample of pixel number `pixel` of this tile.
    pub fn add(&mut self, pixel: usize, id: SampleId, sample: &FinishedSample) {
        let counts = &mut self.counts[pixel];
        counts.taken += 1;
        if sample.is_invalid {
            counts.invalid += 1;
            const KEPT: usize = 16;
            if self.invalid.len() < KEPT {
                self.invalid.push(id);
            }
            return;
        }
        let planes = sample.sums.len();
        let mut total = [0_i128; 3];
        for (plane, sum) in sample.sums.iter().enumerate() {
            for c in 0..3 {
                self.sums[pixel * planes + plane][c] += sum[c];
                total[c] += sum[c];
            }
        }
        for c in 0..3 {
            let sum = &mut self.squares[pixel][c];
            *sum = sum.saturating_add(fixed::square(total[c]));
        }
        if let Some(lanes) = sample.lanes {
            let bins = self.bins.len() / self.counts.len();
            lanes.add_to(&mut self.bins[pixel * bins..(pixel + 1) * bins]);
        }
        if let Some(aovs) = &mut self.aovs {
            aovs.add(pixel, id.sample, &sample.aov);
        }
    }

    /// A pixel's mean colour.
    pub fn mean(&self, pixel: usize) -> [f32; 3] {
        let planes = self.sums.len() / self.counts.len();
        let total = (0..planes).fold([0_i128; 3], |t, p| {
            let s = self.sums[pixel * planes + p];
            [t[0] + s[0], t[1] + s[1], t[2] + s[2]]
        });
        self.over_valid(pixel, total)
    }

    /// A pixel's mean colour in one plane.
    pub fn plane_mean(&self, pixel: usize, plane: usize) -> [f32; 3] {
        let planes = self.sums.len() / self.counts.len();
        self.over_valid(pixel, self.sums[pixel * planes + plane])
    }

    /// A pixel's mean radiance in one spectral bin, per nm.
    pub fn bin_mean(&self, pixel: usize, bin: usize) -> f32 {
        let bins = self.bins.len() / self.counts.len();
        (fixed::to_f64(self.bins[pixel * bins + bin]) / self.valid(pixel)) as f32
    }

    fn over_valid(&self, pixel: usize, total: [i128; 3]) -> [f32; 3] {
        let n = self.valid(pixel);
        total.map(|s| (fixed::to_f64(s) / n) as f32)
    }

    /// Samples that count; 1 if there are none.
    fn valid(&self, pixel: usize) -> f64 {
        let c = &self.counts[pixel];
        f64::from((c.taken - c.invalid).max(1))
    }

    /// Variance of the mean, per channel (unbiased; 0 for fewer than two samples).
    pub fn variance_of_mean(&self, pixel: usize) -> [f32; 3] {
        self.moments(pixel).1.map(|v| v as f32)
    }

    /// A pixel's mean colour, and the variance of that mean per channel (unbiased; 0 for fewer than two samples).
    pub fn moments(&self, pixel: usize) -> ([f64; 3], [f64; 3]) {
        let n = self.valid(pixel);
        let planes = self.sums.len() / self.counts.len();
        let sums = &self.sums[pixel * planes..(pixel + 1) * planes];
        let mean: [f64; 3] =
            std::array::from_fn(|i| fixed::to_f64(sums.iter().fold(0, |t: i128, s| t.wrapping_add(s[i]))) / n);
        let variance = std::array::from_fn(|i| match n < 2.0 {
            true => 0.0,
            false => (fixed::square_to_f64(self.squares[pixel][i]) / n - mean[i] * mean[i]).max(0.0) / (n - 1.0),
        });
        (mean, variance)
    }
}
