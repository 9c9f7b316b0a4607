//! Mutation testing of the formulas: a fixed random sample of mutants must be caught by the tests.

use crate::sh::{self, Outcome, output, program, root, target_dir};
use std::fs;

/// Where formulas live.
const FILES: [&str; 2] = ["crates/optics/src/**/*.rs", "crates/render/src/integrators/*.rs"];

/// Seed of the sample.
const SEED: u64 = 6837;

/// Tests that take long and catch little that others do not: only what survives without them faces them.
const SLOW: [&str; 7] =
    ["samples_follow", "a_furnace", "densities_integrate", "shapes", "textures", "cameras", "filters"];

/// `cargo xtask mutants [COUNT]`
pub fn run(args: &[String]) -> Outcome {
    let count: usize = args.first().map_or(Ok(100), |a| a.parse()).map_err(|e| format!("count: {e}"))?;
    if output(program("cargo").args(["mutants", "--version"])).is_err() {
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
    let quick = judge(&names, &SLOW)?;
    let survivors: Vec<&str> = quick.missed.lines().collect();
    let full = if survivors.is_empty() { Verdict::default() } else { judge(&survivors, &[])? };
    // Mutants of one name face all tests together, those that were already caught among them.
    let caught = quick.caught + survivors.len() - full.missed.lines().count();
    println!("{caught} caught, {} missed, {} do not compile", full.missed.lines().count(), quick.unviable);
    print!("{}", full.missed);
    let judged = caught + full.missed.lines().count();
    if caught * 10 < judged * 9 { Err("fewer than 90 % caught".into()) } else { Ok(()) }
}

/// What became of some mutants. One that hangs is caught.
#[derive(Default)]
struct Verdict {
    caught: usize,
    missed: String,
    unviable: usize,
}

/// Let the tests, but those named, judge the mutants.
fn judge(names: &[&str], skipped: &[&str]) -> Result<Verdict, String> {
    let mut c = program("cargo");
    c.env("CARGO_TARGET_DIR", target_dir().join("mutants"));
    c.args([
        "mutants",
        "--workspace",
        "--no-shuffle",
        "--profile",
        "checked",
        "--timeout",
        "180",
        "--baseline",
        "skip",
    ]);
    for f in FILES {
        c.args(["--file", f]);
    }
    for name in names {
        c.args(["--re", &format!("^{}$", escape(name))]);
    }
    c.args(["--", "--"]);
    for name in skipped {
        c.args(["--skip", name]);
    }
    // Its exit code tells whether all were caught, which is ours to judge.
    c.status().map_err(|e| format!("cargo mutants did not start: {e}"))?;
    let out = root().join("mutants.out");
    let text = |f: &str| fs::read_to_string(out.join(f)).unwrap_or_default();
    Ok(Verdict {
        caught: text("caught.txt").lines().count() + text("timeout.txt").lines().count(),
        missed: text("missed.txt"),
        unviable: text("unviable.txt").lines().count(),
    })
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
