//! Where the files of one picture go: its pictures, its statistics, its checkpoint.

use crate::frames::numbered;
use crate::header::Header;
use crate::output::{PictureFile, PictureFormat, check_writable};
use crate::pictures::Development;
use crate::problem::Problem;
use kirkas_images::{decode, read_exr};
use kirkas_scene::Diagnostic;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The files of one picture.
#[derive(Clone, Debug)]
pub struct Places {
    /// Its pictures.
    pub pictures: Vec<PictureFile>,
    /// Its statistics, unless to stdout.
    pub stats: Option<PathBuf>,
    /// What is done so far.
    pub checkpoint: Option<PathBuf>,
}

impl Places {
    /// The same for a frame of a film.
    pub fn of_frame(&self, frame: u32, frames: &Range<u32>) -> Places {
        let place = |path: &PathBuf| numbered(path, frame, frames);
        let picture = |f: &PictureFile| PictureFile { path: place(&f.path), ..f.clone() };
        Places {
            pictures: self.pictures.iter().map(picture).collect(),
            stats: self.stats.as_ref().map(place),
            checkpoint: self.checkpoint.as_ref().map(place),
        }
    }

    /// Every file can be written, none is written twice.
    pub fn check(&self) -> Result<(), Problem> {
        let mut places: Vec<&Path> = self.pictures.iter().map(|f| f.path.as_path()).collect();
        places.extend(self.stats.as_deref());
        places.extend(self.checkpoint.as_deref());
        for (i, place) in places.iter().enumerate() {
            if places[..i].contains(place) {
                let message = format!("`{}` would be written twice", place.display());
                return Err(Problem::input(
                    Diagnostic::error("same-file", message).help("give each file a name of its own"),
                ));
            }
            check_writable(place)?;
        }
        match &self.checkpoint {
            Some(path) if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("exr")) => {
                let message = format!("the checkpoint `{}` must be an `.exr`", path.display());
                Err(Problem::input(Diagnostic::error("unknown-format", message).help("give it the extension `.exr`")))
            }
            _ => Ok(()),
        }
    }

    /// No checkpoint is lost.
    pub fn check_checkpoint(&self) -> Result<(), Problem> {
        let Some(path) = self.checkpoint.as_ref().filter(|p| p.exists()) else { return Ok(()) };
        let message = format!("the checkpoint `{}` exists already", path.display());
        let help = "give --resume to go on from it, or remove it to begin anew";
        Err(Problem::input(Diagnostic::error("checkpoint-exists", message).help(help)))
    }

    /// Everything that is written.
    pub fn all(&self, development: &Development) -> Vec<PathBuf> {
        let pictures = self.pictures.iter().map(|f| f.path.clone());
        let layers = development.aov_files(&self.pictures).into_iter().map(|l| l.0);
        let noisy = development.noisy_files(&self.pictures).into_iter().map(|f| f.path);
        pictures.chain(layers).chain(noisy).chain(self.stats.clone()).chain(self.checkpoint.clone()).collect()
    }

    /// True when all pictures are there, finished, and made as `header` says.
    pub fn hold(&self, header: &Header, development: &Development) -> bool {
        let header = development.told(header);
        let is_made = |path: &Path, format| header_of(path, format).is_some_and(|h| h.is_of_same_picture(&header));
        let noisy = development.noisy_files(&self.pictures);
        self.pictures.iter().chain(&noisy).all(|f| is_made(&f.path, f.format))
            && development.aov_files(&self.pictures).iter().all(|l| is_made(&l.0, PictureFormat::Png))
            && self.stats.as_ref().is_none_or(|path| path.exists())
    }
}

/// The header of the picture at `path`, if it can be read to its end.
fn header_of(path: &Path, format: PictureFormat) -> Option<Header> {
    let bytes = std::fs::read(path).ok()?;
    Some(match format {
        PictureFormat::Exr => Header::of_image(&read_exr(&bytes).ok()?),
        PictureFormat::Png | PictureFormat::Hdr => Header::of_texts(&decode(&bytes, None).ok()?.texts),
    })
}
