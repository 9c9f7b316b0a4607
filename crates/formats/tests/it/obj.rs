//! OBJ and MTL: what is read, what is refused, and `tobj` as the twin.

use crate::show::failure;
use kirkas_formats::obj::{Reading, read_with_warnings};
use kirkas_geometry::{Vec2, Vec3};
use kirkas_scene::{Diagnostic, MeshData, Value};

/// Read with the MTL files given.
fn read_all(text: &str, mtls: &[(&str, &str)]) -> Result<Reading, String> {
    let mut mtl = |name: &str| match mtls.iter().find(|m| m.0 == name) {
        Some(m) => Ok(m.1.as_bytes().into()),
        None => Err(Diagnostic::error("file-not-found", format!("there is no file `{name}`"))),
    };
    read_with_warnings(text.as_bytes(), "a/mesh.obj", &mut mtl).map_err(|f| failure(&f))
}

fn read(text: &str) -> MeshData {
    let reading = read_all(text, &[]).unwrap_or_else(|e| panic!("{e}"));
    reading.mesh.validate().unwrap();
    reading.mesh
}

fn complaint(text: &str) -> String {
    read_all(text, &[]).map(|r| r.mesh).expect_err("an error").trim_end().to_string()
}

/// Every cut of `good`, many flipped bits, and random rows of its words go through `read`, which must not panic or hang.
pub(crate) fn damage(good: &[u8], mut read: impl FnMut(&[u8])) {
    for end in 0..=good.len() {
        read(&good[..end]);
    }
    let mut random = 1_u64;
    let mut below = |n: usize| {
        random = kirkas_geometry::hash::mix64(random.wrapping_add(0x9e37_79b9_7f4a_7c15));
        (random % n as u64) as usize
    };
    for _ in 0..3000 {
        let mut bytes = good.to_vec();
        for _ in 0..=below(4) {
            bytes[below(good.len())] ^= 1 << below(8);
        }
        read(&bytes);
    }
    let words: Vec<&[u8]> = good.split(|b| b" \n".contains(b)).filter(|w| !w.is_empty()).collect();
    for _ in 0..1000 {
        let mut bytes = good[..below(good.len())].to_vec();
        for _ in 0..below(40) {
            bytes.extend(words[below(words.len())]);
            bytes.push(b" \n"[below(2)]);
        }
        for (from, to) in [(below(2000), b'9'), (below(2000), b'-')] {
            if let Some(b) = bytes.get_mut(from) {
                *b = to;
            }
        }
        read(&bytes);
    }
}

#[test]
fn corners_may_be_written_in_four_ways_and_count_from_both_ends() {
    let vertices = "v 0 0 0\nv 1 0 0 0.5\nv 1 1 0 1 0 0\nvt 0 0.25\nvt 1\nvn 0 0 2\n";
    let plain = read(&format!("{vertices}f 1 2 3\nf -3 -2 -1"));
    assert_eq!(plain.triangles, [[0, 1, 2], [0, 1, 2]]);
    assert_eq!(plain.positions[2], Vec3::new(1.0, 1.0, 0.0));
    assert!(plain.normals.is_empty() && plain.uvs.is_empty());
    let full = read(&format!("{vertices}f 1/1 2/2/1 3//1\nf -3/-2 \\\n -2/-1/-1 -1//-1\r\nf 1/2 2/2/1 3//1"));
    assert_eq!(full.triangles, [[0, 1, 2], [0, 1, 2], [3, 1, 2]]);
    assert_eq!(full.normals, [Vec3::ZERO, Vec3::Z, Vec3::Z, Vec3::ZERO]);
    assert_eq!(full.uvs, [Vec2::new(0.0, 0.25), Vec2::X, Vec2::ZERO, Vec2::X]);
}

