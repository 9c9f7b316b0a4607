//! MIT 6.837 scene text: what it means natively, every scene of the course, and damaged ones.

use crate::obj::damage;
use crate::show::{failure, files};
use kirkas_formats::mit6837::{read, read_with_warnings};
use kirkas_geometry::DVec3;
use kirkas_scene::transforms::read_transform;
use kirkas_scene::{Description, Entity, Kind};

const HEAD: &str = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }\n";

fn scene(text: &str) -> Description {
    let text = format!("{HEAD}{text}");
    read(&files(&[("a/s.txt", &text)]), "a/s.txt").unwrap_or_else(|f| panic!("{}", failure(&f)))
}

fn complaint(text: &str) -> String {
    read(&files(&[("s.txt", text)]), "s.txt").map_err(|f| failure(&f)).expect_err("an error").trim_end().to_string()
}

fn find<'a>(d: &'a Description, kind: Kind, name: &str) -> &'a Entity {
    d.find(kind, name).unwrap_or_else(|| panic!("no {name}"))
}

fn vector(e: &Entity, name: &str) -> [f64; 3] {
    e.params.get(name).and_then(|n| n.numbers()).unwrap_or_else(|| panic!("no {name}"))
}

fn number(e: &Entity, name: &str) -> f64 {
    e.params.get(name).and_then(|n| n.number()).unwrap_or_else(|| panic!("no {name}"))
}

fn text<'a>(e: &'a Entity, name: &str) -> &'a str {
    e.params.get(name).and_then(|n| n.text()).unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn settings_camera_and_lights_are_the_courses() {
    let d = scene(
        "Lights { numLights 2 DirectionalLight { direction 0 -1 0 color .8 .8 .8 }
           PointLight { position 0 5 0 color 1 0.5 0 attenuation 1 2 3 } }
         Background { color 0 0 1 ambientLight 0.2 0.2 0.2 } # a comment
         Materials { numMaterials 1 PhongMaterial { diffuseColor 1 0 0 } } // another
         Group { numObjects 1 MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }",
    );
    let film = d.single(Kind::Film).unwrap();
    assert_eq!((number(film, "width"), number(film, "height"), text(film, "filter")), (200.0, 200.0, "point"));
    let integrator = d.single(Kind::Integrator).unwrap();
    assert_eq!((number(integrator, "max_depth"), text(integrator, "shadows")), (0.0, "none"));
    let camera = find(&d, Kind::Camera, "camera");
    assert_eq!((camera.type_name.text.as_str(), vector(camera, "look_at")), ("perspective", [0.0, 0.0, 4.0]));
    assert_eq!(number(camera, "fov"), 30.0);
    assert_eq!(vector(find(&d, Kind::Light, "ambient"), "color"), [0.2; 3]);
    assert_eq!(vector(find(&d, Kind::Light, "light_0"), "direction"), [0.0, -1.0, 0.0]);
    assert_eq!(vector(find(&d, Kind::Light, "light_1"), "attenuation"), [3.0, 2.0, 1.0]);
    assert_eq!(text(find(&d, Kind::Light, "light_1"), "unit"), "plain");
    assert_eq!(vector(d.single(Kind::Background).unwrap(), "color"), [0.0, 0.0, 1.0]);
    let sphere = find(&d, Kind::Object, "sphere_0");
    assert_eq!(text(sphere, "material"), "material_0");
    assert_eq!(d.sources.line_column(sphere.span), Some((6, 47)));
    assert_eq!(d.sources.0[0].path, "a/s.txt");
}

const SPHERE: &str = "Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }";

#[test]
fn without_any_light_the_plain_colour_shows() {
    let materials = "Materials { Material { diffuseColor 1 0 0 } }";
    assert_eq!(vector(find(&scene(&format!("{materials}{SPHERE}")), Kind::Light, "ambient"), "color"), [1.0; 3]);
    assert!(scene(&format!("Lights {{ numLights 0 }}{materials}{SPHERE}")).all(Kind::Light).is_empty());
}

#[test]
fn a_point_light_without_attenuation_has_no_falloff() {
    let d = scene(&format!(
        "Lights {{ PointLight {{ position 0 5 0 color 1 1 1 }} }} Materials {{ Material {{ }} }}{SPHERE}"
    ));
    assert_eq!(vector(find(&d, Kind::Light, "light_0"), "attenuation"), [0.0, 0.0, 1.0]);
}

