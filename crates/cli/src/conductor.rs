//! The command line's say in a render: the progress bar, Ctrl-C, the time limit, checkpoints.

use crate::checkpoint::Checkpoint;
use crate::report;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use kirkas_render::{Control, Film};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// How often the user, or the system, asked to stop.
static STOPS: AtomicU32 = AtomicU32::new(0);

/// Watches a render.
pub struct Conductor {
    bar: ProgressBar,
    deadline: Option<Instant>,
    passes: Mutex<Passes>,
    checkpoint: Option<Mutex<Checkpoint>>,
}

/// When the running pass began, and how many samples each pixel had then.
struct Passes {
    begun: Instant,
    taken: u32,
    ended_by_clock: bool,
}

impl Conductor {
    /// `total` samples of pixels, of which `done` are there; `taken` per pixel.
    pub fn new(
        is_quiet: bool,
        total: u64,
        (done, taken): (u64, u32),
        deadline: Option<Instant>,
        checkpoint: Option<Checkpoint>,
    ) -> Self {
        let target = if is_quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(total), target).with_style(style()).with_position(done);
        bar.reset_eta();
        let passes = Passes { begun: Instant::now(), taken, ended_by_clock: false };
        Conductor { bar, deadline, passes: Mutex::new(passes), checkpoint: checkpoint.map(Mutex::new) }
    }

    /// Take the bar away, write the last checkpoint, and say why the render ended early, if it did.
    pub fn finish(self, film: &Film, wanted: u32) -> Result<Option<&'static str>, crate::problem::Problem> {
        self.bar.finish_and_clear();
        if let Some(checkpoint) = self.checkpoint.and_then(|c| c.into_inner().ok()) {
            let mut checkpoint = checkpoint;
            checkpoint.save(film)?;
        }
        let is_short = crate::parts::taken(film).0 < wanted;
        let by_clock = self.passes.into_inner().is_ok_and(|p| p.ended_by_clock);
        Ok(match is_short {
            false => None,
            true if by_clock => Some("the time limit was reached"),
            true => Some("stopped"),
        })
    }

    fn save(&self, film: &Film) {
        let Some(mut checkpoint) = self.checkpoint.as_ref().and_then(|c| c.lock().ok()) else { return };
        if let Err(problem) = checkpoint.save_if_due(film) {
            // The picture may yet be saved; the last checkpoint will say so again.
            self.bar.suspend(|| report::print(&problem.failure.sources, &problem.failure.diagnostics));
        }
    }

    /// True when the next pass, as long as the last ones let expect, would end more beyond the limit than before it.
    fn is_out_of_time(&self, film: &Film) -> bool {
        let (Some(deadline), Ok(mut passes)) = (self.deadline, self.passes.lock()) else { return false };
        let now = Instant::now();
        let taken = crate::parts::taken(film).0;
        let per_sample = (now - passes.begun) / (taken - passes.taken.min(taken)).max(1);
        let next = per_sample * taken.clamp(1, LONGEST_PASS);
        (passes.begun, passes.taken) = (now, taken);
        passes.ended_by_clock = now + next / 2 > deadline;
        passes.ended_by_clock
    }
}

/// As the renderer has it: a pass doubles the samples until it takes so many.
const LONGEST_PASS: u32 = 16;

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

    fn after_pass(&self, film: &Film) -> bool {
        let is_late = self.is_out_of_time(film);
        STOPS.load(Ordering::Relaxed) == 0 && !is_late
    }
}

fn style() -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{:.2} M samples/s", state.per_sec() / 1e6);
    };
    let eta = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{}", short(state.eta()));
    };
    ProgressStyle::with_template("{bar:40} {percent:>3} %  {rate}  {left} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("rate", rate)
        .with_key("left", eta)
        .progress_chars("━╸ ")
}

fn short(time: Duration) -> String {
    let s = time.as_secs();
    match s {
        0..60 => format!("{s} s"),
        60..3600 => format!("{}:{:02} min", s / 60, s % 60),
        _ => format!("{}:{:02} h", s / 3600, s / 60 % 60),
    }
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
