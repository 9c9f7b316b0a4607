//! Displaced meshes: where their vertices go, that they stay closed, and what is refused.

use crate::support::{assert_near, prepared, prepared_with};
use kirkas_accel::{Query, Shape};
use kirkas_formats::{FormatAssets, load};
use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_geometry::{Ray, Vec3};
use kirkas_render::scene::SECONDARY;
use kirkas_render::{Options, Prepared, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

const EYE: &str =
    "[cameras.eye]\ntype = \"perspective\"\n[lights.sun]\ntype = \"directional\"\ndirection = [0, -1, 0]\n";

fn triangles(p: &Prepared) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    match &p.scene.accel.scene_geometry().world[0].shape {
        Shape::Triangles { positions, indices } => (positions.to_vec(), indices.to_vec()),
        _ => panic!("no mesh"),
    }
}

#[test]
fn a_flat_mesh_rises_by_its_displacement_times_the_scale() {
    let p = prepared(&format!(
        "{EYE}[textures.slope]\ntype = \"gradient\"\nalong = \"u\"\n[objects.sheet]\ntype = \"mesh\"\n\
         vertices = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]\nuvs = [0, 0, 1, 0, 1, 1, 0, 1]\nfaces = [0, 3, 2, 0, 2, 1]\n\
         subdivisions = 3\ndisplacement = \"slope\"\ndisplacement_scale = 0.6\ndisplacement_middle = 0.5\n\
         transform = [{{ scale = 2 }}]\n"
    ));
    let (positions, indices) = triangles(&p);
    assert_eq!(indices.len(), 2 * 64);
    assert_eq!(positions.len(), 9 * 9);
    for q in positions {
        assert_near(f64::from(q.y) + 2.0, 2.0 + 2.0 * 0.6 * (f64::from(q.x) / 2.0 - 0.5), 1e-6);
    }
}

#[test]
fn displaced_meshes_with_split_vertices_stay_closed() {
    // A cube whose every face has vertices and texture coordinates of its own.
    let mut obj = String::new();
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let faces = [[4, 3, 2, 1], [5, 6, 7, 8], [1, 2, 6, 5], [3, 4, 8, 7], [2, 3, 7, 6], [1, 5, 8, 4]];
    for c in corners {
        obj += &format!("v {} {} {}\n", c[0], c[1], c[2]);
    }
    for i in 0..6 {
        for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            obj += &format!("vt {} {}\n", u + 0.13 * f64::from(i), v * 0.7);
        }
    }
    for (i, f) in faces.iter().enumerate() {
        obj +=
            &format!("f {}/{} {}/{} {}/{} {}/{}\n", f[0], 4 * i + 1, f[1], 4 * i + 2, f[2], 4 * i + 3, f[3], 4 * i + 4);
    }
    let toml = format!(
        "{EYE}[textures.bumps]\ntype = \"noise\"\noctaves = 4\nmapping = \"uv\"\ntransform = [{{ scale = 0.2 }}]\n\
         [objects.rock]\ntype = \"mesh\"\nfile = \"cube.obj\"\nsubdivisions = 4\ndisplacement = \"bumps\"\ndisplacement_scale = 0.3\n"
    );
    let p = prepared_with(&toml, &[("cube.obj", obj.as_bytes())], &Options::default());
    let (positions, indices) = triangles(&p);
    // Every edge, by the places of its ends, is met once from either side.
    let mut edges = std::collections::BTreeMap::new();
    let key = |i: u32| positions[i as usize].to_array().map(f32::to_bits);
    for t in &indices {
        for k in 0..3 {
            let (a, b) = (key(t[k]), key(t[(k + 1) % 3]));
            *edges.entry(if a < b { (a, b) } else { (b, a) }).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|&n| n == 0), "open edges");
    assert!(positions.iter().any(|q| q.x < -0.02), "nothing moved");
    // And no ray gets out.
    for i in 0..20_000 {
        let direction = square_to_uniform_sphere(owen_sobol_2d(i, 3));
        let ray = Ray { mask: SECONDARY, ..Ray::new(Vec3::splat(0.5), direction) };
        assert!(p.scene.accel.closest_hit(&ray, Query::ALL, 0, &mut Default::default()).is_some(), "{direction}");
    }
}

fn complaint(toml: &str) -> String {
    let mut all = MemoryFiles::default();
    all.0.insert("scene.toml".into(), toml.as_bytes().to_vec());
    let access = FileAccess::new(Box::new(all), Limits::default());
    let description = load(&access, "scene.toml").expect("sound syntax");
    let assets = FormatAssets::new(&access, &description.sources);
    let errors = prepare(&description, &assets, &Options::default()).map(|_| ()).expect_err("an error");
    errors.iter().map(|e| format!("{} / {}\n", e.message, e.help.clone().unwrap_or_default())).collect()
}

#[test]
fn what_cannot_be_displaced_says_so() {
    let ball = complaint(&format!("{EYE}[objects.ball]\ntype = \"sphere\"\ndisplacement = 0.1\n"));
    assert!(ball.contains("displacement") && ball.contains("sphere"), "{ball}");
    let mesh = "vertices = [[0, 0, 0], [1, 0, 0], [1, 0, 1]]\nfaces = [0, 1, 2]\n";
    let many = format!("{EYE}[objects.sheet]\ntype = \"mesh\"\n{mesh}subdivisions = 11\n");
    assert!(complaint(&many).contains("subdivisions"), "{}", complaint(&many));
    let unknown = format!("{EYE}[objects.sheet]\ntype = \"mesh\"\n{mesh}displacement = \"hills\"\n");
    assert!(complaint(&unknown).contains("hills"), "{}", complaint(&unknown));
}
