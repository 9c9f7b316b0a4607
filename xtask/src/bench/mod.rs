//! Times in one run, ours beside others': whole renders beside POV-Ray and Mitsuba, the ray kernel beside Embree.

mod flake;
mod measured;
mod mesh;
mod renders;

use crate::sh::{self, Outcome, cargo};

/// `cargo xtask bench [renders|kernel] [--quick] [--runs N] [--json FILE]`
pub fn run(args: &[String]) -> Outcome {
    match args.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        Some(("kernel", rest)) => kernel(rest),
        Some(("renders", rest)) => renders::run(rest),
        _ => renders::run(args),
    }
}

/// The ray kernel beside Embree 3; takes the options of `kernel --help`.
fn kernel(args: &[String]) -> Outcome {
    let program = ["run", "--release", "--package", "kirkas-bench", "--bin", "kernel", "--"];
    sh::run(cargo().args(program).args(args))
}
