//! The one door through which files are read: it keeps to a root folder, limits sizes and counts, and remembers the hash of
//! everything it gave out, so that an image can name exactly what made it.

use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

/// Where bytes come from: a disk, a web page, a test. Paths are relative to the root, `/` between parts, without `..`.
pub trait Files: Send + Sync {
    /// The whole file, refused when it is longer than `limit` bytes.
    fn fetch(&self, path: &str, limit: u64) -> Result<Vec<u8>, FileError>;
}

/// Why a file could not be had.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FileError {
    /// No such file.
    #[error("there is no file `{0}`")]
    NotFound(String),
    /// The path leads out of the root folder.
    #[error("`{0}` lies outside the scene's folder")]
    Outside(String),
    /// Too long.
    #[error("`{path}` is longer than the {limit} bytes allowed")]
    TooLarge {
        /// Which.
        path: String,
        /// The limit.
        limit: u64,
    },
    /// Too many files.
    #[error("the scene reads more than {0} files")]
    TooMany(usize),
    /// Anything else.
    #[error("`{path}` cannot be read: {why}")]
    Other {
        /// Which.
        path: String,
        /// What the system said.
        why: String,
    },
}

/// Limits on what one scene may read.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Bytes in one file.
    pub file_bytes: u64,
    /// Files in all.
    pub files: usize,
    /// Depth of includes.
    pub include_depth: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { file_bytes: 8 << 30, files: 100_000, include_depth: 32 }
    }
}

/// Reads files for one scene, within limits, and keeps the record.
pub struct FileAccess {
    provider: Box<dyn Files>,
    limits: Limits,
    record: Mutex<BTreeMap<String, [u8; 32]>>,
}

impl FileAccess {
    /// Read through `provider`.
    pub fn new(provider: Box<dyn Files>, limits: Limits) -> Self {
        FileAccess { provider, limits, record: Mutex::default() }
    }

    /// The limits in force.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Read `path`, relative to `folder`.
    pub fn read(&self, folder: &str, path: &str) -> Result<(String, Arc<[u8]>), FileError> {
        let full = resolve(folder, path)?;
        let count = self.record.lock().map_or(0, |r| r.len());
        if count >= self.limits.files {
            return Err(FileError::TooMany(self.limits.files));
        }
        let bytes = self.provider.fetch(&full, self.limits.file_bytes)?;
        let hash: [u8; 32] = Sha256::digest(&bytes).into();
        if let Ok(mut record) = self.record.lock() {
            record.insert(full.clone(), hash);
        }
        Ok((full, bytes.into()))
    }

    /// Every file read so far and its SHA-256.
    pub fn record(&self) -> BTreeMap<String, [u8; 32]> {
        self.record.lock().map(|r| r.clone()).unwrap_or_default()
    }

    /// One hash over all of them (name, length of name, content hash), in order of name: the scene hash.
    pub fn scene_hash(&self) -> String {
        let mut all = Sha256::new();
        for (path, hash) in self.record() {
            all.update((path.len() as u64).to_le_bytes());
            all.update(path.as_bytes());
            all.update(hash);
        }
        all.finalize().iter().map(|b| format!("{b:02x}")).collect()
    }
}

/// `path` as seen from `folder`, without `.` and `..`; an error if it climbs out of the root or is absolute.
pub fn resolve(folder: &str, path: &str) -> Result<String, FileError> {
    let path = path.replace('\\', "/");
    if path.starts_with('/') || path.contains('\0') || path.get(1..2) == Some(":") {
        return Err(FileError::Outside(path));
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." => {
                if parts.pop().is_none() {
                    return Err(FileError::Outside(path.clone()));
                }
            }
            p => parts.push(p),
        }
    }
    Ok(parts.join("/"))
}

/// Files held in memory: for tests, the web and the viewer.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles(pub BTreeMap<String, Vec<u8>>);

impl Files for MemoryFiles {
    fn fetch(&self, path: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let bytes = self.0.get(path).ok_or_else(|| FileError::NotFound(path.into()))?;
        if bytes.len() as u64 > limit {
            return Err(FileError::TooLarge { path: path.into(), limit });
        }
        Ok(bytes.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_inside_the_root() {
        assert_eq!(resolve("a/b", "../c.ply").unwrap(), "a/c.ply");
        assert_eq!(resolve("", "./x.toml").unwrap(), "x.toml");
        for bad in ["../x", "a/../../x", "/etc/passwd", "C:\\x", "..\\x", "a\0b"] {
            assert!(resolve("", bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_record_names_what_was_read_and_the_hash_changes_with_it() {
        let access = |text: &str| {
            let files = MemoryFiles([("s.toml".to_string(), text.as_bytes().to_vec())].into());
            let a = FileAccess::new(Box::new(files), Limits::default());
            a.read("", "s.toml").unwrap();
            assert!(a.read("", "none").is_err());
            (a.record().len(), a.scene_hash())
        };
        assert_eq!(access("a"), access("a"));
        assert_ne!(access("a"), access("b"));
        assert_eq!(access("a").0, 1);
    }
}
