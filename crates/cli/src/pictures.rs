//! From a film to files: display pictures, linear light, layers, integers.

use crate::aov_args::AovArg;
use crate::aov_picture::aov_codes;
use crate::denoise::Denoiser;
use crate::header::Header;
use crate::output::{PictureFile, PictureFormat, write_atomically};
use crate::problem::Problem;
use kirkas_geometry::elementary::pow;
use kirkas_images::{
    ChannelData, ExrCompression, ImageError, RgbImage, Texts, ToneCurve, to_srgb8, write_exr, write_hdr, write_png8,
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
    /// PNG and HDR pictures are denoised, the noisy ones beside them; EXR has a layer `denoised`.
    pub denoiser: Option<Denoiser>,
    /// Layers that PNG and HDR pictures get beside them as pictures of their own.
    pub aovs: Vec<AovArg>,
}

impl Development {
    /// Write all files.
    pub fn write(&self, film: &Film, header: &Header, files: &[PictureFile]) -> Result<(), Problem> {
        let header = self.told(header);
        let noisy = if self.denoiser.is_some() { self.noisy_files(files) } else { files.to_vec() };
        for file in &noisy {
            let bytes = match file.format {
                PictureFormat::Png => self.png(film, &header.texts()),
                PictureFormat::Hdr => write_hdr(&film.to_rgb(), &header.texts()),
                PictureFormat::Exr => continue,
            };
            write_atomically(&file.path, &bytes.map_err(|e| failed(&file.path, e))?)?;
        }
        // What may fail last: the noisy pictures are safe.
        let clean = self.denoiser.as_ref().map(|d| denoised(d, film));
        let (clean, problem) = match clean {
            Some(Err(problem)) => (None, Some(problem)),
            Some(Ok(clean)) => (Some(clean), None),
            None => (None, None),
        };
        for file in files {
            let bytes = match (file.format, &clean) {
                (PictureFormat::Exr, clean) => self.exr(film, clean.as_ref(), &header),
                (PictureFormat::Png, Some(rgb)) => {
                    write_png8(rgb.width, rgb.height, &codes(rgb, &self.tone, self.exposure), &header.texts())
                }
                (PictureFormat::Hdr, Some(rgb)) => write_hdr(rgb, &header.texts()),
                _ => continue,
            };
            write_atomically(&file.path, &bytes.map_err(|e| failed(&file.path, e))?)?;
        }
        for (path, aov) in self.aov_files(files) {
            let c = film.layout.crop;
            let bytes = write_png8(c.width(), c.height(), &aov_codes(film, aov), &header.texts());
            write_atomically(&path, &bytes.map_err(|e| failed(&path, e))?)?;
        }
        problem.map_or(Ok(()), Err)
    }

    /// `OUT.noisy.png` beside a denoised `OUT.png`.
    pub fn noisy_files(&self, files: &[PictureFile]) -> Vec<PictureFile> {
        let is_flat = |f: &&PictureFile| self.denoiser.is_some() && f.format != PictureFormat::Exr;
        let noisy = |f: &PictureFile| {
            let extension = f.path.extension().unwrap_or_default().to_string_lossy();
            PictureFile { path: f.path.with_extension(format!("noisy.{extension}")), format: f.format }
        };
        files.iter().filter(is_flat).map(noisy).collect()
    }

    /// The header that the files get.
    pub fn told(&self, header: &Header) -> Header {
        let mut header = header.clone();
        header.set("exposure", self.exposure.to_string());
        header.set("tone", self.tone.as_str());
        header.set("denoised", if self.denoiser.is_some() { "Open Image Denoise" } else { "" });
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
        let size = film.layout.crop;
        let mut all = Vec::with_capacity(3 * size.area());
        for top in (0..size.height()).step_by(TILE as usize) {
            let band = film.rows_to_rgb(top..(top + TILE).min(size.height()));
            all.extend(codes(&band, &self.tone, self.exposure));
        }
        write_png8(size.width(), size.height(), &all, texts)
    }

    fn exr(&self, film: &Film, clean: Option<&RgbImage>, header: &Header) -> Result<Vec<u8>, ImageError> {
        let mut image = film.to_image(if self.is_half { Depth::Half } else { Depth::Float });
        for (c, channel) in ["R", "G", "B"].into_iter().enumerate() {
            let Some(rgb) = clean else { break };
            let values = rgb.pixels.iter().map(|p| p[c]).collect();
            let data = if self.is_half { ChannelData::F16(values) } else { ChannelData::F32(values) };
            image.push(format!("denoised.{channel}"), data);
        }
        header.write_to(&mut image);
        if self.keeps_integers {
            write_part(film, &mut image);
        }
        write_exr(&image, ExrCompression::Zip)
    }
}

/// The film's picture without its noise, guided by the albedo and normals of its first hits.
fn denoised(denoiser: &Denoiser, film: &Film) -> Result<RgbImage, Problem> {
    let guide = |name: &str| -> Vec<[f32; 3]> {
        let channels: Vec<ChannelData> = (0..3).map(|c| film.aov_channel(name, c)).collect();
        let lane = |c: usize, i: usize| channels[c].floats().map_or(0.0, |v| v[i]);
        (0..film.layout.crop.area()).map(|i| [lane(0, i), lane(1, i), lane(2, i)]).collect()
    };
    denoiser.denoise(&film.to_rgb(), &guide("albedo"), &guide("normals"))
}

/// A picture for a screen, as the tone curve of this name and the exposure in stops show it.
pub fn codes(rgb: &RgbImage, tone: &str, exposure: f32) -> Vec<u8> {
    match ToneCurve::from_name(tone) {
        Some(curve) => to_srgb8(rgb, exposure, curve),
        None => raw_codes(rgb, exposure),
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