#[test]
fn polygons_become_fans_and_concave_ones_stay_inside() {
    let pentagon = "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n";
    assert_eq!(read(pentagon).triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    let arrow = "v 0 0 0\nv 2 0 1\nv 0 0 2\nv 1 0 1\nf 1 2 3 4\n";
    assert_eq!(read(arrow).triangles, [[3, 0, 1], [3, 1, 2]]);
}

#[test]
fn faces_may_name_vertices_that_follow() {
    assert_eq!(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles, [[0, 1, 2]]);
}

#[test]
fn groups_lines_and_smoothing_are_passed_over_and_unknown_words_warned_of() {
    let text = "\u{feff}# made by hand\no thing\ng a b\ns off\nv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 1\nfrob 3\nf 1 2 3 # front\n";
    let reading = read_all(text, &[]).unwrap();
    assert_eq!(reading.mesh.triangles.len(), 1);
    assert_eq!(reading.warnings.len(), 1);
    assert_eq!(reading.warnings[0].message, "unknown statement `frob`");
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn every_error_has_its_place() {
    for (text, expected) in [
        ("v 0 0\n", "`v` takes 3 numbers, here are 2"),
        ("v 0 0 x1\n", "`x1` is not a number"),
        ("v 0 nan 0\n", "`nan` is not a finite number"),
        ("v 0 1e99 0\n", "`1e99` is not a finite number"),
        ("f 1 2\n", "a face needs at least 3 corners, this one has 2"),
        ("f 1 2 4\n", "vertex 4 does not exist: there are 3"),
        ("f 1 2 -4\n", "vertex -4 does not exist: there are 3"),
        ("f 1 2 0\n", "a vertex has number 0"),
        ("f 1 2/7 3\n", "texture coordinate 7 does not exist: there are 0"),
        ("f 1 2//7 3\n", "normal 7 does not exist: there are 0"),
        ("f 1 2/a 3\n", "`2/a` is not a corner of a face"),
        ("f 1 2/1/1/1 3\n", "`2/1/1/1` is not a corner of a face"),
        ("f 1 2 99999999999\n", "vertex 99999999999 does not exist: there are 3"),
        ("f 1 2 -9223372036854775808\n", "vertex -9223372036854775808 does not exist: there are 3"),
        ("# nothing\n", "`a/mesh.obj` holds 3 vertices but no faces: there is nothing to draw"),
    ] {
        let found = complaint(&format!("{TRIANGLE}{text}"));
        assert!(found.contains(expected), "{found}\nshould say\n{expected}");
        assert!(found.contains("a/mesh.obj:4:") || expected.contains("nothing to draw"), "{found}");
    }
    let found = complaint(&format!("{TRIANGLE}f 1 2 3\n\n  f 1 2 3 17\n"));
    assert!(found.contains("a/mesh.obj:6:11"), "{found}");
    assert!(complaint("").contains("holds no faces"));
}

fn material(mtl: &str) -> (String, Vec<(String, Value)>, Vec<String>) {
    let text = format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n");
    let reading = read_all(&text, &[("m.mtl", mtl)]).unwrap_or_else(|e| panic!("{e}"));
    let m = &reading.mesh.materials[0];
    let params = m.params.iter().map(|(n, v)| (n.text.clone(), v.value.clone())).collect();
    (m.type_name.text.clone(), params, reading.warnings.iter().map(|w| w.message.clone()).collect())
}

fn is(mtl: &str, type_name: &str, params: &[(&str, Value)]) {
    let (found, found_params, warnings) = material(mtl);
    assert_eq!(found, type_name, "{mtl}");
    let params: Vec<(String, Value)> = params.iter().map(|(n, v)| (n.to_string(), v.clone())).collect();
    assert_eq!(found_params, params, "{mtl}");
    assert_eq!(warnings, Vec::<String>::new(), "{mtl}");
}

#[test]
fn materials_become_native_ones() {
    let grey = |v: f64| Value::from([v; 3]);
    is("newmtl a\n", "lambert", &[]);
    is("newmtl a\nKd 1 0 0\nKs 0 0 0\nNs 10\n", "lambert", &[("reflectance", [1.0, 0.0, 0.0].into())]);
    is("newmtl a\nKd 0.5\nd 0.25", "lambert", &[("reflectance", grey(0.5)), ("alpha", 0.25.into())]);
    is("newmtl a\nKd 0.5\nTr 0.75", "lambert", &[("reflectance", grey(0.5)), ("alpha", 0.25.into())]);
    is(
        "newmtl a\nKd 0.5\nKs 0.25\nNs 10\nillum 2",
        "blinn_phong",
        &[("diffuse", grey(0.5)), ("form", "classic".into()), ("specular", grey(0.25)), ("exponent", 10.0.into())],
    );
    is("newmtl a\nKd 0\nKs 1\nillum 3", "mirror", &[("reflectance", grey(1.0)), ("fresnel", "constant".into())]);
    is("newmtl a\nKs 0.25\nillum 5", "mirror", &[("reflectance", grey(0.25)), ("fresnel", "schlick".into())]);
    is("newmtl a\nNi 1.25\nKd 0\nillum 4", "dielectric", &[("ior", 1.25.into()), ("transmittance", grey(1.0))]);
    is("newmtl a\nTf 0.5\nKd 0\nillum 7", "dielectric", &[("ior", 1.5.into()), ("transmittance", grey(0.5))]);
    is("newmtl a\nKd 0.5\nillum 4", "lambert", &[("reflectance", grey(0.5))]);
    is(
        "newmtl a\nKd 0.5\nKs 0.25\nd 0.25\nNi 1.25\nillum 6",
        "blinn_phong",
        &[
            ("diffuse", grey(0.5)),
            ("form", "classic".into()),
            ("specular", grey(0.25)),
            ("transmit", grey(0.75)),
            ("ior", 1.25.into()),
            ("reflect", grey(0.25)),
            ("fresnel", "constant".into()),
        ],
    );
    let shines = ("radiance", [3.0, 2.0, 1.0].into());
    is("newmtl a\nKd 0.5\nKe 3 2 1", "emitter", &[shines.clone(), ("reflectance", [0.5; 3].into())]);
    is("newmtl a\nKd 0\nKe 3 2 1", "emitter", &[shines]);
}

#[test]
fn maps_become_textures_once() {
    let obj = format!("mtllib sub/m.mtl\n{TRIANGLE}f 3 2 1\nusemtl a\nf 1 2 3\nusemtl b\nf 2 3 1\nusemtl\nf 1 2 3\n");
    let mtl = "newmtl a\nmap_Kd -s 2 3 1 -o 0.5 -clamp on my image.png\nmap_d -mm 0 1 mask.png\n\
               newmtl b\nKd 0.3 0.3 0.3\nmap_Kd -clamp on -s 2 3 -o 0.5 0 my image.png\nbump b.png\nKd 2 0 0\n";
    let reading = read_all(&obj, &[("sub/m.mtl", mtl)]).unwrap();
    let mesh = &reading.mesh;
    assert_eq!(mesh.folder, "a");
    let runs: Vec<(&str, u32, u32)> = mesh.parts.iter().map(|p| (p.material.as_str(), p.first, p.count)).collect();
    assert_eq!(runs, [("a", 1, 1), ("b", 2, 1)]);
    let textures: Vec<&str> = mesh.textures.iter().map(|t| t.name.text.as_str()).collect();
    assert_eq!(textures, ["a_map_Kd", "a_map_d"]);
    let image = &mesh.textures[0].params;
    assert_eq!(image.get("file").unwrap().text(), Some("sub/my image.png"));
    assert_eq!(image.get("scale").unwrap().numbers(), Some([2.0, 3.0]));
    assert_eq!(image.get("offset").unwrap().numbers(), Some([0.5, 0.0]));
    assert_eq!(image.get("wrap").unwrap().text(), Some("clamp"));
    assert_eq!(mesh.materials[1].params.get("reflectance").unwrap().text(), Some("a_map_Kd"));
    assert_eq!(mesh.materials[0].params.get("alpha").unwrap().text(), Some("a_map_d"));
    let warnings: Vec<&str> = reading.warnings.iter().map(|w| w.message.as_str()).collect();
    assert_eq!(
        warnings,
        [
            "the texture option `-mm` is ignored",
            "`bump` of material `b` is ignored",
            "`Kd` is 2; 1 is used",
            "`Kd` of material `b` does not tint its `map_Kd`"
        ]
    );
}

#[test]
fn a_missing_mtl_is_a_warning_and_a_broken_one_an_error() {
    let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl red\nf 1 2 3\n");
    let reading = read_all(&obj, &[]).unwrap();
    assert!(reading.mesh.parts.is_empty() && reading.mesh.materials.is_empty());
    assert_eq!(reading.warnings.len(), 2);
    assert_eq!(reading.warnings[1].message, "unknown material `red`");
    for (mtl, expected) in [
        ("newmtl red\nKd 1 x 0\n", "`x` is not a number"),
        ("newmtl red\nKd 1 1\n", "`Kd` needs a number"),
        ("Kd 1 1 1\n", "`Kd` stands before any material"),
        ("newmtl\n", "`newmtl` needs a name"),
        ("newmtl red\nmap_Kd -s 1 1 1\n", "`map_Kd` names no file"),
        ("newmtl red\nNs nan\n", "`nan` is not a finite number"),
        ("newmtl red\n\u{7f}\u{e9} 3\n", "this is not an MTL file"),
    ] {
        let found = read_all(&obj, &[("m.mtl", mtl)]).map(|r| r.mesh).expect_err(mtl);
        assert!(found.contains(expected) && found.contains("a/m.mtl:"), "{found}\nshould say\n{expected}");
    }
}

#[test]
fn damaged_files_are_refused_in_peace() {
    let obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 .2 0\nvt 0 1\nvt 1e-3 0\nvn 0 0 1\nusemtl a\n\
               f 1/1/1 2/2/1 3//1 4 -1\nf -1 -2 -3\n";
    let mtl = b"newmtl a\nKd 1 0.5 0\nKs 0.1 0.1 0.1\nillum 4\nd 0.5\nNi 1.5\nTf 1 1 1\nmap_Kd -s 1 2 3 -o 0 1 a b.png\nKe 0 0 0\n";
    let library: std::sync::Arc<[u8]> = mtl[..].into();
    damage(obj.as_bytes(), |bytes| {
        if let Ok(reading) = read_with_warnings(bytes, "m.obj", &mut |_| Ok(library.clone())) {
            reading.mesh.validate().unwrap();
        }
    });
    damage(mtl, |bytes| {
        let _ = read_with_warnings(obj.as_bytes(), "m.obj", &mut |_| Ok(bytes.into()));
    });
    // One long word must not cost more than its length.
    let long = vec![b'x'; 1 << 20];
    let _ = read_with_warnings(&long, "m.obj", &mut |_| Ok(library.clone()));
    let _ = read_with_warnings(&[b"usemtl ", &long[..], b"\n", obj.as_bytes()].concat(), "m.obj", &mut |_| {
        Ok(library.clone())
    });
}

/// Corners as points, in order.
fn corners(mesh: &MeshData) -> Vec<[Vec3; 3]> {
    mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize])).collect()
}

