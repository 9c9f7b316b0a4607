//! Extra layers, as EXR layers and as pictures.

use crate::common::{BALL, Folder};
use kirkas_images::{Pixels, read_png};

/// A wall at z = 0 that fills the lower half of the picture, seen from z = 5.
const WALL: &str = r#"
[film]
width = 8
height = 8
filter = "point"

[cameras.main]
type = "orthographic"

[lights.sun]
type = "directional"

[materials.grey]
type = "lambert"
reflectance = [0.5, 0.25, 0]

[objects.wall]
type = "rectangle"
center = [0, -1, 0]
edge_u = [4, 0, 0]
edge_v = [0, 1, 0]
material = "grey"
"#;

fn codes(f: &Folder, name: &str) -> Vec<[u8; 3]> {
    let Pixels::Srgb8(codes) = read_png(&std::fs::read(f.path(name)).unwrap()).unwrap().pixels else { panic!() };
    codes.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()
}

#[test]
fn pictures_show_layers_as_the_course_does() {
    let f = Folder::with_scene("aov_pictures", WALL);
    f.ok(&["render", "scene.toml", "-o", "w.png", "--aov", "depth:4:8,normals,albedo,object_id,sample_count"]);
    let bottom = |name: &str| codes(&f, name)[8 * 7 + 3];
    let top = |name: &str| codes(&f, name)[3];
    assert_eq!((top("w.depth.png"), bottom("w.depth.png")), ([0; 3], [191; 3]));
    assert_eq!((top("w.normals.png"), bottom("w.normals.png")), ([0; 3], [0, 0, 255]));
    assert_eq!((top("w.albedo.png"), bottom("w.albedo.png")), ([0; 3], [188, 137, 0]));
    assert_eq!(top("w.object_id.png"), [0; 3]);
    assert_ne!(bottom("w.object_id.png"), [0; 3]);
    assert_eq!(bottom("w.sample_count.png"), [255; 3]);
}

#[test]
fn exr_keeps_all_layers_and_writes_no_pictures_beside() {
    let f = Folder::with_scene("aov_exr", WALL);
    let all = "depth,normals,albedo,position,object_id,material_id,sample_count,variance";
    f.ok(&["render", "scene.toml", "-o", "w.exr", "--aov", all]);
    assert_eq!(f.names(), ["scene.toml", "w.exr"]);
    let image = f.exr("w.exr");
    let depth = image.channel("depth.Z").and_then(|d| d.floats()).unwrap();
    assert_eq!((depth[3], depth[8 * 7 + 3]), (0.0, 5.0));
    for name in
        ["normals.X", "albedo.B", "position.Y", "object_id.id", "material_id.id", "sample_count.N", "variance.G"]
    {
        assert!(image.channel(name).is_some(), "{name}");
    }
}

#[test]
fn half_floats_are_half() {
    let f = Folder::with_scene("half", BALL);
    f.ok(&["render", "scene.toml", "-o", "half.exr", "--half"]);
    assert!(matches!(f.exr("half.exr").channel("R"), Some(kirkas_images::ChannelData::F16(_))));
}

#[test]
fn raw_tone_writes_numbers_without_a_curve() {
    let f = Folder::with_scene("raw", BALL);
    f.ok(&["render", "scene.toml", "-o", "a.png", "-o", "a.exr", "--tone", "raw", "--exposure", "-1"]);
    let red = f.exr("a.exr");
    let red = red.channel("R").and_then(|d| d.floats()).unwrap();
    for (code, value) in codes(&f, "a.png").iter().zip(red) {
        assert_eq!(code[0], (value * 0.5 * 255.0) as u8);
    }
}
