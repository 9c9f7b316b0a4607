//! `path` against its plain twin and against `whitted`, where their domains overlap.

use crate::support::{assert_agree, assert_near, expose, grey, prepared, prepared_with};
use kirkas_render::{Film, Options};

/// A camera with few pixels and independent samples, whose noise is what it says.
fn picture(integrator: &str, body: &str, samples: u32) -> Film {
    let leaf: (&str, &[u8]) = ("leaf.png", include_bytes!("scenes/leaf.png"));
    let p = prepared_with(
        &format!(
            "[integrator]\n{integrator}\n[film]\nwidth = 12\nheight = 9\nfilter = \"box\"\n[sampler]\ntype = \"independent\"\n\
             [cameras.eye]\ntype = \"perspective\"\nposition = [0.2, 1, 3.4]\nlook_at = [0, 0.8, 0]\nfov = 50\n{body}"
        ),
        &[leaf],
        &Options::default(),
    );
    expose(&p, 0..samples).0
}

const ROOM: &str = "
[materials.grey]
type = \"lambert\"
reflectance = [0.7, 0.6, 0.5]
[objects.floor]
type = \"rectangle\"
edge_u = [6, 0, 0]
edge_v = [0, 0, -6]
material = \"grey\"
[objects.wall]
type = \"rectangle\"
center = [0, 1.5, -2]
edge_u = [6, 0, 0]
edge_v = [0, 3, 0]
material = \"grey\"
";

/// What a scene holds besides the room; each with everything that could go wrong in its own way.
const CASES: [(&str, &str); 7] = [
    (
        "lamps of several shapes and a sky",
        "[background]\ntype = \"gradient\"\nstops = [[-1, 0.1], [0, 0.2], [1, [0.3, 0.5, 0.9]]]
         [materials.lamp]\ntype = \"emitter\"\nradiance = [4, 3, 2]\n
         [objects.panel]\ntype = \"disk\"\ncenter = [0, 2.6, 0]\nnormal = [0.2, -1, 0]\nradius = 0.6\nmaterial = \"lamp\"
         [objects.bulb]\ntype = \"sphere\"\ncenter = [-1, 0.8, -0.8]\nradius = 0.4\nmaterial = \"lamp\"
         [objects.tent]\ntype = \"mesh\"\nvertices = [[0.6, 0.2, -1], [1.2, 0.2, -1], [0.9, 0.8, -0.6], [1.4, 0.9, -1.2]]\nfaces = [0, 1, 2, 1, 3, 2]\nmaterial = \"both\"
         [materials.both]\ntype = \"emitter\"\ntwo_sided = true\nunit = \"W\"\nintensity = 4\n",
    ),
    (
        "points and directions",
        "[lights.bulb]\ntype = \"point\"\nposition = [1, 1.5, 1]\n[lights.stage]\ntype = \"spot\"\nposition = [-2, 2.5, 1]\ndirection = [1, -1, -1]
         [lights.sun]\ntype = \"directional\"\ndirection = [0.3, -1, -0.4]\n",
    ),
    (
        "rough metal, and highlights on a lamp's reflection",
        "[materials.lamp]\ntype = \"emitter\"\nradiance = 3\n[objects.panel]\ntype = \"rectangle\"\ncenter = [0, 2.5, 0.5]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]\nmaterial = \"lamp\"
         [materials.metal]\ntype = \"rough_mirror\"\nroughness = 0.3\nreflectance = [0.9, 0.7, 0.4]\n[objects.ball]\ntype = \"sphere\"\ncenter = [-0.7, 0.6, 0]\nradius = 0.6\nmaterial = \"metal\"
         [materials.gloss]\ntype = \"phong\"\nspecular = 0.4\nexponent = 20\nreflect = 0.1\n[objects.other]\ntype = \"sphere\"\ncenter = [0.8, 0.6, 0]\nradius = 0.6\nmaterial = \"gloss\"\n",
    ),
    (
        "glass that absorbs, with water in it",
        "[background]\ncolor = [0.8, 0.9, 1]\n[materials.glass]\ntype = \"dielectric\"\nabsorption = [0.2, 0.6, 1]\npriority = 1\n[materials.water]\ntype = \"dielectric\"\nior = 1.33
         [objects.ball]\ntype = \"sphere\"\ncenter = [-0.3, 0.8, 0]\nradius = 0.8\nmaterial = \"glass\"\n[objects.drop]\ntype = \"sphere\"\ncenter = [0.6, 0.8, 0.1]\nradius = 0.6\nmaterial = \"water\"\n",
    ),
    (
        "frosted glass before a lamp",
        "[background]\ncolor = 0.3\n[materials.frost]\ntype = \"rough_dielectric\"\nroughness = 0.4\nabsorption = 0.3\n[objects.block]\ntype = \"box\"\nmin = [-0.8, 0.1, -0.4]\nmax = [0.8, 1.3, 0.4]\nmaterial = \"frost\"
         [materials.lamp]\ntype = \"emitter\"\nradiance = 3\n[objects.panel]\ntype = \"sphere\"\ncenter = [0.3, 1.6, -1.2]\nradius = 0.5\nmaterial = \"lamp\"\n",
    ),
    (
        "interpolated normals and a lamp inside",
        "[background]\ncolor = 0.5\n[materials.lamp]\ntype = \"emitter\"\nradiance = 5\ntwo_sided = true\n[objects.panel]\ntype = \"rectangle\"\ncenter = [0, 2, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]\nmaterial = \"lamp\"
         [objects.gem]\ntype = \"mesh\"\nnormals = \"smooth\"\nmaterial = \"grey\"\nvertices = [[0.9, 0.8, 0], [-0.9, 0.8, 0], [0, 1.6, 0], [0, 0, 0], [0, 0.8, 0.9], [0, 0.8, -0.9]]\nfaces = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5]\n",
    ),
    (
        "what is half there, glows in parts, and stands elsewhere",
        "[background]\ncolor = 0.4\n[textures.leaf]\ntype = \"image\"\nfile = \"leaf.png\"\n[textures.squares]\ntype = \"checker\"\nmapping = \"solid\"\nscale = 0.4\na = [1, 0.5, 0.25]\nb = 0.1
         [materials.veil]\ntype = \"lambert\"\nalpha = 0.5\n[objects.veil]\ntype = \"sphere\"\ncenter = [-0.8, 0.7, 0.2]\nradius = 0.7\nmaterial = \"veil\"
         [materials.glow]\ntype = \"emitter\"\nradiance = \"squares\"\nintensity = 2\nalpha = 0.7\ntwo_sided = true
         [objects.model]\ntype = \"group\"\ntemplate = true\n[objects.pane]\ntype = \"rectangle\"\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nmaterial = \"glow\"\nparent = \"model\"
         [objects.copy]\ntype = \"instance\"\nof = \"model\"\ntransform = [{ scale = [1.5, 0.7, 1] }, { rotate = [0, 1, 0, -50] }, { translate = [1, 1, -0.5] }]\n",
    ),
];

