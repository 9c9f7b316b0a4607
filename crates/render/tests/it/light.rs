//! `light` against `path`, pixel by pixel, and against itself in pieces.

use crate::support::{ROOM, assert_agree, expose, noisy, pixel, prepared, prepared_with};
use kirkas_formats::{FormatAssets, load};
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, prepare};
use kirkas_scene::Diagnostic;
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_testkit::{Measured, z_test};

const EYE: &str = "type = \"perspective\"\nposition = [0.1, 1.6, 1.9]\nlook_at = [0, 0.5, 0]\nfov = 60\n";
const LIGHT: &str = "type = \"light\"\nparticles = 10000\n";

fn scene(integrator: &str, camera: &str, body: &str) -> String {
    format!(
        "[integrator]\n{integrator}\n[sampler]\ntype = \"independent\"\n[film]\nwidth = 20\nheight = 14\nfilter = \"box\"\n[cameras.eye]\n{camera}\n{body}"
    )
}

fn take(toml: &str, samples: u32) -> Film {
    expose(&prepared(toml), 0..samples).0
}

/// Both show the same in every pixel, but for their noise.
#[track_caller]
fn check(what: &str, camera: &str, body: &str) {
    let path = take(&scene("type = \"path\"", camera, body), 256);
    let light = take(&scene(LIGHT, camera, body), 64);
    assert_agree(what, &path, &light);
}

/// The same for scenes where few samples carry much light: pixels do not know their noise, but blocks of them do.
#[track_caller]
fn check_blocks(what: &str, camera: &str, body: &str) {
    let path = take(&scene("type = \"path\"", camera, body), 512);
    let light = take(&scene(LIGHT, camera, body), 96);
    assert_blocks_agree(what, &path, &light);
}

#[track_caller]
fn assert_blocks_agree(what: &str, a: &Film, b: &Film) {
    let ((mean_a, variance_a), (mean_b, variance_b)) = (blocks(a), blocks(b));
    let of = |mean, variance| Measured { mean, variance };
    let found = z_test(of(&mean_a, &variance_a), of(&mean_b, &variance_b), 1e-4, 1e-4);
    let (sum_a, sum_b) = (mean_a.iter().sum::<f64>(), mean_b.iter().sum::<f64>());
    println!("{what}: {:+.2} % all together, least p {:.1e}", 100.0 * (sum_b / sum_a - 1.0), found.p_value);
    assert!(found.passed, "{what}: {found:?}, {} and {}", mean_a[found.worst], mean_b[found.worst]);
}

/// Means over blocks of 5 x 7 pixels, channel by channel, and their variances.
fn blocks(film: &Film) -> (Vec<f64>, Vec<f64>) {
    let (mean, variance) = noisy(film);
    let (width, height) = film.layout.size;
    let count = (width / 5) * (height / 7) * 3;
    let (mut means, mut variances) = (vec![0.0; count as usize], vec![0.0; count as usize]);
    for (i, (_, _, tile, pixel)) in film.pixels().enumerate() {
        let (x, y) = tile.place(pixel);
        for c in 0..3 {
            let block = (((y / 7) * (width / 5) + x / 5) * 3 + c) as usize;
            means[block] += mean[3 * i + c as usize] / 35.0;
            variances[block] += variance[3 * i + c as usize] / 35.0 / 35.0;
        }
    }
    (means, variances)
}

fn ball(name: &str, center: &str, radius: f32, material: &str) -> String {
    format!(
        "[objects.{name}]\ntype = \"sphere\"\ncenter = {center}\nradius = {radius}\nmaterial = \"{name}\"\n[materials.{name}]\n{material}\n"
    )
}

#[test]
fn light_and_path_agree_in_a_matte_room() {
    check("matte", EYE, ROOM);
}

#[test]
fn light_and_path_agree_where_surfaces_are_rough() {
    let body = [
        ROOM,
        &ball("metal", "[0.8, 0.5, 0.2]", 0.5, "type = \"rough_mirror\"\nroughness = 0.4"),
        &ball(
            "gold",
            "[-0.3, 0.4, 0.7]",
            0.4,
            "type = \"rough_conductor\"\nior = { material = \"gold\" }\nroughness = 0.5",
        ),
        &ball("frosted", "[-0.9, 0.6, 0]", 0.6, "type = \"rough_dielectric\"\nroughness = 0.5"),
        &ball("plastic", "[0, 0.3, 1]", 0.3, "type = \"phong\"\ndiffuse = 0.5\nspecular = 0.3\nexponent = 20"),
    ]
    .concat();
    check("rough", EYE, &body);
}

