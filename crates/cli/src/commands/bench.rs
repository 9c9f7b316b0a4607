//! `kirkas bench`: how fast the structures are built over a scene's own geometry, and how fast they answer.

use crate::bench_table::{Answers, Row, json, table};
use crate::output::{check_writable, print_out, write_atomically};
use crate::problem::{Outcome, Problem};
use crate::scene_file::SceneFile;
use crate::settings::{SceneArgs, Settings};
use kirkas_accel::ray_sets::{DEFAULT_SIDE, Pinhole, RaySet, Setup, nearest_in, rays};
use kirkas_accel::{Accel, AccelKind, Counters, Query, SceneGeometry, Serial};
use kirkas_geometry::{Ray, Vec3};
use kirkas_render::camera::CameraSample;
use kirkas_render::{Options, Prepared, prepare};
use kirkas_scene::Diagnostic;
use kirkas_scene::diagnostic::nearest;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const EXAMPLES: &str = "Examples:
  kirkas bench build scenes/sphereflake.toml
  kirkas bench rays bunny.ply
  kirkas bench rays scene.toml --accel bvh2,bvh8 --side 1024 --json speed.json";

/// Measure how rays find surfaces, on one thread
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, arg_required_else_help = true)]
pub struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Build each structure, and ask it for the hits of fixed sets of rays
    #[command(after_help = EXAMPLES)]
    Rays(Rays),
    /// Build each structure
    #[command(after_help = EXAMPLES)]
    Build(Build),
}

