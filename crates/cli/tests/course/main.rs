//! MIT 6.837's own scenes at the course's own flags, beside two students' pictures (2004). Needs `KIRKAS_DATA`.
//!
//! `cargo test -p kirkas-cli --test course -- --nocapture` prints the table of VALIDATION.md.

use kirkas_images::decode;
use kirkas_images::metrics::fraction_within;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const STUDENTS: [&str; 2] = ["tsssni+mit-6.837", "zhanzhanfu+MIT-CG6.837-2004"];

/// Share of pixels within 3/255 that a picture on which both students agree must reach.
const LEAST: f64 = 0.99;

fn data(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("KIRKAS_DATA").map(|d| PathBuf::from(d).join("mit6837"));
    if folder.is_none() {
        println!("skipped: {test} (KIRKAS_DATA is not set)");
    }
    folder
}

fn render(scene: &Path, out: &Path, options: &[String]) {
    let run = Command::new(env!("CARGO_BIN_EXE_kirkas"))
        .arg("render")
        .arg(scene)
        .arg("-o")
        .arg(out)
        .args(options)
        .arg("--quiet")
        .output()
        .expect("kirkas starts");
    assert!(run.status.success(), "{}: {}", scene.display(), String::from_utf8_lossy(&run.stderr));
}

/// The course's flags as Kirkas takes them, and which picture is meant.
fn options(flags: &str) -> (Vec<String>, &'static str) {
    let words: Vec<&str> = flags.split_whitespace().collect();
    let value = |flag: &str, i: usize| words.iter().position(|w| *w == flag).map(|at| words[at + i].to_string());
    let mut options = Vec::new();
    let mut set = |path: &str, v: String| options.extend(["-D".to_string(), format!("integrator.{path}={v}")]);
    if words.contains(&"-shadows") {
        set("shadows", "opaque".into());
    }
    if words.contains(&"-shade_back") {
        set("shade_back", "true".into());
    }
    if let Some(bounces) = value("-bounces", 1) {
        set("max_depth", bounces);
    }
    if let Some(weight) = value("-weight", 1) {
        set("min_contribution", weight);
    }
    if let (Some(width), Some(height)) = (value("-size", 1), value("-size", 2)) {
        options.extend(["--size".into(), format!("{width}x{height}")]);
    }
    if let (Some(near), Some(far)) = (value("-depth", 1), value("-depth", 2)) {
        options.extend(["--aov".into(), format!("depth:{near}:{far}")]);
        return (options, "depth");
    }
    if words.contains(&"-normals") {
        options.extend(["--aov".into(), "normals".into()]);
        return (options, "normals");
    }
    (options, "")
}

/// Pictures and their commands, from the course's list; "a|b" are two names of one picture.
fn commands(folder: &Path) -> BTreeMap<String, (String, String)> {
    let text = fs::read_to_string(folder.join("2004/COMMANDS.txt")).expect("the list of commands");
    let mut all = BTreeMap::new();
    for line in text.lines().filter(|l| !l.starts_with('#') && !l.trim().is_empty()) {
        let mut columns = line.split('\t');
        let (names, scene, flags) =
            (columns.next().unwrap_or(""), columns.next().unwrap_or(""), columns.next().unwrap_or(""));
        let mut letters = names.split('|');
        let first = letters.next().unwrap_or("").to_string();
        let stem = first[..first.len() - 1].to_string();
        for name in std::iter::once(first.clone()).chain(letters.map(|l| format!("{stem}{l}"))) {
            all.insert(name, (scene.to_string(), flags.to_string()));
        }
    }
    all
}

fn codes(path: &Path) -> Vec<u8> {
    let bytes = fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let hint = path.extension().and_then(|e| e.to_str());
    let picture = decode(&bytes, hint).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    picture.raw().iter().flat_map(|p| [p[0], p[1], p[2]]).map(|c| (c * 255.0).round() as u8).collect()
}

#[test]
fn pictures_on_which_both_students_agree_agree_with_ours() {
    let Some(folder) = data("pictures_on_which_both_students_agree_agree_with_ours") else { return };
    let commands = commands(&folder);
    let work = std::env::temp_dir().join(format!("kirkas-course-{}", std::process::id()));
    fs::create_dir_all(&work).unwrap();
    let consensus = fs::read_to_string(folder.join("2004/CONSENSUS.tsv")).unwrap();
    let (mut agreed, mut wrong) = (0, Vec::new());
    println!("| picture | students agree | {} | {} |\n|---|---|---|---|", STUDENTS[0], STUDENTS[1]);
    for line in consensus.lines().skip(1) {
        let columns: Vec<&str> = line.split('\t').collect();
        let (file, agree, assignment) = (columns[0], columns[3], columns[4]);
        let name = file.trim_end_matches(".tga");
        // Variants without a published command (7_02a ...) show filters and sampling patterns of the students' own choice.
        let Some((scene, flags)) = commands.get(name) else { continue };
        let (options, which) = options(flags);
        let out = work.join(format!("{name}.png"));
        let assignment = folder.join("2004").join(assignment);
        render(&assignment.join(scene), &out, &options);
        let ours = codes(&if which.is_empty() { out } else { work.join(format!("{name}.{which}.png")) });
        let shares = STUDENTS.map(|s| {
            let theirs = codes(&assignment.join("student-outputs").join(s).join(file));
            fraction_within(&ours, &theirs, 3).unwrap_or(0.0)
        });
        println!("| {name} | {agree} | {:.2} % | {:.2} % |", shares[0] * 100.0, shares[1] * 100.0);
        if agree == "yes" {
            agreed += 1;
            if shares[0].min(shares[1]) < LEAST {
                wrong.push(name.to_string());
            }
        }
    }
    let _ = fs::remove_dir_all(&work);
    assert!(agreed >= 20, "only {agreed} pictures were compared");
    assert!(wrong.is_empty(), "too far from both students: {wrong:?}");
}

#[test]
fn every_scene_of_the_course_renders() {
    let Some(folder) = data("every_scene_of_the_course_renders") else { return };
    let work = std::env::temp_dir().join(format!("kirkas-course-all-{}", std::process::id()));
    fs::create_dir_all(&work).unwrap();
    let mut scenes = Vec::new();
    for part in
        ["2004/Assignment1", "2004/Assignment2", "2004/Assignment4", "2004/Assignment6", "2004/Assignment7", "2012"]
    {
        for entry in fs::read_dir(folder.join(part)).unwrap().flatten() {
            let path = entry.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name.starts_with("scene") && name.ends_with(".txt") {
                scenes.push(path);
            }
        }
    }
    assert!(scenes.len() >= 35, "only {} scenes", scenes.len());
    for scene in &scenes {
        // No flags at all, then the most that the course uses.
        render(scene, &work.join("plain.png"), &[]);
        let (options, _) = options("-size 100 100 -shadows -shade_back -bounces 5 -weight 0.01");
        render(scene, &work.join("full.png"), &options);
    }
    let _ = fs::remove_dir_all(&work);
}
