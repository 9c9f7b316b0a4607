//! The words of every error.

use crate::show::{bytes, diagnostic, failure, files};
use kirkas_formats::toml::{apply_override, read};
use kirkas_scene::Description;
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

#[track_caller]
fn check(text: &str, expected: &str) {
    check_files(&[("s.toml", text)], expected);
}

#[track_caller]
fn check_files(all: &[(&str, &str)], expected: &str) {
    let found = failure(&read(&files(all), "s.toml").expect_err("an error"));
    assert_eq!(found, expected, "\n{found}\n");
}

#[track_caller]
fn check_override(text: &str, expected: &str) {
    let mut d = Description::default();
    let error = apply_override(&mut d, text).expect_err("an error");
    let found = diagnostic(&d.sources, &error);
    assert_eq!(found, expected, "\n{found}\n");
}

#[test]
fn syntax() {
    check("width = \n", "s.toml:1:9 \"\": here: a value is missing | write `name = value`");
    check(
        "[film]\nwidth = 3 4\nheight = = 2\n[foo\nx = 1",
        "s.toml:2:9 \"3 4\": here: a text must stand in quotes | write `\"...\"`\ns.toml:3:10 \"=\": here: extra `=` | see https://toml.io for how TOML is written\ns.toml:4:5 \"\": here: this header does not end | close it with `]`",
    );
    check(
        "a = \"abc\nb=1",
        "s.toml:1:9 \"\": here: this text does not end | close it with the quote that it began with",
    );
    check(
        "a = [1, 2\nb = 3\n",
        "s.toml:2:1 \"\": here: a comma or an end is missing | put a comma between values, and close what was opened",
    );
    check(
        "a = { x = 1\n b=2",
        "s.toml:2:2 \"\": here: a comma or an end is missing | put a comma between values, and close what was opened",
    );
    check("width", "s.toml:1:6 \"\": here: this name has no value | write `name = value`");
    check("= 3", "s.toml:1:1 \"\": here: a name is missing | write a name of letters, digits, `_` and `-`");
    check(
        "a = \"\\q\"",
        "s.toml:1:7 \"\": here: a backslash begins a sign such as `\\n` | write `\\\\` for the backslash itself",
    );
    check("a = 01", "s.toml:1:5 \"0\": here: a number does not begin with 0 | leave the leading zeros out");
    check(
        "a = tru",
        "s.toml:1:5 \"tru\": here: neither `true` nor `false` | write `true` or `false`, or put a text in quotes",
    );
    check("[[[", "s.toml:1:3 \"\": here: a name is missing | write a name of letters, digits, `_` and `-`");
    check("]", "s.toml:1:1 \"\": here: missing table open, expected `[` | see https://toml.io for how TOML is written");
    check(
        "é = 1",
        "s.toml:1:1 \"é\": here: this name needs quotes | only letters a-z, digits, `_` and `-` stand without",
    );
    check("a = 1 b = 2", "s.toml:1:9 \"\": here: one line says one thing | begin a new line here");
    check("a = .5", "s.toml:1:5 \"\": here: a digit is missing beside the point | write `0.5` and `5.0`");
    check("a = {x=1", "s.toml:1:9 \"\": here: this table does not end | close it with `}`");
    check("a = [1,", "s.toml:1:8 \"\": here: this list does not end | close it with `]`");
    check(
        "[film]\nwidth = 1\nwidth = 2",
        "s.toml:3:1 \"width\": here: this name is already taken | a name stands once in its table: rename or remove one",
    );
    check(
        "[a]\nx=1\n[a]\ny=2",
        "s.toml:3:2 \"a\": here: this name is already taken | a name stands once in its table: rename or remove one",
    );
}

#[test]
fn values() {
    check(
        "a = 2024-01-01\nb = 1e999\nc = 99999999999999999999\nd = 0x1F",
        "s.toml:1:5 \"2024-01-01\": here: a date is not a value in a scene | put it in quotes if it is a text\ns.toml:2:5 \"1e999\": here: this number is too large | numbers go up to about 1.8e308\ns.toml:3:5 \"99999999999999999999\": here: this whole number is too large | write it as a float, such as 1e20",
    );
}

