//! The unsafe code of the structures under checkers: Miri runs the portable code step by step, and AddressSanitizer all tests of
//! `accel` with AVX2. Needs a nightly toolchain.

use crate::sh::{Outcome, output, program, run as sh_run, target_dir};

/// `cargo xtask sanitize`
pub fn run(_: &[String]) -> Outcome {
    sh_run(program("rustup").args(["+nightly", "component", "add", "miri", "rust-src"]))?;
    let tests = ["--package", "kirkas-accel", "--test", "it"];
    let mut miri = program("cargo");
    miri.args(["+nightly", "miri", "test"]).args(tests).args(["--", "tiny"]);
    // Files and clocks are the machine's; what is checked is memory.
    sh_run(miri.env("MIRIFLAGS", "-Zmiri-disable-isolation").env("CARGO_TARGET_DIR", target_dir().join("miri")))?;
    let version = output(program("rustc").args(["+nightly", "--version", "--verbose"]))?;
    let host = version.lines().find_map(|l| l.strip_prefix("host: ")).ok_or("rustc does not tell its host")?;
    let mut address = program("cargo");
    address.args(["+nightly", "test", "--release", "--target", host]).args(tests);
    sh_run(address.env("RUSTFLAGS", "-Zsanitizer=address").env("CARGO_TARGET_DIR", target_dir().join("address")))?;
    println!("sanitize: nothing found");
    Ok(())
}