#[test]
fn path_and_its_plain_twin_agree() {
    for (what, case) in CASES {
        let body = format!("{ROOM}{case}");
        let path = picture("type = \"path\"\nmax_depth = 12", &body, 1500);
        let asking = picture("type = \"path_simple\"\nmax_depth = 12", &body, 3000);
        let finding = picture("type = \"path_simple\"\nmax_depth = 12\nnext_event = false", &body, 3000);
        assert_agree(&format!("{what}, asking lights"), &path, &asking);
        assert_agree(&format!("{what}, finding lights"), &path, &finding);
    }
}

#[test]
fn path_and_whitted_agree_on_direct_light() {
    for (what, case) in &CASES[..3] {
        // Whitted knows neither the light of the sky nor matte light in mirrors' rays beyond its depth.
        let body = format!("{ROOM}{case}").replace("[background]", "[background]\n# ");
        let body = body.replace("\n# \ntype = \"gradient\"\nstops", "\ncolor = 0\n# stops");
        let body =
            body.replace("type = \"rough_mirror\"\nroughness = 0.3", "type = \"lambert\"").replace("reflect = 0.1", "");
        let path = picture("type = \"path\"\nmax_depth = 1", &body, 1500);
        let whitted = picture("type = \"whitted\"\nmax_depth = 0", &body, 400);
        assert_agree(what, &path, &whitted);
    }
}