#[test]
fn sections() {
    check(
        "[fillm]\nwidth = 1\n[material.red]\ntype='x'\n[xyzzy]",
        "s.toml:1:2 \"fillm\": not known: unknown section `fillm`; did you mean `film`? | write `film`, or one of: `accelerator`, `background`, `cameras`, `description`, `film`, `include`, `integrator`, `lights`, `materials`, `media`, `objects`, `phases`, `sampler`, `textures`, `title`, `version`\ns.toml:3:2 \"material\": not known: unknown section `material`; did you mean `materials`? | write `materials`, or one of: `accelerator`, `background`, `cameras`, `description`, `film`, `include`, `integrator`, `lights`, `materials`, `media`, `objects`, `phases`, `sampler`, `textures`, `title`, `version`\ns.toml:5:2 \"xyzzy\": not known: unknown section `xyzzy` | write one of: `accelerator`, `background`, `cameras`, `description`, `film`, `include`, `integrator`, `lights`, `materials`, `media`, `objects`, `phases`, `sampler`, `textures`, `title`, `version`",
    );
    check(
        "version = 2",
        "s.toml:1:11 \"2\": another version: this Kirkas reads version 1 of the scene format | write `version = 1`, or use the Kirkas that this scene was made for",
    );
    check(
        "version = 'x'",
        "s.toml:1:11 \"'x'\": another version: this Kirkas reads version 1 of the scene format | write `version = 1`, or use the Kirkas that this scene was made for",
    );
    check(
        "title = 3\ndescription = []\ninclude = 3",
        "s.toml:3:11 \"3\": expected a path: `include` takes paths, not a whole number | write `include = [\"studio.toml\"]`\ns.toml:1:9 \"3\": expected a text: `title` takes a text, not a whole number | put it in quotes\ns.toml:2:15 \"[]\": expected a text: `description` takes a text, not a list | put it in quotes",
    );
    check(
        "[[objects]]\ntype='sphere'",
        "s.toml:1:3 \"objects\": here: objects have names | write [objects.NAME], with single brackets, and its values below",
    );
    check(
        "[[film]]\nwidth=1",
        "s.toml:1:3 \"film\": here: a scene has one film | write [film], with single brackets, and its values below",
    );
    check(
        "[materials]\ntype = 'lambert'",
        "s.toml:2:1 \"type\": whose?: `type` stands in [materials], but materials have names | write [materials.NAME] above it",
    );
    check(
        "film = 3\nobjects = [1]",
        "s.toml:1:1 \"film\": here: `film` is a table, not a whole number | write [film], with single brackets, and its values below\ns.toml:2:1 \"objects\": here: `objects` is a table, not a list | write [objects.NAME], with single brackets, and its values below",
    );
    check(
        "[objects.a]\ntype = 3",
        "s.toml:2:8 \"3\": expected a text: `type` takes a text, not a whole number | write `type = \"NAME\"`",
    );
}

#[test]
fn includes() {
    check(
        "include = ['none.toml', '../up.toml', 's.toml', 3]",
        "s.toml:1:12 \"'none.toml'\": included here: there is no file `none.toml` | check the name; paths are relative to the file that names them\ns.toml:1:25 \"'../up.toml'\": included here: `../up.toml` lies outside the scene's folder | a scene reads only below its root folder; move the file there\ns.toml:1:39 \"'s.toml'\": included here: `s.toml` includes itself: `s.toml` -> `s.toml` | remove one of these includes\ns.toml:1:49 \"3\": expected a path: `include` takes paths, not a whole number | write `include = [\"studio.toml\"]`",
    );
}

