//! Every scene format by its extension, bare meshes, and the files beside a scene.

use crate::show::{failure, files};
use kirkas_formats::{FormatAssets, MeshCache, load, load_cached, rebase_paths, toml};
use kirkas_geometry::{DVec3, elementary::tan};
use kirkas_scene::{Assets, Catalog, Fallback, Kind, ParamSpec, ParamType, TypeSpec};
use std::sync::Arc;

const TETRAHEDRON: &str = "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn the_extension_tells_the_format() {
    let all = files(&[("a.TOML", "title = 'x'"), ("m/t.obj", TETRAHEDRON)]);
    assert_eq!(load(&all, "a.TOML").unwrap().title, "x");
    assert!(load(&all, "m/t.obj").unwrap().find(Kind::Object, "mesh").is_some());
    let error = |path: &str| failure(&load(&all, path).unwrap_err());
    assert_eq!(
        error("a.blend"),
        "`a.blend`: `.blend` is not a scene format that Kirkas reads | use one of: `.toml`, `.txt`, `.obj`, `.ply`"
    );
    assert_eq!(
        error("a.b/c"),
        "`a.b/c` has no extension that tells its format | use one of: `.toml`, `.txt`, `.obj`, `.ply`"
    );
    assert_eq!(
        error("none.ply"),
        "there is no file `none.ply` | check the name; paths are relative to the file that names them"
    );
}

#[test]
fn a_bare_mesh_is_framed_at_any_size() {
    for scale in [1e-6, 1.0, 1e6] {
        let text: String = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]
            .map(|p: [f64; 3]| format!("v {} {} {}\n", p[0] * scale, p[1] * scale, p[2] * scale))
            .concat();
        let all = files(&[("t.obj", &(text + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"))]);
        let meshes = MeshCache::default();
        let scene = load_cached(&all, "t.obj", &meshes).unwrap();
        let camera = &scene.all(Kind::Camera)[0].params;
        let point = |name: &str| DVec3::from_array(camera.get(name).unwrap().numbers().unwrap());
        let (eye, at) = (point("position"), point("look_at"));
        let forward = (at - eye).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let slope = tan((camera.get("fov").unwrap().number().unwrap() / 2.0).to_radians());
        let mut fullest = 0.0_f64;
        for p in &meshes.read(&all, "", "t.obj").unwrap().positions {
            let d = p.as_dvec3() - eye;
            let (x, y) = (d.dot(right) / d.dot(forward) / slope / (4.0 / 3.0), d.dot(up) / d.dot(forward) / slope);
            fullest = fullest.max(x.abs()).max(y.abs());
        }
        assert!((0.7..0.9).contains(&fullest), "the mesh takes {fullest} of the picture at scale {scale}");
        assert_eq!(all.record().len(), 1);
    }
}

#[test]
fn a_mesh_without_extent_is_refused() {
    let all = files(&[("t.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")]);
    assert_eq!(
        failure(&load(&all, "t.obj").unwrap_err()),
        "`t.obj` holds nothing that can be seen | a mesh needs at least one triangle that is not a point"
    );
}

#[test]
fn a_mesh_is_read_once_and_beside_the_file_that_names_it() {
    let all = files(&[
        ("s.toml", "include = 'lib/a.toml'"),
        ("lib/a.toml", "[objects.a]\ntype = 'mesh'\nfile = 't.obj'"),
        ("lib/t.obj", TETRAHEDRON),
        ("lib/bad.obj", "v 0 0 0\nv 1 x 0\nf 1 2 3"),
    ]);
    let d = load(&all, "s.toml").unwrap();
    let from = Some(d.find(Kind::Object, "a").unwrap().params.get("file").unwrap().span.source);
    let assets = FormatAssets::new(&all, &d.sources);
    let mesh = assets.mesh(from, "t.obj").unwrap();
    assert_eq!(mesh.triangles.len(), 4);
    assert!(Arc::ptr_eq(&mesh, &assets.mesh(None, "lib/t.obj").unwrap()));
    assert_eq!(&assets.bytes(from, "t.obj").unwrap()[..], TETRAHEDRON.as_bytes());
    let error = assets.mesh(from, "bad.obj").unwrap_err();
    assert!(error.message.starts_with("lib/bad.obj:2:5: "), "{error}");
    assert!(error.labels.is_empty(), "its text is not among the scene's");
    assert_eq!(assets.mesh(from, "t.stl").unwrap_err().code, "unknown-format");
}

static MESH: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "mesh",
    doc: "",
    params: &[ParamSpec::new("file", ParamType::Path, Fallback::Absent, "")],
};

#[test]
fn paths_follow_a_scene_that_moves() {
    let all = files(&[
        ("scenes/s.toml", "include = 'lib/a.toml'\n[objects.b]\ntype = 'mesh'\nfile = '../m/b.ply'"),
        ("scenes/lib/a.toml", "[objects.a]\ntype = 'mesh'\nfile = 'a.ply'"),
    ]);
    let catalog = Catalog { types: vec![&MESH], common: vec![] };
    for (folder, expected) in [
        ("", ["scenes/lib/a.ply", "m/b.ply"]),
        ("scenes", ["lib/a.ply", "../m/b.ply"]),
        ("scenes/lib", ["a.ply", "../../m/b.ply"]),
        ("out/x", ["../../scenes/lib/a.ply", "../../m/b.ply"]),
    ] {
        let mut d = toml::read(&all, "scenes/s.toml").unwrap();
        rebase_paths(&mut d, &catalog, folder);
        let file =
            |name: &str| d.find(Kind::Object, name).unwrap().params.get("file").unwrap().text().unwrap().to_string();
        assert_eq!([file("a"), file("b")], expected);
    }
}
