//! Whole renders beside POV-Ray and Mitsuba 3: from process start to written image, same samples per pixel, on every core that
//! the system gives (bind the chore to two with `taskset -c 0,1` for figures that compare).
//!
//! Mitsuba is the command `mitsuba`, or what `KIRKAS_MITSUBA` names (`pip install mitsuba`); its LLVM variant also wants a
//! libLLVM, which `DRJIT_LIBLLVM_PATH` names. Who is not there has an empty column.

use super::measured::{Measured, Meter, median};
use super::{flake, mesh};
use crate::sh::{Outcome, build_shipped, exists, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// One scene, written for each that renders it.
pub struct Case {
    /// Also the stem of its files.
    pub name: &'static str,
    pub folder: PathBuf,
    pub has_pov: bool,
    /// The variants of Mitsuba that render it.
    pub mitsuba: &'static [&'static str],
}

/// Edge of every picture.
pub const SIZE: u32 = 512;

impl Case {
    pub fn file(&self, end: &str) -> PathBuf {
        self.folder.join(format!("{}.{end}", self.name))
    }

    fn kirkas(&self, kirkas: &Path) -> Command {
        let mut c = Command::new(kirkas);
        c.arg("render").arg(self.file("toml")).arg("-o").arg(self.file("kirkas.png")).arg("--quiet");
        c
    }

    fn povray(&self) -> Command {
        let mut c = Command::new("povray");
        c.arg(format!("+I{}", self.file("pov").display())).arg(format!("+O{}", self.file("povray.png").display()));
        // Every pixel 2 x 2 samples: antialiasing method 1 with threshold 0 always supersamples.
        c.args([&format!("+W{SIZE}"), &format!("+H{SIZE}"), "+A0.0", "+AM1", "+R2", "-J", "+FN8", "-D", "-P"]);
        c
    }

    fn mitsuba(&self, mitsuba: &str, variant: &str) -> Command {
        let mut c = Command::new(mitsuba);
        c.args(["-m", variant, "-o"]).arg(self.file(&format!("{variant}.exr"))).arg(self.file("xml"));
        c
    }
}

/// `cargo xtask bench renders [--quick] [--runs N] [--json FILE]`
pub fn run(args: &[String]) -> Outcome {
    let quick = args.iter().any(|a| a == "--quick");
    let json = args.iter().position(|a| a == "--json").and_then(|i| args.get(i + 1));
    let kirkas = build_shipped()?;
    let mitsuba = std::env::var("KIRKAS_MITSUBA").unwrap_or_else(|_| "mitsuba".into());
    let (has_povray, has_mitsuba) = (exists("povray", "--version"), exists(&mitsuba, "--help"));
    let folder = root().join("target/bench");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let (depth, n) = if quick { (3, 100) } else { (5, 1000) };
    let cases = [
        flake::lit(&folder, depth)?,
        flake::mirrors(&folder, depth)?,
        mesh::lit(&folder, n)?,
        mesh::under_a_sky(&folder, n)?,
    ];
    let (meter, mut rows) = (Meter::new(), Vec::new());
    let count = args.iter().position(|a| a == "--runs").and_then(|i| args.get(i + 1)?.parse().ok());
    for case in &cases {
        let mut contestants = vec![("kirkas", case.kirkas(&kirkas))];
        if case.has_pov && has_povray {
            contestants.push(("povray", case.povray()));
        }
        if has_mitsuba {
            contestants.extend(case.mitsuba.iter().map(|v| (*v, case.mitsuba(&mitsuba, v))));
        }
        let mut runs = vec![Vec::new(); contestants.len()];
        for _ in 0..count.unwrap_or(if quick { 1 } else { 5 }) {
            // Interleaved, so that all see the same weather.
            for ((name, command), runs) in contestants.iter().zip(&mut runs) {
                match meter.run(command) {
                    Ok(m) => runs.push(m),
                    // A Mitsuba without its compiler is as good as none.
                    Err(_) if *name == COMPILED => {}
                    Err(e) => return Err(e),
                }
            }
        }
        let ours = median(&runs[0]).ok_or("no run of kirkas")?;
        let all: Vec<(&str, Option<Measured>)> =
            contestants.iter().zip(&runs).map(|((name, _), r)| (*name, median(r))).collect();
        println!("{}", table_row(case.name, ours, &all));
        rows.push(json_row(case.name, &all));
    }
    if let Some(file) = json {
        fs::write(file, format!("[\n  {}\n]\n", rows.join(",\n  "))).map_err(|e| e.to_string())?;
    }
    Ok(())
}

