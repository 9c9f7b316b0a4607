//! `kirkas render`: a scene becomes pictures.

use crate::aov_args::{self, AovArg};
use crate::conductor::{watch_for_stops, why_to_stop};
use crate::denoise::Denoiser;
use crate::frames;
use crate::header::Header;
use crate::job::Job;
use crate::output::{PictureFile, PictureFormat, check_no_loss, true_place};
use crate::pictures::Development;
use crate::places::Places;
use crate::problem::{Outcome, Problem};
use crate::progress::Progress;
use crate::ranges::parse_range;
use crate::report;
use crate::scene_file::SceneFile;
use crate::settings::{SceneArgs, Settings};
use crate::stats::Seconds;
use clap::ArgGroup;
use kirkas_render::film::SpectralBins;
use kirkas_render::{Options, Prepared, Rect, prepare};
use kirkas_scene::{Diagnostic, Kind};
use std::ops::Range;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const EXAMPLES: &str = "Examples:
  kirkas render scenes/sphereflake.toml -o flake.png
  kirkas render scene.toml -o out.exr -o out.png --spp 256 --aov depth,normals
  kirkas render scene.toml --error 0.02 --aov sample_count -o out.exr
  kirkas render scene.toml --color spectral --spectral-bins 40 -o spectra.exr
  kirkas render scene.toml --light-groups --samples 0..256 -o lights.exr
  kirkas render scene.toml --spp 4096 --checkpoint night.exr --resume -o out.exr
  kirkas render scene.toml --frames 0..48 --resume -o out.####.png -D film.frames_per_second=25
  ffmpeg -framerate 25 -i out.%04d.png -pix_fmt yuv420p out.mp4";

/// Render a scene to pictures
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, group = ArgGroup::new("resumable").args(["checkpoint", "frames"]).multiple(true))]
pub struct Render {
    #[command(flatten)]
    scene: SceneArgs,
    /// Picture to write: .png, .exr or .hdr; may be given several times [default: SCENE.png]
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// How light is found
    #[arg(long, value_name = "NAME")]
    integrator: Option<String>,
    /// Samples per pixel; with --error, at most
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    spp: Option<i64>,
    /// Sample blocks of 8x8 pixels until the noise of each is below this share of its brightness
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = finite)]
    error: Option<f64>,
    /// Size of the whole image in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(i64, i64)>,
    /// Which of all pictures of the scene
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<i64>,
    /// Threads to use [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Light as rgb, or spectral: as wavelengths
    #[arg(long, value_name = "MODE")]
    color: Option<String>,
    /// With --color spectral, an EXR also keeps the spectrum of each pixel: N layers of mean radiance per nm, from 380 to 780 nm
    /// or LO to HI
    #[arg(long, value_name = "N[:LO..HI]", allow_negative_numbers = true, value_parser = spectral_bins)]
    spectral_bins: Option<SpectralBins>,
    /// How rays find surfaces
    #[arg(long, value_name = "NAME")]
    accel: Option<String>,
    /// Which of the scene's cameras
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Render only this part: pixels from the top left
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<Rect>,
    /// Render a film: frames from A up to, not including, B. Frame n opens the shutter at n / film.frames_per_second seconds;
    /// OUT.png becomes OUT.0007.png, and a run of # in a name (OUT.###.png) becomes the number
    #[arg(long, value_name = "A..B", value_parser = frames::parse, conflicts_with = "time")]
    frames: Option<Range<u32>>,
    /// Open the shutter at this time, in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = finite)]
    time: Option<f64>,
    /// Finish the pass that runs after so many seconds, then write; begin no other frame
    #[arg(long, value_name = "SECONDS", value_parser = not_negative)]
    time_limit: Option<f64>,
    /// Render only these samples of each pixel, to be merged: from A up to, not including, B
    #[arg(long, value_name = "A..B", value_parser = samples, conflicts_with = "spp")]
    samples: Option<Range<u32>>,
    /// Keep what is done in this file, now and then
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Go on from the checkpoint; with --frames, leave finished frames as they are
    #[arg(long, requires = "resumable")]
    pub resume: bool,
    /// From one checkpoint to the next
    #[arg(long, value_name = "SECONDS", hide = true, default_value_t = 20)]
    pub checkpoint_seconds: u64,
    /// Extra layers: depth[:NEAR:FAR], normals, albedo, position, object_id, material_id, sample_count, variance
    #[arg(long, value_name = "NAME[:ARGS],...", value_delimiter = ',')]
    aov: Vec<String>,
    /// Keep one EXR layer per light, or group of lights, for `kirkas relight`
    #[arg(long)]
    light_groups: bool,
    /// Remove the noise with Open Image Denoise, if it is installed; the noisy picture is kept as OUT.noisy.png, and in an EXR
    /// the denoised one is the layer `denoised`
    #[arg(long)]
    denoise: bool,
    /// Write what it cost as JSON; `-` is stdout
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Show no progress and no warnings
    #[arg(long)]
    pub quiet: bool,
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
    #[arg(long, value_name = "N", hide = true, default_value_t = 256, value_parser = clap::value_parser!(u16).range(1..))]
    pub flock: u16,
}

