//! From sums to an image: means, layers, AOVs.

use super::aov::AOVS;
use super::{Film, Tile};
use core::ops::Range;
use kirkas_images::{ChannelData, Image, RgbImage, Window};

/// How floats are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 16 bits.
    Half,
    /// 32 bits.
    Float,
}

impl Film {
    /// The beauty image of the crop.
    pub fn to_rgb(&self) -> RgbImage {
        self.rows_to_rgb(0..self.layout.crop.height())
    }

    /// These rows of the crop's beauty image, counted from its top.
    pub fn rows_to_rgb(&self, rows: Range<u32>) -> RgbImage {
        let (c, width) = (self.layout.crop, self.layout.crop.width() as usize);
        let mut pixels = vec![[0.0; 3]; width * rows.len()];
        let is_near = |t: &&Tile| t.rect.y0 < c.y0 + rows.end && c.y0 + rows.start < t.rect.y1;
        for (tile, i) in self.tiles.iter().filter(is_near).flat_map(|t| (0..t.rect.area()).map(move |i| (t, i))) {
            let (dx, dy) = (i as u32 % tile.rect.width(), i as u32 / tile.rect.width());
            let (x, y) = (tile.rect.x0 + dx - c.x0, tile.rect.y0 + dy - c.y0);
            if rows.contains(&y) {
                pixels[(y - rows.start) as usize * width + x as usize] = tile.mean(i);
            }
        }
        RgbImage { width: c.width(), height: rows.len() as u32, pixels }
    }

    /// All layers: beauty, light groups, AOVs, spectral bins. AOVs that are numbers, and bins, stay 32 bits wide.
    pub fn to_image(&self, depth: Depth) -> Image {
        let c = self.layout.crop;
        let window = |x: u32, y: u32, width: u32, height: u32| Window { x: x as i32, y: y as i32, width, height };
        let mut image = Image {
            data: window(c.x0, c.y0, c.width(), c.height()),
            display: window(0, 0, self.layout.size.0, self.layout.size.1),
            ..Image::default()
        };
        let floats = |values: Vec<f32>| match depth {
            Depth::Half => ChannelData::F16(values),
            Depth::Float => ChannelData::F32(values),
        };
        let groups = layer_names(&self.layout.groups);
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            image.push(name, floats(self.plane(|t, i| t.mean(i)[c])));
            for (g, group) in groups.iter().enumerate() {
                image.push(format!("group.{group}.{name}"), floats(self.plane(|t, i| t.plane_mean(i, g)[c])));
            }
        }
        for (name, channels, _) in AOVS.iter().filter(|a| self.layout.aovs.has(a.0)) {
            for (c, channel) in channels.iter().enumerate() {
                image.push(format!("{name}.{channel}"), self.aov_channel(name, c));
            }
        }
        self.write_bins(&mut image);
        image
    }

    /// Channel `c` of an AOV.
    pub fn aov_channel(&self, name: &str, c: usize) -> ChannelData {
        let value = |k: usize| self.plane(move |t, i| t.aovs.as_ref().map_or(0.0, |a| a.mean(i, k)));
        let id =
            |pick: fn(&super::aov::Ids) -> u32| self.plane(move |t, i| t.aovs.as_ref().map_or(0, |a| pick(&a.ids[i])));
        match name {
            "depth" => ChannelData::F32(value(0)),
            "normals" => ChannelData::F32(value(1 + c)),
            "albedo" => ChannelData::F32(value(4 + c)),
            "position" => ChannelData::F32(value(7 + c)),
            "object_id" => ChannelData::U32(id(|i| i.object)),
            "material_id" => ChannelData::U32(id(|i| i.material)),
            "sample_count" => ChannelData::U32(self.plane(|t, i| t.counts[i].taken - t.counts[i].invalid)),
            _ => ChannelData::F32(self.plane(|t, i| t.variance_of_mean(i)[c])),
        }
    }

    /// One value per pixel of the crop, rows from the top.
    pub(crate) fn plane<T: Clone + Default>(&self, value: impl Fn(&Tile, usize) -> T) -> Vec<T> {
        let mut out = vec![T::default(); self.layout.crop.area()];
        for (x, y, tile, i) in self.pixels() {
            out[self.index(x, y)] = value(tile, i);
        }
        out
    }

    fn index(&self, x: u32, y: u32) -> usize {
        let c = self.layout.crop;
        (y - c.y0) as usize * c.width() as usize + (x - c.x0) as usize
    }
}

/// Names of the groups' layers: dots separate layers in EXR, so names keep none, and stay apart by a number where that makes
/// two the same.
pub fn layer_names(groups: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for group in groups {
        let plain = group.replace('.', "_");
        let numbered = (2..).map(|n| format!("{plain}_{n}"));
        let is_free = |name: &String| !names.contains(name) && (*name == *group || !groups.contains(name));
        let name = std::iter::once(plain.clone()).chain(numbered).find(is_free);
        names.push(name.unwrap_or(plain));
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{FilmLayout, Rect};

    #[test]
    fn bands_of_rows_are_the_rows_of_the_picture() {
        let crop = Rect { x0: 5, y0: 3, x1: 45, y1: 70 };
        let size = (80, 80);
        let mut film = Film::new(FilmLayout { size, crop, groups: Vec::new(), aovs: Default::default(), bins: None });
        for tile in &mut film.tiles {
            for (i, sum) in tile.sums.iter_mut().enumerate() {
                let (x, y) = (tile.rect.x0 + i as u32 % tile.rect.width(), tile.rect.y0 + i as u32 / tile.rect.width());
                *sum = [i128::from(100 * y + x) << 64; 3];
            }
        }
        for rows in [0..67, 0..1, 20..50, 29..30, 61..67, 4..4] {
            let band = film.rows_to_rgb(rows.clone());
            let expected: Vec<_> = rows.flat_map(|y| (5..45).map(move |x| [(100 * (y + 3) + x) as f32; 3])).collect();
            assert_eq!(band.pixels, expected);
        }
    }

    #[test]
    fn layers_of_groups_have_names_of_their_own() {
        let names = |all: &[&str]| layer_names(&all.iter().map(|s| s.to_string()).collect::<Vec<_>>());
        assert_eq!(names(&["sky", "a.b", "a_b", "a.b"]), ["sky", "a_b_2", "a_b", "a_b_3"]);
    }
}
