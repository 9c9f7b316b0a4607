//! Patterns and mappings against their closed forms; vertex colours; every parameter of every material takes a texture.

use crate::support::{assert_near, grey, prepared_with, seen};
use kirkas_geometry::{DVec3, Vec3};
use kirkas_render::textures::{ColorSource, Patch, TexturePoint};
use kirkas_render::{Options, catalog};
use kirkas_scene::{Fallback, Kind, ParamType};

const EYE: &str =
    "[cameras.eye]\ntype = \"perspective\"\n[lights.sun]\ntype = \"directional\"\ndirection = [0, -1, 0]\n";

/// The colour of the one texture `t` of `toml` at a point of object space that faces `normal`.
fn color(toml: &str, at: [f64; 3], normal: [f32; 3]) -> [f32; 3] {
    let picture = kirkas_images::write_png8(
        2,
        2,
        &[255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255],
        &kirkas_images::Texts::new(),
    )
    .expect("a sound picture");
    let p = prepared_with(&format!("{EYE}[textures.t]\n{toml}\n"), &[("p.png", &picture)], &Options::default());
    let [object_normal, world_normal] = [Vec3::from_array(normal); 2];
    let patch = Patch { object_normal, world_normal, ..Patch::POINT };
    let at = DVec3::from_array(at);
    p.scene.textures.color(ColorSource::Texture(0), &TexturePoint { patch, ..TexturePoint::at([0.0; 2], at, at) })
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];
const WHITE: [f32; 3] = [1.0; 3];

#[test]
fn mappings_lay_a_picture_as_they_say() {
    // Red and green above, blue and white below.
    let at = |mapping: &str, p: [f64; 3], n: [f32; 3]| {
        color(&format!("type = \"image\"\nfile = \"p.png\"\nfilter = \"nearest\"\nmapping = \"{mapping}\""), p, n)
    };
    let up = [0.0, 1.0, 0.0];
    for (place, expected) in
        [([0.2, 0.8, 7.0], RED), ([0.8, 0.8, 0.0], GREEN), ([0.2, 0.2, 0.0], BLUE), ([0.8, 0.2, 0.0], WHITE)]
    {
        assert_eq!(at("planar", place, up), expected, "{place:?}");
    }
    // From -z over -x to +z: the left half.
    assert_eq!(at("spherical", [-1.0, 1.0, 0.0], up), RED);
    assert_eq!(at("spherical", [1.0, 1.0, 0.0], up), GREEN);
    assert_eq!(at("spherical", [1.0, -1.0, 0.0], up), WHITE);
    assert_eq!(at("cylindrical", [-1.0, 0.2, 0.0], up), BLUE);
    assert_eq!(at("cylindrical", [2.0, 0.8, 0.1], up), GREEN);
    // A box: seen from +x, u runs along -z; from above, v runs along -z.
    assert_eq!(at("box", [9.0, 0.8, -0.2], [1.0, 0.1, 0.2]), RED);
    assert_eq!(at("box", [9.0, 0.8, 0.2], [-1.0, 0.1, 0.2]), RED);
    assert_eq!(at("box", [0.8, 9.0, -0.2], [0.1, 1.0, 0.2]), WHITE);
    assert_eq!(at("box", [0.8, 0.8, 9.0], [0.1, 0.2, 1.0]), GREEN);
    // Facing one axis it is that side alone; facing three, a third of each.
    assert_eq!(at("triplanar", [9.0, 0.8, -0.2], [1.0, 0.0, 0.0]), RED);
    let mixed = at("triplanar", [0.2, 0.8, -0.2], [1.0, 1.0, 1.0]);
    // From +x red (0.2, 0.8), from +y blue (0.2, 0.2), from +z red (0.2, 0.8).
    for (lane, expected) in mixed.into_iter().zip([2.0 / 3.0, 0.0, 1.0 / 3.0]) {
        assert!((lane - expected).abs() < 1e-6, "{mixed:?}");
    }
}

