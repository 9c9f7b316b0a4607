//! The frames of a film: which ones, and how their files are numbered.

use crate::ranges::parse_range;
use std::ffi::OsString;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// More at a time are refused: surely a slip of the hand.
const MOST: u32 = 1_000_000;
/// Digits of a number where the name does not say how many.
const DIGITS: usize = 4;

/// The value of `--frames`.
pub fn parse(text: &str) -> Result<Range<u32>, String> {
    match parse_range(text) {
        Some(range) if range.is_empty() => {
            Err("write A..B with A < B, such as 0..48: B is the first not rendered".into())
        }
        Some(range) if range.end - range.start > MOST => Err(format!("render at most {MOST} frames at a time")),
        Some(range) => Ok(range),
        None => Err("write A..B with A < B, such as 0..48".into()),
    }
}

/// `path` with the number of a frame: in place of the last run of `#` in the file's name, or before its extension. All frames
/// of `frames` get equally many digits.
pub fn numbered(path: &Path, frame: u32, frames: &Range<u32>) -> PathBuf {
    let needed = (frames.end - 1).to_string().len();
    let number = |digits: usize| format!("{frame:0width$}", width = digits.max(needed));
    let name = path.file_name().unwrap_or_default();
    if let Some((head, tail)) = name.to_str().and_then(|n| n.rsplit_once('#')) {
        let start = head.trim_end_matches('#');
        return path.with_file_name(format!("{start}{}{tail}", number(head.len() - start.len() + 1)));
    }
    let mut name = OsString::from(path.file_stem().unwrap_or_default());
    name.push(format!(".{}", number(DIGITS)));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_before_the_extension_or_where_the_hashes_are() {
        let name = |path: &str, frame, last| numbered(Path::new(path), frame, &(0..last)).display().to_string();
        assert_eq!(name("out.png", 7, 10), "out.0007.png");
        assert_eq!(name("a.b/out.tar.png", 7, 10), "a.b/out.tar.0007.png");
        assert_eq!(name("stats", 7, 10), "stats.0007");
        assert_eq!(name("out.##.png", 7, 10), "out.07.png");
        assert_eq!(name("f/#_######.exr", 7, 10), "f/#_000007.exr");
        assert_eq!(name("a#/out.exr", 7, 10), "a#/out.0007.exr");
        assert_eq!(name("#", 7, 10), "7");
    }

    #[test]
    fn every_number_is_as_wide_as_the_last_frame_needs() {
        let name = |path: &str, last| numbered(Path::new(path), 7, &(0..last)).display().to_string();
        assert_eq!(name("#.png", 10), "7.png");
        assert_eq!(name("#.png", 11), "07.png");
        assert_eq!(name("a.png", 10_000), "a.0007.png");
        assert_eq!(name("a.png", 10_001), "a.00007.png");
    }

    #[test]
    fn ranges_are_rising_and_not_endless() {
        assert_eq!(parse("3..4"), Ok(3..4));
        for bad in ["4..4", "4..3", "4", "..4", "-1..3", "0..2000000", "0..99999999999"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
