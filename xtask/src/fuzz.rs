//! Long fuzzing of every parser. Needs a nightly toolchain; installs cargo-fuzz once.

use crate::sh::{Outcome, exists, output, program, root, run as sh_run};
use std::fs;

/// `cargo xtask fuzz [SECONDS]`
pub fn run(args: &[String]) -> Outcome {
    let seconds: u32 = args.first().map_or(Ok(600), |a| a.parse()).map_err(|e| format!("seconds: {e}"))?;
    if !exists("cargo-fuzz", "--version") {
        sh_run(program("cargo").args(["install", "--locked", "cargo-fuzz"]))?;
    }
    let targets = output(program("cargo").args(["+nightly", "fuzz", "list"]))?;
    for target in targets.lines() {
        let corpus = root().join("fuzz/corpus").join(target);
        fs::create_dir_all(&corpus).map_err(|e| e.to_string())?;
        let seeds = root().join("fuzz/seeds").join(target);
        let mut c = program("cargo");
        c.args(["+nightly", "fuzz", "run", "--release", target]).arg(&corpus).arg(&seeds);
        c.args(["--", &format!("-max_total_time={seconds}"), "-timeout=10", "-rss_limit_mb=4096", "-max_len=65536"]);
        c.args(["-print_final_stats=1", "-verbosity=0"]);
        sh_run(&mut c)?;
    }
    println!("fuzz: {} targets, {seconds} s each, no panic, no hang", targets.lines().count());
    Ok(())
}
