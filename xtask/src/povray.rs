//! Kirkas beside POV-Ray: six scenes, written for both by [`crate::both`], compared pixel by pixel.

use crate::both::{Body, Lamp, Scene, Surface};
use crate::sh::{Outcome, build_kirkas, exists, output, root};
use std::fs;
use std::path::Path;
use std::process::Command;

const WIDTH: u32 = 400;
const HEIGHT: u32 = 300;

/// Share of pixels that must be within 3/255.
const LEAST: f64 = 99.0;

/// `cargo xtask povray`
pub fn run(_: &[String]) -> Outcome {
    if !exists("povray", "--version") {
        return Err("POV-Ray is not installed (Debian: apt-get install povray)".into());
    }
    let kirkas = build_kirkas()?;
    let folder = root().join("target/povray");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let mut failed = Vec::new();
    println!("scene                      pixels within 3/255");
    for scene in scenes() {
        let within = compare(&kirkas, &folder, &scene)?;
        println!("{:26} {within:.3} %", scene.name);
        if within < LEAST {
            failed.push(scene.name);
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("below {LEAST} %: {}", failed.join(", "))) }
}

fn compare(kirkas: &Path, folder: &Path, scene: &Scene) -> Result<f64, String> {
    let file = |end: &str| folder.join(format!("{}{end}", scene.name));
    fs::write(file(".toml"), scene.to_toml(WIDTH, HEIGHT)).map_err(|e| e.to_string())?;
    fs::write(file(".pov"), scene.to_pov()).map_err(|e| e.to_string())?;
    output(Command::new(kirkas).arg("render").arg(file(".toml")).arg("-o").arg(file("_kirkas.png")).arg("--quiet"))?;
    output(
        Command::new("povray")
            .arg(format!("+I{}", file(".pov").display()))
            .arg(format!("+O{}", file("_povray.png").display()))
            .args([&format!("+W{WIDTH}"), &format!("+H{HEIGHT}"), "+FN8", "File_Gamma=1.0", "-D", "-P", "-A"]),
    )?;
    let text =
        output(Command::new(kirkas).arg("diff").arg(file("_kirkas.png")).arg(file("_povray.png")).arg("--verbose"))?;
    let line = text.lines().find_map(|l| l.strip_prefix("pixels within 3/255: ")).ok_or("diff said nothing")?;
    line.trim_end_matches(" %").parse().map_err(|e| format!("{line}: {e}"))
}

/// The six.
fn scenes() -> Vec<Scene> {
    let red = Surface::Matte { color: [0.9, 0.3, 0.2], ambient: 0.1, diffuse: 0.8 };
    let blue = Surface::Matte { color: [0.2, 0.4, 0.9], ambient: 0.1, diffuse: 0.8 };
    let grey = Surface::Matte { color: [0.8, 0.8, 0.75], ambient: 0.1, diffuse: 0.7 };
    let glow = Surface::Glowing { a: [0.85, 0.8, 0.7], b: [0.25, 0.2, 0.3], size: 1.0 };
    let sky = [0.35, 0.5, 0.7];
    let clear = |ior| Surface::Glass { ior, priority: 0 };
    let base = |name| Scene {
        name,
        camera: ([0.0, 2.5, 7.0], [0.0, 0.8, 0.0]),
        fov: 45.0,
        sky,
        depth: 8,
        lamps: vec![Lamp::Point([4.0, 7.0, 5.0], 0.9)],
        bodies: vec![(Body::Floor(0.0), grey)],
    };
    let with = |name, bodies: Vec<(Body, Surface)>| Scene { bodies, ..base(name) };
    vec![
        with(
            "shadow",
            vec![
                (Body::Floor(0.0), grey),
                (Body::Sphere([0.0, 1.0, 0.0], 1.0), red),
                (Body::Block([1.3, 0.0, -0.5], [2.3, 1.6, 0.5]), blue),
            ],
        ),
        with(
            "mirror",
            vec![
                (Body::Floor(0.0), Surface::Mirror { color: [0.7; 3], ambient: 0.1, diffuse: 0.5, reflect: 0.3 }),
                (
                    Body::Sphere([-1.1, 1.0, 0.0], 1.0),
                    Surface::Mirror { color: [1.0; 3], ambient: 0.0, diffuse: 0.0, reflect: 0.8 },
                ),
                (
                    Body::Sphere([1.1, 1.0, 0.0], 1.0),
                    Surface::Mirror { color: [0.9, 0.6, 0.2], ambient: 0.1, diffuse: 0.4, reflect: 0.5 },
                ),
            ],
        ),
        Scene {
            lamps: Vec::new(),
            bodies: vec![
                (Body::Floor(-0.005), glow),
                (Body::Sphere([-1.2, 1.0, 0.0], 1.0), clear(1.5)),
                (Body::Sphere([1.2, 1.2, 0.4], 1.2), clear(1.333)),
            ],
            ..base("glass")
        },
        Scene {
            lamps: Vec::new(),
            camera: ([2.4, 1.6, 5.0], [0.0, 0.8, 0.0]),
            bodies: vec![(Body::Floor(-0.005), glow), (Body::Block([-1.3, 0.2, -1.0], [1.3, 1.8, 1.0]), clear(1.6))],
            ..base("total_internal_reflection")
        },
        Scene {
            lamps: Vec::new(),
            bodies: vec![
                (Body::Floor(-0.005), glow),
                // Refraction alone: POV-Ray loses most of what inner boundaries reflect (see VALIDATION.md).
                (Body::Sphere([0.0, 1.4, 0.0], 1.4), Surface::Clear { ior: 1.3, priority: 0 }),
                (Body::Sphere([0.0, 1.4, 0.0], 0.9), Surface::Clear { ior: 1.6, priority: 1 }),
            ],
            ..base("nested_glass")
        },
        Scene {
            lamps: vec![Lamp::Spot([3.0, 5.0, 3.0], [0.0, 0.4, 0.0], 12.0, 20.0)],
            bodies: vec![(Body::Floor(0.0), grey), (Body::Sphere([0.0, 1.0, 0.0], 1.0), red)],
            ..base("spotlight")
        },
    ]
}