#[test]
fn a_picture_turns_counter_clockwise() {
    let at = |more: &str, p| {
        color(
            &format!("type = \"image\"\nfile = \"p.png\"\nfilter = \"nearest\"\nmapping = \"planar\"\n{more}"),
            p,
            [0.0; 3],
        )
    };
    // The lower right quarter, white, comes to stand above the origin's right.
    assert_eq!(at("rotation = 90", [-0.2, 0.8, 0.0]), WHITE);
    assert_eq!(at("rotation = 90", [-0.8, 0.2, 0.0]), RED);
}

#[test]
fn gradients_follow_their_stops_and_are_averaged_exactly() {
    let ramp =
        "type = \"gradient\"\nmapping = \"solid\"\nstops = [[0.0, [0, 0, 0]], [0.5, [1, 0, 0]], [1.0, [1, 1, 0]]]\n";
    let at = |more: &str, p: [f64; 3]| color(&format!("{ramp}{more}"), p, [0.0; 3]);
    assert_eq!(at("", [0.25, 9.0, 9.0]), [0.5, 0.0, 0.0]);
    assert_eq!(at("along = \"v\"", [9.0, 0.75, 9.0]), [1.0, 0.5, 0.0]);
    assert_eq!(at("", [-3.0, 0.0, 0.0]), [0.0; 3]);
    assert_eq!(at("", [3.0, 0.0, 0.0]), [1.0, 1.0, 0.0]);
    assert_eq!(at("repeat = \"repeat\"", [3.25, 0.0, 0.0]), [0.5, 0.0, 0.0]);
    assert_eq!(at("repeat = \"mirror\"", [3.25, 0.0, 0.0]), [1.0, 0.5, 0.0]);
    assert_eq!(at("along = \"radial\"", [0.0, 0.3, 0.4]), [1.0, 0.0, 0.0]);
    assert_eq!(at("along = \"angle\"", [-2.0, 0.0, 5.0]), [1.0, 0.0, 0.0]);
    // Over a wide footprint: the mean of the ramp.
    let p = prepared_with(&format!("{EYE}[textures.t]\n{ramp}repeat = \"mirror\"\n"), &[], &Options::default());
    let patch = Patch { object_axes: [Vec3::X * 40.0, Vec3::ZERO], ..Patch::POINT };
    let at = TexturePoint { patch, ..TexturePoint::at([0.0; 2], DVec3::splat(0.37), DVec3::ZERO) };
    let [r, g, _] = p.scene.textures.color(ColorSource::Texture(0), &at);
    assert!((r - 0.75).abs() < 0.01 && (g - 0.25).abs() < 0.01, "{r} {g}");
}

#[test]
fn bricks_lie_in_shifted_rows() {
    let wall = "type = \"brick\"\na = 1\nb = 0\nsize = [1, 0.5]\nmortar = 0.1\nmapping = \"planar\"";
    let at = |x, y| color(wall, [x, y, 0.0], [0.0; 3])[0];
    assert_eq!(
        [at(0.5, 0.25), at(0.02, 0.25), at(0.5, 0.02), at(0.5, 0.75), at(0.02, 0.75)],
        [1.0, 0.0, 0.0, 0.0, 1.0]
    );
}

