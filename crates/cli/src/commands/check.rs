//! `kirkas check`: everything that is wrong or suspicious in a scene, without rendering it.

use crate::output::print_out;
use crate::problem::{Outcome, Problem};
use crate::report;
use crate::scene_file::SceneFile;
use crate::settings::{SceneArgs, Settings};
use kirkas_accel::Shape;
use kirkas_formats::Failure;
use kirkas_render::{Options, Scene, prepare};
use kirkas_scene::{Description, Kind};

const EXAMPLES: &str = "Examples:
  kirkas check scene.toml
  kirkas check scene.txt --strict";

/// Say everything that is wrong or suspicious in a scene
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Check {
    #[command(flatten)]
    scene: SceneArgs,
    /// Take warnings for errors
    #[arg(long)]
    strict: bool,
}

/// Do it.
pub fn run(args: &Check) -> Result<Outcome, Problem> {
    let mut scene = SceneFile::open(&args.scene.scene, args.scene.root.as_deref())?;
    let mut settings = Settings::new(&mut scene);
    settings.overrides(&args.scene.set);
    settings.finish()?;
    let prepared = prepare(&scene.description, &scene.assets(), &Options::default());
    let found = match &prepared {
        Ok(p) => p.warnings.clone(),
        Err(errors) => errors.clone(),
    };
    let Failure { sources, diagnostics } =
        scene.failure([scene.warnings.clone(), found, scene.mesh_warnings()].concat());
    report::print(&sources, &diagnostics);
    let errors = diagnostics.iter().filter(|d| d.is_error()).count();
    let warnings = diagnostics.len() - errors;
    let mut text =
        format!("{}: {}, {}\n", args.scene.scene.display(), counted(errors, "error"), counted(warnings, "warning"));
    if let Ok(p) = &prepared {
        text += &summary(&scene, &p.scene);
    }
    print_out(text.as_bytes())?;
    let is_bad = errors > 0 || (args.strict && warnings > 0);
    Ok(if is_bad { Outcome::BadInput } else { Outcome::Done })
}

fn summary(file: &SceneFile, scene: &Scene) -> String {
    let d: &Description = &file.description;
    let geometry = scene.accel.scene_geometry();
    let shapes =
        || geometry.world.iter().chain(geometry.aggregates.iter().flat_map(|a| &a.geometries)).map(|g| &g.shape);
    let triangles: usize = shapes().filter(|s| matches!(s, Shape::Triangles { .. })).map(|s| s.len()).sum();
    let built = scene.accel.statistics();
    let files = file.files.record();
    let bytes: u64 = files.keys().filter_map(|f| std::fs::metadata(file.root.join(f)).ok()).map(|m| m.len()).sum();
    let rows = [
        ("cameras", d.all(Kind::Camera).len()),
        ("lights", scene.lights.len() + scene.ambient.len()),
        ("textures", d.all(Kind::Texture).len()),
        ("materials", scene.materials.len()),
        ("objects", d.all(Kind::Object).len()),
        ("instances", built.instances),
        ("primitives", built.primitives),
        ("triangles", triangles),
        ("files", files.len()),
    ];
    let mut text: String = rows.iter().map(|(name, n)| format!("  {name:<12}{n:>12}\n")).collect();
    for p in scene.textures.pictures() {
        let meaning = if p.is_srgb { "sRGB" } else { "linear" };
        let why = if p.is_chosen { "as told" } else { "by its kind" };
        text += &format!("  picture {}: {} x {}, {meaning} ({why})\n", p.path, p.size.0, p.size.1);
    }
    text += &format!("  {:<12}{bytes:>12}\n  {:<12}{:>12}\n", "file bytes", "tree bytes", built.bytes);
    text
}

fn counted(n: usize, what: &str) -> String {
    match n {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}
