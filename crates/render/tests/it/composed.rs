//! Materials that are made of others: what they do in a picture, and what is said about wrong ones.

use crate::support::{assert_near, grey, prepared, seen};
use kirkas_formats::{FormatAssets, load};
use kirkas_render::{Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

/// A plate in the plane z = 0 under a sky of 1, seen from straight above and from below.
fn plate(materials: &str) -> String {
    format!(
        "[integrator]\ntype = \"path\"\n[background]\ncolor = 1\n{materials}\n[objects.plate]\ntype = \"rectangle\"\nmaterial = \"it\"\n"
    )
}

const ABOVE: [f64; 3] = [0.01, 0.02, 3.0];
const BELOW: [f64; 3] = [0.01, 0.02, -3.0];
const MIDDLE: [f64; 3] = [0.01, 0.02, 0.0];

const WALLS: &str = "[materials.light]\ntype = \"lambert\"\nreflectance = 0.8\n[materials.dark]\ntype = \"lambert\"\nreflectance = 0.2\n\
    [materials.veil]\ntype = \"mask\"\nmaterial = \"light\"\nopacity = 0.5\n";

#[test]
fn a_mask_lets_straight_through_what_it_does_not_cover() {
    let scene = |opacity: &str| {
        plate(&format!("{WALLS}[materials.it]\ntype = \"mask\"\nmaterial = \"dark\"\nopacity = {opacity}\n"))
    };
    assert_near(grey(&scene("1"), ABOVE, MIDDLE, 4000), 0.2, 1e-2);
    assert_near(grey(&scene("0"), ABOVE, MIDDLE, 4), 1.0, 1e-6);
    assert_near(grey(&scene("0.3"), ABOVE, MIDDLE, 60_000), 0.3 * 0.2 + 0.7, 5e-3);
    // Masks and `alpha` multiply.
    let both = scene("0.5\nalpha = 0.4");
    assert_near(grey(&both, ABOVE, MIDDLE, 60_000), 0.2 * 0.2 + 0.8, 5e-3);
}

#[test]
fn shadow_rays_pass_the_holes_of_a_mask_as_often_as_light_does() {
    for integrator in ["path", "whitted", "path_simple"] {
        let scene = format!(
            "[integrator]\ntype = \"{integrator}\"\n{WALLS}[materials.net]\ntype = \"mask\"\nmaterial = \"dark\"\nopacity = 0.3\n\
             [lights.sun]\ntype = \"directional\"\ndirection = [0, 0, -1]\n\
             [objects.net]\ntype = \"rectangle\"\nmaterial = \"net\"\ncenter = [0, 0, 1]\nvisible = false\n\
             [objects.floor]\ntype = \"rectangle\"\nmaterial = \"light\"\nedge_u = [9, 0, 0]\nedge_v = [0, 9, 0]\n\
             [background]\ncolor = 0\n"
        );
        let open = scene.replace("opacity = 0.3", "opacity = 0");
        let from = [3.0, 0.0, 0.5];
        let (shaded, bright) = (grey(&scene, from, MIDDLE, 40_000), grey(&open, from, MIDDLE, 4));
        // What bounces off the floor and the net besides is a few hundredths.
        assert!((shaded / bright - 0.7).abs() < 0.04, "{integrator}: {shaded} of {bright}");
    }
}

#[test]
fn blends_and_sums_weigh_their_parts_and_the_holes_in_them() {
    let with = |words: &str| grey(&plate(&format!("{WALLS}[materials.it]\n{words}\n")), ABOVE, MIDDLE, 40_000);
    assert_near(with("type = \"blend\"\nfirst = \"light\"\nsecond = \"dark\"\namount = 0.25"), 0.65, 2e-3);
    let half = with("type = \"blend\"\nfirst = \"veil\"\nsecond = \"dark\"\namount = 0.5");
    assert_near(half, 0.5 * (0.5 * 0.8 + 0.5) + 0.5 * 0.2, 6e-3);
    assert_near(with("type = \"sum\"\nmaterials = [\"light\", \"dark\"]\nweights = [0.5, 0.25]"), 0.45, 2e-3);
    assert_near(with("type = \"sum\"\nmaterials = [\"light\", \"dark\"]\nweights = [3, 1]"), 0.65, 2e-3);
    assert_near(with("type = \"sum\"\nmaterials = [\"light\", \"dark\"]\nform = \"classic\""), 1.0, 2e-3);
}

#[test]
fn a_blend_follows_its_texture() {
    let scene = plate(&format!(
        "{WALLS}[materials.it]\ntype = \"blend\"\nfirst = \"light\"\nsecond = \"dark\"\namount = \"squares\"\n\
         [textures.squares]\ntype = \"checker\"\nscale = 2\n"
    ));
    let at = |x: f64, y: f64| grey(&scene, [x, y, 3.0], [x, y, 0.0], 16);
    assert_near(at(-0.2, -0.2), 0.2, 0.05);
    assert_near(at(0.2, -0.2), 0.8, 0.05);
}

#[test]
fn a_sheet_has_two_faces_and_nothing_goes_through() {
    let sheet = "[materials.red]\ntype = \"lambert\"\nreflectance = [0.8, 0.1, 0.1]\n[materials.glass]\ntype = \"dielectric\"\n\
        [materials.it]\ntype = \"two_sided\"\nfront = \"red\"\nback = \"glass\"\n";
    let front = seen(&plate(sheet), ABOVE, MIDDLE, 4000);
    assert_near(front[0], 0.8, 1e-2);
    assert_near(front[1], 0.1, 1e-2);
    // Fresnel's equations straight on: 4 %, and the rest is swallowed.
    assert_near(grey(&plate(sheet), BELOW, MIDDLE, 4000), 0.04, 1e-3);
    let same = sheet.replace("back = \"glass\"", "");
    assert_near(seen(&plate(&same), BELOW, MIDDLE, 4000)[0], 0.8, 1e-2);
}

/// A mirror that a map turns by atan(1/2) about y throws a view from straight above towards (4, 0, 3) / 5; of that its upright facets
/// hide 1 - G1 = 2/5, which they send to the other side.
#[test]
fn a_turned_mirror_shows_what_lies_where_it_turns_to() {
    let lit = "[integrator]\ntype = \"path\"\n[materials.silver]\ntype = \"mirror\"\nreflectance = 1\n\
        [materials.it]\ntype = \"normal_map\"\nmaterial = \"silver\"\nnormals = [0.75, 0.5, 1]\n\
        [objects.plate]\ntype = \"rectangle\"\nmaterial = \"it\"\n\
        [materials.lamp]\ntype = \"emitter\"\n[objects.lamp]\ntype = \"sphere\"\nradius = 2\nmaterial = \"lamp\"\n";
    let lamp_at =
        |x: f64, z: f64| grey(&format!("{lit}center = [{x}, 0, {z}]\n"), [0.0, 0.0, 3.0], [0.0, 0.0, 0.0], 20_000);
    assert_near(lamp_at(16.0, 12.0), 0.6, 0.03);
    assert_near(lamp_at(-16.0, 12.0), 0.4, 0.03);
    assert_eq!(lamp_at(0.0, 30.0), 0.0);
}

/// Parts of one filling make one body: glass, in places frosted, keeps the furnace.
#[test]
fn glass_that_is_frosted_in_places_is_one_body() {
    let scene = "[integrator]\ntype = \"path\"\n[background]\ncolor = 1\n[materials.clear]\ntype = \"dielectric\"\n\
        [materials.rough]\ntype = \"rough_dielectric\"\nroughness = 0.001\n\
        [materials.it]\ntype = \"blend\"\nfirst = \"clear\"\nsecond = \"rough\"\n[objects.ball]\ntype = \"sphere\"\nmaterial = \"it\"\n";
    assert_near(grey(scene, [0.3, 0.2, 4.0], [0.0, 0.0, 0.0], 4000), 1.0, 5e-3);
    let p = prepared(
        &(scene.to_string()
            + "[film]\nwidth = 2\nheight = 2\n[cameras.eye]\ntype = \"perspective\"\nposition = [0, 0, 0]\nlook_at = [0, 0, 1]\n"),
    );
    assert!(p.scene.materials.iter().find(|m| m.name == "it").is_some_and(|m| m.medium.is_some()));
}

fn complaint(materials: &str) -> String {
    let toml = format!(
        "{materials}[cameras.eye]\ntype = \"perspective\"\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n[objects.plate]\ntype = \"rectangle\"\nmaterial = \"it\"\n"
    );
    let mut files = MemoryFiles::default();
    files.0.insert("scene.toml".into(), toml.into_bytes());
    let access = FileAccess::new(Box::new(files), Limits::default());
    let description = load(&access, "scene.toml").expect("readable");
    let assets = FormatAssets::new(&access, &description.sources);
    let found = prepare(&description, &assets, &Options::default()).err().expect("refused");
    format!("{}: {} | {}", found[0].code, found[0].message, found[0].help.clone().unwrap_or_default())
}

#[test]
fn wrong_parts_are_refused_with_a_cure() {
    let blend = |a: &str, b: &str| format!("type = \"blend\"\nfirst = \"{a}\"\nsecond = \"{b}\"\n");
    let it = blend("a", "b");
    let a_lamp = format!("[materials.it]\n{it}[materials.a]\ntype = \"emitter\"\n[materials.b]\ntype = \"lambert\"\n");
    assert_eq!(
        complaint(&a_lamp),
        "bad-part: `a` is a lamp, which cannot be part of `it` | only a `mask` can be made of an `emitter`"
    );
    let a_hull = a_lamp.replace("emitter", "hull");
    assert_eq!(
        complaint(&a_hull),
        "bad-part: `a` is a hull, which cannot be part of `it` | a hull bounds a medium by itself: give it an object of its own"
    );
    let ring = format!("[materials.it]\n{it}[materials.a]\n{}[materials.b]\ntype = \"lambert\"\n", blend("b", "it"));
    assert_eq!(
        complaint(&ring),
        "material-cycle: material `it` is made of itself: `it` -> `a` -> `it` | make one of these of another material"
    );
    let two = format!(
        "[materials.it]\n{it}[materials.a]\ntype = \"dielectric\"\n[materials.b]\ntype = \"dielectric\"\nior = 2\n"
    );
    assert_eq!(
        complaint(&two),
        "two-bodies: `a` and `b` are filled differently, but `it` has one inside | give both the same `ior`, `absorption`, `priority`, `fresnel` and `interior`"
    );
    let unknown = format!("[materials.it]\n{}[materials.wood]\ntype = \"lambert\"\n", blend("wod", "wood"));
    assert!(complaint(&unknown).contains("did you mean `wood`?"), "{}", complaint(&unknown));
    let sum =
        "[materials.it]\ntype = \"sum\"\nmaterials = [\"a\"]\nweights = [1, 2]\n[materials.a]\ntype = \"lambert\"\n";
    assert_eq!(complaint(sum), "bad-sum: `it` has 2 weights for 1 materials | give one weight for each material");
    assert_eq!(complaint(&sum.replace("[\"a\"]", "[]")), "bad-sum: `it` adds up 0 materials | name from 1 to 16");
    // A chain that doubles at every link, and one that is only long.
    let chain = |n: usize, second: &str| {
        let link = |i: usize| {
            let below = if i + 1 == n { "end".to_string() } else { format!("m{}", i + 1) };
            let name = if i == 0 { "it".to_string() } else { format!("m{i}") };
            format!("[materials.{name}]\n{}", blend(&below, if second == "same" { &below } else { second }))
        };
        (0..n).map(link).collect::<String>() + "[materials.end]\ntype = \"lambert\"\n"
    };
    assert_eq!(
        complaint(&chain(8, "same")),
        "too-deep: `m2` is made of 127 materials, all told | at most 64 can be put together"
    );
    assert_eq!(
        complaint(&chain(20, "end")),
        "too-deep: material `it` is made of materials more than 16 deep | put less into each other"
    );
    assert_near(grey(&plate(&chain(5, "same")), ABOVE, MIDDLE, 4000), 0.5, 1e-2);
}