#[test]
fn colours_of_vertices_are_mixed_over_the_triangle_and_light_rooms() {
    let obj = b"v -1 -1 0 1 0 0\nv 3 -1 0 0 1 0\nv -1 3 0 0 0 1\nf 1 2 3\n";
    let scene = "[textures.paint]\ntype = \"vertex_color\"\n[materials.shining]\ntype = \"emitter\"\nradiance = \"paint\"\n\
                 [objects.sheet]\ntype = \"mesh\"\nfile = \"sheet.obj\"\nmaterial = \"shining\"\n";
    let look = |x: f64, y: f64| {
        let toml = crate::support::one_pixel(scene, [x, y, 2.0], [x, y, 0.0], 1);
        let p = prepared_with(&toml, &[("sheet.obj", obj)], &Options::default());
        crate::support::pixel(&crate::support::expose(&p, 0..1).0, 0, 0)
    };
    for (x, y) in [(0.0, 0.0), (-0.5, 1.0)] {
        let [r, g, b] = look(x, y);
        assert_near(g, (x + 1.0) / 4.0, 1e-5);
        assert_near(b, (y + 1.0) / 4.0, 1e-5);
        assert_near(r, 1.0 - (x + y + 2.0) / 4.0, 1e-5);
    }
    // Without colours: the fallback.
    let bare = scene.replace("type = \"vertex_color\"", "type = \"vertex_color\"\nfallback = 0.25").replace(
        "type = \"mesh\"\nfile = \"sheet.obj\"",
        "type = \"rectangle\"\nedge_u = [4, 0, 0]\nedge_v = [0, 4, 0]",
    );
    assert_near(grey(&bare, [0.0, 0.0, 2.0], [0.0; 3], 1), 0.25, 1e-6);
    assert_eq!(seen(&bare, [0.0, 0.0, 2.0], [9.0, 9.0, 0.0], 1), [0.0; 3]);
}

/// Numbers and colours of materials that are the same all over a surface, and why.
const EVEN: &[(&str, &str)] = &[
    ("ior", "the boundary of a body has one index, or tables are made for it beforehand"),
    ("coat_ior", "tables are made for it beforehand"),
    ("film_ior", "the film's waves are prepared for it"),
    ("k", "the metal's waves are prepared with its index"),
    ("absorption", "it fills the body, not the surface"),
    ("priority", "it ranks whole bodies"),
    ("intensity", "it scales `radiance`, which takes a texture; light sampling counts the whole lamp by it"),
    ("samples", "rays of a whole lamp"),
    ("spread", "the table of facets is made for it beforehand"),
    ("angle", "the table of facets is made for it beforehand"),
    ("columns", "the shape of a table"),
];

#[test]
fn every_number_and_colour_of_every_material_takes_a_texture_or_has_a_reason() {
    let catalog = catalog();
    let mut taken = 0;
    for spec in catalog.of_kind(Kind::Material) {
        // What must be written besides.
        let required: String = spec
            .params
            .iter()
            .filter(|row| row.fallback == Fallback::Required)
            .map(|row| match row.ty {
                ParamType::Reference(_) => format!("{} = \"base\"\n", row.name),
                ParamType::References(_) => format!("{} = [\"base\"]\n", row.name),
                ParamType::Numbers => format!("{} = [-1, -1, 1, 10, 0.5, 0.5, 0.5]\n", row.name),
                ParamType::ColorTexture | ParamType::NumberTexture => format!("{} = \"t\"\n", row.name),
                ParamType::Path => format!("{} = \"none.binary\"\n", row.name),
                ParamType::Index => format!("{} = 1.5\n", row.name),
                _ => String::new(),
            })
            .collect();
        for row in catalog.rows(spec) {
            let is_value =
                matches!(row.ty, ParamType::Integer | ParamType::Number | ParamType::Color | ParamType::Index);
            let is_texture = matches!(row.ty, ParamType::ColorTexture | ParamType::NumberTexture);
            let reason = EVEN.iter().find(|e| e.0 == row.name);
            assert!(!is_value || reason.is_some(), "{}.{} takes no texture: why?", spec.name, row.name);
            if !is_texture || required.contains("none.binary") {
                continue;
            }
            let required = required.replace(&format!("{} = \"t\"\n", row.name), "");
            let toml = format!(
                "{EYE}[textures.t]\ntype = \"checker\"\na = 0.2\nb = 0.9\n[materials.m]\ntype = \"{}\"\n{required}{} = \"t\"\n\
                 [materials.base]\ntype = \"lambert\"\n[objects.o]\ntype = \"sphere\"\nmaterial = \"m\"\n",
                spec.name, row.name
            );
            let p = prepared_with(&toml, &[], &Options::default());
            let m = &p.scene.materials[0];
            assert_eq!(m.detail, kirkas_render::shapes::Detail::Texture, "{}.{} is not looked up", spec.name, row.name);
            taken += 1;
        }
    }
    assert!(taken > 60, "only {taken} parameters");
}
