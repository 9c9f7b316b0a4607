//! Checkpoints: the film as it stands, written now and then, so that nothing is lost when a render dies.

use crate::header::Header;
use crate::output::write_atomically;
use crate::parts::{Part, taken, tell_samples};
use crate::problem::Problem;
use kirkas_images::{ExrCompression, write_exr};
use kirkas_render::film::image::Depth;
use kirkas_render::film::part::write_part;
use kirkas_render::{Film, FilmLayout};
use kirkas_scene::Diagnostic;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Writes checkpoints, not too often.
pub struct Checkpoint {
    path: PathBuf,
    header: Header,
    samples: Range<u32>,
    last: Instant,
    /// From one checkpoint to the next, if they are cheap.
    usual: Duration,
    wait: Duration,
}

/// From one checkpoint to the next at the longest, however dear they are.
const LONGEST: Duration = Duration::from_secs(55);
/// Writing takes at most this part of the time, if it can be.
const SHARE: u32 = 20;

impl Checkpoint {
    /// At `path`, of a render of these samples, about every `usual` seconds.
    pub fn new(path: &Path, header: &Header, samples: &Range<u32>, usual: Duration) -> Self {
        let samples = samples.clone();
        Checkpoint { path: path.into(), header: header.clone(), samples, last: Instant::now(), usual, wait: usual }
    }

    /// Write one if it is time.
    pub fn save_if_due(&mut self, film: &Film) -> Result<(), Problem> {
        if self.last.elapsed() < self.wait { Ok(()) } else { self.save(film) }
    }

    /// Write one.
    pub fn save(&mut self, film: &Film) -> Result<(), Problem> {
        let begun = Instant::now();
        tell_samples(&mut self.header, film, &self.samples);
        let mut image = film.to_image(Depth::Float);
        self.header.write_to(&mut image);
        write_part(film, &mut image);
        let fail = |e| Problem::failed(Diagnostic::error("cannot-write", format!("`{}`: {e}", self.path.display())));
        let bytes = write_exr(&image, ExrCompression::None).map_err(fail)?;
        write_atomically(&self.path, &bytes)?;
        self.last = Instant::now();
        self.wait = (begun.elapsed() * SHARE).clamp(self.usual, LONGEST.max(self.usual));
        Ok(())
    }
}

/// The film of the checkpoint at `path`, if it belongs to this picture and asks for no fewer samples.
pub fn load(path: &Path, header: &Header, layout: &FilmLayout, samples: &Range<u32>) -> Result<Film, Problem> {
    let part = Part::read(path)?;
    let mut differences = part.header.differences(header);
    let (a, b) = (&part.film.layout, layout);
    let differs = [
        ("the image size", a.size != b.size),
        ("the crop window", a.crop != b.crop),
        ("the light groups", a.groups != b.groups),
        ("the spectral bins", a.bins != b.bins),
        ("the AOVs", a.aovs != b.aovs),
    ];
    differences.extend(differs.iter().filter(|d| d.1).map(|d| d.0.to_string()));
    if part.samples.single().is_none_or(|r| r.start != samples.start) {
        differences.push(format!("the samples: {} and {}..{}", part.samples, samples.start, samples.end));
    }
    if !differences.is_empty() {
        let message = format!("`{}` is a checkpoint of another picture", path.display());
        let help = format!(
            "these differ: {}; take them back, or begin anew with another --checkpoint",
            differences.join("; ")
        );
        return Err(Problem::input(Diagnostic::error("other-checkpoint", message).help(help)));
    }
    let most = taken(&part.film).1;
    if most > samples.end - samples.start {
        let message = format!("`{}` has {most} samples per pixel already", path.display());
        let help = format!("ask for {} or more: samples cannot be taken away", samples.start + most);
        return Err(Problem::input(Diagnostic::error("fewer-samples", message).help(help)));
    }
    Ok(part.film)
}
