//! All that made a picture, as texts: what its file's header says.
//!
//! | name | what |
//! |---|---|
//! | `kirkas.version` | of the program |
//! | `kirkas.argv` | the command, as one would type it again |
//! | `kirkas.scene` | the scene file, as the user named it |
//! | `kirkas.scene_hash` | SHA-256 over every file read |
//! | `kirkas.files` | one line per file: its SHA-256 and its path from the root folder |
//! | `kirkas.overrides` | one line per value that the command line set |
//! | `kirkas.seed` | which of all pictures |
//! | `kirkas.color` | how light was carried: `rgb` or `spectral` |
//! | `kirkas.frame` | which frame of a film, if it is one |
//! | `kirkas.crop` | which part of the whole image, if not all: `x0,y0,x1,y1` |
//! | `kirkas.samples` | which samples of each pixel, such as `0..64` |
//! | `kirkas.error` | the error target of adaptive sampling; pixels that stopped have fewer samples |
//! | `kirkas.clamp` | the firefly clamp, if there is one: the picture is darker than the truth |
//! | `kirkas.relight` | how light groups were mixed, if by `relight` |
//! | `kirkas.unfinished` | if stopped within a pass: which further samples some pixels have |
//! | `kirkas.invalid` | samples left out because they were not finite, if any |
//! | `kirkas.strata` | how many samples per pixel the sampler was made for, if it cannot give more |
//! | `kirkas.exposure`, `kirkas.tone` | how it is shown on a screen |
//! | `kirkas.aov` | layers asked for, as typed |
//! | `kirkas.units` | what the numbers mean |

use crate::ranges::SampleRanges;
use kirkas_images::{Attribute, Image, Texts};
use kirkas_scene::files::FileAccess;

/// What the numbers of EXR and HDR pictures mean.
const UNITS: &str = "linear, scene-referred, Rec.709 primaries; 1.0 is one unit of radiance, 1 W/(m2 sr) where the scene's lights \
                     are given in watts";

const PREFIX: &str = "kirkas.";

/// Texts that must agree between pictures that are added, and what is said where they do not.
const MUST_AGREE: [(&str, &str); 8] = [
    ("version", "the version of Kirkas"),
    ("scene_hash", "the scene"),
    ("overrides", "the overrides"),
    ("seed", "the seed"),
    ("color", "how colour is carried"),
    ("frame", "the frame"),
    ("relight", "the mix of lights"),
    ("strata", "the number of samples that the sampler was made for"),
];

/// Texts that may differ between files of one picture.
const MAY_DIFFER: [&str; 3] = ["argv", "scene", "invalid"];

/// The texts, by name without `kirkas.`. An absent one is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header(Texts);

impl Header {
    /// What is known before the first ray.
    pub fn new(scene: &str, files: &FileAccess, overrides: &str, seed: u64) -> Self {
        let hex = |hash: [u8; 32]| hash.iter().map(|b| format!("{b:02x}")).collect::<String>();
        let lines: Vec<String> =
            files.record().into_iter().map(|(path, hash)| format!("{}  {path}", hex(hash))).collect();
        let mut header = Header::default();
        header.set("version", env!("CARGO_PKG_VERSION"));
        header.set("argv", command_line());
        header.set("scene", scene);
        header.set("scene_hash", files.scene_hash());
        header.set("files", lines.join("\n"));
        header.set("overrides", overrides);
        header.set("seed", seed.to_string());
        header.set("units", UNITS);
        header
    }

    /// From a picture's attributes.
    pub fn of_image(image: &Image) -> Self {
        let text = |(name, value): (&String, &Attribute)| match value {
            Attribute::Text(text) => Some((name.clone(), text.clone())),
            Attribute::Number(_) => None,
        };
        let mut header = Header::of_texts(&image.attributes.iter().filter_map(text).collect());
        // The layout of the integers is the film's.
        header.0.remove("groups");
        header.0.remove("spectral_bins");
        header
    }

    /// From the texts of a PNG or HDR picture.
    pub fn of_texts(texts: &Texts) -> Self {
        let ours = |(name, text): (&String, &String)| Some((name.strip_prefix(PREFIX)?.to_string(), text.clone()));
        Header(texts.iter().filter_map(ours).collect())
    }

    /// Say something; an empty text says nothing.
    pub fn set(&mut self, name: &str, text: impl Into<String>) {
        match text.into() {
            empty if empty.is_empty() => self.0.remove(name),
            text => self.0.insert(name.to_string(), text),
        };
    }

    /// What was said.
    pub fn get(&self, name: &str) -> &str {
        self.0.get(name).map_or("", String::as_str)
    }

    /// Which samples.
    pub fn samples(&self) -> Option<SampleRanges> {
        SampleRanges::parse(self.get("samples"))
    }

    /// As a PNG or HDR keeps it.
    pub fn texts(&self) -> Texts {
        self.0.iter().map(|(name, text)| (format!("{PREFIX}{name}"), text.clone())).collect()
    }

    /// As an EXR keeps it.
    pub fn write_to(&self, image: &mut Image) {
        image.attributes.extend(self.texts().into_iter().map(|(name, text)| (name, Attribute::Text(text))));
    }

    /// True when both tell of one picture, with the same samples, shown alike.
    pub fn is_of_same_picture(&self, other: &Header) -> bool {
        let told = |h: &Header| -> Texts {
            h.0.iter().filter(|t| !MAY_DIFFER.contains(&t.0.as_str())).map(|(n, t)| (n.clone(), t.clone())).collect()
        };
        told(self) == told(other)
    }

    /// Why samples of `other` are not samples of the same picture; empty if they are.
    pub fn differences(&self, other: &Header) -> Vec<String> {
        let mut found = Vec::new();
        for (name, words) in MUST_AGREE {
            let (a, b) = (self.get(name), other.get(name));
            match name {
                _ if a == b => {}
                "scene_hash" => found.push(format!("{words}: {}", self.changed_files(other).join(", "))),
                _ => found.push(format!("{words}: {} and {}", quoted(a), quoted(b))),
            }
        }
        found
    }

    fn changed_files(&self, other: &Header) -> Vec<String> {
        let files = |h: &Header| -> Texts {
            h.get("files")
                .lines()
                .filter_map(|l| l.split_once("  "))
                .map(|(hash, path)| (path.into(), hash.into()))
                .collect()
        };
        let (a, b) = (files(self), files(other));
        let mut found: Vec<String> =
            a.iter().filter(|(path, hash)| b.get(*path) != Some(hash)).map(|(path, _)| format!("`{path}`")).collect();
        found.extend(b.keys().filter(|path| !a.contains_key(*path)).map(|path| format!("`{path}`")));
        const MOST: usize = 5;
        if found.len() > MOST {
            let more = found.len() - MOST;
            found.truncate(MOST);
            found.push(format!("and {more} more files"));
        }
        found
    }
}

fn quoted(text: &str) -> String {
    match text {
        "" => "none".into(),
        lines => lines.lines().map(|l| format!("`{l}`")).collect::<Vec<_>>().join(" "),
    }
}

/// The arguments, quoted for a shell where they need it.
pub fn command_line() -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,+%@".contains(c);
    let quote = |a: String| match !a.is_empty() && a.chars().all(plain) {
        true => a,
        false => format!("'{}'", a.replace('\'', "'\\''")),
    };
    std::env::args_os().map(|a| quote(a.to_string_lossy().into_owned())).collect::<Vec<_>>().join(" ")
}
