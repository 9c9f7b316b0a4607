//! What the compiler does not check: floors, absences, manual heads, sizes, words.

use crate::sh::{Outcome, root};
use std::fs;
use std::path::{Path, PathBuf};

/// Each crate, and the crates of ours it may depend on.
const FLOORS: &[(&str, &[&str])] = &[
    ("geometry", &[]),
    ("scene", &["geometry"]),
    ("accel", &["geometry"]),
    ("optics", &["geometry", "scene"]),
    ("images", &["geometry"]),
    ("formats", &["geometry", "scene"]),
    ("render", &["geometry", "scene", "accel", "optics", "images"]),
    ("plot", &["geometry"]),
    ("explain", &["geometry", "accel", "optics", "render"]),
    ("cli", &["geometry", "scene", "accel", "optics", "images", "formats", "render", "plot", "explain"]),
    ("probe", &["scene", "formats", "render"]),
    ("testkit", &["geometry"]),
];

/// Words that must not stand in the sources of a crate: what it does not know.
const ABSENT: &[(&str, &[&str])] = &[
    ("geometry", &["std::fs", "std::time", "std::thread", "std::net"]),
    ("scene", &["std::fs", "std::time", "std::thread", "std::net"]),
    ("accel", &["std::fs", "std::time", "std::thread", "std::net", "rayon"]),
    ("optics", &["std::fs", "std::time", "std::thread", "std::net"]),
    ("images", &["std::fs", "std::time", "std::thread", "std::net"]),
    ("formats", &["std::fs", "std::time", "std::thread", "std::net", "kirkas_render"]),
    ("render", &["std::fs", "std::time", "std::net", "kirkas_formats", "HashSet"]),
];

/// Calls that give other bits on other platforms, in crates whose results are pictures.
const PLATFORM_MATH: [&str; 14] = [
    ".sin()",
    ".cos()",
    ".tan()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".exp()",
    ".ln()",
    ".powf(",
    ".powi(",
    ".mul_add(",
    ".cbrt()",
    ".sin_cos()",
];

/// Lines in a file from which a second look is asked.
const LONG: usize = 600;

/// Folders whose files each are one user-visible thing, with the manual at their head.
const KINDS: [&str; 6] = [
    "crates/optics/src/bsdf",
    "crates/render/src/shapes",
    "crates/render/src/textures",
    "crates/render/src/lights",
    "crates/render/src/camera",
    "crates/render/src/integrators",
];

/// `cargo xtask tidy`
pub fn run(_: &[String]) -> Outcome {
    let mut found = Vec::new();
    floors(&mut found);
    for file in ["crates", "bench"].iter().flat_map(|dir| files(&root().join(dir), "rs")) {
        check_source(&file, &mut found);
    }
    for kind in KINDS {
        for file in files(&root().join(kind), "rs") {
            check_manual(&file, &mut found);
        }
    }
    pages(&mut found);
    if found.is_empty() {
        println!("tidy: all in order");
        return Ok(());
    }
    for f in &found {
        eprintln!("{f}");
    }
    Err(format!("{} untidy", found.len()))
}

/// Dependencies run down only.
fn floors(found: &mut Vec<String>) {
    for (name, allowed) in FLOORS {
        let path = root().join("crates").join(name).join("Cargo.toml");
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let own = text.split("[dev-dependencies]").next().unwrap_or_default();
        let deps = own.split("[dependencies]").nth(1).unwrap_or_default();
        for dep in deps.lines().filter_map(|l| l.strip_prefix("kirkas-")) {
            let dep = dep.split(['.', ' ', '=']).next().unwrap_or_default();
            if !allowed.contains(&dep) {
                found.push(format!(
                    "{}: `{name}` must not depend on `{dep}`: dependencies run down only",
                    path.display()
                ));
            }
        }
    }
}

fn check_source(path: &Path, found: &mut Vec<String>) {
    let Ok(text) = fs::read_to_string(path) else { return };
    let shown = path.strip_prefix(root()).unwrap_or(path).display().to_string();
    let mut parts = shown.split('/').skip(1);
    let name = parts.next().unwrap_or_default();
    let is_source = parts.next() == Some("src");
    let lines = text.lines().count();
    if lines > LONG {
        found.push(format!("{shown}: {lines} lines: two subjects in one room?"));
    }
    if !is_source {
        return;
    }
    // What follows the tests' heading is not part of the room.
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    for (number, line) in code.lines().enumerate() {
        let line = line.split("//").next().unwrap_or_default();
        let mut say = |what: String| found.push(format!("{shown}:{}: {what}", number + 1));
        for (_, words) in ABSENT.iter().filter(|a| a.0 == name) {
            for word in words.iter().filter(|w| line.contains(**w)) {
                say(format!("`{name}` knows nothing of `{word}`"));
            }
        }
        let is_exempt = shown.ends_with("elementary.rs") || ["testkit", "cli"].contains(&name);
        for call in PLATFORM_MATH.iter().filter(|c| !is_exempt && line.contains(**c)) {
            say(format!("`{call}` gives other bits elsewhere: use kirkas_geometry::elementary"));
        }
        if line.contains("todo!(") || line.contains("unimplemented!(") {
            say("unfinished".into());
        }
    }
}

/// A file with a table must have its manual at the head.
fn check_manual(path: &Path, found: &mut Vec<String>) {
    let Ok(text) = fs::read_to_string(path) else { return };
    if !text.contains("pub const SPEC: TypeSpec") {
        return;
    }
    let head: String = text.lines().take_while(|l| l.starts_with("//!")).collect::<Vec<_>>().join("\n");
    for part in ["Parameters", "Example", "Limits", "References"] {
        if !head.contains(part) {
            found.push(format!("{}: the manual at its head lacks `{part}`", path.display()));
        }
    }
}

/// Pages that must be there.
fn pages(found: &mut Vec<String>) {
    for page in [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "BENCHMARKS.md",
        "LICENSE-MIT",
        "LICENSE-APACHE",
    ] {
        if !root().join(page).is_file() {
            found.push(format!("{page} is missing"));
        }
    }
    const TWO_PAGES: usize = 130;
    let lines = fs::read_to_string(root().join("ARCHITECTURE.md")).map_or(0, |t| t.lines().count());
    if lines > TWO_PAGES {
        found.push(format!("ARCHITECTURE.md has {lines} lines: two pages are {TWO_PAGES}"));
    }
}

/// All files below `dir` with an extension, in order.
pub fn files(dir: &Path, extension: &str) -> Vec<PathBuf> {
    let mut out = Vec::new();
    let Ok(entries) = fs::read_dir(dir) else { return out };
    for path in entries.flatten().map(|e| e.path()) {
        if path.is_dir() {
            out.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            out.push(path);
        }
    }
    out.sort();
    out
}
