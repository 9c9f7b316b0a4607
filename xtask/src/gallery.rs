//! The gallery: every lecture scene, rendered small into `docs/gallery`.

use crate::sh::{self, Outcome, build_kirkas, root};
use std::fs;
use std::process::Command;

/// One picture: its name, its scene, and what differs from the scene as it stands.
struct Picture {
    name: &'static str,
    scene: &'static str,
    options: &'static [&'static str],
}

const fn plain(name: &'static str) -> Picture {
    Picture { name, scene: name, options: &[] }
}

const fn variant(name: &'static str, scene: &'static str, options: &'static [&'static str]) -> Picture {
    Picture { name, scene, options }
}

/// Every picture, in the order of the lecture.
const PICTURES: &[Picture] = &[
    Picture { name: "sphereflake", scene: "../sphereflake", options: &["--size", "640x480"] },
];

/// `cargo xtask gallery [NAME...]`
pub fn run(only: &[String]) -> Outcome {
    let kirkas = build_kirkas()?;
    let folder = root().join("docs/gallery");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    for p in PICTURES.iter().filter(|p| only.is_empty() || only.iter().any(|o| o == p.name)) {
        let mut c = Command::new(&kirkas);
        c.current_dir(root());
        c.arg("render").arg(format!("scenes/lecture/{}.toml", p.scene)).arg("-o").arg(folder.join(format!("{}.png", p.name)));
        c.args(p.options).arg("--quiet");
        sh::run(&mut c)?;
    }
    Ok(())
}
