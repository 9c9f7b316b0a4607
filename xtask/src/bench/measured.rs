//! A program's time from start to end, and its memory at most.

use crate::sh::{exists, output};
use std::process::Command;
use std::time::Instant;

/// What one run took.
#[derive(Clone, Copy)]
pub struct Measured {
    pub seconds: f64,
    /// Peak resident memory in MB (10^6 bytes), where GNU time is installed.
    pub megabytes: Option<f64>,
}

/// Tells what a run takes.
pub struct Meter {
    has_gnu_time: bool,
}

const GNU_TIME: &str = "/usr/bin/time";

impl Meter {
    pub fn new() -> Self {
        Meter { has_gnu_time: exists(GNU_TIME, "--version") }
    }

    pub fn run(&self, command: &Command) -> Result<Measured, String> {
        let report = std::env::temp_dir().join(format!("kirkas-bench-{}.kilobytes", std::process::id()));
        let mut c = if self.has_gnu_time {
            let mut c = Command::new(GNU_TIME);
            c.args(["-f", "%M", "-o"]).arg(&report).arg(command.get_program()).args(command.get_args());
            c
        } else {
            let mut c = Command::new(command.get_program());
            c.args(command.get_args());
            c
        };
        let start = Instant::now();
        output(&mut c)?;
        let seconds = start.elapsed().as_secs_f64();
        let kilobytes = std::fs::read_to_string(&report).ok().and_then(|t| t.trim().parse::<f64>().ok());
        let _ = std::fs::remove_file(&report);
        Ok(Measured { seconds, megabytes: kilobytes.map(|k| k * 1024.0 / 1e6) })
    }
}

/// The medians of both.
pub fn median(runs: &[Measured]) -> Option<Measured> {
    let middle = |mut v: Vec<f64>| {
        v.sort_by(f64::total_cmp);
        v.get(v.len() / 2).copied()
    };
    let seconds = middle(runs.iter().map(|r| r.seconds).collect())?;
    Some(Measured { seconds, megabytes: middle(runs.iter().filter_map(|r| r.megabytes).collect()) })
}
