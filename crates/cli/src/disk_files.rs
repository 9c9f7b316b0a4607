//! Files on the disk, below one folder: nothing outside it can be read, also not through a link.

use kirkas_scene::files::{FileError, Files};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::PathBuf;

/// Files below a folder.
pub struct DiskFiles {
    /// Canonical.
    root: PathBuf,
}

impl DiskFiles {
    /// Below `root`, which must be canonical.
    pub fn new(root: PathBuf) -> Self {
        DiskFiles { root }
    }
}

impl Files for DiskFiles {
    fn fetch(&self, path: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let other = |e: std::io::Error| match e.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => FileError::NotFound(path.into()),
            _ => FileError::Other { path: path.into(), why: e.to_string() },
        };
        let full = self.root.join(path).canonicalize().map_err(other)?;
        if !full.starts_with(&self.root) {
            return Err(FileError::Outside(path.into()));
        }
        // Before it is opened: to open a pipe is to wait for ever.
        let about = full.metadata().map_err(other)?;
        if !about.is_file() {
            return Err(FileError::Other { path: path.into(), why: "it is not a file".into() });
        }
        if about.len() > limit {
            return Err(FileError::TooLarge { path: path.into(), limit });
        }
        let file = File::open(&full).map_err(other)?;
        // A file may grow while it is read.
        let mut bytes = Vec::with_capacity(about.len().min(limit) as usize + 1);
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(other)?;
        if bytes.len() as u64 > limit {
            return Err(FileError::TooLarge { path: path.into(), limit });
        }
        Ok(bytes)
    }
}
