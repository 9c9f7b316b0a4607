//! Plots as files: SVG or PNG, by the ending of their name.

use crate::output::{check_no_loss, check_writable, write_atomically};
use crate::problem::Problem;
use kirkas_images::{Texts, write_png8};
use kirkas_plot::{Drawing, rasterize, write_svg};
use kirkas_scene::Diagnostic;
use std::path::PathBuf;

/// Pixels of a PNG to a point of the drawing.
const PIXELS_PER_POINT: f64 = 2.0;

/// Make sure, before the work, that these plots can be written after it.
pub fn check(paths: &[PathBuf]) -> Result<(), Problem> {
    for path in paths {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        if !matches!(extension.as_deref(), Some("svg" | "png")) {
            let message = format!("`{}`: a plot is an `.svg` or a `.png`", path.display());
            let help = "give it one of these extensions";
            return Err(Problem::input(Diagnostic::error("unknown-format", message).help(help)));
        }
        check_writable(path)?;
    }
    check_no_loss(paths.iter().map(PathBuf::as_path), &[])
}

/// Write them all.
pub fn write(drawing: &Drawing, paths: &[PathBuf]) -> Result<(), Problem> {
    for path in paths {
        let is_svg = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg"));
        let bytes = if is_svg { write_svg(drawing).into_bytes() } else { png(drawing)? };
        write_atomically(path, &bytes)?;
    }
    Ok(())
}

fn png(drawing: &Drawing) -> Result<Vec<u8>, Problem> {
    let too_large = || Problem::input(Diagnostic::error("too-large", "this plot has too many pixels for a PNG"));
    let pixels = rasterize(drawing, PIXELS_PER_POINT).ok_or_else(too_large)?;
    Ok(pack(pixels.width, pixels.height, &pixels.rgb))
}

/// Red, green and blue as a PNG file.
pub fn pack(width: u32, height: u32, rgb: &[u8]) -> Vec<u8> {
    write_png8(width, height, rgb, &Texts::default()).unwrap_or_default()
}
