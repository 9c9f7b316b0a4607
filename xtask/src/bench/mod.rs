//! Times in one run, ours beside others': whole renders beside POV-Ray and Mitsuba, the ray kernel beside Embree, the time to an error
//! beside Mitsuba.

mod flake;
mod measured;
mod mesh;
mod renders;

use crate::sh::{self, Outcome, build_shipped, cargo, exists, program};

/// `cargo xtask bench [renders|kernel|converge] [--quick] [--runs N] [--json FILE]`
pub fn run(args: &[String]) -> Outcome {
    match args.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        Some(("kernel", rest)) => kernel(rest),
        Some(("converge", rest)) => converge(rest),
        Some(("renders", rest)) => renders::run(rest),
        _ => renders::run(args),
    }
}

/// The ray kernel beside Embree 3; takes the options of `kernel --help`.
fn kernel(args: &[String]) -> Outcome {
    let program = ["run", "--release", "--package", "kirkas-bench", "--bin", "kernel", "--"];
    sh::run(cargo().args(program).args(args))
}

/// The time to an error, in Python; takes the options of `bench/converge/converge.py --help`. `KIRKAS_PYTHON` names a Python that has
/// Mitsuba and NumPy; `KIRKAS_CYCLES_PYTHON` one with `bpy`, `KIRKAS_LUXCORE_PYTHON` one with `pyluxcore`, without which those peers are left out.
fn converge(args: &[String]) -> Outcome {
    let python = std::env::var("KIRKAS_PYTHON").unwrap_or_else(|_| "python3".into());
    if !exists(&python, "--version") {
        return Err(format!("`{python}` does not start: set KIRKAS_PYTHON to a Python with Mitsuba and NumPy"));
    }
    if !program(&python).args(["-c", "import mitsuba, numpy"]).output().is_ok_and(|o| o.status.success()) {
        return Err(format!("`{python}` lacks Mitsuba: `{python} -m pip install mitsuba numpy`, or set KIRKAS_PYTHON"));
    }
    let kirkas = build_shipped()?;
    sh::run(program(&python).arg("bench/converge/converge.py").arg("--kirkas").arg(kirkas).args(args))
}
