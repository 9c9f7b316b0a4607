//! `kirkas render`: a scene becomes pictures.

use crate::aov_args::{self, AovArg};
use crate::checkpoint::{self, Checkpoint};
use crate::conductor::{Conductor, watch_for_stops};
use crate::header::Header;
use crate::output::{PictureFile, check_no_loss, check_writable, print_out, write_atomically};
use crate::parts::tell_samples;
use crate::pictures::Development;
use crate::problem::{Outcome, Problem};
use crate::ranges::parse_range;
use crate::report;
use crate::scene_file::SceneFile;
use crate::settings::{SceneArgs, Settings};
use crate::stats::{Seconds, stats_json};
use kirkas_render::{Film, Options, Prepared, Rect, prepare};
use kirkas_scene::{Diagnostic, Kind};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const EXAMPLES: &str = "Examples:
  kirkas render scenes/sphereflake.toml -o flake.png
  kirkas render scene.toml -o out.exr -o out.png --spp 256 --aov depth,normals
  kirkas render scene.toml --spp 4096 --checkpoint night.exr --resume -o out.exr";

/// Render a scene to pictures
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Render {
    #[command(flatten)]
    scene: SceneArgs,
    /// Picture to write: .png, .exr or .hdr; may be given several times [default: SCENE.png]
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// How light is found
    #[arg(long, value_name = "NAME")]
    integrator: Option<String>,
    /// Samples per pixel
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    spp: Option<i64>,
    /// Size of the whole image in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(i64, i64)>,
    /// Which of all pictures of the scene
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<i64>,
    /// Threads to use [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// How rays find surfaces
    #[arg(long, value_name = "NAME")]
    accel: Option<String>,
    /// Which of the scene's cameras
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Render only this part: pixels from the top left
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<Rect>,
    /// Open the shutter at this time, in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = finite)]
    time: Option<f64>,
    /// Finish the pass that runs after so many seconds, then write
    #[arg(long, value_name = "SECONDS", value_parser = not_negative)]
    time_limit: Option<f64>,
    /// Render only these samples of each pixel, to be merged: from A up to, not including, B
    #[arg(long, value_name = "A..B", value_parser = samples, conflicts_with = "spp")]
    samples: Option<Range<u32>>,
    /// Keep what is done in this file, now and then
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Go on from the checkpoint
    #[arg(long, requires = "checkpoint")]
    resume: bool,
    /// From one checkpoint to the next
    #[arg(long, value_name = "SECONDS", hide = true, default_value_t = 20)]
    checkpoint_seconds: u64,
    /// Extra layers: depth[:NEAR:FAR], normals, albedo, position, object_id, material_id, sample_count, variance
    #[arg(long, value_name = "NAME[:ARGS],...", value_delimiter = ',')]
    aov: Vec<String>,
    /// Write what it cost as JSON; `-` is stdout
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Show no progress and no warnings
    #[arg(long)]
    quiet: bool,
    /// EXR in 16 bits instead of 32
    #[arg(long)]
    half: bool,
    /// Brightness of PNG pictures in stops
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = finite)]
    exposure: Option<f64>,
    /// Tone curve of PNG pictures: linear, filmic, aces, raw
    #[arg(long, value_name = "NAME")]
    tone: Option<String>,
    /// Rays that travel together
    #[arg(long, value_name = "N", hide = true, default_value_t = 64, value_parser = clap::value_parser!(u16).range(1..))]
    flock: u16,
}

