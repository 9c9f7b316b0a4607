//! What is given to people: archives and pages.

use crate::sh::{self, Outcome, build_kirkas, build_shipped, output, program, root};
use std::fs;
use std::process::Command;

/// `cargo xtask dist`
pub fn run(_: &[String]) -> Outcome {
    let binary = build_shipped()?;
    let version = output(Command::new(&binary).arg("--version"))?;
    let version = version.split_whitespace().nth(1).unwrap_or("0").to_string();
    let name = format!("kirkas-{version}-{}-{}", std::env::consts::ARCH, std::env::consts::OS);
    let dist = root().join("dist");
    let folder = dist.join(&name);
    let fail = |e: std::io::Error| e.to_string();
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("scenes/lecture")).map_err(fail)?;
    let shipped = folder.join(binary.file_name().unwrap_or_default());
    fs::copy(&binary, &shipped).map_err(fail)?;
    let stripped = program("strip").arg(&shipped).status().is_ok_and(|s| s.success());
    println!("{}", if stripped { "stripped" } else { "not stripped: there is no `strip` here" });
    for page in ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "scenes/sphereflake.toml"] {
        fs::copy(root().join(page), folder.join(page)).map_err(|e| format!("{page}: {e}"))?;
    }
    for scene in crate::tidy::files(&root().join("scenes/lecture"), "toml") {
        let to = folder.join("scenes/lecture").join(scene.file_name().unwrap_or_default());
        fs::copy(&scene, to).map_err(fail)?;
    }
    for shell in ["bash", "zsh", "fish"] {
        let script = output(Command::new(&binary).args(["completions", shell]))?;
        fs::write(folder.join(format!("kirkas.{shell}")), script).map_err(fail)?;
    }
    let archive = dist.join(format!("{name}.tar.gz"));
    sh::run(program("tar").arg("-C").arg(&dist).arg("-czf").arg(&archive).arg(&name))?;
    println!("{} ({} KiB)", archive.display(), fs::metadata(&archive).map_or(0, |m| m.len() / 1024));
    Ok(())
}

/// `cargo xtask docs`
pub fn docs(_: &[String]) -> Outcome {
    let binary = build_kirkas()?;
    let schema = output(Command::new(&binary).arg("schema"))?;
    fs::write(root().join("docs/kirkas.schema.json"), schema).map_err(|e| e.to_string())?;
    let explanation = output(Command::new(&binary).args(["schema", "--explanation"]))?;
    fs::write(root().join("docs/explanation.schema.json"), explanation).map_err(|e| e.to_string())?;
    let manual = output(Command::new(&binary).args(["schema", "--manual"]))?;
    fs::write(root().join("docs/manual.md"), manual).map_err(|e| e.to_string())
}