#[test]
fn light_and_path_agree_under_a_textured_lamp_that_shines_both_ways() {
    let body = format!(
        "{ROOM}[textures.squares]\ntype = \"checker\"\nscale = 0.25\na = 0.1\nb = [0.9, 0.5, 0.2]\n[materials.glow]\ntype = \"emitter\"\nradiance = \"squares\"\nintensity = 5\ntwo_sided = true\n\
         [objects.pane]\ntype = \"rectangle\"\ncenter = [0.3, 0.8, -0.8]\nedge_u = [1.2, 0, 0]\nedge_v = [0, 0.6, 0.2]\nmaterial = \"glow\"\n"
    );
    check("textured lamp", EYE, &body);
}

#[test]
fn light_and_path_agree_on_interpolated_normals() {
    // A ball of 2 x 8 x 8 triangles.
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for i in 0..=8_u32 {
        let (y, r) =
            ((f64::from(i) * std::f64::consts::PI / 8.0).cos(), (f64::from(i) * std::f64::consts::PI / 8.0).sin());
        for k in 0..8_u32 {
            let a = f64::from(k) * std::f64::consts::PI / 4.0;
            vertices.push(format!("[{:.5}, {:.5}, {:.5}]", 0.7 * r * a.cos(), 0.8 + 0.7 * y, 0.7 * r * a.sin()));
            if i < 8 {
                let at = |i: u32, k: u32| i * 8 + k % 8;
                let (a, b, c, d) = (at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
                faces.push(format!("{a}, {b}, {c}, {a}, {c}, {d}"));
            }
        }
    }
    let mesh = format!(
        "type = \"mesh\"\nnormals = \"smooth\"\nvertices = [{}]\nfaces = [{}]\n",
        vertices.join(", "),
        faces.join(", ")
    );
    for material in ["type = \"lambert\"\nreflectance = 0.8", "type = \"rough_mirror\"\nroughness = 0.5"] {
        let body = format!("{ROOM}[materials.skin]\n{material}\n[objects.ball]\n{mesh}material = \"skin\"\n");
        check(material, EYE, &body);
    }
}

#[test]
fn light_and_path_agree_through_a_lens() {
    let round = "type = \"thin_lens\"\nposition = [0.1, 1.6, 1.9]\nlook_at = [0, 0.5, 0]\nfov = 60\naperture_radius = 0.2\nfocus_distance = 1.1\n";
    let body = format!("{ROOM}{}", ball("grey", "[0.3, 0.9, 0.8]", 0.3, "type = \"lambert\"\nreflectance = 0.4"));
    check("a round lens", round, &body);
    check("five blades", &format!("{round}blades = 5\nblade_rotation = 20\n"), &body);
}

#[test]
fn light_and_path_agree_on_cameras_of_every_shape() {
    for (what, camera) in [
        ("orthographic", "type = \"orthographic\"\nposition = [0.5, 2.5, 1.5]\nlook_at = [0, 0.5, 0]\nheight = 1.5\n".to_string()),
        ("wide", EYE.replace("60", "120\nfov_axis = \"horizontal\"")),
        ("scaled unevenly", format!("{EYE}transform = [{{ scale = [0.7, 0.9, 0.8] }}]\n")),
        ("scaled unevenly and parallel", "type = \"orthographic\"\nposition = [0.5, 2.5, 1.5]\nlook_at = [0, 0.5, 0]\nheight = 1.5\ntransform = [{ scale = [0.7, 0.9, 0.8] }]\n".into()),
    ] {
        check(what, &camera, &format!("{OPEN}{SUNNY}"));
    }
}

#[test]
fn light_and_path_agree_through_every_filter() {
    for filter in ["gaussian", "tent", "mitchell", "blackman_harris"] {
        let with = |integrator: &str| {
            scene(integrator, EYE, ROOM)
                .replace("filter = \"box\"", &format!("filter = \"{filter}\"\nshift = [-0.5, 0.25]"))
        };
        assert_agree(filter, &take(&with("type = \"path\""), 256), &take(&with(LIGHT), 32));
    }
}

#[test]
fn light_and_path_agree_on_a_caustic_below_glass() {
    // A wide lamp, so that `path` finds it through the glass.
    let glass = "type = \"dielectric\"\nabsorption = [0.1, 0.4, 0.2]";
    let block = format!(
        "{ROOM}[materials.glass]\n{glass}\n[objects.block]\ntype = \"box\"\nmin = [-0.9, 0.3, -0.6]\nmax = [0, 0.8, 0.5]\nmaterial = \"glass\"\n"
    );
    check("a block", EYE, &block);
    check_blocks("a ball", EYE, &format!("{ROOM}{}", ball("glass", "[-0.2, 0.7, 0.1]", 0.6, glass)));
}

#[test]
fn light_and_path_agree_on_what_mirrors_and_glass_show() {
    let body = [
        ROOM,
        &ball("silver", "[-0.8, 0.6, 0]", 0.6, "type = \"mirror\"\nreflectance = 0.9"),
        &ball("coated", "[0.7, 0.4, 0.6]", 0.4, "type = \"phong\"\ndiffuse = 0.4\nspecular = 0.2\nexponent = 9\nreflect = 0.3"),
        "[materials.water]\ntype = \"dielectric\"\nior = 1.33\nabsorption = [0.3, 0.1, 0.05]\n[objects.pool]\ntype = \"box\"\nmin = [-2.5, -0.5, -2.5]\nmax = [2.5, 0.2, 2.5]\nmaterial = \"water\"\n",
    ]
    .concat();
    check_blocks("mirrors and a pool", EYE, &body);
}

#[test]
fn light_and_path_agree_with_the_camera_in_water_and_bodies_that_overlap() {
    let body = format!(
        "{ROOM}[materials.water]\ntype = \"dielectric\"\nior = 1.33\nabsorption = [0.3, 0.1, 0.05]\npriority = 2\n[objects.pool]\ntype = \"box\"\nmin = [-2.5, -0.5, -2.5]\nmax = [2.5, 2.5, 2.5]\nmaterial = \"water\"\n\
         [materials.oil]\ntype = \"dielectric\"\nior = 1.5\npriority = 1\n[objects.drop]\ntype = \"sphere\"\ncenter = [0, 0.5, 0.5]\nradius = 0.5\nmaterial = \"oil\"\n\
         [objects.lantern]\ntype = \"sphere\"\ncenter = [0, 1, -1.2]\nradius = 0.3\nmaterial = \"lamp\"\n"
    );
    check_blocks("under water", EYE, &body);
}

/// A floor and a ball, in the open.
const OPEN: &str = "
[materials.white]
type = \"lambert\"
reflectance = 0.8
[objects.floor]
type = \"rectangle\"
edge_u = [0, 0, 3]
edge_v = [3, 0, 0]
material = \"white\"
[objects.ball]
type = \"sphere\"
center = [0, 0.5, 0]
radius = 0.5
material = \"white\"
";

/// A lamp for it, and a sky.
const SUNNY: &str = "
[lights.sun]
type = \"directional\"
direction = [1, -2, -0.5]
[background]
color = [0.3, 0.4, 0.6]
";

#[test]
fn light_and_path_agree_under_lamps_of_every_kind() {
    for (what, lamps) in [
        (
            "sun and sky",
            "[lights.sun]\ntype = \"directional\"\ndirection = [1, -2, -0.5]\n[background]\ntype = \"gradient\"\nstops = [[-1, 0.1], [0, 0.2], [1, [0.3, 0.5, 0.9]]]\n",
        ),
        (
            "point and spot",
            "[lights.bulb]\ntype = \"point\"\nposition = [1, 1.5, 0.5]\n[lights.spot]\ntype = \"spot\"\nposition = [-1, 2, 1]\ndirection = [1, -2, -1]\nattenuation = [0, 1, 0]\n",
        ),
        (
            "a far lamp that is not seen",
            "[materials.lamp]\ntype = \"emitter\"\nunit = \"W\"\nintensity = 40\n[objects.lamp]\ntype = \"sphere\"\ncenter = [1, 2, 1]\nradius = 0.3\nmaterial = \"lamp\"\nvisible = false\n",
        ),
    ] {
        check_blocks(what, EYE, &format!("{OPEN}{lamps}"));
    }
}

#[test]
fn light_and_path_agree_where_things_move_and_stand_in_copies() {
    let body = format!(
        "{OPEN}[lights.bulb]\ntype = \"point\"\nposition = [1, 1.5, 0.5]\n[background]\ncolor = 0.3\n\
         [objects.model]\ntype = \"group\"\ntemplate = true\n[objects.leaf]\ntype = \"rectangle\"\nedge_u = [0.5, 0, 0]\nedge_v = [0, 0.5, 0]\nmaterial = \"white\"\nparent = \"model\"\n\
         [objects.glowing]\ntype = \"disk\"\ncenter = [0.6, 0.2, 0]\nradius = 0.2\nnormal = [0, 1, 1]\nmaterial = \"glow\"\nparent = \"model\"\n[materials.glow]\ntype = \"emitter\"\nradiance = 3\n\
         [objects.copy]\ntype = \"instance\"\nof = \"model\"\ntransform = [{{ scale = 1.5 }}, {{ rotate = [0, 1, 0, -50] }}, {{ translate = [-0.8, 0.4, 0.5] }}]\nmotion = [{{ time = 0, transform = [{{ translate = [0, 0, 0] }}] }}, {{ time = 1, transform = [{{ translate = [0.6, 0, 0.2] }}] }}]\n\
         [objects.hidden]\ntype = \"sphere\"\ncenter = [0.9, 0.3, 0.5]\nradius = 0.3\nmaterial = \"white\"\nvisible = false\n"
    );
    let camera = format!(
        "{EYE}shutter = [0, 1]\nmotion = [{{ time = 0, transform = [{{ translate = [0, 0, 0] }}] }}, {{ time = 1, transform = [{{ translate = [0.1, 0.05, 0] }}] }}]\n"
    );
    check_blocks("moving copies", &camera, &body);
}

#[test]
fn light_and_path_agree_where_opacity_is_partial() {
    let body = format!(
        "{OPEN}[lights.bulb]\ntype = \"point\"\nposition = [1, 1.5, 0.5]\n[materials.lace]\ntype = \"lambert\"\nreflectance = 0.6\nalpha = 0.5\n\
         [objects.veil]\ntype = \"rectangle\"\ncenter = [0.1, 1, 0.9]\nedge_u = [0.8, 0, 0]\nedge_v = [0, 0.7, -0.3]\nmaterial = \"lace\"\n"
    );
    check("a veil", EYE, &body);
}

#[test]
fn light_and_path_agree_in_fog_and_mist() {
    let mist = "[materials.hull]\ntype = \"hull\"\ninterior = \"mist\"\n[objects.cloud]\ntype = \"sphere\"\ncenter = [-0.5, 0.8, 0.3]\nradius = 0.7\nmaterial = \"hull\"\n\
         [media.mist]\ntype = \"homogeneous\"\nscattering = [3, 2, 1]\nabsorption = 0.2\nphase = \"lobe\"\n[phases.lobe]\ntype = \"henyey_greenstein\"\ng = 0.6\n";
    check("mist", EYE, &format!("{ROOM}{mist}"));
    check_blocks("mist before the sky", EYE, &format!("{OPEN}{mist}[background]\ncolor = 0.7\n"));
    let fog = "[background]\nmedium = \"fog\"\n[media.fog]\ntype = \"homogeneous\"\nscattering = 0.3\n[media.puff]\ntype = \"cloud\"\n";
    check_blocks("fog everywhere", EYE, &format!("{ROOM}{fog}"));
    let puff = "[background]\ncolor = 0.5\nmedium = \"puff\"\n[media.puff]\ntype = \"cloud\"\nscattering = 4\ntransform = [{ translate = [-0.5, 0.6, -0.2] }]\n[lights.bulb]\ntype = \"point\"\nposition = [1, 1.5, 0.5]\n";
    check_blocks("a cloud in the open", EYE, &format!("{OPEN}{puff}"));
}

#[test]
fn light_and_path_agree_in_both_colour_modes_where_lanes_part() {
    let body = format!(
        "{ROOM}{}",
        ball("flint", "[-0.2, 0.9, 0.1]", 0.6, "type = \"dielectric\"\nior = { material = \"N-SF11\" }")
    );
    for color in ["rgb", "spectral"] {
        let with = |integrator: &str| {
            scene(integrator, EYE, &body).replace("filter = \"box\"", &format!("filter = \"box\"\ncolor = \"{color}\""))
        };
        assert_blocks_agree(color, &take(&with("type = \"path\""), 1024), &take(&with(LIGHT), 128));
    }
}

#[test]
fn bounces_count_as_they_do_for_path() {
    for depth in [1, 2, 3] {
        let with = |name: &str| scene(&format!("{name}\nmax_depth = {depth}"), EYE, ROOM);
        assert_agree(&format!("{depth} bounces"), &take(&with("type = \"path\""), 128), &take(&with(LIGHT), 32));
    }
}

#[test]
fn any_threads_flock_split_and_stop_give_the_same_bits() {
    let body = format!(
        "{ROOM}{}[objects.slider]\ntype = \"sphere\"\ncenter = [1, 0.3, 0.5]\nradius = 0.3\nmaterial = \"wall\"\nmotion = [{{ time = 0, transform = [{{ translate = [0, 0, 0] }}] }}, {{ time = 1, transform = [{{ translate = [0.3, 0, 0] }}] }}]\n",
        ball("flint", "[-0.2, 0.9, 0.1]", 0.6, "type = \"dielectric\"\nior = { material = \"N-SF11\" }")
    );
    for color in ["rgb", "spectral"] {
        let toml = scene("type = \"light\"\nparticles = 9000", &format!("{EYE}shutter = [0, 1]"), &body)
            .replace("filter = \"box\"", &format!("filter = \"mitchell\"\ncolor = \"{color}\"\nlight_groups = true"));
        let p = prepared(&toml);
        let expose = |samples, flock| {
            let mut film = Film::new(p.film.clone());
            p.renderer(flock).render(&mut film, samples, &Undisturbed);
            film
        };
        let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let one = pool(1).install(|| expose(0..5, 64));
        let four = pool(4).install(|| expose(0..5, 7));
        assert!(one == four, "threads and flocks show");

        // Split by samples, then stopped and gone on with; and a part of the picture.
        let mut film = expose(0..2, 64);
        let mut both = film.clone();
        both.merge(&expose(2..5, 64)).unwrap();
        assert!(both.tiles.iter().zip(&one.tiles).all(|(a, b)| a.sums == b.sums), "splits show");
        p.renderer(3).render(&mut film, 0..5, &Undisturbed);
        assert!(film == one, "a render that was stopped shows");
        let crop = Some(kirkas_render::film::Rect { x0: 3, y0: 2, x1: 11, y1: 9 });
        let part = expose_part(&toml, crop);
        for (x, y, tile, i) in part.pixels() {
            let whole = pixel(&one, x, y);
            assert_eq!(tile.counts[i].taken, 5);
            assert_eq!(pixel(&part, x, y), whole);
        }

        // A pixel replayed.
        let alone = p.renderer(1).replay(9, 7, 0..5, &mut ());
        let (_, _, tile, i) = one.pixels().find(|p| (p.0, p.1) == (9, 7)).unwrap();
        let planes = one.layout.planes();
        assert_eq!(alone.sums[..], tile.sums[i * planes..][..planes]);
        assert!(alone.sums.iter().any(|s| *s != [0; 3]));
    }
}

fn expose_part(toml: &str, crop: Option<kirkas_render::film::Rect>) -> Film {
    expose(&prepared_with(toml, &[], &Options { crop, ..Options::default() }), 0..5).0
}

#[test]
fn light_says_what_it_does_not_show() {
    let warned = |body: &str| -> Vec<String> {
        prepared(&scene(LIGHT, EYE, body)).warnings.iter().map(|d| d.code.to_string()).collect()
    };
    let endless = "[objects.ground]\ntype = \"plane\"\nmaterial = \"white\"\n";
    assert_eq!(warned(&format!("{OPEN}{endless}[background]\ncolor = 1\n")), ["endless-shape"]);
    assert!(warned(&format!("{OPEN}{endless}[lights.bulb]\ntype = \"point\"\n")).is_empty());
    let glow = "[background]\nmedium = \"gas\"\n[media.gas]\ntype = \"homogeneous\"\nemission = 1\n";
    assert_eq!(warned(&format!("{OPEN}{glow}")), ["glowing-medium"]);
}

#[test]
fn light_refuses_spectral_bins() {
    let bins = "filter = \"box\"\ncolor = \"spectral\"\nspectral_bins = 8";
    let toml = scene(LIGHT, EYE, ROOM).replace("filter = \"box\"", bins);
    let refused = refusal(&toml);
    assert_eq!(refused.len(), 1);
    assert_eq!(refused[0].code, "no-bins");
    assert!(refused[0].message.contains("`light` keeps no spectral bins"), "{}", refused[0].message);
}

fn refusal(toml: &str) -> Vec<Diagnostic> {
    let mut all = MemoryFiles::default();
    all.0.insert("scene.toml".into(), toml.as_bytes().to_vec());
    let access = FileAccess::new(Box::new(all), Limits::default());
    let description = load(&access, "scene.toml").expect("the text is right");
    let assets = FormatAssets::new(&access, &description.sources);
    prepare(&description, &assets, &Options::default()).err().expect("it is refused")
}
