//! `kirkas explain`: why a pixel has its colour.

mod picture;
mod source;
mod worst;

use crate::output::{check_no_loss, check_writable, print_out, true_place, write_atomically};
use crate::problem::{Outcome, Problem};
use crate::progress::Progress;
use crate::ranges::parse_range;
use crate::report;
use kirkas_explain::{Explanation, Style, explain, findings, page, summary, tree};
use kirkas_scene::Diagnostic;
use source::{Source, Verdict};
use std::io::IsTerminal;
use std::ops::Range;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Examples:
  kirkas explain flake.png --pixel 320,240
  kirkas explain out.exr --pixel 320,240 --sample 17
  kirkas explain scene.toml --pixel 320,240 --spp 64 -D integrator.type=path
  kirkas explain out.exr --pixel 320,240 -o pixel.html
  kirkas explain out.exr --pixel 320,240 -o pixel.json
  kirkas explain out.exr --worst 5

A picture's header names its scene, its overrides, its seed and its samples; a scene that has changed since is refused, and the
stored pixel is compared with the one that is traced again. Contributions add up to the pixel's integers exactly.";

/// Tell why a pixel has its colour: the rays that made it, traced again before a recorder
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Explain {
    /// Picture that Kirkas rendered (.exr, .png, .hdr), or a scene
    #[arg(value_name = "IMAGE|SCENE")]
    source: PathBuf,
    /// Column and row, from the top left of the whole image
    #[arg(long, value_name = "X,Y", value_parser = pixel, required_unless_present = "worst")]
    pixel: Option<(u32, u32)>,
    /// Only this sample of it
    #[arg(long, value_name = "K", conflicts_with = "samples")]
    sample: Option<u32>,
    /// Only these samples of it: from A up to, not including, B
    #[arg(long, value_name = "A..B", value_parser = range)]
    samples: Option<Range<u32>>,
    /// Samples per pixel, of a scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    spp: Option<u32>,
    /// Explain the N pixels that most need it: not finite, fireflies, noise
    #[arg(long, value_name = "N", conflicts_with_all = ["pixel", "sample", "samples", "output"], value_parser = clap::value_parser!(u16).range(1..))]
    worst: Option<u16>,
    /// Everything that was recorded: .html is one page with the ray tree in 3D, .json all numbers, `-` the JSON on stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Branches of the tree that bring less than this share of the pixel are folded
    #[arg(long, value_name = "SHARE", default_value_t = 0.01, value_parser = share)]
    fold: f64,
    /// Levels of the tree that are shown
    #[arg(long, value_name = "N", default_value_t = 12)]
    depth: usize,
    /// Set any value of the scene, of a scene: `-D integrator.max_depth=3`
    #[arg(short = 'D', value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Folder below which the scene may read files; its own by default
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Show no progress and no warnings
    #[arg(long)]
    quiet: bool,
}

/// Do it.
pub fn run(args: &Explain) -> Result<Outcome, Problem> {
    // What can be refused before any work.
    let file = args.output.as_deref().filter(|p| p.as_os_str() != "-");
    let format = args.output.as_deref().map(Format::of).transpose()?;
    if let Some(path) = file {
        check_writable(path)?;
        check_no_loss([path], &[true_place(&args.source)])?;
    }

    let source = Source::open(args)?;
    if let Some(n) = args.worst {
        return worst::run(args, &source, usize::from(n));
    }
    let Some(pixel) = args.pixel else { return Ok(Outcome::Done) };
    let samples = source.samples(args, pixel)?;
    let explanation = replay(args, &source, pixel, samples)?;
    if let Some(path) = file {
        check_no_loss([path], &source.inputs())?;
    }
    let text = match format {
        Some(Format::Page) => {
            let picture = picture::picture(&source);
            page(&explanation, &source.prepared.scene, picture.as_ref().map(|(png, w, h)| (&png[..], *w, *h)))
        }
        Some(Format::Json) => format!("{:#}\n", explanation.to_json()),
        None => String::new(),
    };
    match (file, format) {
        (Some(path), _) => write_atomically(path, text.as_bytes())?,
        (None, Some(_)) => {
            print_out(text.as_bytes())?;
            return Ok(Outcome::Done);
        }
        (None, None) => {}
    }
    print_out(told(args, &source, &explanation).as_bytes())?;
    Ok(Outcome::Done)
}

/// Trace the pixel again.
fn replay(args: &Explain, source: &Source, pixel: (u32, u32), samples: Range<u32>) -> Result<Explanation, Problem> {
    let progress = Progress::new(args.quiet, None);
    let bar = progress.picture(u64::from(samples.end - samples.start), 0);
    let e = explain(&source.prepared, pixel, samples, &source.integrator, &source.name, &mut |done| {
        bar.set_position(u64::from(done));
    });
    bar.finish_and_clear();
    Ok(e)
}

/// Paragraph, findings, tree, and whether the picture agrees.
fn told(args: &Explain, source: &Source, e: &Explanation) -> String {
    let mut text = report::wrapped(&summary(e)) + "\n";
    for f in findings(e) {
        text += &report::wrapped(&format!("{}: {} ({}).", f.code, f.text, f.cure));
        text.push('\n');
    }
    let is_colored = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    text += "\n";
    text += &tree(e, &Style { is_colored, least_share: args.fold, depth: args.depth });
    text += &match source.verify(e) {
        Verdict::Same => "The picture holds exactly this pixel.\n".to_string(),
        Verdict::Part => "These are not all samples of the picture's pixel.\n".to_string(),
        Verdict::Coarse(why) => format!("The pixel was not compared: {why}.\n"),
        Verdict::Fresh => String::new(),
        Verdict::Other([r, g, b]) => {
            format!(
                "But the picture holds {r:.6} {g:.6} {b:.6} here: it was changed, or made by another build of Kirkas.\n"
            )
        }
    };
    text
}

/// What is written besides the terminal.
#[derive(Clone, Copy)]
enum Format {
    Json,
    Page,
}

impl Format {
    /// By the file's extension; `-` is JSON.
    fn of(path: &Path) -> Result<Self, Problem> {
        match path.extension().map(|e| e.to_string_lossy().to_lowercase()).as_deref() {
            Some("json") => Ok(Format::Json),
            Some("html" | "htm") => Ok(Format::Page),
            _ if path.as_os_str() == "-" => Ok(Format::Json),
            _ => Err(Problem::input(
                Diagnostic::error("unknown-format", format!("`{}` has no extension of an explanation", path.display()))
                    .help("give it the extension `.html` or `.json`"),
            )),
        }
    }
}

fn pixel(text: &str) -> Result<(u32, u32), String> {
    let place = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    place.ok_or_else(|| "write X,Y, such as 320,240".into())
}

fn range(text: &str) -> Result<Range<u32>, String> {
    parse_range(text).filter(|r| !r.is_empty()).ok_or_else(|| "write A..B with A < B, such as 0..20".into())
}

fn share(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| (0.0..=1.0).contains(v))
        .ok_or_else(|| "write a share from 0 to 1, such as 0.01".into())
}
