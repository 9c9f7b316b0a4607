//! Files that are written: beside their place first, then renamed into it, so that no one ever sees half a file.

use crate::problem::Problem;
use kirkas_scene::Diagnostic;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The picture formats, by extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// 8-bit display picture.
    Png,
    /// Linear light and all layers.
    Exr,
    /// Linear light.
    Hdr,
}

/// Where a picture goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// The file.
    pub path: PathBuf,
    /// Told by its extension.
    pub format: PictureFormat,
}

impl PictureFile {
    /// By the extension of `path`.
    pub fn new(path: &Path) -> Result<Self, Problem> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let format = match extension.as_deref() {
            Some("png") => PictureFormat::Png,
            Some("exr") => PictureFormat::Exr,
            Some("hdr") => PictureFormat::Hdr,
            other => {
                let message = match other {
                    Some(e) => format!("`{}`: `.{e}` is not a picture format that Kirkas writes", path.display()),
                    None => format!("`{}` has no extension that tells its format", path.display()),
                };
                let cure = "use one of: `.png`, `.exr`, `.hdr`";
                return Err(Problem::input(Diagnostic::error("unknown-format", message).help(cure)));
            }
        };
        Ok(PictureFile { path: path.to_path_buf(), format })
    }
}

/// Make sure, before the work, that `path` can be written after it.
pub fn check_writable(path: &Path) -> Result<(), Problem> {
    if path.is_dir() {
        return Err(unwritable(path, "it is a folder"));
    }
    let probe = beside(path, "probe");
    let made = File::create(&probe);
    let _ = fs::remove_file(&probe);
    match made {
        Ok(_) => Ok(()),
        Err(e) => Err(unwritable(path, e)),
    }
}

/// Make sure that nothing which is written replaces something that was read (at these true places), nor another file that is
/// written.
pub fn check_no_loss<'a>(outputs: impl IntoIterator<Item = &'a Path>, inputs: &[PathBuf]) -> Result<(), Problem> {
    let mut seen: Vec<PathBuf> = Vec::new();
    for path in outputs {
        let place = true_place(path);
        if inputs.contains(&place) {
            let message = format!("`{}` is read, so writing it would lose what is in it", path.display());
            let help = "give what is written another name (-o FILE)";
            return Err(Problem::input(Diagnostic::error("would-overwrite", message).help(help)));
        }
        if seen.contains(&place) {
            let message = format!("`{}` would be written twice", path.display());
            let error = Diagnostic::error("same-file", message).help("give each file a name of its own");
            return Err(Problem::input(error));
        }
        seen.push(place);
    }
    Ok(())
}

/// One name for a file, whatever way leads to it.
pub fn true_place(path: &Path) -> PathBuf {
    if let Ok(full) = path.canonicalize() {
        return full;
    }
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    parent.canonicalize().unwrap_or_else(|_| parent.to_path_buf()).join(path.file_name().unwrap_or_default())
}

fn unwritable(path: &Path, why: impl std::fmt::Display) -> Problem {
    let message = format!("`{}` cannot be written: {why}", path.display());
    Problem::input(
        Diagnostic::error("cannot-write", message).help("choose a folder that exists and that you may write to"),
    )
}

/// Write `bytes` to `path` in one step.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), Problem> {
    let part = beside(path, "part");
    let write = || -> std::io::Result<()> {
        let mut file = File::create(&part)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&part, path)
    };
    write().map_err(|e| {
        let _ = fs::remove_file(&part);
        let message = format!("`{}` cannot be written: {e}", path.display());
        Problem::failed(
            Diagnostic::error("cannot-write", message).help("make room on the disk or choose another folder"),
        )
    })
}

/// A hidden file in the same folder that no other process uses.
fn beside(path: &Path, what: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.{what}", std::process::id()))
}

/// Write to stdout. A reader that has seen enough is no problem.
pub fn print_out(bytes: &[u8]) -> Result<(), Problem> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Problem::failed(Diagnostic::error("cannot-write", format!("stdout cannot be written: {e}"))))
        }
        _ => Ok(()),
    }
}