/// Do it.
pub fn run(args: &Render, started: Instant) -> Result<Outcome, Problem> {
    // What can be refused before any work.
    let aovs = aov_args::parse(&args.aov)?;
    let places = Places {
        pictures: output_files(args)?,
        stats: args.stats.clone().filter(|p| p.as_os_str() != "-"),
        checkpoint: args.checkpoint.clone(),
    };
    check_bins(args, &places.pictures)?;
    let denoiser = args.denoise.then(Denoiser::find).transpose()?;
    let frames: Vec<Option<u32>> = args.frames.clone().map_or(vec![None], |all| all.map(Some).collect());
    let places_of = |frame: Option<u32>| match (frame, &args.frames) {
        (Some(n), Some(all)) => places.of_frame(n, all),
        _ => places.clone(),
    };
    places_of(frames[0]).check()?;
    if !args.resume {
        frames.iter().try_for_each(|&frame| places_of(frame).check_checkpoint())?;
    }
    if let Some(n) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(n));
        pool.build_global().map_err(|e| Problem::failed(Diagnostic::error("no-threads", e.to_string())))?;
    }

    // Load and compile.
    let mut scene = SceneFile::open(&args.scene.scene, args.scene.root.as_deref())?;
    let overrides = apply(args, &mut scene)?;
    let mut seconds = Seconds { load: started.elapsed().as_secs_f64(), ..Seconds::default() };
    let kept = aov_args::set(&aovs).with(if denoiser.is_some() { &["albedo", "normals"] } else { &[] });
    let options = Options { crop: args.crop, aovs: kept, frame: frames[0] };
    let build_started = Instant::now();
    let prepared = prepare(&scene.description, &scene.assets(), &options);
    let mut prepared = prepared.map_err(|d| Problem::from(scene.failure(d)))?;
    seconds.build = build_started.elapsed().as_secs_f64();
    // A moment was asked for.
    prepared.warnings.retain(|w| args.time.is_none() || w.code != "no-shutter");
    let warnings = scene.failure([scene.warnings.clone(), prepared.warnings.clone(), scene.mesh_warnings()].concat());
    if !args.quiet {
        report::print(&warnings.sources, &warnings.diagnostics);
    }

    let samples = args.samples.clone().unwrap_or(0..prepared.samples);
    check_limit(&prepared, &samples)?;
    if prepared.target.is_some() && args.samples.is_some() {
        let message = "adaptive sampling looks at all samples so far, so it cannot render some of them";
        let help = "leave out --samples, or give `-D sampler.error=0`";
        return Err(Problem::input(Diagnostic::error("adaptive-part", message).help(help)));
    }

    // Nothing that the scene was made of may be lost.
    let development = development(args, &prepared, aovs, denoiser);
    let inputs: Vec<PathBuf> = scene.files.record().keys().map(|k| true_place(&scene.root.join(k))).collect();
    for &frame in &frames {
        check_no_loss(places_of(frame).all(&development).iter().map(PathBuf::as_path), &inputs)?;
    }

    // Render picture after picture.
    let scene_name = args.scene.scene.to_string_lossy();
    let mut header = Header::new(&scene_name, &scene.files, &overrides, prepared.seed);
    header.set("aov", aov_args::text(&development.aovs));
    header.set("error", prepared.target.map_or(String::new(), |t| t.error.to_string()));
    header.set("clamp", if prepared.clamp > 0.0 { prepared.clamp.to_string() } else { String::new() });
    header.set("strata", prepared.sampler.limit().map_or(String::new(), |n| n.to_string()));
    header.set("color", prepared.scene.color.name());
    header.set("crop", args.crop.map_or(String::new(), |c| format!("{},{},{},{}", c.x0, c.y0, c.x1, c.y1)));
    let job = Job {
        args,
        samples,
        development,
        deadline: args.time_limit.and_then(|s| started.checked_add(Duration::try_from_secs_f64(s).ok()?)),
        warnings: warnings.diagnostics,
        progress: Progress::new(args.quiet, args.frames.as_ref().map(Range::len)),
    };
    watch_for_stops();
    let (mut begun, mut is_first, mut skipped) = (started, true, 0);
    for &frame in &frames {
        let places = places_of(frame);
        if let Some(n) = frame {
            header.set("frame", n.to_string());
            job.progress.begin(n);
            if args.resume && job.is_done(&header, &places) {
                job.progress.end(true);
                skipped += 1;
                continue;
            }
            if let Some(why) = why_to_stop(job.deadline).filter(|_| !is_first) {
                job.progress.suspend(|| report::note(format_args!("kirkas: {why} before frame {n}")));
                break;
            }
            if prepared.frame != frame {
                let build_started = Instant::now();
                prepared = prepared.at_frame(n).map_err(|d| Problem::from(scene.failure(d)))?;
                seconds.build += build_started.elapsed().as_secs_f64();
            }
        }
        if !job.render(&prepared, header.clone(), &places, (seconds, begun))? {
            break;
        }
        job.progress.end(false);
        (seconds, begun, is_first) = (Seconds::default(), Instant::now(), false);
    }
    if skipped > 0 && !args.quiet {
        let all = frames.len();
        job.progress.suspend(|| report::note(format_args!("kirkas: {skipped} of {all} frames were finished already")));
    }
    Ok(Outcome::Done)
}