/// Do it.
pub fn run(args: &Render, started: Instant) -> Result<Outcome, Problem> {
    // What can be refused before any work.
    let aovs = aov_args::parse(&args.aov)?;
    let files = output_files(args)?;
    check_places(args, &files)?;
    if let Some(n) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(n));
        pool.build_global().map_err(|e| Problem::failed(Diagnostic::error("no-threads", e.to_string())))?;
    }

    // Load and compile.
    let mut scene = SceneFile::open(&args.scene.scene, args.scene.root.as_deref())?;
    let overrides = apply(args, &mut scene)?;
    let mut seconds = Seconds { load: started.elapsed().as_secs_f64(), ..Seconds::default() };
    let options = Options { crop: args.crop, aovs: aov_args::set(&aovs) };
    let build_started = Instant::now();
    let prepared = prepare(&scene.description, &scene.assets(), &options);
    let prepared = prepared.map_err(|d| Problem::from(scene.failure(d)))?;
    seconds.build = build_started.elapsed().as_secs_f64();
    let warnings = scene.failure([scene.warnings.clone(), prepared.warnings.clone(), scene.mesh_warnings()].concat());
    if !args.quiet {
        report::print(&warnings.sources, &warnings.diagnostics);
    }

    // Nothing that the scene was made of may be lost.
    let development = development(args, &prepared, aovs);
    let inputs: Vec<PathBuf> = scene.files.record().keys().map(|k| scene.root.join(k)).collect();
    let layers = development.aov_files(&files);
    let outputs = files
        .iter()
        .map(|f| &f.path)
        .chain(layers.iter().map(|l| &l.0))
        .chain(stats_file(args))
        .chain(&args.checkpoint);
    check_no_loss(outputs.map(PathBuf::as_path), &inputs)?;

    // Begin, or go on.
    let samples = args.samples.clone().unwrap_or(0..prepared.samples);
    let scene_name = args.scene.scene.to_string_lossy();
    let mut header = Header::new(&scene_name, &scene.files, &overrides, prepared.seed);
    header.set("aov", aov_args::text(&development.aovs));
    let mut film = first_film(args, &header, &prepared, &samples)?;

    // Render.
    let usual = Duration::from_secs(args.checkpoint_seconds);
    let checkpoint = args.checkpoint.as_ref().map(|path| Checkpoint::new(path, &header, samples.start, usual));
    let wanted = samples.end - samples.start;
    let pixels = prepared.film.crop.area() as u64;
    let done: u64 = film.tiles.iter().flat_map(|t| &t.counts).map(|c| u64::from(c.taken)).sum();
    let deadline = args.time_limit.and_then(|s| started.checked_add(Duration::try_from_secs_f64(s).ok()?));
    watch_for_stops();
    let render_started = Instant::now();
    let conductor = Conductor::new(args.quiet, pixels * u64::from(wanted), done, deadline, checkpoint);
    let counted = conductor.render(&prepared.renderer(usize::from(args.flock)), &mut film, samples.clone());
    seconds.render = render_started.elapsed().as_secs_f64();

    // Write.
    // The checkpoint first: should the pictures fail, nothing is lost.
    let stopped = conductor.finish(&film, wanted);
    let done = tell_samples(&mut header, &film, samples.start);
    development.write(&film, &header, &files)?;
    let stopped = stopped?;
    seconds.total = started.elapsed().as_secs_f64();
    if let Some(path) = &args.stats {
        let warnings = &warnings.diagnostics;
        let json = stats_json(&header.texts(), &prepared, &film, &done, &counted, seconds, warnings);
        let text = format!("{json:#}\n");
        if stats_file(args).is_some() { write_atomically(path, text.as_bytes())? } else { print_out(text.as_bytes())? }
    }
    if let Some(why) = stopped {
        report::note(format_args!("kirkas: {why} after {} of {wanted} samples per pixel", done.end - done.start));
    }
    if film.invalid_samples() > 0 && !args.quiet {
        report::print(&Default::default(), &[invalid_samples(&film)]);
    }
    Ok(Outcome::Done)
}

fn output_files(args: &Render) -> Result<Vec<PictureFile>, Problem> {
    let default = || PathBuf::from(args.scene.scene.file_stem().unwrap_or_default()).with_extension("png");
    let paths = if args.output.is_empty() { vec![default()] } else { args.output.clone() };
    paths.iter().map(|p| PictureFile::new(p)).collect()
}

/// Where the statistics go, unless to stdout (`-`).
fn stats_file(args: &Render) -> Option<&PathBuf> {
    args.stats.as_ref().filter(|p| p.as_os_str() != "-")
}