#[test]
fn tobj_reads_the_same_triangles() {
    let Some(data) = std::env::var_os("KIRKAS_DATA") else {
        eprintln!("skipped: tobj_reads_the_same_triangles (KIRKAS_DATA is not set)");
        return;
    };
    let mut count = 0;
    for entry in std::fs::read_dir(std::path::Path::new(&data).join("meshes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "obj") {
            continue;
        }
        let mine = read(&std::fs::read_to_string(&path).unwrap());
        let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
        let (models, _) = tobj::load_obj(&path, &options).unwrap();
        let mut theirs = Vec::new();
        for tobj::Model { mesh, .. } in &models {
            let point = |i: u32| Vec3::from_slice(&mesh.positions[3 * i as usize..]);
            theirs.extend(mesh.indices.chunks(3).map(|t| [point(t[0]), point(t[1]), point(t[2])]));
            if models.len() == 1 {
                let uv = |i: u32| Vec2::from_slice(&mesh.texcoords[2 * i as usize..]);
                for (t, o) in mine.triangles.iter().flatten().zip(&mesh.indices) {
                    assert!(mine.uvs.is_empty() || mine.uvs[*t as usize] == uv(*o));
                }
            }
        }
        assert_eq!(corners(&mine).len(), theirs.len(), "{}", path.display());
        // Quads that are not convex have their one good diagonal here; tobj always cuts at the first corner.
        let different: Vec<_> = corners(&mine).into_iter().zip(theirs).filter(|(a, b)| a != b).collect();
        assert!(different.len() <= 4, "{}: {} differ", path.display(), different.len());
        for quad in different.chunks(2) {
            let points = |triangles: [[Vec3; 3]; 2]| -> std::collections::BTreeSet<[u32; 3]> {
                triangles.iter().flatten().map(|p| p.to_array().map(f32::to_bits)).collect()
            };
            let mine = points([quad[0].0, quad[1].0]);
            assert_eq!(mine.len(), 4);
            assert_eq!(mine, points([quad[0].1, quad[1].1]), "{}", path.display());
        }
        count += 1;
    }
    assert!(count >= 4, "only {count} meshes in {data:?}");
}

#[test]
fn colours_behind_positions_come_along_and_weights_do_not() {
    let mesh = read("v 0 0 0 0.5 1 2\nv 1 0 0 0 0 0\nv 0 1 0 1 0 0\nv 9 9 9 1 1 1\nvt 0 0\nf 3/1 1/1 2/1\n");
    assert_eq!(mesh.colors, [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.5, 1.0, 2.0), Vec3::ZERO]);
    assert!(read("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").colors.is_empty());
    // Those without a colour are white.
    let mesh = read("v 0 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(mesh.colors, [Vec3::ONE, Vec3::new(0.0, 1.0, 0.0), Vec3::ONE]);
}