fn output_files(args: &Render) -> Result<Vec<PictureFile>, Problem> {
    let default = || PathBuf::from(args.scene.scene.file_stem().unwrap_or_default()).with_extension("png");
    let paths = if args.output.is_empty() { vec![default()] } else { args.output.clone() };
    paths.iter().map(|p| PictureFile::new(p)).collect()
}

/// Only an EXR, or a checkpoint, has layers for spectral bins.
fn check_bins(args: &Render, pictures: &[PictureFile]) -> Result<(), Problem> {
    let has_layers = args.checkpoint.is_some() || pictures.iter().any(|p| p.format == PictureFormat::Exr);
    match args.spectral_bins {
        Some(_) if !has_layers => {
            let message = "only an EXR keeps spectral bins, and none is to be written";
            Err(Problem::input(Diagnostic::error("no-layers", message).help("add an EXR: `-o OUT.exr`")))
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
    if let Some(error) = args.error {
        set.error_target(error);
    }
    if let Some(n) = args.spp {
        set.samples(n);
    }
    if args.light_groups {
        set.flag("--light-groups", "film.light_groups", true);
    }
    if let Some(n) = args.seed {
        set.flag("--seed", "sampler.seed", n);
    }
    if let Some(name) = &args.color {
        set.flag("--color", "film.color", name.as_str());
    }
    if let Some(bins) = args.spectral_bins {
        set.spectral_bins(bins);
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

fn development(args: &Render, prepared: &Prepared, aovs: Vec<AovArg>, denoiser: Option<Denoiser>) -> Development {
    Development {
        exposure: prepared.exposure,
        tone: prepared.tone.clone(),
        is_half: args.half,
        keeps_integers: args.samples.is_some(),
        denoiser,
        aovs,
    }
}

/// Some samplers have only so many samples.
fn check_limit(prepared: &Prepared, samples: &Range<u32>) -> Result<(), Problem> {
    match prepared.sampler.limit().filter(|&limit| limit < samples.end) {
        None => Ok(()),
        Some(limit) => {
            let message = format!("this sampler has {limit} samples per pixel, so it cannot give samples {samples:?}");
            let help = format!(
                "make it for all of them, with `-D sampler.samples={}`, or take one that goes on and on, such as `sobol`",
                samples.end
            );
            Err(Problem::input(Diagnostic::error("no-more-samples", message).help(help)))
        }
    }
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

fn spectral_bins(text: &str) -> Result<SpectralBins, String> {
    let (most, [low, high]) = (SpectralBins::MOST, SpectralBins::RANGE);
    SpectralBins::parse(text).ok_or_else(|| {
        format!(
            "write a number of bins from 1 to {most}, such as 40, or with a range within {low}..{high} nm: 30:400..700"
        )
    })
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
