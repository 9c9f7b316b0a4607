//! `photon` against `path`, against closed forms, and against itself in pieces.

use crate::support::{ROOM, pixels, prepared};
use kirkas_geometry::DVec3;
use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_optics::Lanes;
use kirkas_render::Film;
use kirkas_render::lights::emit::BoundingSphere;
use kirkas_render::render::Undisturbed;
use std::f64::consts::PI;
use std::ops::Range;

/// A camera that looks at the floor of a room from above.
fn scene(integrator: &str, body: &str) -> String {
    format!(
        "[integrator]\n{integrator}\n[film]\nwidth = 24\nheight = 18\nfilter = \"box\"\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0.1, 1.6, 1.9]\nlook_at = [0, 0.5, 0]\nfov = 60\n{body}"
    )
}

const PHOTON: &str = "type = \"photon\"\nphotons = 20000\nradius = 0.12";

fn expose(toml: &str, samples: Range<u32>, flock: usize) -> Film {
    let p = prepared(toml);
    let mut film = Film::new(p.film.clone());
    p.renderer(flock).render(&mut film, samples, &Undisturbed);
    assert_eq!(film.invalid_samples(), 0);
    film
}

/// The mean over the picture, red, green and blue together.
fn mean(film: &Film) -> f64 {
    let all = pixels(film);
    all.iter().map(|p| p.iter().sum::<f64>()).sum::<f64>() / (3 * all.len()) as f64
}

/// Scenes that both integrators can do: what they hold, and how far the means of the pictures may be from each other.
const CASES: [(&str, &str, f64); 5] = [
    ("matte", "", 0.01),
    (
        "mirrors, plastic and brushed metal",
        "[materials.silver]\ntype = \"mirror\"\nreflectance = 0.9\n[objects.ball]\ntype = \"sphere\"\ncenter = [-0.7, 0.6, 0]\nradius = 0.6\nmaterial = \"silver\"
         [materials.metal]\ntype = \"rough_mirror\"\nroughness = 0.4\n[objects.other]\ntype = \"sphere\"\ncenter = [0.8, 0.5, 0.2]\nradius = 0.5\nmaterial = \"metal\"
         [materials.plastic]\ntype = \"phong\"\ndiffuse = 0.5\nspecular = 0.3\nexponent = 20\nreflect = 0.1\n[objects.third]\ntype = \"sphere\"\ncenter = [0, 0.3, 0.8]\nradius = 0.3\nmaterial = \"plastic\"\n",
        0.01,
    ),
    (
        "glass that absorbs",
        "[materials.glass]\ntype = \"dielectric\"\nabsorption = [0.1, 0.4, 0.2]\n[objects.ball]\ntype = \"sphere\"\ncenter = [-0.2, 0.6, 0.1]\nradius = 0.6\nmaterial = \"glass\"\n",
        0.01,
    ),
    (
        "interpolated normals",
        "[objects.gem]\ntype = \"mesh\"\nnormals = \"smooth\"\nmaterial = \"wall\"\nvertices = [[0.9, 0.8, 0], [-0.9, 0.8, 0], [0, 1.6, 0], [0, 0, 0], [0, 0.8, 0.9], [0, 0.8, -0.9]]\nfaces = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5]\n",
        0.01,
    ),
    (
        "a lamp that is covered by a body, and water on the floor",
        "[materials.water]\ntype = \"dielectric\"\nior = 1.33\nabsorption = [0.3, 0.1, 0.05]\n[objects.pool]\ntype = \"box\"\nmin = [-2.5, -0.5, -2.5]\nmax = [2.5, 0.4, 2.5]\nmaterial = \"water\"
         [objects.lantern]\ntype = \"sphere\"\ncenter = [0, 1, -1.2]\nradius = 0.3\nmaterial = \"lamp\"\n",
        0.01,
    ),
];

#[test]
fn photon_and_path_agree_within_a_hundredth() {
    for (what, body, tolerance) in CASES {
        let body = format!("{ROOM}{body}");
        let path = mean(&expose(&scene("type = \"path\"", &body), 0..1024, 64));
        let photon = mean(&expose(&scene(PHOTON, &body), 0..64, 64));
        println!("{what}: path {path:.5}, photon {photon:.5}, {:+.2} %", 100.0 * (photon / path - 1.0));
        assert!((photon / path - 1.0).abs() < tolerance, "{what}: path {path}, photon {photon}");
    }
}

