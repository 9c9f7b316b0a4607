//! Mutation testing of the formulas: a fixed random sample of mutants must be caught by the tests.

use crate::sh::{self, Outcome, exists, output, program, root};
use std::fs;

/// Where formulas live.
const FILES: [&str; 2] = ["crates/optics/src/**/*.rs", "crates/render/src/integrators/*.rs"];

/// Seed of the sample.
const SEED: u64 = 6837;

/// `cargo xtask mutants [COUNT]`
pub fn run(args: &[String]) -> Outcome {
    let count: usize = args.first().map_or(Ok(100), |a| a.parse()).map_err(|e| format!("count: {e}"))?;
    if !exists("cargo-mutants", "--version") {
        sh::run(program("cargo").args(["install", "--locked", "cargo-mutants"]))?;
    }
    let mut list = program("cargo");
    list.args(["mutants", "--list", "--workspace"]);
    for f in FILES {
        list.args(["--file", f]);
    }
    let all = output(&mut list)?;
    let mut names: Vec<&str> = all.lines().collect();
    shuffle(&mut names);
    names.truncate(count);
    names.sort_unstable();
    println!("{} of {} mutants, seed {SEED}", names.len(), all.lines().count());
    let mut c = program("cargo");
    c.args(["mutants", "--workspace", "--no-shuffle", "--profile", "checked", "--timeout", "180", "--baseline", "skip"]);
    for f in FILES {
        c.args(["--file", f]);
    }
    for name in &names {
        c.args(["--re", &format!("^{}$", escape(name))]);
    }
    let _ = sh::run(&mut c);
    let lines = |f: &str| fs::read_to_string(root().join("mutants.out").join(f)).map_or(0, |t| t.lines().count());
    let (caught, missed, timed_out, unviable) =
        (lines("caught.txt"), lines("missed.txt"), lines("timeout.txt"), lines("unviable.txt"));
    println!("{caught} caught, {missed} missed, {timed_out} timed out, {unviable} do not compile");
    print!("{}", fs::read_to_string(root().join("mutants.out/missed.txt")).unwrap_or_default());
    let judged = caught + missed + timed_out;
    if (caught + timed_out) * 10 < judged * 9 { Err("fewer than 90 % caught".into()) } else { Ok(()) }
}

/// Fisher-Yates with SplitMix64: the same sample everywhere.
fn shuffle(names: &mut [&str]) {
    let mut state = SEED;
    for i in (1..names.len()).rev() {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        names.swap(i, ((z ^ (z >> 31)) % (i as u64 + 1)) as usize);
    }
}

/// For a regular expression. (`\<` would be the start of a word, so only what must be is escaped.)
fn escape(text: &str) -> String {
    const SPECIAL: &str = "\\.+*?()|[]{}^$-";
    text.chars().flat_map(|c| SPECIAL.contains(c).then_some('\\').into_iter().chain([c])).collect()
}