#[test]
fn both_dialects_of_materials_are_understood() {
    let d = scene(&format!(
        "Materials {{ PhongMaterial {{ diffuseColor 0 0 1 specularColor 1 1 1 exponent 64 reflectiveColor .5 .5 .5
           transparentColor .1 .2 .3 indexOfRefraction 1.25 }} PhongMaterial {{ specularColor 1 1 1 shininess 20}}
           Material {{ texture tex/a.bmp }} Material {{ Noise {{ color 1 0 0 color 0 1 0 octaves 3 frequency 2 }} }} }}{SPHERE}"
    ));
    let all = d.all(Kind::Material);
    assert_eq!(all[0].type_name.text, "blinn_phong");
    assert_eq!((number(&all[0], "exponent"), number(&all[0], "ior")), (64.0, 1.25));
    assert_eq!((text(&all[0], "form"), text(&all[0], "fresnel")), ("classic", "constant"));
    assert_eq!(vector(&all[0], "transmit"), [0.1, 0.2, 0.3]);
    assert_eq!(all[1].type_name.text, "phong");
    assert_eq!(vector(&all[1], "diffuse"), [1.0; 3]);
    assert_eq!(text(&all[2], "diffuse"), "material_2_image");
    let image = find(&d, Kind::Texture, "material_2_image");
    assert_eq!((text(image, "file"), text(image, "encoding")), ("tex/a.bmp", "linear"));
    let noise = find(&d, Kind::Texture, "material_3_noise");
    assert_eq!(
        (noise.type_name.text.as_str(), number(noise, "octaves"), number(noise, "amplitude")),
        ("marble", 3.0, 1.0)
    );
}

#[test]
fn patterns_become_textures_where_their_materials_differ() {
    let d = scene(&format!(
        "Materials {{ numMaterials 5
           PhongMaterial {{ diffuseColor 1 0 0 specularColor 1 1 1 exponent 64 }}
           PhongMaterial {{ diffuseColor 0 0 1 specularColor 1 1 1 exponent 32 }}
           Checkerboard {{ Transform {{ UniformScale 2 YRotate 20 Translate 1 2 3 Rotate {{ 1 0 0 30 }} }}
             materialIndex 0 materialIndex 1 }}
           Noise {{ materialIndex 2 materialIndex 0 octaves 4 }}
           Wood {{ materialIndex 0 materialIndex 1 octaves 0 frequency 7 amplitude 2 }} }}{SPHERE}"
    ));
    let checker = find(&d, Kind::Texture, "material_2_diffuse");
    assert_eq!(
        (checker.type_name.text.as_str(), text(checker, "mapping"), text(checker, "space")),
        ("checker", "solid", "world")
    );
    assert_eq!((vector(checker, "a"), vector(checker, "b")), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    // The course looks up M p, with M the product of the steps in written order; Kirkas looks up with the inverse.
    let world_from_texture = read_transform(checker.params.get("transform").unwrap()).unwrap();
    let t = (30_f64.to_radians(), 20_f64.to_radians());
    let p = DVec3::new(0.3, -0.7, 1.9);
    let q = DVec3::new(p.x, p.y * t.0.cos() - p.z * t.0.sin(), p.y * t.0.sin() + p.z * t.0.cos())
        + DVec3::new(1.0, 2.0, 3.0);
    let q = 2.0 * DVec3::new(q.x * t.1.cos() + q.z * t.1.sin(), q.y, q.z * t.1.cos() - q.x * t.1.sin());
    assert!((world_from_texture.inverse().transform_point3(p) - q).length() < 1e-12);
    let all = d.all(Kind::Material);
    assert_eq!(vector(&all[2], "specular"), [1.0; 3]);
    assert_eq!(text(&all[2], "exponent"), "material_2_exponent");
    assert_eq!(number(find(&d, Kind::Texture, "material_2_exponent"), "b"), 32.0);
    assert_eq!(text(find(&d, Kind::Texture, "material_3_diffuse"), "a"), "material_2_diffuse");
    let wood = find(&d, Kind::Texture, "material_4_diffuse");
    assert_eq!((number(wood, "frequency"), number(wood, "amplitude"), number(wood, "octaves")), (7.0, 2.0, 0.0));
}

