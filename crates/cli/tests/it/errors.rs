//! What is wrong in a scene, as the user sees it: one snapshot for each kind. `INSTA_UPDATE=always` writes them anew.

use crate::common::{BALL, Folder};

/// Run, and compare everything that was said with the snapshot `name`.
pub fn said(f: &Folder, name: &str, args: &[&str]) {
    let done = f.run(args);
    let code = done.code.map_or("none".into(), |c| c.to_string());
    let said = format!("$ kirkas {}\nexit {code}\n{}{}", args.join(" "), done.stdout, done.stderr);
    assert!(!said.contains('\u{1b}'), "colours without a terminal");
    insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "../snapshots", omit_expression => true }, {
        insta::assert_snapshot!(name, said);
    });
}

/// A scene with one fault, checked: the ball with words replaced, or with lines added.
macro_rules! faulty_scenes {
    ($($name:ident: $from:expr => $to:expr;)*) => {$(
        #[test]
        fn $name() {
            let name = stringify!($name);
            assert!($from.is_empty() || BALL.contains($from));
            let scene = if $from.is_empty() { format!("{BALL}{}", $to) } else { BALL.replace($from, $to) };
            said(&Folder::with_scene(&format!("error_{name}"), &scene), name, &["check", "scene.toml"]);
        }
    )*};
}

faulty_scenes! {
    unknown_reference: "\"red\"\n" => "\"rod\"\n";
    unknown_type: "\"lambert\"" => "\"lambret\"";
    unknown_parameter: "intensity" => "intensty";
    unknown_section: "[lights.lamp]" => "[light.lamp]";
    unknown_choice: "height = 16" => "height = 16\nfilter = \"gausian\"";
    unknown_far_name: "\"red\"\n" => "\"xyzzy\"\n";
    missing_type: "type = \"lambert\"\n" => "";
    missing_parameter: "" => "[objects.copy]\ntype = \"instance\"\n";
    missing_name: "[lights.lamp]\n" => "[lights]\n";
    wrong_type: "width = 24" => "width = \"wide\"";
    wrong_color: "[0.8, 0.2, 0.1]" => "[0.8, 0.2]";
    out_of_range: "samples = 4" => "samples = 0";
    not_finite: "intensity = 20" => "intensity = nan";
    duplicate_name: "" => "[objects.ball]\ntype = \"sphere\"\n";
    syntax: "position = [2, 3, 4]" => "position = [2, 3, 4";
    several_at_once: "type = \"sphere\"\nmaterial = \"red\"" => "type = \"sphre\"\nmaterial = 7\n[materials.blue]\ntype = \"lambert\"\nreflectnce = 1\n";
    unknown_version: "\n[film]" => "version = 9\n[film]";
    bad_include: "\n[film]" => "include = 3\n[film]";
    recursive_include: "\n[film]" => "include = [\"scene.toml\"]\n[film]";
    missing_include: "\n[film]" => "include = [\"studio.toml\"]\n[film]";
    outside_include: "\n[film]" => "include = [\"../studio.toml\"]\n[film]";
    missing_mesh: "" => "[objects.m]\ntype = \"mesh\"\nfile = \"bunny.ply\"\n";
    unknown_mesh_format: "" => "[objects.m]\ntype = \"mesh\"\nfile = \"scene.toml\"\n";
    missing_picture: "" => "[textures.t]\ntype = \"image\"\nfile = \"wood.png\"\n";
    bad_picture: "" => "[textures.t]\ntype = \"image\"\nfile = \"scene.toml\"\n";
    texture_cycle: "" => "[textures.t]\ntype = \"checker\"\na = \"u\"\n[textures.u]\ntype = \"checker\"\na = \"t\"\n";
    bad_parent: "" => "[objects.b]\ntype = \"sphere\"\nparent = \"ball\"\n";
    parent_cycle: "" => "[objects.g]\ntype = \"group\"\nparent = \"h\"\n[objects.h]\ntype = \"group\"\nparent = \"g\"\n";
    instance_cycle: "" => "[objects.g]\ntype = \"group\"\n[objects.i]\ntype = \"instance\"\nof = \"g\"\nparent = \"g\"\n";
    no_camera: "[cameras.main]\ntype = \"perspective\"\n" => "";
    bad_camera: "type = \"perspective\"" => "type = \"perspective\"\nposition = [0, 0, 0]";
    bad_shutter: "type = \"perspective\"" => "type = \"perspective\"\nshutter = [1, 0]";
    flat_scale: "" => "[objects.b]\ntype = \"sphere\"\ntransform = [{ scale = [1, 0, 1] }]\n";
    unknown_transform: "" => "[objects.b]\ntype = \"sphere\"\ntransform = [{ rotat = [0, 1, 0, 90] }]\n";
    unsampled_light: "" => "[materials.e]\ntype = \"emitter\"\n[objects.sheet]\ntype = \"plane\"\nmaterial = \"e\"\n";
}

/// A file that is no good scene at all.
macro_rules! faulty_files {
    ($($name:ident: $file:expr, $bytes:expr;)*) => {$(
        #[test]
        fn $name() {
            let name = stringify!($name);
            let f = Folder::new(&format!("error_{name}")).file($file, $bytes);
            said(&f, name, &["render", $file, "-o", "a.png"]);
            assert!(!f.path("a.png").exists());
        }
    )*};
}

faulty_files! {
    not_utf8: "scene.toml", b"title = \"caf\xe9\"\n";
    unknown_scene_format: "scene.blend", b"x";
    no_extension: "scene", b"x";
    course_unknown_word: "scene.txt", b"PerspectiveCamera {\n  center 0 0 5\n  direktion 0 0 -1\n}\n";
    course_cut_off: "scene.txt", b"PerspectiveCamera {\n  center 0 0 5\n";
    obj_bad_number: "t.obj", b"v 0 0 0\nv 1 0 zero\n";
    obj_bad_index: "t.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n";
    obj_without_faces: "t.obj", b"v 0 0 0\n";
    ply_cut_off: "t.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n";
    ply_huge_count: "t.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    not_a_ply: "t.ply", b"solid stl\n";
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_root_folder_is_refused_until_the_root_is_wide_enough() {
    let scene = format!("include = [\"link.toml\"]\n{BALL}");
    let f = Folder::new("error_link").file("in/scene.toml", scene).file("outside.toml", "title = \"x\"\n");
    std::os::unix::fs::symlink("../outside.toml", f.path("in/link.toml")).unwrap();
    said(&f, "link_outside", &["check", "in/scene.toml"]);
    f.ok(&["check", "in/scene.toml", "--root", "."]);
}

#[test]
fn a_path_is_shown_as_the_user_typed_it() {
    let f = Folder::new("error_typed").file("a/b/scene.toml", BALL.replace("\"red\"\n", "\"rad\"\n"));
    said(&f, "typed_path", &["check", "a/b/scene.toml"]);
}

#[test]
fn an_error_in_an_included_file_points_into_it() {
    let f = Folder::new("error_included")
        .file("scene.toml", "include = [\"parts/ball.toml\"]\n[objects.ball]\ntype = \"sphere\"\n")
        .file("parts/ball.toml", BALL);
    said(&f, "included_duplicate", &["check", "scene.toml"]);
}
