//! Everything that must hold, on any machine with the Rust toolchain.

use crate::sh::{self, Outcome, cargo, exists, program};
use crate::tidy;

/// Crates of floors 0 to 2, which must also work in a web page.
const WEB_CRATES: [&str; 7] = ["geometry", "scene", "accel", "optics", "images", "formats", "render"];
const WEB_TARGET: &str = "wasm32-unknown-unknown";

/// `cargo xtask test`
pub fn run(extra: &[String]) -> Outcome {
    tidy::run(&[])?;
    add_web_target()?;
    let mut check = cargo();
    check.args(["check", "--target", WEB_TARGET]);
    for name in WEB_CRATES {
        check.args(["--package", &format!("kirkas-{name}")]);
    }
    sh::run(&mut check)?;
    sh::run(cargo().args(["test", "--workspace", "--profile", "checked"]).args(extra))
}

/// Tests compare native bits with wasm's, so the target must be there.
fn add_web_target() -> Outcome {
    let installed =
        std::process::Command::new("rustc").args(["--print", "target-libdir", "--target", WEB_TARGET]).output();
    let has_core = installed.is_ok_and(|o| {
        let dir = String::from_utf8_lossy(&o.stdout).trim().to_string();
        o.status.success() && std::path::Path::new(&dir).is_dir()
    });
    if has_core {
        return Ok(());
    }
    if !exists("rustup", "--version") {
        return Err(format!("the target {WEB_TARGET} is not installed, and there is no rustup to install it"));
    }
    sh::run(program("rustup").args(["target", "add", WEB_TARGET]))
}

/// `cargo xtask bless`
pub fn bless(extra: &[String]) -> Outcome {
    sh::run(
        cargo()
            .env("INSTA_UPDATE", "always")
            .env("KIRKAS_BLESS", "1")
            .args(["test", "--workspace", "--profile", "checked"])
            .args(extra),
    )
}
