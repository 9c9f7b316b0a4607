//! Rays that get out of closed meshes, and hits that a structure loses: there must be none.

use crate::sh::{Outcome, cargo, run as sh_run};

/// `cargo xtask leaks [COUNT]`
pub fn run(args: &[String]) -> Outcome {
    let count: u64 = args.first().map_or(Ok(100_000_000), |a| a.parse()).map_err(|e| format!("count: {e}"))?;
    let example = ["run", "--release", "--package", "kirkas-accel", "--example", "leaks", "--"];
    sh_run(cargo().args(example).arg(count.to_string()))
}
