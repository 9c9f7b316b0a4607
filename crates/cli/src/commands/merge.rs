//! `kirkas merge`: partial pictures added up, as if they had been rendered at once.

use crate::aov_args;
use crate::output::{PictureFile, check_no_loss, check_writable, true_place};
use crate::parts::Part;
use crate::pictures::Development;
use crate::problem::{Outcome, Problem};
use kirkas_render::film::part::PartError;
use kirkas_scene::Diagnostic;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Examples:
  kirkas render scene.toml --samples 0..20 -o a.exr
  kirkas render scene.toml --samples 20..64 -o b.exr
  kirkas merge a.exr b.exr -o all.exr -o all.png

An EXR keeps the integers, so that it can be merged and resumed again.";

/// Add up partial pictures that hold different samples
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Merge {
    /// Pictures written with --samples or --checkpoint, or merged
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,
    /// Picture to write: .exr, .png or .hdr; may be given several times
    #[arg(short, long, required = true, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// EXR without the integers, as `render --spp` writes it
    #[arg(long)]
    flat: bool,
    /// EXR in 16 bits instead of 32
    #[arg(long)]
    half: bool,
}

/// Do it.
pub fn run(args: &Merge) -> Result<Outcome, Problem> {
    let files = args.output.iter().map(|p| PictureFile::new(p)).collect::<Result<Vec<_>, _>>()?;
    files.iter().try_for_each(|f| check_writable(&f.path))?;
    let parts: Vec<PathBuf> = args.parts.iter().map(|p| true_place(p)).collect();
    check_no_loss(files.iter().map(|f| f.path.as_path()), &parts)?;
    let (first, others) = args.parts.split_first().expect("clap asks for one at least");
    let mut sum = read_whole(first)?;
    for path in others {
        let part = read_whole(path)?;
        for (part, path) in [(&sum, first), (&part, path)] {
            refuse_adaptive(part, path)?;
        }
        add(&mut sum, &part, first, path)?;
    }
    let mut header = sum.header;
    header.set("argv", crate::header::command_line());
    header.set("samples", sum.samples.to_string());
    let invalid = sum.film.invalid_samples();
    header.set("invalid", if invalid > 0 { invalid.to_string() } else { String::new() });
    let names: Vec<String> = header.get("aov").split(',').map(String::from).collect();
    let development = Development {
        exposure: header.get("exposure").parse().unwrap_or(0.0),
        tone: header.get("tone").to_string(),
        is_half: args.half,
        keeps_integers: !args.flat,
        denoiser: None,
        aovs: aov_args::parse(&names)?,
    };
    development.write(&sum.film, &header, &files)?;
    Ok(Outcome::Done)
}

/// A part of which every pixel has the same samples.
fn read_whole(path: &Path) -> Result<Part, Problem> {
    let part = Part::read(path)?;
    match part.header.get("unfinished") {
        "" => Ok(part),
        range => {
            let message =
                format!("`{}` was stopped within a pass: some pixels also have samples {range}", path.display());
            let help = "finish it first: render it again with --checkpoint and --resume";
            Err(Problem::input(Diagnostic::error("unfinished-part", message).help(help)))
        }
    }
}

/// Each pixel of an adaptive picture has its own number of samples, and which, another part decides.
fn refuse_adaptive(part: &Part, path: &Path) -> Result<(), Problem> {
    match part.header.get("error") {
        "" => Ok(()),
        error => {
            let message = format!(
                "`{}` was sampled adaptively, to an error of {error}, so nothing can be added to it",
                path.display()
            );
            let help =
                "render parts with a number of samples (`--samples A..B -D sampler.error=0`), or the whole in one go";
            Err(Problem::input(Diagnostic::error("adaptive-part", message).help(help)))
        }
    }
}

fn add(sum: &mut Part, part: &Part, first: &Path, path: &Path) -> Result<(), Problem> {
    let differences = sum.header.differences(&part.header);
    let unfit = |what: String| {
        let message = format!("`{}` and `{}` are not parts of one picture", first.display(), path.display());
        Problem::input(Diagnostic::error("other-picture", message).help(format!("these differ: {what}")))
    };
    if !differences.is_empty() {
        return Err(unfit(differences.join("; ")));
    }
    sum.samples = sum.samples.union(&part.samples).map_err(|twice| {
        let message =
            format!("samples {}..{} of `{}` are in another part already", twice.start, twice.end, path.display());
        Problem::input(
            Diagnostic::error("overlapping-parts", message).help("give each sample once; leave this part out"),
        )
    })?;
    sum.film.merge(&part.film).map_err(|e| match e {
        PartError::Different(what) => unfit(what),
        other => unfit(other.to_string()),
    })
}