/// Lanes part in both halves of a path: on the way from the lamp and on the way from the camera.
#[test]
fn photon_and_path_agree_where_lanes_part() {
    let body = format!(
        "{ROOM}[materials.flint]\ntype = \"dielectric\"\nior = {{ material = \"N-SF11\" }}\n[objects.ball]\ntype = \"sphere\"\ncenter = [-0.2, 0.9, 0.1]\nradius = 0.6\nmaterial = \"flint\"\n"
    );
    for color in ["rgb", "spectral"] {
        let with = |integrator: &str| {
            scene(integrator, &body).replace("filter = \"box\"", &format!("filter = \"box\"\ncolor = \"{color}\""))
        };
        let path = mean(&expose(&with("type = \"path\""), 0..2048, 64));
        let photon = mean(&expose(&with(PHOTON), 0..192, 64));
        println!("{color}: path {path:.5}, photon {photon:.5}, {:+.2} %", 100.0 * (photon / path - 1.0));
        assert!((photon / path - 1.0).abs() < 0.01, "{color}: path {path}, photon {photon}");
    }
}

#[test]
fn bounces_count_as_they_do_for_path() {
    for depth in [1, 2, 3] {
        let path = mean(&expose(&scene(&format!("type = \"path\"\nmax_depth = {depth}"), ROOM), 0..512, 64));
        let photon = mean(&expose(&scene(&format!("{PHOTON}\nmax_depth = {depth}"), ROOM), 0..32, 64));
        println!("{depth}: path {path:.5}, photon {photon:.5}");
        assert!((photon / path - 1.0).abs() < 0.01, "{depth}: path {path}, photon {photon}");
    }
}

#[test]
fn rays_that_leave_a_light_carry_its_power() {
    let toml = "[materials.lamp]\ntype = \"emitter\"\nradiance = [3, 2, 1]\n[materials.both]\ntype = \"emitter\"\ntwo_sided = true\nunit = \"W\"\nintensity = 4\n\
         [textures.squares]\ntype = \"checker\"\nscale = 0.25\na = 0.1\n[materials.glow]\ntype = \"emitter\"\nradiance = \"squares\"\n\
         [lights.point]\ntype = \"point\"\nposition = [0, 1, 0]\n[lights.spot]\ntype = \"spot\"\nhotspot = 25\nfalloff_angle = 60\n\
         [lights.sun]\ntype = \"directional\"\ndirection = [1, -2, 0]\n\
         [objects.disk]\ntype = \"disk\"\nnormal = [1, 2, 0]\nmaterial = \"lamp\"\n[objects.ball]\ntype = \"sphere\"\ncenter = [3, 0, 0]\nmaterial = \"lamp\"\n\
         [objects.pane]\ntype = \"rectangle\"\nedge_u = [1, 0, 0]\nedge_v = [0, 2, 0]\nmaterial = \"glow\"\n\
         [objects.model]\ntype = \"group\"\ntemplate = true\n[objects.leaf]\ntype = \"mesh\"\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 1]]\nfaces = [0, 1, 2, 0, 2, 3]\nmaterial = \"both\"\nparent = \"model\"\n\
         [objects.copy]\ntype = \"instance\"\nof = \"model\"\ntransform = [{ scale = 1.5 }, { rotate = [0, 1, 0, -50] }]\n\
         [background]\ntype = \"gradient\"\nstops = [[-1, 0.1], [0, 0.2], [1, [0.3, 0.5, 0.9]]]\n\
         [cameras.eye]\ntype = \"perspective\"\n";
    let scene = prepared(toml).scene;
    let bounds = BoundingSphere { center: DVec3::new(0.5, 0.0, 0.0), radius: 4.0 };
    assert_eq!(scene.lights.len(), 8);
    for light in &scene.lights {
        let truth = light.lamp.power(&scene.materials, &scene.textures, bounds.radius);
        let (n, mut sum) = (1 << 14, 0.0);
        for i in 0..n {
            let (place, way) = (owen_sobol_2d(i, 1), owen_sobol_2d(i, 2));
            let things = (&scene.materials[..], &scene.textures);
            let Some(e) = light.lamp.emit(&Lanes::RGB, things, &bounds, 0.0, (place, way)) else { continue };
            sum += e.power.sum();
            if light.lamp.is_far() {
                let from = e.ray.origin.as_dvec3() - bounds.center;
                let nearest = from.cross(e.ray.direction.as_dvec3()).length();
                assert!(nearest <= bounds.radius * 1.0001 && from.length() >= 0.999 * bounds.radius);
            }
        }
        let mean = sum / f64::from(n);
        println!("{}: {mean:.4} W of {truth:.4}", light.name);
        assert!((mean / truth - 1.0).abs() < 0.01, "{}: {mean} of {truth}", light.name);
    }
}