#[test]
fn overrides() {
    check_override(
        "integrator.max_depth",
        "-D:1:1 \"integrator.max_depth\": no value: `integrator.max_depth` sets nothing | write `-D path.to.value=VALUE`, such as `-D integrator.max_depth=3`",
    );
    check_override(
        "film.width=",
        "-D:1:1 \"film.width=\": no value: `film.width=` sets nothing | write `-D path.to.value=VALUE`, such as `-D integrator.max_depth=3`",
    );
    check_override(
        "fim.width=3",
        "-D:1:1 \"fim.width\": not known: unknown section `fim`; did you mean `film`? | write `film`, or one of: `accelerator`, `background`, `cameras`, `film`, `integrator`, `lights`, `materials`, `media`, `objects`, `phases`, `sampler`, `textures`",
    );
    check_override(
        "lights.lam.x=3",
        "-D:1:1 \"lights.lam.x\": not known: unknown light `lam` | the scene defines no light; define one, or remove this",
    );
    check_override("film.width=[1,", "-D:1:15 \"\": here: this list does not end | close it with `]`");
    check_override(
        "film.width=99999999999999999999",
        "-D:1:12 \"99999999999999999999\": here: this whole number is too large | write it as a float, such as 1e20",
    );
    check_override(
        "film=3",
        "-D:1:1 \"film\": stops too early: `film` names a film, not one of its values | write `film.parameter=value`",
    );
    check_override(
        "film.type=3",
        "-D:1:11 \"3\": expected a text: a type is a text, not a whole number | write `film.type=NAME`",
    );
    check_override(
        "film.a.b=1",
        "-D:1:1 \"film.a.b\": no such place: `film.a.b` leads to nothing that was written | set the whole value instead, one step up",
    );
    check_override(
        "film.width=\"abc",
        "-D:1:16 \"\": here: this text does not end | close it with the quote that it began with",
    );
}

#[test]
fn includes_in_a_circle_name_the_whole_circle() {
    check_files(
        &[
            ("s.toml", "include = 'a/b.toml'"),
            ("a/b.toml", "\ninclude = ['c.toml']"),
            ("a/c.toml", "include = '../a/b.toml'"),
        ],
        "a/c.toml:1:11 \"'../a/b.toml'\": included here: `a/b.toml` includes itself: `a/b.toml` -> `a/c.toml` -> `a/b.toml` | remove one of these includes",
    );
}

#[test]
fn includes_are_not_endless() {
    let name = |i: usize| format!("{i}.toml");
    let chain = (0..100).map(|i| (name(i), format!("include = '{}'", name(i + 1)).into_bytes())).collect();
    let access = FileAccess::new(Box::new(MemoryFiles(chain)), Limits { include_depth: 3, ..Limits::default() });
    assert_eq!(
        failure(&read(&access, "0.toml").unwrap_err()),
        "3.toml:1:11 \"'4.toml'\": included here: `4.toml` lies more than 3 includes deep | include it nearer to the scene"
    );
}

#[test]
fn a_name_in_two_files_shows_both_places() {
    check_files(
        &[("s.toml", "include = 'b.toml'\n[objects.a]\ntype = 'sphere'"), ("b.toml", "[objects.a]\ntype = 'disk'")],
        "s.toml:2:10 \"a\": again here: object `a` is defined twice | rename or remove one of them\n  b.toml:1:10 \"a\": first here",
    );
}

#[test]
fn an_included_file_tells_of_its_own_mistakes() {
    check_files(
        &[("s.toml", "include = 'b.toml'\n[fim]"), ("b.toml", "[film]\nwidth =")],
        "b.toml:2:8 \"\": here: a value is missing | write `name = value`\n\
         s.toml:2:2 \"fim\": not known: unknown section `fim`; did you mean `film`? | write `film`, or one of: `accelerator`, `background`, `cameras`, `description`, `film`, `include`, `integrator`, `lights`, `materials`, `media`, `objects`, `phases`, `sampler`, `textures`, `title`, `version`",
    );
}

#[test]
fn what_is_not_text_is_named() {
    let found = |content: &[u8]| failure(&read(&bytes(&[("s.toml", content)]), "s.toml").unwrap_err());
    assert_eq!(found(b"# ok\n\xC3\x28"), "`s.toml` is not UTF-8 text: byte 0xc3 in line 2 | save it as UTF-8");
    assert_eq!(
        found(b"\xFF\xFEa\0"),
        "`s.toml` is not UTF-8 text: byte 0xff in line 1 | it looks like UTF-16; save it as UTF-8"
    );
    let none = failure(&read(&bytes(&[]), "s.toml").unwrap_err());
    assert_eq!(none, "there is no file `s.toml` | check the name; paths are relative to the file that names them");
}