/// The variant of Mitsuba that takes one ray after the other.
pub const SCALAR: &str = "scalar_rgb";
/// The one that compiles its kernels (and keeps them for the next run).
pub const COMPILED: &str = "llvm_ad_rgb";

fn table_row(scene: &str, ours: Measured, all: &[(&str, Option<Measured>)]) -> String {
    let cell = |(name, m): &(&str, Option<Measured>)| {
        let Some(m) = m else { return format!("{name} absent") };
        let memory = m.megabytes.map_or(String::new(), |mb| format!(" {mb:.0} MB"));
        let ratio = if *name == "kirkas" { String::new() } else { format!(" x{:.2}", m.seconds / ours.seconds) };
        format!("{name} {:.2} s{memory}{ratio}", m.seconds)
    };
    format!("{scene:10} {}", all.iter().map(cell).collect::<Vec<_>>().join("   "))
}

fn json_row(scene: &str, all: &[(&str, Option<Measured>)]) -> String {
    let number = |x: Option<f64>| x.map_or("null".to_string(), |x| format!("{x:.3}"));
    let field = |(name, m): &(&str, Option<Measured>)| {
        let (seconds, megabytes) = (m.map(|m| m.seconds), m.and_then(|m| m.megabytes));
        format!("\"{name}_s\": {}, \"{name}_mb\": {}", number(seconds), number(megabytes))
    };
    format!("{{\"scene\": \"{scene}\", {}}}", all.iter().map(field).collect::<Vec<_>>().join(", "))
}

/// How Mitsuba's scenes begin: paths of `bounces`, this camera, a box filter.
pub fn mitsuba_head(bounces: u32, samples: u32, eye: [f64; 3], sky: [f64; 3]) -> String {
    let words = |v: [f64; 3]| format!("{}, {}, {}", v[0], v[1], v[2]);
    format!(
        "<scene version=\"3.0.0\">\n\
         <integrator type=\"path\"><integer name=\"max_depth\" value=\"{}\"/><integer name=\"rr_depth\" value=\"1000\"/></integrator>\n\
         <sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/><string name=\"fov_axis\" value=\"x\"/>\n\
         <transform name=\"to_world\"><lookat origin=\"{}\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>\n\
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"{SIZE}\"/><integer name=\"height\" value=\"{SIZE}\"/><rfilter type=\"box\"/></film>\n\
         <sampler type=\"independent\"><integer name=\"sample_count\" value=\"{samples}\"/></sampler></sensor>\n\
         <emitter type=\"constant\"><rgb name=\"radiance\" value=\"{}\"/></emitter>\n",
        bounces + 1,
        words(eye),
        words(sky)
    )
}

/// Write a file of a case.
pub fn write(case: &Case, end: &str, text: &str) -> Outcome {
    fs::write(case.file(end), text).map_err(|e| e.to_string())
}

/// How the lit scenes begin.
pub const LIT_HEAD: &str = "[film]\nwidth = 512\nheight = 512\nfilter = \"box\"\n[sampler]\nsamples = 4\n\
[background]\ncolor = [0.35, 0.5, 0.7]\n[lights.ambient]\ntype = \"ambient\"\n\
[lights.lamp]\ntype = \"point\"\nposition = [4, 7, 5]\nintensity = 0.9\nattenuation = [0, 0, 1]\n";
/// The same for POV-Ray.
pub const LIT_POV_HEAD: &str =
    "#version 3.7;\nbackground { rgb <0.35, 0.5, 0.7> }\nlight_source { <4, 7, 5> rgb 0.9 }\n";
