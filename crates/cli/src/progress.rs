//! Progress on a terminal: one bar for the picture and, for a film, one for its frames above it.

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::time::Duration;

/// The bars. Nothing is drawn where stderr is no terminal.
pub struct Progress {
    all: MultiProgress,
    frames: Option<ProgressBar>,
}

impl Progress {
    /// Of one picture, or of a film of so many frames.
    pub fn new(is_quiet: bool, frames: Option<usize>) -> Self {
        let target = if is_quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let all = MultiProgress::with_draw_target(target);
        let bar = |n: usize| {
            all.add(ProgressBar::new(n as u64).with_style(style("frame {msg}  {pos} of {len}  {left} left")))
        };
        let frames = frames.map(bar);
        Progress { all, frames }
    }

    /// A bar for a picture of `total` samples, of which `done` are there.
    pub fn picture(&self, total: u64, done: u64) -> ProgressBar {
        let bar = ProgressBar::new(total).with_style(style("{bar:40} {percent:>3} %  {rate}  {left} left"));
        let bar = self.all.add(bar.with_position(done));
        bar.reset_eta();
        bar
    }

    /// Frame `frame` begins.
    pub fn begin(&self, frame: u32) {
        if let Some(bar) = &self.frames {
            bar.set_message(frame.to_string());
            bar.tick();
        }
    }

    /// A frame is done. One that was `skipped` says nothing of how long the others take.
    pub fn end(&self, skipped: bool) {
        if let Some(bar) = &self.frames {
            bar.inc(1);
            if skipped {
                bar.reset_eta();
            }
        }
    }

    /// Write to the terminal without a bar in the way.
    pub fn suspend(&self, write: impl FnOnce()) {
        self.all.suspend(write);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.frames {
            bar.finish_and_clear();
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{:.2} M samples/s", state.per_sec() / 1e6);
    };
    let eta = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{}", short(state.eta()));
    };
    ProgressStyle::with_template(template)
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
