//! Tests that tell more the longer they run: the same ones that `test` runs shortly.

use crate::sh::{Outcome, cargo, run as sh_run};

/// `cargo xtask bias [SEEDS]`
pub fn bias(args: &[String]) -> Outcome {
    long("the_bias_of_rare_light", "KIRKAS_BIAS_SEEDS", args.first().map_or("1000", String::as_str))
}

/// `cargo xtask hostile [SCENES]`
pub fn hostile(args: &[String]) -> Outcome {
    long("random_scenes_give_numbers", "KIRKAS_HOSTILE_SCENES", args.first().map_or("10000", String::as_str))
}

/// Run a test of the renderer with a number in its environment.
fn long(test: &str, variable: &str, number: &str) -> Outcome {
    number.parse::<u64>().map_err(|e| format!("`{number}`: {e}"))?;
    let words = ["test", "--release", "--package", "kirkas-render", "--test", "it", "--", test, "--nocapture"];
    sh_run(cargo().env(variable, number).args(words))
}
