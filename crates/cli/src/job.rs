//! One picture, or one frame, of a `render`: from the first sample, or the checkpoint, to its files.

use crate::checkpoint::{self, Checkpoint};
use crate::commands::render::Render;
use crate::conductor::{Conductor, settled};
use crate::header::Header;
use crate::output::{print_out, write_atomically};
use crate::parts::tell_samples;
use crate::pictures::Development;
use crate::places::Places;
use crate::problem::Problem;
use crate::progress::Progress;
use crate::ranges::SampleRanges;
use crate::report;
use crate::stats::{Seconds, stats_json};
use kirkas_render::{Film, Prepared};
use kirkas_scene::Diagnostic;
use std::ops::Range;
use std::time::{Duration, Instant};

/// What all frames have in common.
pub struct Job<'a> {
    /// As asked for.
    pub args: &'a Render,
    /// Which samples of each pixel.
    pub samples: Range<u32>,
    /// From a film to files.
    pub development: Development,
    /// When to stop.
    pub deadline: Option<Instant>,
    /// What was suspicious in the scene.
    pub warnings: Vec<Diagnostic>,
    /// The bars.
    pub progress: Progress,
}

impl Job<'_> {
    /// True when all pictures of this frame are there and finished.
    pub fn is_done(&self, header: &Header, places: &Places) -> bool {
        let mut header = header.clone();
        header.set("samples", SampleRanges::one(self.samples.clone()).to_string());
        places.hold(&header, &self.development)
    }

    /// Render and write. The seconds hold what was spent before, and since when the total counts. False if it was stopped early.
    pub fn render(
        &self,
        prepared: &Prepared,
        mut header: Header,
        places: &Places,
        (mut seconds, begun): (Seconds, Instant),
    ) -> Result<bool, Problem> {
        // Begin, or go on.
        let samples = &self.samples;
        let mut film = self.first_film(&header, prepared, places)?;

        // Render.
        let usual = Duration::from_secs(self.args.checkpoint_seconds);
        let checkpoint = places.checkpoint.as_ref().map(|path| Checkpoint::new(path, &header, samples, usual));
        let wanted = samples.end - samples.start;
        let pixels = prepared.film.crop.area() as u64;
        let bar = self.progress.picture(pixels * u64::from(wanted), settled(&film, wanted));
        let render_started = Instant::now();
        let conductor = Conductor::new(bar, self.deadline, checkpoint);
        let counted = conductor.render(&prepared.renderer(usize::from(self.args.flock)), &mut film, samples.clone());
        seconds.render = render_started.elapsed().as_secs_f64();

        // Write.
        // The checkpoint first: should the pictures fail, nothing is lost.
        let stopped = conductor.finish(&film, wanted);
        let done = tell_samples(&mut header, &film, samples);
        self.development.write(&film, &header, &places.pictures)?;
        let stopped = stopped?;
        let late = [unfinished_blocks(&film, prepared, wanted), invalid_samples(&film, prepared.frame)];
        let late: Vec<Diagnostic> = late.into_iter().flatten().collect();
        seconds.total = begun.elapsed().as_secs_f64();
        if self.args.stats.is_some() {
            let json = stats_json(
                &header.texts(),
                prepared,
                &film,
                &done,
                &counted,
                seconds,
                &[&self.warnings[..], &late].concat(),
            );
            let text = format!("{json:#}\n");
            match &places.stats {
                Some(path) => write_atomically(path, text.as_bytes())?,
                None => print_out(text.as_bytes())?,
            }
        }

        // Say what is not as it was asked for.
        self.progress.suspend(|| {
            if let Some(why) = stopped {
                let of_frame = prepared.frame.map_or(String::new(), |n| format!(" of frame {n}"));
                let taken = done.end - done.start;
                report::note(format_args!("kirkas: {why} after {taken} of {wanted} samples per pixel{of_frame}"));
            }
            if !self.args.quiet {
                report::print(&Default::default(), &late);
            }
        });
        Ok(stopped.is_none())
    }

    fn first_film(&self, header: &Header, prepared: &Prepared, places: &Places) -> Result<Film, Problem> {
        match places.checkpoint.as_ref().filter(|_| self.args.resume) {
            Some(path) if path.exists() => return checkpoint::load(path, header, &prepared.film, &self.samples),
            Some(path) if prepared.frame.is_none() => {
                report::note(format_args!("kirkas: no checkpoint `{}` yet, beginning anew", path.display()));
            }
            _ => {}
        }
        Ok(Film::new(prepared.film.clone()))
    }
}

/// Some blocks took all samples that they may, and are not good enough yet.
fn unfinished_blocks(film: &Film, prepared: &Prepared, wanted: u32) -> Option<Diagnostic> {
    let target = prepared.target?;
    let (c, is_at_end) = (film.convergence(), film.going_on().is_some_and(|(least, _)| least >= wanted));
    (is_at_end && c.open > 0).then(|| {
        let message = format!(
            "{} of {} blocks did not reach the error {} in {wanted} samples per pixel",
            c.open, c.blocks, target.error
        );
        Diagnostic::warning("error-not-reached", message)
            .help("give them more (`--spp N`), with --checkpoint and --resume from where they are, or ask for less")
    })
}

fn invalid_samples(film: &Film, frame: Option<u32>) -> Option<Diagnostic> {
    if film.invalid_samples() == 0 {
        return None;
    }
    let places: Vec<String> = film
        .tiles
        .iter()
        .flat_map(|t| &t.invalid)
        .take(4)
        .map(|s| format!("pixel {},{} sample {}", s.x, s.y, s.sample))
        .collect();
    let of_frame = frame.map_or(String::new(), |n| format!(" of frame {n}"));
    let message =
        format!("{} samples{of_frame} were left out: they were not finite, or absurdly bright", film.invalid_samples());
    Some(Diagnostic::warning("invalid-samples", message).help(format!("look at {}", places.join(", "))))
}