/// Mirrors and glass before a matte body with interpolated normals: as many bounces, the last one matte.
#[test]
fn path_and_whitted_agree_behind_glass_and_on_interpolated_normals() {
    let body = "[background]\ncolor = 0\n[lights.bulb]\ntype = \"point\"\nposition = [1, 1.5, 0.7]\nintensity = 4
        [materials.lamp]\ntype = \"emitter\"\nradiance = 3\nsamples = 1\n[objects.lamp]\ntype = \"sphere\"\ncenter = [-1.2, 1.6, 0]\nradius = 0.3\nmaterial = \"lamp\"
        [materials.glass]\ntype = \"dielectric\"\nabsorption = [0.1, 1, 2]\n[objects.pane]\ntype = \"box\"\nmin = [-9, -9, 1]\nmax = [9, 9, 1.2]\nmaterial = \"glass\"
        [materials.white]\ntype = \"lambert\"\nreflectance = 0.8\n[objects.gem]\ntype = \"mesh\"\nnormals = \"smooth\"\nmaterial = \"white\"
        vertices = [[0.9, 0.8, 0], [-0.9, 0.8, 0], [0, 1.6, 0], [0, 0, 0], [0, 0.8, 0.9], [0, 0.8, -0.9]]\nfaces = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5]\n";
    let path = picture("type = \"path\"\nmax_depth = 3", body, 2000);
    let whitted = picture("type = \"whitted\"\nmax_depth = 2\nmin_contribution = 0", body, 400);
    assert_agree("behind glass", &path, &whitted);

    // Where all is mirror, glass and lamp, the tree is the whole truth.
    let clear = "[background]\ntype = \"gradient\"\nstops = [[-1, 0.1], [0, 0.2], [1, [0.3, 0.5, 0.9]]]
        [materials.glass]\ntype = \"dielectric\"\nabsorption = [0.1, 0.5, 0.9]\n[objects.ball]\ntype = \"sphere\"\ncenter = [-0.3, 0.8, 0]\nradius = 0.8\nmaterial = \"glass\"
        [materials.silver]\ntype = \"mirror\"\nreflectance = [0.9, 0.8, 0.7]\n[objects.floor]\ntype = \"plane\"\nmaterial = \"silver\"
        [materials.lamp]\ntype = \"emitter\"\nradiance = 2\n[objects.lamp]\ntype = \"disk\"\ncenter = [1, 1, -1]\nnormal = [-0.3, 0, 1]\nradius = 0.6\nmaterial = \"lamp\"\n";
    let path = picture("type = \"path\"", clear, 8000);
    let whitted = picture("type = \"whitted\"\nmax_depth = 60\nmin_contribution = 1e-5", clear, 2000);
    assert_agree("mirrors and glass", &path, &whitted);
}

#[test]
fn roulette_takes_nothing_and_gives_nothing() {
    let body = format!("{ROOM}{}", CASES[0].1);
    let never = picture("type = \"path\"\nmax_depth = 30\nroulette_depth = 1000", &body, 500);
    let always = picture("type = \"path\"\nmax_depth = 30\nroulette_depth = 0", &body, 1500);
    assert_agree("roulette", &never, &always);
}

#[test]
fn depth_counts_the_bounces_between_lamp_and_eye() {
    // In a closed white sphere with a lamp at its centre each bounce adds the same; the last camera ray counts as one.
    let scene = |depth: u32| {
        format!(
            "[integrator]\ntype = \"path\"\nmax_depth = {depth}\n[materials.half]\ntype = \"lambert\"\nreflectance = 0.5\n\
             [objects.room]\ntype = \"sphere\"\nradius = 2\nmaterial = \"half\"\n[lights.bulb]\ntype = \"point\"\nunit = \"W/sr\"\nintensity = {}\n",
            4.0 * std::f64::consts::PI
        )
    };
    for (depth, truth) in [(0, 0.0), (1, 0.5), (2, 0.75), (3, 0.875)] {
        assert_near(grey(&scene(depth), [0.0, 0.0, 1.0], [0.0, 0.7, 0.0], 16), truth, 2e-4);
    }
}

#[test]
fn ambient_lights_are_ignored_aloud() {
    let scene = "[integrator]\ntype = \"path\"\n[lights.a]\ntype = \"ambient\"\n[objects.o]\ntype = \"sphere\"\n\
                 [cameras.eye]\ntype = \"perspective\"\n";
    let p = prepared(scene);
    assert!(p.warnings.iter().any(|w| w.code == "no-ambient"), "{:?}", p.warnings);
    assert!(prepared(&scene.replace("path", "whitted")).warnings.is_empty());
}
