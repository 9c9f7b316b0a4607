//! Running programs.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What a chore answers: nothing, or what went wrong.
pub type Outcome = Result<(), String>;

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf).unwrap_or_default()
}

/// A program to be run in the root.
pub fn program(name: &str) -> Command {
    let mut c = Command::new(name);
    c.current_dir(root());
    c
}

/// The cargo that runs us.
pub fn cargo() -> Command {
    program(&std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
}

/// Print and run; fail unless it succeeds.
pub fn run(command: &mut Command) -> Outcome {
    let line = describe(command);
    println!("$ {line}");
    match command.status() {
        Ok(s) if s.success() => Ok(()),
        Ok(s) => Err(format!("`{line}` ended with {s}")),
        Err(e) => Err(format!("`{line}` did not start: {e}")),
    }
}

/// Run and give its standard output.
pub fn output(command: &mut Command) -> Result<String, String> {
    let line = describe(command);
    let out = command.output().map_err(|e| format!("`{line}` did not start: {e}"))?;
    if !out.status.success() {
        return Err(format!("`{line}` ended with {}: {}", out.status, String::from_utf8_lossy(&out.stderr)));
    }
    Ok(String::from_utf8_lossy(&out.stdout).into_owned())
}

/// True when a program can be started.
pub fn exists(name: &str, probe: &str) -> bool {
    Command::new(name).arg(probe).output().is_ok_and(|o| o.status.success())
}

/// The program, built soon.
pub fn build_kirkas() -> Result<PathBuf, String> {
    build("release")
}

/// The program as it is given to people: faster, and longer to build.
pub fn build_shipped() -> Result<PathBuf, String> {
    build("dist")
}

/// Or the one that `KIRKAS_BIN` names.
fn build(profile: &str) -> Result<PathBuf, String> {
    if let Some(binary) = std::env::var_os("KIRKAS_BIN") {
        return Ok(root().join(binary));
    }
    run(cargo().args(["build", "--profile", profile, "--package", "kirkas-cli"]))?;
    Ok(target_dir().join(profile).join(format!("kirkas{}", std::env::consts::EXE_SUFFIX)))
}

/// Where cargo puts what it builds.
pub fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |d| root().join(d))
}

fn describe(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|w| w.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}