/// Every file can be written, none is written twice, no checkpoint is lost.
fn check_places(args: &Render, files: &[PictureFile]) -> Result<(), Problem> {
    let mut places: Vec<&Path> = files.iter().map(|f| f.path.as_path()).collect();
    places.extend(stats_file(args).map(PathBuf::as_path));
    places.extend(args.checkpoint.as_deref());
    for (i, place) in places.iter().enumerate() {
        if places[..i].contains(place) {
            let message = format!("`{}` would be written twice", place.display());
            return Err(Problem::input(
                Diagnostic::error("same-file", message).help("give each file a name of its own"),
            ));
        }
        check_writable(place)?;
    }
    match &args.checkpoint {
        Some(path) if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("exr")) => {
            let message = format!("the checkpoint `{}` must be an `.exr`", path.display());
            Err(Problem::input(Diagnostic::error("unknown-format", message).help("give it the extension `.exr`")))
        }
        Some(path) if path.exists() && !args.resume => {
            let message = format!("the checkpoint `{}` exists already", path.display());
            let help = "give --resume to go on from it, or remove it to begin anew";
            Err(Problem::input(Diagnostic::error("checkpoint-exists", message).help(help)))
        }
        _ => Ok(()),
    }
}

/// Set what the options say; the overrides as the header keeps them.
fn apply(args: &Render, scene: &mut SceneFile) -> Result<String, Problem> {
    let mut set = Settings::new(scene);
    // Options have the last word over -D.
    set.overrides(&args.scene.set);
    if let Some(name) = &args.integrator {
        set.type_of("--integrator", Kind::Integrator, name);
    }
    if let Some(name) = &args.accel {
        set.type_of("--accel", Kind::Accelerator, name);
    }
    if let Some((width, height)) = args.size {
        set.flag("--size", "film.width", width);
        set.flag("--size", "film.height", height);
    }
    if let Some(n) = args.spp {
        set.flag("--spp", "sampler.samples", n);
    }
    if let Some(n) = args.seed {
        set.flag("--seed", "sampler.seed", n);
    }
    if let Some(name) = &args.camera {
        set.flag("--camera", "film.camera", name.as_str());
    }
    if let Some(stops) = args.exposure {
        set.flag("--exposure", "film.exposure", stops);
    }
    if let Some(name) = &args.tone {
        set.flag("--tone", "film.tone", name.as_str());
    }
    if let Some(time) = args.time {
        set.time(time);
    }
    set.finish()
}

fn first_film(args: &Render, header: &Header, prepared: &Prepared, samples: &Range<u32>) -> Result<Film, Problem> {
    match args.checkpoint.as_ref().filter(|_| args.resume) {
        Some(path) if path.exists() => checkpoint::load(path, header, &prepared.film, samples),
        Some(path) => {
            report::note(format_args!("kirkas: no checkpoint `{}` yet, beginning anew", path.display()));
            Ok(Film::new(prepared.film.clone()))
        }
        None => Ok(Film::new(prepared.film.clone())),
    }
}

fn development(args: &Render, prepared: &Prepared, aovs: Vec<AovArg>) -> Development {
    Development {
        exposure: prepared.exposure,
        tone: prepared.tone.clone(),
        is_half: args.half,
        keeps_integers: args.samples.is_some(),
        aovs,
    }
}

fn invalid_samples(film: &Film) -> Diagnostic {
    let places: Vec<String> = film
        .tiles
        .iter()
        .flat_map(|t| &t.invalid)
        .take(4)
        .map(|s| format!("pixel {},{} sample {}", s.x, s.y, s.sample))
        .collect();
    let message = format!("{} samples were left out: they were not finite, or absurdly bright", film.invalid_samples());
    Diagnostic::warning("invalid-samples", message).help(format!("look at {}", places.join(", ")))
}

fn size(text: &str) -> Result<(i64, i64), String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    sides.ok_or_else(|| "write WxH, such as 640x480".into())
}

fn crop(text: &str) -> Result<Rect, String> {
    let sides: Option<Vec<u32>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
    match sides.as_deref() {
        Some(&[x0, y0, x1, y1]) => Ok(Rect { x0, y0, x1, y1 }),
        _ => Err("write X0,Y0,X1,Y1, such as 0,0,320,240".into()),
    }
}

fn samples(text: &str) -> Result<Range<u32>, String> {
    match parse_range(text) {
        Some(range) if !range.is_empty() => Ok(range),
        _ => Err("write A..B with A < B, such as 0..20".into()),
    }
}

fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| "write a finite number".into())
}

fn not_negative(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|v| *v >= 0.0).ok_or_else(|| "write a number of seconds, 0 or more".into())
}
