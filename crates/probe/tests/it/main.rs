//! The same bits everywhere: on this machine, as stored, and as WebAssembly.

use std::path::PathBuf;
use std::process::Command;
use std::{env, fs};

/// What [`kirkas_probe::film_hash`] gives on every machine. `KIRKAS_BLESS=1` writes it anew: only for a change that is meant to
/// change pictures.
const STORED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/film_hash.txt");

#[test]
fn the_picture_has_its_stored_bits() {
    let hash = format!("{:016x}\n", kirkas_probe::film_hash());
    if env::var_os("KIRKAS_BLESS").is_some() {
        fs::write(STORED, &hash).expect("a writable tree");
    }
    let stored = fs::read_to_string(STORED).expect("a stored hash; KIRKAS_BLESS=1 writes it");
    assert_eq!(hash, stored, "this machine makes another picture than the one that was blessed");
}

#[test]
fn web_assembly_makes_the_same_picture() {
    let bytes = fs::read(built_for_the_web()).expect("the module just built");
    let engine = wasmi::Engine::default();
    let module = wasmi::Module::new(&engine, &bytes).expect("a sound module");
    let mut store = wasmi::Store::new(&engine, ());
    let instance =
        wasmi::Linker::new(&engine).instantiate_and_start(&mut store, &module).expect("it asks its host for nothing");
    let hash = instance.get_typed_func::<(), u64>(&store, "kirkas_film_hash").expect("it is exported");
    let there = hash.call(&mut store, ()).expect("no trap");
    assert_eq!(there, kirkas_probe::film_hash());
}

/// Build this crate for the web; cargo keeps what it needs beside this test's own build.
fn built_for_the_web() -> PathBuf {
    let target = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("web");
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["rustc", "--quiet", "--release", "--lib", "--crate-type", "cdylib"]);
    cargo.args([
        "--target",
        "wasm32-unknown-unknown",
        "--manifest-path",
        concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"),
    ]);
    // Flags for this machine are not for that one, and a quick build serves here.
    cargo.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS").env_remove("CARGO_BUILD_TARGET");
    cargo.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1").env("CARGO_TARGET_DIR", &target);
    let done = cargo.status().expect("cargo runs");
    assert!(done.success(), "the web build failed; `rustup target add wasm32-unknown-unknown` adds what it needs");
    target.join("wasm32-unknown-unknown/release/kirkas_probe.wasm")
}
