//! `kirkas render`: a scene becomes pictures.

use crate::output::{PictureFile, PictureFormat, check_writable, write_atomically};
use crate::problem::{Outcome, Problem};
use crate::scene_file::SceneFile;
use kirkas_images::{ExrCompression, Texts, ToneCurve, to_srgb8, write_exr, write_hdr, write_png8};
use kirkas_render::film::image::Depth;
use kirkas_render::{Film, Options, prepare};
use std::path::PathBuf;

/// Render a scene to pictures.
#[derive(Debug, clap::Args)]
pub struct Render {
    /// Scene: .toml, .txt (MIT 6.837), .obj or .ply
    scene: PathBuf,
    /// Picture to write: .png, .exr or .hdr; may be given several times
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Samples per pixel
    #[arg(long, value_name = "N")]
    spp: Option<String>,
    /// Size in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Threads to use; all by default
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Which of all pictures of the scene
    #[arg(long, value_name = "N")]
    seed: Option<String>,
    /// Folder below which the scene may read; its own by default
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Set any value of the scene, such as `integrator.max_depth=3`
    #[arg(short = 'D', value_name = "PATH=VALUE")]
    set: Vec<String>,
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let (w, h) = text.split_once('x').ok_or("write it as WxH, such as 640x480")?;
    let side = |s: &str| s.parse::<u32>().ok().filter(|v| (1..=65_536).contains(v));
    side(w).zip(side(h)).ok_or_else(|| "sides go from 1 to 65536".to_string())
}

/// Do it.
pub fn run(args: &Render) -> Result<Outcome, Problem> {
    let default = PathBuf::from(args.scene.file_stem().unwrap_or_default()).with_extension("png");
    let paths = if args.output.is_empty() { vec![default] } else { args.output.clone() };
    let outputs = paths.iter().map(|p| PictureFile::new(p)).collect::<Result<Vec<_>, _>>()?;
    outputs.iter().try_for_each(|o| check_writable(&o.path))?;
    if let Some(n) = args.threads {
        let _ = rayon::ThreadPoolBuilder::new().num_threads(n).build_global();
    }
    let mut scene = SceneFile::open(&args.scene, args.root.as_deref())?;
    let mut sets = args.set.clone();
    sets.extend(args.spp.iter().map(|v| format!("sampler.samples={v}")));
    sets.extend(args.seed.iter().map(|v| format!("sampler.seed={v}")));
    sets.extend(args.size.iter().flat_map(|(w, h)| [format!("film.width={w}"), format!("film.height={h}")]));
    for set in &sets {
        if let Err(d) = kirkas_formats::toml::apply_override(&mut scene.description, set) {
            return Err(scene.failure(vec![d]).into());
        }
    }
    let options = Options::default();
    let prepared = prepare(&scene.description, &scene.assets(), &options);
    let prepared = prepared.map_err(|d| Problem::from(scene.failure(d)))?;
    let warnings = scene.failure(prepared.warnings.clone());
    crate::report::print(&warnings.sources, &warnings.diagnostics);
    let mut film = Film::new(prepared.film.clone());
    prepared.renderer(64).render(&mut film, 0..prepared.samples, &kirkas_render::render::Undisturbed);
    let rgb = film.to_rgb();
    for output in &outputs {
        let texts = Texts::new();
        let bytes = match output.format {
            PictureFormat::Png => {
                let curve = ToneCurve::from_name(&prepared.tone).unwrap_or_default();
                write_png8(rgb.width, rgb.height, &to_srgb8(&rgb, prepared.exposure, curve), &texts)
            }
            PictureFormat::Hdr => write_hdr(&rgb, &texts),
            PictureFormat::Exr => write_exr(&film.to_image(Depth::Float), ExrCompression::Zip),
        };
        let bytes = bytes.map_err(|e| Problem::failed(kirkas_scene::Diagnostic::error("cannot-write", e.to_string())))?;
        write_atomically(&output.path, &bytes)?;
    }
    Ok(Outcome::Done)
}