#[derive(Debug, clap::Args)]
struct Build {
    #[command(flatten)]
    scene: SceneArgs,
    /// Structures to measure [default: all, brute_force only up to 10,000 primitives]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    accel: Vec<String>,
    /// Repeat each measurement for so long; the best counts
    #[arg(long, value_name = "SECONDS", default_value_t = 0.5)]
    seconds: f64,
    /// Write all figures as JSON; `-` is stdout, instead of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
struct Rays {
    #[command(flatten)]
    build: Build,
    /// Rays on a side of each set, a power of two: N x N rays
    #[arg(long, value_name = "N", default_value_t = DEFAULT_SIDE, value_parser = side)]
    side: u32,
}

/// Primitives from which brute force is measured only when asked for.
const MOST_FOR_BRUTE_FORCE: usize = 10_000;

/// Do it.
pub fn run(args: &Bench) -> Result<Outcome, Problem> {
    let (args, side) = match &args.what {
        What::Build(build) => (build, None),
        What::Rays(rays) => (&rays.build, Some(rays.side)),
    };
    let asked = args.accel.iter().map(|name| kind(name)).collect::<Result<Vec<_>, _>>()?;
    let json_file = args.json.as_ref().filter(|p| p.as_os_str() != "-");
    json_file.map_or(Ok(()), |path| check_writable(path))?;

    // The scene's own geometry, and rays from its own camera.
    let mut scene = SceneFile::open(&args.scene.scene, args.scene.root.as_deref())?;
    let mut settings = Settings::new(&mut scene);
    settings.overrides(&args.scene.set);
    settings.finish()?;
    let prepared = prepare(&scene.description, &scene.assets(), &Options::default());
    let prepared = prepared.map_err(|d| Problem::from(scene.failure(d)))?;
    let geometry = prepared.scene.accel.scene_geometry().clone();
    let sets = side.map_or(Vec::new(), |side| ray_sets(&prepared, side));

    // Measure.
    let primitives = prepared.scene.accel.statistics().primitives;
    let is_fast = |k: AccelKind| k != AccelKind::BruteForce || primitives <= MOST_FOR_BRUTE_FORCE;
    let usual = || AccelKind::ALL.into_iter().map(|k| k.0).filter(|&k| is_fast(k)).collect();
    let kinds: Vec<AccelKind> = if asked.is_empty() { usual() } else { asked };
    let patience = Duration::try_from_secs_f64(args.seconds).unwrap_or_default();
    let mut rows = Vec::new();
    let mut first: Vec<Found> = Vec::new();
    for kind in kinds {
        let (accel, build) = built(kind, &geometry, patience)?;
        let mut answers = Vec::new();
        for (i, (set, name, rays)) in sets.iter().enumerate() {
            let (found, mut answer) = answered(&accel, *set, rays, patience);
            answer.set = name;
            answers.push(answer);
            match first.get(i) {
                None => first.push(found),
                Some(expected) if *expected != found => return Err(disagreement(rows.first(), kind, name)),
                Some(_) => {}
            }
        }
        rows.push(Row { name: kind.name(), build, statistics: accel.statistics(), answers });
    }

    // Tell.
    let title = args.scene.scene.to_string_lossy();
    if json_file.is_some() || args.json.is_none() {
        print_out(table(&title, &rows).as_bytes())?;
    }
    if args.json.is_some() {
        let text = format!("{:#}\n", json(&title, &scene.files.scene_hash(), side, &rows));
        match json_file {
            Some(path) => write_atomically(path, text.as_bytes())?,
            None => print_out(text.as_bytes())?,
        }
    }
    Ok(Outcome::Done)
}

/// What a structure found for a set of rays: all give the same.
#[derive(PartialEq)]
enum Found {
    Nearest(Vec<Option<kirkas_accel::Hit>>),
    Any(Vec<bool>),
}

/// Build, again and again for `patience`; the shortest time in seconds.
fn built(kind: AccelKind, geometry: &SceneGeometry, patience: Duration) -> Result<(Accel, f64), Problem> {
    let begun = Instant::now();
    let mut best = f64::INFINITY;
    loop {
        let scene = geometry.clone();
        let start = Instant::now();
        let accel = Accel::build(kind, scene, &Serial);
        best = best.min(start.elapsed().as_secs_f64());
        let accel = accel.map_err(|e| Problem::input(Diagnostic::error("bad-geometry", e.to_string())))?;
        if begun.elapsed() >= patience {
            return Ok((accel, best));
        }
    }
}

/// Answer, again and again for `patience`; the shortest time counts.
fn answered(accel: &Accel, set: RaySet, rays: &[Ray], patience: Duration) -> (Found, Answers) {
    let mut found = match set.asks_any() {
        true => Found::Any(vec![false; rays.len()]),
        false => Found::Nearest(vec![None; rays.len()]),
    };
    let begun = Instant::now();
    let mut best = f64::INFINITY;
    let counters = loop {
        let mut counters = Counters::default();
        let start = Instant::now();
        match &mut found {
            Found::Any(blocked) => accel.any_hits(rays, Query::ALL, blocked, &mut counters),
            Found::Nearest(hits) => accel.closest_hits(rays, Query::ALL, hits, &mut counters),
        }
        best = best.min(start.elapsed().as_secs_f64());
        if begun.elapsed() >= patience {
            break counters;
        }
    };
    let hits = match &found {
        Found::Any(blocked) => blocked.iter().filter(|b| **b).count(),
        Found::Nearest(hits) => hits.iter().flatten().count(),
    };
    (found, Answers { set: "", rays: rays.len(), hits, seconds: best, counters })
}

/// Every set of rays, with its name.
fn ray_sets(prepared: &Prepared, side: u32) -> Vec<(RaySet, &'static str, Vec<Ray>)> {
    let accel = &prepared.scene.accel;
    let setup = Setup { camera: pinhole(prepared), bounds: accel.bounds(), side, seed: prepared.seed };
    RaySet::ALL.into_iter().map(|(set, name)| (set, name, rays(set, &setup, nearest_in(accel)))).collect()
}

/// The scene's camera as a pinhole. One without perspective sees as much at the middle of the scene.
fn pinhole(prepared: &Prepared) -> Pinhole {
    let (width, height) = prepared.film.size;
    let (w, h) = (f64::from(width), f64::from(height));
    let camera = &prepared.scene.camera;
    let ray = |film| {
        let sample = CameraSample { film, lens: (0.5, 0.5), time: camera.shutter().0 };
        camera.ray(&sample, prepared.film.size)
    };
    let middle = ray((w / 2.0, h / 2.0));
    let distance = prepared.scene.accel.bounds().center().distance(middle.origin).max(f32::MIN_POSITIVE);
    let to = |edge: Ray| -> Vec3 {
        let slope = edge.direction / edge.direction.dot(middle.direction) - middle.direction;
        slope + (edge.origin - middle.origin) / distance
    };
    Pinhole { eye: middle.origin, forward: middle.direction, right: to(ray((w, h / 2.0))), up: to(ray((w / 2.0, 0.0))) }
}

fn kind(name: &str) -> Result<AccelKind, Problem> {
    AccelKind::parse(name.trim()).ok_or_else(|| {
        let near = nearest(name, AccelKind::NAMES).map(|n| format!("did you mean `{n}`?"));
        let all = || format!("there are {}", AccelKind::NAMES.map(|n| format!("`{n}`")).join(", "));
        let (message, help) = (format!("there is no structure `{name}`"), near.unwrap_or_else(all));
        Problem::input(Diagnostic::error("unknown-structure", message).help(help))
    })
}

fn disagreement(first: Option<&Row>, kind: AccelKind, set: &str) -> Problem {
    let other = first.map_or("", |row| row.name);
    let message = format!("`{}` and `{other}` find other hits for the rays `{set}`", kind.name());
    Problem::failed(Diagnostic::error("other-hits", message).help("this is a fault of Kirkas: please report it"))
}

fn side(text: &str) -> Result<u32, String> {
    let is_good = |n: &u32| n.is_power_of_two() && *n <= 8192;
    text.parse().ok().filter(is_good).ok_or_else(|| "write a power of two up to 8192, such as 512".into())
}