#[test]
fn transformations_apply_innermost_first_and_groups_are_parents() {
    let d = scene(
        "Materials { Material { diffuseColor 1 0 0 } Material { } }
         Group { numObjects 2
           MaterialIndex 1
           Transform { Translate 1 0 0 Scale 2 2 2
             Transform { ZRotate 90 Matrix { 1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1 } Sphere { center 0 0 0 radius 1 } } }
           Transform { UniformScale 3 Group { numObjects 3
             Plane { normal 0 2 0 offset -1 }
             MaterialIndex 0
             Triangle { vertex0 0 0 0 vertex1 1 0 0 vertex2 0 1 0 }
             Transform { XRotate 90 TriangleMesh { obj_file m/cube.obj } } } } }",
    );
    let transform = |name: &str| read_transform(find(&d, Kind::Object, name).params.get("transform").unwrap()).unwrap();
    let p = transform("sphere_0").transform_point3(DVec3::ZERO);
    assert!((p - DVec3::new(1.0, 10.0, 0.0)).length() < 1e-12, "{p}");
    assert_eq!(text(find(&d, Kind::Object, "sphere_0"), "material"), "material_1");
    assert!(find(&d, Kind::Object, "sphere_0").params.get("parent").is_none());
    assert_eq!(transform("group_0").transform_point3(DVec3::X), DVec3::new(3.0, 0.0, 0.0));
    let plane = find(&d, Kind::Object, "plane_0");
    assert_eq!((vector(plane, "point"), vector(plane, "normal")), ([0.0, -1.0, 0.0], [0.0, 2.0, 0.0]));
    assert_eq!((text(plane, "parent"), text(plane, "material")), ("group_0", "material_1"));
    let triangle = find(&d, Kind::Object, "triangle_0");
    assert_eq!(triangle.params.get("vertices").unwrap().list().unwrap().len(), 3);
    assert_eq!((text(triangle, "parent"), text(triangle, "material")), ("group_0", "material_0"));
    let mesh = find(&d, Kind::Object, "mesh_0");
    assert_eq!((text(mesh, "file"), text(mesh, "normals"), text(mesh, "parent")), ("m/cube.obj", "file", "group_0"));
    assert!(mesh.params.get("file").unwrap().span.is_some(), "its path must be relative to the scene");
}

#[test]
fn what_cannot_be_expressed_is_warned_of() {
    let text = format!(
        "{HEAD}Background {{ cubeMap sky }} Materials {{
           PhongMaterial {{ transparentColor 1 1 1 indexOfRefraction 2 bump b.bmp }}
           PhongMaterial {{ transparentColor 1 1 1 indexOfRefraction 3 }}
           Checkerboard {{ materialIndex 0 materialIndex 1 }} }}
         Group {{ Sphere {{ center 0 0 0 radius 1 }} }}"
    );
    let (_, warnings) = read_with_warnings(&files(&[("s.txt", &text)]), "s.txt").unwrap();
    let messages: Vec<&str> = warnings.iter().map(|w| w.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "`cubeMap` is ignored: Kirkas has no cube maps yet; the background is plain",
            "`bump` is ignored: Kirkas has no bump maps yet",
            "the two materials of a pattern differ in their refractive index",
            "this object stands before any `MaterialIndex`",
        ]
    );
    assert!(warnings.iter().all(|w| !w.is_error() && !w.labels.is_empty()));
}

#[test]
fn every_error_names_the_cure() {
    let ok = format!("{HEAD}Materials {{ numMaterials 1 Material {{ diffuseColor 1 0 0 }} }}\n{SPHERE}");
    assert!(read(&files(&[("s.txt", &ok)]), "s.txt").is_ok());
    for (from, to, expected) in [
        (
            "PerspectiveCamera",
            "PerspectivCamera",
            "unknown block `PerspectivCamera`; did you mean `PerspectiveCamera`?",
        ),
        ("diffuseColor", "difuseColor", "unknown word in `Material`: `difuseColor`; did you mean `diffuseColor`?"),
        ("radius 1", "radius one", "`radius` takes a number here, not `one`"),
        ("radius 1", "radius inf", "`inf` is not a finite number"),
        ("radius 1", "", "`Sphere` lacks `radius`"),
        ("angle 30", "size 30", "unknown word in `PerspectiveCamera`: `size`"),
        ("direction 0 0 -1", "direction 0 0 0", "the direction is 0 0 0"),
        ("numMaterials 1", "numMaterials 2", "`numMaterials` says 2, but this block holds 1 materials"),
        ("Group {", "Group { numObjects 3", "`numObjects` says 3, but this block holds 1 objects"),
        ("MaterialIndex 0", "MaterialIndex 1", "material 1 does not exist: there are 1 above"),
        ("MaterialIndex 0", "MaterialIndex -1", "`MaterialIndex` takes a whole number, not `-1`"),
        ("Sphere {", "Sphere ", "`Sphere` must be followed by `{`, not `center`"),
        ("radius 1 } }", "radius 1 }", "the block of `Group` is never closed"),
        ("radius 1 } }", "radius", "the file ends where a number should follow `radius`"),
        ("Sphere {", "Transform { } Sphere {", "`Transform` lacks `an object`"),
        (
            "Sphere {",
            "Transform { Matrix { 1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1 } Sphere {",
            "the last row of a matrix must be 0 0 0 1",
        ),
        ("Material {", "Checkerboard { materialIndex 0 materialIndex 0 } Material {", "there are none above"),
        (SPHERE, "", "`s.txt` has no objects"),
        (HEAD, "", "`s.txt` has no camera"),
    ] {
        let found = complaint(&ok.replacen(from, to, 1));
        assert!(found.contains(expected), "{found}\nshould say\n{expected}");
    }
    assert!(complaint("").contains("`s.txt` is empty"));
    let flat = ok.replace(
        "} }\nGroup",
        "} Material { } Checkerboard { Transform { Scale 1 0 1 } materialIndex 0 materialIndex 1 } }\nGroup",
    );
    assert!(complaint(&flat.replace("numMaterials 1", "")).contains("squashes the pattern flat"));
}

