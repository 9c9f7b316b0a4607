//! Every listed type has a manual at the head of its file, and the manual's example is a scene that validates.

use kirkas_formats::toml;
use kirkas_render::catalog;
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_scene::validate::validate;
use std::fs;
use std::path::Path;

/// Folders in which one file is one type, beside this crate's own.
const FOLDERS: [&str; 9] = [
    "../optics/src/bsdf",
    "../optics/src/phase",
    "src/media",
    "src/shapes",
    "src/lights",
    "src/textures",
    "src/camera",
    "src/integrators",
    "src/background",
];

/// `(file, example)` for every file with a table.
fn examples() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for folder in FOLDERS.into_iter().chain(["src/sampler"]) {
        for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap().flatten() {
            let text = fs::read_to_string(entry.path()).unwrap_or_default();
            if !text.contains("pub const SPEC: TypeSpec") {
                continue;
            }
            let head: Vec<&str> = text.lines().take_while(|l| l.starts_with("//!")).collect();
            let strip = |l: &&str| l.trim_start_matches("//!").strip_prefix(' ').unwrap_or("").to_string();
            let mut lines = head.iter().map(strip).skip_while(|l| !l.starts_with("```toml")).skip(1);
            let example: Vec<String> = lines.by_ref().take_while(|l| !l.starts_with("```")).collect();
            found.push((entry.path().display().to_string(), example.join("\n")));
        }
    }
    found
}

#[test]
fn every_manual_has_an_example_that_validates() {
    let examples = examples();
    let catalog = catalog();
    assert!(examples.len() >= 30, "only {} manuals", examples.len());
    for (file, example) in &examples {
        assert!(!example.trim().is_empty(), "{file}: no example");
        let files = MemoryFiles([("example.toml".to_string(), example.clone().into_bytes())].into());
        let access = FileAccess::new(Box::new(files), Limits::default());
        let description = match toml::read(&access, "example.toml") {
            Ok(d) => d,
            Err(e) => panic!("{file}: {:?}", e.diagnostics),
        };
        // An example may lean on things that it does not show.
        let shown_elsewhere =
            ["unknown material `", "unknown texture `", "unknown object `", "unknown phase `", "unknown medium `"];
        for d in validate(&description, &catalog) {
            assert!(shown_elsewhere.iter().any(|s| d.message.starts_with(s)), "{file}: {}", d.message);
        }
    }
}

#[test]
fn every_listed_type_is_shown_by_some_example() {
    let all: String = examples().into_iter().map(|e| e.1).collect();
    let catalog = catalog();
    use kirkas_scene::Kind::{Camera, Integrator, Light, Material, Object, Sampler, Texture};
    for kind in [Camera, Integrator, Light, Material, Object, Sampler, Texture] {
        for spec in catalog.of_kind(kind) {
            let shown = all.contains(&format!("type = \"{}\"", spec.name));
            assert!(shown, "no manual shows {} `{}`", kind.singular(), spec.name);
        }
    }
}
