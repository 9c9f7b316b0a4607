//! The pages that are cut from the tables must be those of this build: `cargo xtask docs` writes them.

use std::fs;
use std::path::Path;
use std::process::Command;

fn check(page: &str, args: &[&str]) {
    let run = Command::new(env!("CARGO_BIN_EXE_kirkas")).args(args).output().expect("kirkas starts");
    assert!(run.status.success());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(page);
    let printed = String::from_utf8(run.stdout).expect("the page is text");
    if std::env::var_os("KIRKAS_BLESS").is_some() {
        fs::write(&path, &printed).expect("the page can be written");
    }
    let kept = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(kept == printed, "docs/{page} is out of date: run `cargo xtask docs`");
}

#[test]
fn the_manual_is_that_of_this_build() {
    check("manual.md", &["schema", "--manual"]);
}

#[test]
fn the_schema_of_explanations_is_that_of_this_build() {
    check("explanation.schema.json", &["schema", "--explanation"]);
}

#[test]
fn the_schema_is_that_of_this_build() {
    check("kirkas.schema.json", &["schema"]);
}
