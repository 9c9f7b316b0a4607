//! Any bytes give a description or a clear error: no panic, no hang, every span in its text.

use crate::show::{bytes, failure};
use kirkas_formats::toml::read;
use proptest::prelude::*;

const VALID: &str = r##"
version = 1
title = "Everything é"
description = """
two
lines"""
include = []
[film]
width = 320 # comment
crop = [[0, 0.5], [1e-3, +inf]]
[cameras."ma in"]
type = 'perspective'
position = [0, 1_000, 0x1F]
[lights]
a = { type = "point", intensity = 1.5 }
b.type = "spot"
[objects.heap]
type = "mesh"
transform = [{ scale = 2 }, { rotate = [0, 1, 0, 90] }]
"##;

fn survive(content: &[u8]) {
    if let Err(f) = read(&bytes(&[("s.toml", content)]), "s.toml") {
        assert!(!f.diagnostics.is_empty());
        // Looks up every span.
        let _ = failure(&f);
    }
}

#[test]
fn every_truncation_is_survived() {
    assert!(read(&bytes(&[("s.toml", VALID.as_bytes())]), "s.toml").is_ok());
    (0..VALID.len()).for_each(|n| survive(&VALID.as_bytes()[..n]));
}

#[test]
fn every_lost_or_doubled_byte_is_survived() {
    for i in 0..VALID.len() {
        let (before, after) = VALID.as_bytes().split_at(i);
        survive(&[before, &after[1..]].concat());
        survive(&[before, &after[..1], after].concat());
        survive(&[before, b"[", after].concat());
    }
}

#[test]
fn deep_nesting_is_refused_without_a_fall() {
    let deep = 200_000;
    for text in [
        format!("a = {}", "[".repeat(deep)),
        format!("a = {}1{}", "[".repeat(deep), "]".repeat(deep)),
        format!("a = {}", "{a=".repeat(deep)),
        format!("{}a = 1", "a.".repeat(deep)),
        format!("[{}a]", "a.".repeat(deep)),
        "[".repeat(deep),
        "[[a]]\n".repeat(deep),
        format!("a = {}", "{a.a.a.a.a.a.a.a=[".repeat(deep)),
    ] {
        let f = read(&bytes(&[("s.toml", text.as_bytes())]), "s.toml").unwrap_err();
        assert!(failure(&f).len() < deep * 4);
    }
}

proptest! {
    #[test]
    fn random_bytes_are_survived(content in prop::collection::vec(any::<u8>(), 0..200)) {
        survive(&content);
    }

    #[test]
    fn random_toml_like_text_is_survived(words in prop::collection::vec(prop::sample::select(WORDS), 0..40)) {
        survive(words.concat().as_bytes());
    }
}

const WORDS: &[&str] = &[
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    ".",
    "\n",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "#",
    " ",
    "\r\n",
    "film",
    "objects",
    "a",
    "b",
    "type",
    "include",
    "title",
    "version",
    "1",
    "0x",
    "1e",
    "-",
    "+",
    "inf",
    "nan",
    "true",
    "2024-01-01",
    "T07:00",
    "\\u00e9",
    "é",
    "\u{0}",
];

#[test]
fn long_texts_take_time_in_proportion() {
    // Each of these took minutes if it were quadratic.
    let many = 200_000;
    let objects: String = (0..many / 4).map(|i| format!("[objects.o{i}]\ntype = 'sphere'\n")).collect();
    let keys: String =
        std::iter::once("[film]\n".to_string()).chain((0..many).map(|i| format!("k{i} = 1\n"))).collect();
    for text in ["= ".repeat(many), "=\n".repeat(many), "[a]\n".repeat(many), objects, keys] {
        survive(text.as_bytes());
    }
}
