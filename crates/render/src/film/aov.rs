//! Extra quantities of the first hit ("arbitrary output variables"), kept as integers like the light.

use super::fixed;

/// The AOVs that exist: name, channels, one line.
pub const AOVS: [(&str, &[&str], &str); 8] = [
    ("depth", &["Z"], "Distance along the camera ray to the first hit (mean over the samples that hit)."),
    ("normals", &["X", "Y", "Z"], "Shading normal in world space (mean)."),
    ("albedo", &["R", "G", "B"], "Colour of the first surface (mean)."),
    ("position", &["X", "Y", "Z"], "World position of the first hit (mean)."),
    ("object_id", &["id"], "Number of the object (from 1, 0 = none) that the first sample hit."),
    ("material_id", &["id"], "Number of the material (from 1, 0 = none) that the first sample hit."),
    ("sample_count", &["N"], "Valid samples."),
    ("variance", &["R", "G", "B"], "Variance of the pixel's mean."),
];

/// A set of AOVs, as bits in the order of [`AOVS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AovSet(pub u16);

impl AovSet {
    /// By names; the first unknown one as error.
    pub fn from_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, &'a str> {
        let mut set = 0;
        for name in names {
            let i = AOVS.iter().position(|a| a.0 == name).ok_or(name)?;
            set |= 1 << i;
        }
        Ok(AovSet(set))
    }

    /// True when nothing is kept.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True when `name` is in it.
    pub fn has(self, name: &str) -> bool {
        AOVS.iter().position(|a| a.0 == name).is_some_and(|i| self.0 >> i & 1 == 1)
    }

    /// With these as well.
    pub fn with(self, names: &[&str]) -> Self {
        AovSet(self.0 | AovSet::from_names(names.iter().copied()).unwrap_or_default().0)
    }

    /// The others.
    pub fn without(self, name: &str) -> Self {
        AovSet(AOVS.iter().position(|a| a.0 == name).map_or(self.0, |i| self.0 & !(1 << i)))
    }

    /// Names, in the order of [`AOVS`].
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        AOVS.iter().map(|a| a.0).filter(move |n| self.has(n))
    }
}

/// One sample's first hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct AovSample {
    /// True when something was hit.
    pub is_hit: bool,
    /// Distance.
    pub depth: f32,
    /// Shading normal.
    pub normal: [f32; 3],
    /// Colour.
    pub albedo: [f32; 3],
    /// Position.
    pub position: [f32; 3],
    /// Object number, 0 = none.
    pub object: u32,
    /// Material number, 0 = none.
    pub material: u32,
}

/// A tile's sums. Values: depth, normal, albedo, position.
#[derive(Clone, Debug, PartialEq)]
pub struct AovTile {
    /// Per pixel.
    pub values: Vec<[i128; 10]>,
    /// Per pixel: samples that hit.
    pub hits: Vec<u32>,
    /// Per pixel: object and material of the lowest sample, and which sample that was.
    pub ids: Vec<Ids>,
}

/// Who was hit by the lowest sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ids {
    /// The sample.
    pub sample: u32,
    /// Object number.
    pub object: u32,
    /// Material number.
    pub material: u32,
}

impl AovTile {
    /// Empty, for so many pixels.
    pub fn new(pixels: usize) -> Self {
        AovTile {
            values: vec![[0; 10]; pixels],
            hits: vec![0; pixels],
            ids: vec![Ids { sample: u32::MAX, object: 0, material: 0 }; pixels],
        }
    }

    /// Add a sample.
    pub fn add(&mut self, pixel: usize, sample: u32, a: &AovSample) {
        if sample < self.ids[pixel].sample {
            self.ids[pixel] = Ids { sample, object: a.object, material: a.material };
        }
        if !a.is_hit {
            return;
        }
        self.hits[pixel] += 1;
        let all = std::iter::once(&a.depth).chain(&a.normal).chain(&a.albedo).chain(&a.position);
        for (sum, v) in self.values[pixel].iter_mut().zip(all) {
            *sum += fixed::from_f64(f64::from(*v)).unwrap_or(0);
        }
    }

    /// Add another tile's sums.
    pub fn merge(&mut self, other: &AovTile) {
        for (p, v) in other.values.iter().enumerate() {
            for (a, b) in self.values[p].iter_mut().zip(v) {
                *a += b;
            }
            self.hits[p] += other.hits[p];
            if other.ids[p].sample < self.ids[p].sample {
                self.ids[p] = other.ids[p];
            }
        }
    }

    /// Mean of value `i` over the samples that hit.
    pub fn mean(&self, pixel: usize, i: usize) -> f32 {
        match self.hits[pixel] {
            0 => 0.0,
            n => (fixed::to_f64(self.values[pixel][i]) / f64::from(n)) as f32,
        }
    }
}
