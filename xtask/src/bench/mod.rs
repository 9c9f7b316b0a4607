//! Time beside POV-Ray, in one run: from process start to written image, both on two threads, same samples per pixel.

use crate::sh::{self, Outcome, build_kirkas, cargo, exists, output, root};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// `cargo xtask bench [kernel] [--quick] [--json FILE]`
pub fn run(args: &[String]) -> Outcome {
    if let Some(("kernel", rest)) = args.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        return kernel(rest);
    }
    let quick = args.iter().any(|a| a == "--quick");
    let json = args.iter().position(|a| a == "--json").and_then(|i| args.get(i + 1));
    let has_povray = exists("povray", "--version");
    let kirkas = build_kirkas()?;
    let folder = root().join("target/bench");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let runs = if quick { 1 } else { 5 };
    let mut rows = Vec::new();
    for case in [sphereflake(&folder, if quick { 3 } else { 5 })?, mesh(&folder, if quick { 100 } else { 1000 })?] {
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for _ in 0..runs {
            // Interleaved, so that both see the same weather.
            ours.push(seconds(&mut case.kirkas(&kirkas))?);
            if has_povray {
                theirs.push(seconds(&mut case.povray())?);
            }
        }
        let (k, p) = (median(&mut ours), has_povray.then(|| median(&mut theirs)));
        let ratio = p.map(|p| p / k);
        let number = |x: Option<f64>| x.map_or("absent".to_string(), |x| format!("{x:.2}"));
        println!("{:12} kirkas {k:.2} s   povray {} s   ratio {}", case.name, number(p), number(ratio));
        rows.push(format!(
            "{{\"scene\": \"{}\", \"kirkas_s\": {k:.3}, \"povray_s\": {}, \"ratio\": {}}}",
            case.name,
            p.map_or("null".into(), |x| format!("{x:.3}")),
            ratio.map_or("null".into(), |x| format!("{x:.3}"))
        ));
    }
    if let Some(file) = json {
        fs::write(file, format!("[\n  {}\n]\n", rows.join(",\n  "))).map_err(|e| e.to_string())?;
    }
    Ok(())
}

/// The ray kernel beside Embree 3; takes the options of `kernel --help`.
fn kernel(args: &[String]) -> Outcome {
    let program = ["run", "--release", "--package", "kirkas-bench", "--bin", "kernel", "--"];
    sh::run(cargo().args(program).args(args))
}

/// One scene for both.
struct Case {
    name: &'static str,
    toml: PathBuf,
    pov: PathBuf,
}

/// Both antialias with 2 x 2 samples per pixel.
const SIZE: u32 = 512;

impl Case {
    fn kirkas(&self, kirkas: &Path) -> Command {
        let mut c = Command::new(kirkas);
        c.arg("render").arg(&self.toml).arg("-o").arg(self.toml.with_extension("kirkas.png")).args([
            "--quiet",
            "--threads",
            "2",
        ]);
        c
    }

    fn povray(&self) -> Command {
        let mut c = Command::new("povray");
        c.arg(format!("+I{}", self.pov.display()))
            .arg(format!("+O{}", self.pov.with_extension("povray.png").display()));
        // Every pixel 2 x 2 samples: antialiasing method 1 with threshold 0 always supersamples.
        c.args([&format!("+W{SIZE}"), &format!("+H{SIZE}"), "+A0.0", "+AM1", "+R2", "-J", "+FN8", "-D", "-P", "+WT2"]);
        c
    }
}

fn seconds(c: &mut Command) -> Result<f64, String> {
    let start = Instant::now();
    output(c)?;
    Ok(start.elapsed().as_secs_f64())
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

const HEAD: &str = "[film]\nwidth = 512\nheight = 512\nfilter = \"box\"\n[sampler]\nsamples = 4\n\
[background]\ncolor = [0.35, 0.5, 0.7]\n[lights.ambient]\ntype = \"ambient\"\n\
[lights.lamp]\ntype = \"point\"\nposition = [4, 7, 5]\nintensity = 0.9\nattenuation = [0, 0, 1]\n";
const POV_HEAD: &str = "#version 3.7;\nbackground { rgb <0.35, 0.5, 0.7> }\nlight_source { <4, 7, 5> rgb 0.9 }\n";

/// 66,430 mirror spheres over a floor, at most five bounces.
fn sphereflake(folder: &Path, depth: u32) -> Result<Case, String> {
    let case = Case { name: "sphereflake", toml: folder.join("flake.toml"), pov: folder.join("flake.pov") };
    let toml = format!(
        "{HEAD}[integrator]\nmax_depth = 5\nmin_contribution = 0.004\n\
         [cameras.main]\ntype = \"perspective\"\nposition = [2.1, 1.3, 1.7]\nlook_at = [0, 0, 0]\nfov = 45\nfov_axis = \"horizontal\"\n\
         [materials.flake]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0.2\nambient = 0.04\nreflect = 0.7\n\
         [materials.floor]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0.6\nambient = 0.1\n\
         [objects.flake]\ntype = \"sphereflake\"\nradius = 0.5\ndepth = {depth}\naxis = [0, 0, 1]\nmaterial = \"flake\"\n\
         [objects.floor]\ntype = \"plane\"\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n"
    );
    let mut pov = format!(
        "{POV_HEAD}global_settings {{ assumed_gamma 1.0 max_trace_level 6 adc_bailout 0.004 ambient_light rgb 1 }}\n\
         camera {{ perspective location <2.1, 1.3, 1.7> right -x up y sky y angle 45 look_at <0, 0, 0> }}\n\
         plane {{ y, -1 pigment {{ rgb 1 }} finish {{ ambient 0.1 diffuse 0.6 }} }}\n\
         #declare F = texture {{ pigment {{ rgb 1 }} finish {{ ambient 0.04 diffuse 0.2 reflection {{ 0.7 }} }} }}\nunion {{\n"
    );
    flake(&mut pov, [0.0; 3], 0.5, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], depth);
    pov.push_str("texture { F } }\n");
    write(&case, &toml, &pov)?;
    Ok(case)
}

