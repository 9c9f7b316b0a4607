//! Pictures that keep their integers: partial pictures, merged ones, checkpoints.

use crate::header::Header;
use crate::input::read_file;
use crate::problem::Problem;
use crate::ranges::SampleRanges;
use kirkas_images::{Image, read_exr};
use kirkas_render::Film;
use kirkas_render::film::part::read_part;
use kirkas_scene::Diagnostic;
use std::ops::Range;
use std::path::Path;

/// The first bytes of an EXR file.
pub const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// A picture with its integers.
pub struct Part {
    /// What its file says of it.
    pub header: Header,
    /// The sums.
    pub film: Film,
    /// Which samples every pixel has.
    pub samples: SampleRanges,
}

impl Part {
    /// Read one.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let bytes = read_file(path)?;
        let cure = "write it with `kirkas render SCENE --samples A..B -o PART.exr` or `--checkpoint FILE`";
        let bad = |why: String| {
            Problem::input(Diagnostic::error("not-a-part", format!("`{}`: {why}", path.display())).help(cure))
        };
        if !bytes.starts_with(&EXR) {
            return Err(bad("it is not an EXR picture, and no other keeps the integers".into()));
        }
        let image: Image = read_exr(&bytes).map_err(|e| bad(e.to_string()))?;
        let film = read_part(&image).map_err(|e| bad(e.to_string()))?;
        let header = Header::of_image(&image);
        let samples = header.samples().ok_or_else(|| bad("its header does not say which samples it holds".into()))?;
        Ok(Part { header, film, samples })
    }
}

/// The fewest and the most samples that any pixel has taken.
pub fn taken(film: &Film) -> (u32, u32) {
    let counts = || film.tiles.iter().flat_map(|t| &t.counts).map(|c| c.taken);
    (counts().min().unwrap_or(0), counts().max().unwrap_or(0))
}

/// Say in the header which of the samples that are asked for the film has now. Pixels that adaptive sampling has stopped count
/// as if they had all.
pub fn tell_samples(header: &mut Header, film: &Film, asked: &Range<u32>) -> Range<u32> {
    let start = asked.start;
    let (least, most) = film.going_on().unwrap_or((asked.end - start, asked.end - start));
    let range = start..start.saturating_add(least);
    header.set("samples", SampleRanges::one(range.clone()).to_string());
    let unfinished =
        if most > least { format!("{}..{}", range.end, start.saturating_add(most)) } else { String::new() };
    header.set("unfinished", unfinished);
    let invalid = film.invalid_samples();
    header.set("invalid", if invalid > 0 { invalid.to_string() } else { String::new() });
    range
}
