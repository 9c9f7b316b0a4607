//! From a film to files: display pictures, linear light, layers, integers.

use crate::aov_args::AovArg;
use crate::aov_picture::aov_codes;
use crate::header::Header;
use crate::output::{PictureFile, PictureFormat, write_atomically};
use crate::problem::Problem;
use kirkas_geometry::elementary::pow;
use kirkas_images::{
    ExrCompression, ImageError, RgbImage, Texts, ToneCurve, to_srgb8, write_exr, write_hdr, write_png8,
};
use kirkas_render::Film;
use kirkas_render::film::TILE;
use kirkas_render::film::image::Depth;
use kirkas_render::film::part::write_part;
use kirkas_scene::Diagnostic;
use std::path::{Path, PathBuf};

/// How a film becomes files.
pub struct Development {
    /// Display exposure in stops.
    pub exposure: f32,
    /// Display tone curve.
    pub tone: String,
    /// EXR in 16 bits instead of 32.
    pub is_half: bool,
    /// EXR also keeps the integers, so that it can be merged and resumed.
    pub keeps_integers: bool,
    /// Layers that PNG and HDR pictures get beside them as pictures of their own.
    pub aovs: Vec<AovArg>,
}

impl Development {
    /// Write all files.
    pub fn write(&self, film: &Film, header: &Header, files: &[PictureFile]) -> Result<(), Problem> {
        let header = self.told(header);
        for file in files {
            let bytes = match file.format {
                PictureFormat::Png => self.png(film, &header.texts()),
                PictureFormat::Hdr => write_hdr(&film.to_rgb(), &header.texts()),
                PictureFormat::Exr => self.exr(film, &header),
            };
            write_atomically(&file.path, &bytes.map_err(|e| failed(&file.path, e))?)?;
        }
        for (path, aov) in self.aov_files(files) {
            let c = film.layout.crop;
            let bytes = write_png8(c.width(), c.height(), &aov_codes(film, aov), &header.texts());
            write_atomically(&path, &bytes.map_err(|e| failed(&path, e))?)?;
        }
        Ok(())
    }

    /// The header that the files get.
    pub fn told(&self, header: &Header) -> Header {
        let mut header = header.clone();
        header.set("exposure", self.exposure.to_string());
        header.set("tone", self.tone.as_str());
        header
    }

    /// `OUT.depth.png` beside `OUT.png`.
    pub fn aov_files(&self, files: &[PictureFile]) -> Vec<(PathBuf, &AovArg)> {
        let flat = files.iter().filter(|f| f.format != PictureFormat::Exr);
        let mut all: Vec<_> = flat
            .flat_map(|f| self.aovs.iter().map(|a| (f.path.with_extension(format!("{}.png", a.name)), a)))
            .collect();
        all.sort_by(|a, b| a.0.cmp(&b.0));
        all.dedup_by(|a, b| a.0 == b.0);
        all
    }

    fn png(&self, film: &Film, texts: &Texts) -> Result<Vec<u8>, ImageError> {
        // Band by band, so that the picture is never there as floats.
        let (curve, size) = (ToneCurve::from_name(&self.tone), film.layout.crop);
        let mut codes = Vec::with_capacity(3 * size.area());
        for top in (0..size.height()).step_by(TILE as usize) {
            let band = film.rows_to_rgb(top..(top + TILE).min(size.height()));
            codes.extend(match curve {
                Some(curve) => to_srgb8(&band, self.exposure, curve),
                None => raw_codes(&band, self.exposure),
            });
        }
        write_png8(size.width(), size.height(), &codes, texts)
    }

    fn exr(&self, film: &Film, header: &Header) -> Result<Vec<u8>, ImageError> {
        let mut image = film.to_image(if self.is_half { Depth::Half } else { Depth::Float });
        header.write_to(&mut image);
        if self.keeps_integers {
            write_part(film, &mut image);
        }
        write_exr(&image, ExrCompression::Zip)
    }
}

/// `tone = "raw"`: the number times 255, cut off, as the programs of MIT 6.837 write it: no sRGB curve at all.
fn raw_codes(rgb: &RgbImage, exposure: f32) -> Vec<u8> {
    let scale = pow(2.0, f64::from(exposure)) as f32;
    rgb.pixels.iter().flatten().map(|v| raw_code(v * scale)).collect()
}

/// The same for one number; also for depth and normals, which are no light.
pub fn raw_code(value: f32) -> u8 {
    (value * 255.0) as u8
}

fn failed(path: &Path, error: ImageError) -> Problem {
    Problem::failed(Diagnostic::error("cannot-write", format!("`{}`: {error}", path.display())))
}