/// The sphereflake again, as plainly as can be: the twin of the renderer's own.
fn flake(out: &mut String, center: [f64; 3], radius: f64, frame: [[f64; 3]; 3], depth: u32) {
    let _ = writeln!(out, "sphere {{ <{}, {}, {}>, {radius} }}", center[0], center[1], center[2]);
    if depth == 0 {
        return;
    }
    let (third, h) = (radius / 3.0, 0.75_f64.sqrt());
    for quarter in [(1.0, 0.0), (-0.5, h), (-0.5, -h)] {
        for d in [[h, -0.5, 0.0], [h, 0.5, 0.0], [(1.0_f64 / 3.0).sqrt(), 0.0, (2.0_f64 / 3.0).sqrt()]] {
            let d = [quarter.0 * d[0] - quarter.1 * d[1], quarter.1 * d[0] + quarter.0 * d[1], d[2]];
            let along: [f64; 3] = std::array::from_fn(|k| (0..3).map(|j| frame[j][k] * d[j]).sum());
            let at: [f64; 3] = std::array::from_fn(|k| center[k] + along[k] * (radius + third));
            flake(out, at, third, turned(frame, along), depth - 1);
        }
    }
}

/// The frame turned the shortest way so that its last axis becomes `z`.
fn turned(frame: [[f64; 3]; 3], z: [f64; 3]) -> [[f64; 3]; 3] {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let (axis, c) = (cross(frame[2], z), dot(frame[2], z));
    let turn = |v: [f64; 3]| {
        let (w, s) = (cross(axis, v), dot(axis, v) / (1.0 + c));
        std::array::from_fn(|k| v[k] * c + w[k] + axis[k] * s)
    };
    [turn(frame[0]), turn(frame[1]), z]
}

/// A displaced sphere of `2 n^2 / 2` triangles: a million for n = 1000.
fn mesh(folder: &Path, n: usize) -> Result<Case, String> {
    let case = Case { name: "mesh", toml: folder.join("mesh.toml"), pov: folder.join("mesh.pov") };
    let (rows, columns) = (n / 2, n);
    let mut points = Vec::new();
    for i in 0..=rows {
        for j in 0..columns {
            let (theta, phi) =
                (std::f64::consts::PI * i as f64 / rows as f64, std::f64::consts::TAU * j as f64 / columns as f64);
            let r = 1.0
                + 0.05 * (9.0 * theta).sin() * (11.0 * phi).sin()
                + 0.01 * (60.0 * theta).sin() * (70.0 * phi).cos();
            points.push([r * theta.sin() * phi.cos(), r * theta.cos(), r * theta.sin() * phi.sin()].map(|x| x as f32));
        }
    }
    let mut faces = Vec::new();
    let at = |i: usize, j: usize| (i * columns + j % columns) as u32;
    for i in 0..rows {
        for j in 0..columns {
            faces.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            faces.push([at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
    }
    write_ply(&folder.join("mesh.ply"), &points, &faces).map_err(|e| e.to_string())?;
    let toml = format!(
        "{HEAD}[cameras.main]\ntype = \"perspective\"\nposition = [1.2, 1.4, 2.6]\nlook_at = [0, 0, 0]\nfov = 45\nfov_axis = \"horizontal\"\n\
         [materials.clay]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0.7\nambient = 0.1\n\
         [objects.mesh]\ntype = \"mesh\"\nfile = \"mesh.ply\"\nmaterial = \"clay\"\n\
         [objects.floor]\ntype = \"plane\"\npoint = [0, -1.1, 0]\nnormal = [0, 1, 0]\nmaterial = \"clay\"\n"
    );
    let mut pov = format!(
        "{POV_HEAD}global_settings {{ assumed_gamma 1.0 ambient_light rgb 1 }}\n\
         camera {{ perspective location <1.2, 1.4, 2.6> right -x up y sky y angle 45 look_at <0, 0, 0> }}\n\
         #declare C = texture {{ pigment {{ rgb 1 }} finish {{ ambient 0.1 diffuse 0.7 }} }}\n\
         plane {{ y, -1.1 texture {{ C }} }}\nmesh2 {{ vertex_vectors {{ {}",
        points.len()
    );
    for p in &points {
        let _ = write!(pov, ",<{},{},{}>", p[0], p[1], p[2]);
    }
    let _ = write!(pov, "}}\nface_indices {{ {}", faces.len());
    for f in &faces {
        let _ = write!(pov, ",<{},{},{}>", f[0], f[1], f[2]);
    }
    pov.push_str("}\ntexture { C } }\n");
    write(&case, &toml, &pov)?;
    Ok(case)
}

fn write(case: &Case, toml: &str, pov: &str) -> Outcome {
    fs::write(&case.toml, toml).and_then(|()| fs::write(&case.pov, pov)).map_err(|e| e.to_string())
}

fn write_ply(path: &Path, points: &[[f32; 3]], faces: &[[u32; 3]]) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(fs::File::create(path)?);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        points.len(),
        faces.len()
    )?;
    for c in points.iter().flatten() {
        out.write_all(&c.to_le_bytes())?;
    }
    for f in faces {
        out.write_all(&[3])?;
        for i in f {
            out.write_all(&i.to_le_bytes())?;
        }
    }
    out.flush()
}