/// A mirror throws all that a lamp sends onto a white floor, which sees nothing else of it.
#[test]
fn a_mirror_passes_on_the_whole_power() {
    let spot = "[lights.l]\ntype = \"spot\"\nunit = \"W\"\nposition = [0, 1, 0]\ndirection = [0, 1, 0]\nhotspot = 10\nfalloff_angle = 20\n";
    let sun = "[lights.l]\ntype = \"directional\"\nunit = \"W/m2\"\nintensity = 0.25\ndirection = [1, 0, 0]\n";
    // Above a spot, level; in the sun, tilted, 2 x 2 as the sun sees it.
    for (lamp, edges) in
        [(spot, "edge_u = [4, 0, 0]\nedge_v = [0, 0, 4]"), (sun, "edge_u = [2, -2, 0]\nedge_v = [0, 0, 2]")]
    {
        let body = format!(
            "[integrator]\ntype = \"photon\"\nphotons = 20000\nradius = 0.2\nmax_depth = 2\n\
             [materials.silver]\ntype = \"mirror\"\nreflectance = 1\n[materials.white]\ntype = \"lambert\"\nreflectance = 1\n\
             [objects.mirror]\ntype = \"rectangle\"\ncenter = [0, 2, 0]\n{edges}\nmaterial = \"silver\"\nvisible = false\n\
             [objects.floor]\ntype = \"rectangle\"\nedge_u = [0, 0, 12]\nedge_v = [12, 0, 0]\nmaterial = \"white\"\n{lamp}\
             [film]\nwidth = 12\nheight = 12\nfilter = \"box\"\n[cameras.eye]\ntype = \"orthographic\"\nposition = [0, 5, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\nheight = 12\n"
        );
        // Radiance is irradiance over pi; the picture is 144 square units.
        let power = mean(&expose(&body, 0..32, 64)) * PI * 144.0;
        println!("{power:.4} W of 1");
        assert!((power - 1.0).abs() < 0.02, "{power} of 1: {lamp}");
    }
}

#[test]
fn any_threads_flock_split_and_stop_give_the_same_bits() {
    let body = format!(
        "{ROOM}{}[objects.slider]\ntype = \"sphere\"\ncenter = [1, 0.3, 0.5]\nradius = 0.3\nmaterial = \"wall\"\nmotion = [{{ time = 0, transform = [{{ translate = [0, 0, 0] }}] }}, {{ time = 1, transform = [{{ translate = [0.3, 0, 0] }}] }}]\n",
        CASES[2].1
    );
    let toml = scene("type = \"photon\"\nphotons = 5000\nradius = 0.2", &body)
        .replace("fov = 60", "fov = 60\nshutter = [0, 1]");
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let one = pool(1).install(|| expose(&toml, 0..5, 64));
    let four = pool(4).install(|| expose(&toml, 0..5, 7));
    assert!(one == four, "threads and flocks show");

    // Split by samples, then stopped and gone on with.
    let p = prepared(&toml);
    let (mut film, mut rest) = (Film::new(p.film.clone()), Film::new(p.film.clone()));
    p.renderer(64).render(&mut film, 0..2, &Undisturbed);
    p.renderer(64).render(&mut rest, 2..5, &Undisturbed);
    for (a, (b, whole)) in film.tiles.iter().zip(rest.tiles.iter().zip(&one.tiles)) {
        for (i, sum) in whole.sums.iter().enumerate() {
            assert_eq!(std::array::from_fn::<i128, 3, _>(|c| a.sums[i][c] + b.sums[i][c]), *sum);
        }
    }
    p.renderer(3).render(&mut film, 0..5, &Undisturbed);
    assert!(film == one, "a render that was stopped shows");

    // A pixel replayed.
    let alone = p.renderer(1).replay(9, 7, 0..5, &mut ());
    let (_, _, tile, i) = one.pixels().find(|p| (p.0, p.1) == (9, 7)).unwrap();
    assert_eq!(alone.sums[0], tile.sums[i]);
    assert_ne!(alone.sums[0], [0; 3]);
}

#[test]
fn light_groups_get_what_their_lamps_send() {
    let body = format!(
        "{ROOM}[lights.bulb]\ntype = \"point\"\nposition = [1, 2, 1]\nintensity = 0.3\n[materials.glass]\ntype = \"dielectric\"\n\
         [objects.ball]\ntype = \"sphere\"\ncenter = [-0.2, 0.6, 0.1]\nradius = 0.6\nmaterial = \"glass\"\n"
    );
    let whole = scene(PHOTON, &body).replace("filter = \"box\"", "filter = \"box\"\nlight_groups = true");
    let layers = expose(&whole, 0..2, 64);
    let beauty = expose(&scene(PHOTON, &body), 0..2, 64);
    let planes = layers.layout.planes();
    let number = |name: &str| layers.layout.groups.iter().position(|g| g == name).unwrap();
    let mut sums = vec![0_i128; planes];
    for (a, b) in layers.tiles.iter().zip(&beauty.tiles) {
        for (i, sum) in b.sums.iter().enumerate() {
            // Rounded group by group there, and all together here: a few units of 2^-64 apart.
            let total: i128 = (0..planes).map(|g| a.sums[i * planes + g][1]).sum();
            assert!((total - sum[1]).abs() <= 8, "{total} {}", sum[1]);
            (0..planes).for_each(|g| sums[g] += a.sums[i * planes + g][1]);
        }
    }
    assert!(sums[number("bulb")] > 0 && sums[number("lamp")] > 0, "{sums:?}");
}