#[test]
fn deep_nesting_is_an_error_not_a_crash() {
    for word in ["Group { ", "Transform { "] {
        let deep = format!("{HEAD} Group {{ {}", word.repeat(100_000));
        assert!(complaint(&deep).contains("nest deeper than 64"), "{word}");
    }
}

#[test]
fn damaged_files_are_refused_in_peace() {
    let text = format!(
        "{HEAD}Lights {{ numLights 1 PointLight {{ position 0 1 2 color 1 1 1 attenuation 1 0 0 }} }}
         Background {{ color 0 0 0 ambientLight 0 0 0 }}
         Materials {{ numMaterials 3 PhongMaterial {{ diffuseColor 1 0 0 exponent 5 specularColor 1 1 1 }} Material {{ }}
           Wood {{ Transform {{ Scale 1 2 3 Rotate {{ 1 0 0 5 }} }} materialIndex 0 materialIndex 1 octaves 1 }} }}
         Group {{ numObjects 2 MaterialIndex 2 Transform {{ ZRotate 5 TriangleMesh {{ obj_file a.obj }} }}
           Group {{ Plane {{ normal 0 1 0 offset 2 }} }} }}"
    );
    damage(text.as_bytes(), |bytes| {
        let files = kirkas_scene::files::MemoryFiles([("s.txt".to_string(), bytes.to_vec())].into());
        let files = kirkas_scene::files::FileAccess::new(Box::new(files), kirkas_scene::files::Limits::default());
        let _ = read(&files, "s.txt");
    });
}

/// All scenes below `folder`.
fn scenes(folder: &std::path::Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            scenes(&path, found);
        } else if name.starts_with("scene") && name.ends_with(".txt") {
            found.push(path);
        }
    }
}

#[test]
fn every_scene_of_the_course_is_read_without_a_warning() {
    let Some(data) = std::env::var_os("KIRKAS_DATA") else {
        eprintln!("skipped: every_scene_of_the_course_is_read_without_a_warning (KIRKAS_DATA is not set)");
        return;
    };
    let mut all = Vec::new();
    scenes(&std::path::Path::new(&data).join("mit6837"), &mut all);
    assert!(all.len() >= 60, "only {} scenes", all.len());
    for path in all {
        let text = std::fs::read_to_string(&path).unwrap();
        match read_with_warnings(&files(&[("s.txt", &text)]), "s.txt") {
            Ok((d, warnings)) => {
                assert!(warnings.is_empty(), "{}: {warnings:?}", path.display());
                for mesh in d.all(Kind::Object).iter().filter(|o| o.type_name.text == "mesh") {
                    let file = path.parent().unwrap().join(self::text(mesh, "file"));
                    let bytes = std::fs::read(&file).unwrap();
                    let mesh = kirkas_formats::obj::read(&bytes, "m.obj", &mut |n| panic!("{n}"));
                    mesh.unwrap_or_else(|f| panic!("{}: {}", file.display(), failure(&f))).validate().unwrap();
                }
            }
            // One scene is empty on some disks.
            Err(f) => assert!(
                text.trim().is_empty() && failure(&f).contains("is empty"),
                "{}: {}",
                path.display(),
                failure(&f)
            ),
        }
    }
}
