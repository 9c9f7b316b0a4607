//! Trees that were saved and loaded answer as those that were built; whatever else is in a file is refused.

use crate::agreement;
use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Ray, Vec3};
use std::io;
use std::sync::Arc;

const SAVABLE: [AccelKind; 4] = [AccelKind::Bvh8, AccelKind::Bvh8Fast, AccelKind::Bvh8Best, AccelKind::Bvh8Compact];

fn saved(accel: &Accel) -> Vec<u8> {
    let mut file = Vec::new();
    accel.save(&mut file).unwrap();
    file
}

fn load(scene: &SceneGeometry, file: &[u8]) -> Result<Accel, SavedTreeError> {
    Accel::load(scene.clone(), &mut &file[..])
}

fn refusal(scene: &SceneGeometry, file: &[u8]) -> String {
    load(scene, file).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn what_is_loaded_answers_as_what_was_saved() {
    for seed in 0..12 {
        let r = &mut Random::new(seed);
        let (scene, corners) = agreement::scene(r, [0, 1, 9, 300][seed as usize % 4]);
        let rays: Vec<Ray> =
            (0..200).map(|_| agreement::ray(r, if corners.is_empty() { &[Vec3::X] } else { &corners })).collect();
        for kind in SAVABLE {
            let built = build(kind, &scene);
            let file = saved(&built);
            let loaded = load(&scene, &file).unwrap();
            assert_eq!((loaded.kind(), loaded.statistics()), (kind, built.statistics()));
            assert_eq!(loaded.bounds(), built.bounds());
            assert!(saved(&loaded) == file);
            for ray in &rays {
                assert_eq!(bits(closest(&loaded, ray)), bits(closest(&built, ray)));
            }
        }
    }
}

/// A mesh twice, a ball.
fn small_scene() -> SceneGeometry {
    let (positions, indices) = crate::meshes::ball(1);
    let mesh = Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) };
    let at = |x: f64| AnimatedTransform::still(DAffine3::from_translation(DVec3::X * x));
    let instance = |x| Instance { aggregate: 0, outer_from_object: at(x), mask: u32::MAX };
    let ball = Sphere { center: Vec3::Y * 2.0, radius: 0.5 };
    SceneGeometry {
        world: vec![geometry(Shape::Spheres(Arc::new(vec![ball])))],
        aggregates: vec![vec![geometry(mesh)].into()],
        instances: vec![instance(-2.0), instance(2.0)],
        ..SceneGeometry::default()
    }
}

#[test]
fn a_file_that_was_altered_anywhere_or_cut_is_refused() {
    let scene = small_scene();
    for kind in SAVABLE {
        let file = saved(&build(kind, &scene));
        for at in 0..file.len() {
            for change in [1, 0x80, 0xff] {
                let mut altered = file.clone();
                altered[at] ^= change;
                assert!(load(&scene, &altered).is_err(), "byte {at} of {}", file.len());
            }
            assert!(load(&scene, &file[..at]).is_err(), "cut at {at}");
        }
    }
}

#[test]
fn each_refusal_says_why() {
    let scene = small_scene();
    let file = saved(&build(AccelKind::Bvh8, &scene));
    let with = |at: usize, bytes: &[u8]| {
        let mut other = file.clone();
        other[at..at + bytes.len()].copy_from_slice(bytes);
        refusal(&scene, &other)
    };
    assert_eq!(refusal(&scene, b"ply\nformat ascii 1.0\n"), "this is no saved tree");
    assert_eq!(refusal(&scene, b""), "this is no saved tree");
    assert_eq!(refusal(&scene, &file[..100]), "the saved tree is damaged: it ends too soon");
    assert_eq!(with(file.len() - 1, &[!file[file.len() - 1]]), "the saved tree is damaged: its checksum does not fit");
    let mut order = file[8..16].to_vec();
    order.reverse();
    assert_eq!(with(8, &order), "the tree was saved on a machine with another order of bytes; build it anew");
    let version = "the tree was saved in version 77 of the format, and this is version 2; build it anew";
    assert_eq!(with(16, &77_u64.to_ne_bytes()), version);
    let text = build(AccelKind::Bvh2, &scene).save(&mut Vec::new()).unwrap_err().to_string();
    assert_eq!(text, "a bvh2 cannot be saved; trees of the kinds bvh8, bvh8_fast, bvh8_best and bvh8_compact can");

    let full = build(AccelKind::Bvh8, &scene).save(&mut &mut [0_u8; 99][..]).unwrap_err();
    assert!(matches!(full, SavedTreeError::Io(e) if e.kind() == io::ErrorKind::WriteZero));
}

#[test]
fn other_geometry_is_refused_and_other_masks_are_not() {
    let scene = small_scene();
    let file = saved(&build(AccelKind::Bvh8, &scene));
    let mut masked = scene.clone();
    masked.world[0].mask = 3;
    masked.world[0].opaque = false;
    masked.instances[0].mask = 7;
    assert!(load(&masked, &file).is_ok());
    let changes: [fn(&mut SceneGeometry); 5] = [
        |s| s.shutter.1 = 1.0,
        |s| s.world.clear(),
        |s| s.instances.swap(0, 1),
        |s| s.world[0].shape = Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::Y * 2.0, radius: 0.51 }])),
        |s| {
            let Shape::Triangles { positions, .. } = &mut s.aggregates[0].geometries[0].shape else { unreachable!() };
            Arc::make_mut(positions)[2].x = -0.0;
        },
    ];
    for change in changes {
        let mut other = scene.clone();
        change(&mut other);
        assert_eq!(refusal(&other, &file), "the tree was built over other geometry; build it anew");
    }
}
