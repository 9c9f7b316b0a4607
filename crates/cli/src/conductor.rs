//! The command line's say in a render: the progress bar, Ctrl-C, the time limit, checkpoints.

use crate::checkpoint::Checkpoint;
use crate::problem::Problem;
use crate::report;
use indicatif::ProgressBar;
use kirkas_render::{Control, Film, Renderer, Statistics};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// How often the user, or the system, asked to stop.
static STOPS: AtomicU32 = AtomicU32::new(0);

/// A pass doubles the samples until it takes so many.
const MOST_SAMPLES: u32 = 16;
/// A pass is no longer than this, if it can be: then it is soon time for a checkpoint, or to stop.
const LONGEST_PASS: Duration = Duration::from_secs(10);

/// Why a render ended early.
const STOPPED: &str = "stopped";
const TIME_IS_UP: &str = "the time limit was reached";

/// Watches a render.
pub struct Conductor {
    bar: ProgressBar,
    deadline: Option<Instant>,
    checkpoint: Option<Mutex<Checkpoint>>,
}

impl Conductor {
    /// With a bar that counts samples of pixels.
    pub fn new(bar: ProgressBar, deadline: Option<Instant>, checkpoint: Option<Checkpoint>) -> Self {
        Conductor { bar, deadline, checkpoint: checkpoint.map(Mutex::new) }
    }

    /// Pass after pass until every pixel of `film` has `samples`, or until it is time to stop.
    pub fn render(&self, renderer: &Renderer, film: &mut Film, samples: Range<u32>) -> Statistics {
        let mut counted = Statistics::default();
        let mut per_sample = Duration::ZERO;
        let mut is_first = true;
        loop {
            let wanted = samples.end - samples.start;
            let Some((done, _)) = film.going_on() else { return counted };
            let left = wanted.saturating_sub(done);
            let is_late = self.deadline.is_some_and(|d| Instant::now() + per_sample / 2 > d);
            if left == 0 || STOPS.load(Ordering::Relaxed) > 0 || (is_late && !is_first) {
                return counted;
            }
            let length = self.affordable(per_sample).min(done.clamp(1, MOST_SAMPLES)).min(left);
            let begun = Instant::now();
            let pass = samples.start..samples.start + done + length;
            counted = counted.plus(&renderer.render(film, pass, self));
            per_sample = begun.elapsed() / length;
            if renderer.target.is_some() {
                self.bar.set_position(settled(film, wanted));
            }
            is_first = false;
        }
    }

    /// Samples that fit into the longest pass and into the time that is left; one at least.
    fn affordable(&self, per_sample: Duration) -> u32 {
        let left = self.deadline.map(|d| d.saturating_duration_since(Instant::now()));
        let time = left.map_or(LONGEST_PASS, |l| l.min(LONGEST_PASS));
        (time.as_secs_f64() / per_sample.as_secs_f64().max(1e-9)).clamp(1.0, 1e6) as u32
    }

    /// Take the bar away, write the last checkpoint, and say why the render ended early, if it did.
    pub fn finish(self, film: &Film, wanted: u32) -> Result<Option<&'static str>, Problem> {
        self.bar.finish_and_clear();
        if let Some(mut checkpoint) = self.checkpoint.and_then(|c| c.into_inner().ok()) {
            checkpoint.save(film)?;
        }
        Ok(match STOPS.load(Ordering::Relaxed) {
            _ if film.going_on().is_none_or(|(least, _)| least >= wanted) => None,
            0 => Some(TIME_IS_UP),
            _ => Some(STOPPED),
        })
    }

    fn save(&self, film: &Film) {
        let Some(mut checkpoint) = self.checkpoint.as_ref().and_then(|c| c.lock().ok()) else { return };
        if let Err(problem) = checkpoint.save_if_due(film) {
            // The picture may yet be saved; the last checkpoint will say so again.
            self.bar.suspend(|| report::print(&problem.failure.sources, &problem.failure.diagnostics));
        }
    }
}

impl Control for Conductor {
    fn progress(&self, samples: u64) {
        self.bar.inc(samples);
    }

    fn between(&self, film: &Film) -> bool {
        if STOPS.load(Ordering::Relaxed) > 1 {
            return false;
        }
        self.save(film);
        true
    }
}

/// Samples that a film has, or will never need, of `wanted` per pixel.
pub fn settled(film: &Film, wanted: u32) -> u64 {
    let counts = film.tiles.iter().flat_map(|t| &t.counts);
    counts.map(|c| u64::from(if c.is_stopped { wanted } else { c.taken })).sum()
}

/// Why nothing more should begin, if so.
pub fn why_to_stop(deadline: Option<Instant>) -> Option<&'static str> {
    if STOPS.load(Ordering::Relaxed) > 0 {
        return Some(STOPPED);
    }
    deadline.is_some_and(|d| Instant::now() >= d).then_some(TIME_IS_UP)
}

/// From now on Ctrl-C ends the render kindly: once after the running pass, twice at the next chance, three times at once.
pub fn watch_for_stops() {
    let stop = || match STOPS.fetch_add(1, Ordering::Relaxed) {
        0 => report::note("kirkas: finishing the running pass, then writing; Ctrl-C again to stop sooner"),
        1 => report::note("kirkas: stopping; Ctrl-C again to give up everything"),
        _ => std::process::exit(130),
    };
    // Without a handler Ctrl-C ends the program as ever.
    let _ = ctrlc::set_handler(stop);
}
