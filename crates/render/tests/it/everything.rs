//! The same bits: one scene with every effect at once, rendered in different ways. (That it has the same bits on other
//! machines too is the business of the crate `probe`.)

use crate::support::{expose, pixels, prepared_with};
use kirkas_images::{ExrCompression, read_exr, write_exr};
use kirkas_render::film::image::Depth;
use kirkas_render::film::part::{read_part, write_part};
use kirkas_render::film::{AovSet, filter};
use kirkas_render::render::{Control, Undisturbed};
use kirkas_render::{Film, Options, Prepared, Rect, catalog};
use kirkas_scene::Kind;

const SCENE: &str = include_str!("scenes/everything.toml");
/// Media, for integrators that know them.
const MEDIA: &str = include_str!("scenes/media.toml");
/// More reflectance models.
const MATTER: &str = include_str!("scenes/matter.toml");
const FILES: [(&str, &[u8]); 3] = [
    ("gem.obj", include_bytes!("scenes/gem.obj")),
    ("leaf.png", include_bytes!("scenes/leaf.png")),
    ("puff.vol", include_bytes!("scenes/puff.vol")),
];

/// A part that covers four tiles' corner, for tests of many samples.
const CORNER: Rect = Rect { x0: 14, y0: 24, x1: 34, y1: 34 };

fn all_aovs() -> AovSet {
    AovSet(u16::MAX >> 8)
}

fn compiled(toml: &str, crop: Option<Rect>) -> Prepared {
    prepared_with(toml, &FILES, &Options { crop, aovs: all_aovs(), frame: None })
}

/// The scene with other words in it.
fn variant(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(SCENE.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// What else a render may be made of.
fn variants() -> [String; 4] {
    let plain = [
        ("shadows = \"transparent\"", "shadows = \"opaque\"\nshade_back = false"),
        ("[sampler]", "[sampler]\ntype = \"independent\""),
        ("filter = \"mitchell\"\nlight_groups = true", "filter = \"gaussian\""),
    ];
    let traced = |integrator: &str, sampler: &str| {
        variant(&[
            (
                "type = \"whitted\"\nmax_depth = 6\nmin_contribution = 0.004",
                &format!("type = \"{integrator}\"\nmax_depth = 20"),
            ),
            ("shadows = \"transparent\"\nglossy_samples = 2\n", ""),
            ("[sampler]", &format!("[sampler]\ntype = \"{sampler}\"")),
            ("light_groups = true", "light_groups = true\ncolor = \"spectral\""),
        ]) + MEDIA
            + MATTER
    };
    [SCENE.to_string(), variant(&plain), traced("path", "halton"), traced("path_simple", "stratified")]
}

fn with_threads<T: Send>(n: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("a pool").install(work)
}

fn taken_at(p: &Prepared, threads: usize, flock: usize, samples: u32) -> Film {
    let mut film = Film::new(p.film.clone());
    with_threads(threads, || p.renderer(flock).render(&mut film, 0..samples, &Undisturbed));
    film
}

#[test]
fn every_sampler_gives_the_same_bits_in_any_order_of_work() {
    for spec in catalog().of_kind(Kind::Sampler) {
        let p = compiled(&variant(&[("[sampler]", &format!("[sampler]\ntype = \"{}\"", spec.name))]), Some(CORNER));
        assert!(taken_at(&p, 1, 64, 4) == taken_at(&p, 3, 7, 4), "{}", spec.name);
    }
}

#[test]
fn everything_that_is_listed_is_in_the_scene() {
    let words: Vec<String> = variants().iter().map(|v| v.replace(' ', "")).collect();
    let is_there = |what: &str| words.iter().any(|w| w.contains(what));
    for spec in catalog().types {
        let by_kind = matches!(
            spec.kind,
            Kind::Material | Kind::Light | Kind::Texture | Kind::Object | Kind::Medium | Kind::Phase
        );
        let missing_on_purpose = ["measured"].contains(&spec.name);
        assert!(!by_kind || missing_on_purpose || is_there(&format!("type=\"{}\"", spec.name)), "no {}", spec.name);
    }
    assert!(filter::FILTERS.iter().any(|f| is_there(&format!("filter=\"{f}\""))));
}

#[test]
fn every_kind_of_ray_flies_and_every_lamp_shines() {
    let p = compiled(SCENE, None);
    let (film, s) = expose(&p, 0..4);
    let counts = [
        s.camera_rays,
        s.reflected_rays,
        s.refracted_rays,
        s.glossy_rays,
        s.shadow_rays,
        s.hits,
        s.lens_samples,
        s.time_samples,
    ];
    assert!(counts.iter().all(|&n| n > 1000), "{s:?}");
    assert_eq!(s.camera_rays, 4 * 40 * 36);
    for (plane, name) in film.layout.groups.iter().enumerate() {
        let lit = film.pixels().filter(|(_, _, t, i)| t.plane_mean(*i, plane)[1] > 0.0).count();
        assert!(lit > 40, "{name} lights {lit} pixels");
    }
}

#[test]
fn the_number_of_threads_and_the_size_of_flocks_change_no_bit() {
    for toml in variants() {
        let p = compiled(&toml, None);
        let one = taken_at(&p, 1, 1, 4);
        for (threads, flock) in [(1, 64), (2, 7), (7, 64), (7, 1)] {
            assert!(taken_at(&p, threads, flock, 4) == one, "{threads} threads, flocks of {flock}");
        }
    }
}

#[test]
fn crops_in_any_order_are_the_parts_of_the_whole() {
    let (whole, _) = expose(&compiled(SCENE, None), 0..2);
    let pieces = [(17, 20, 40, 36), (0, 20, 17, 36), (5, 0, 40, 20), (0, 0, 5, 20)];
    let mut seen = 0;
    for (x0, y0, x1, y1) in pieces {
        let p = compiled(SCENE, Some(Rect { x0, y0, x1, y1 }));
        let (piece, _) = expose(&p, 0..2);
        let planes = piece.layout.planes();
        for (x, y, tile, i) in piece.pixels() {
            let (_, _, t, j) = whole.pixels().find(|w| (w.0, w.1) == (x, y)).expect("inside");
            assert_eq!(tile.sums[i * planes..(i + 1) * planes], t.sums[j * planes..(j + 1) * planes]);
            assert_eq!((tile.squares[i], &tile.counts[i]), (t.squares[j], &t.counts[j]));
            let (a, b) = (tile.aovs.as_ref().expect("kept"), t.aovs.as_ref().expect("kept"));
            assert_eq!((a.values[i], a.hits[i], a.ids[i]), (b.values[j], b.hits[j], b.ids[j]));
            seen += 1;
        }
    }
    assert_eq!(seen, 40 * 36);
}

/// Through the file, as another machine would send it.
fn mailed(film: &Film) -> Film {
    let mut image = film.to_image(Depth::Half);
    write_part(film, &mut image);
    let bytes = write_exr(&image, ExrCompression::Zip).expect("an image");
    read_part(&read_exr(&bytes).expect("it was just written")).expect("a part")
}

#[test]
fn samples_in_parts_merged_in_any_order_are_the_samples_at_once() {
    let p = compiled(SCENE, Some(CORNER));
    let (whole, _) = expose(&p, 0..64);
    assert!(mailed(&whole) == whole, "the file keeps every bit");
    let (first, _) = expose(&p, 0..20);
    let (second, _) = expose(&p, 20..64);
    assert!(first != whole && first != second);
    let mut forward = mailed(&first);
    forward.merge(&mailed(&second)).expect("they fit");
    assert!(forward == whole, "0..20 + 20..64");
    let mut backward = second;
    backward.merge(&first).expect("they fit");
    assert!(backward == whole, "20..64 + 0..20");
}

#[test]
fn a_resumed_picture_is_the_picture_made_at_once() {
    let p = compiled(SCENE, Some(CORNER));
    let (whole, _) = expose(&p, 0..64);
    let mut film = Film::new(p.film.clone());
    p.renderer(64).render(&mut film, 0..20, &Undisturbed);
    let mut film = mailed(&film);
    let rest = p.renderer(7).render(&mut film, 0..64, &Undisturbed);
    assert_eq!(rest.samples, 44 * CORNER.area() as u64);
    assert!(film == whole);
    assert_eq!(p.renderer(7).render(&mut film, 0..64, &Undisturbed).samples, 0, "nothing is left to do");
    assert!(film == whole);
}

#[test]
fn a_picture_stopped_between_passes_goes_on_where_it_was() {
    struct Impatient;
    impl Control for Impatient {
        fn after_pass(&self, film: &Film) -> bool {
            film.tiles[0].counts[0].taken < 5
        }
    }
    let p = compiled(SCENE, Some(CORNER));
    let (whole, _) = expose(&p, 3..40);
    let mut film = Film::new(p.film.clone());
    p.renderer(64).render(&mut film, 3..40, &Impatient);
    assert!((5..37).contains(&film.tiles[0].counts[0].taken));
    p.renderer(64).render(&mut film, 3..40, &Undisturbed);
    assert!(film == whole);
}

/// One tile further than the other, as after a kill between checkpoints.
#[test]
fn tiles_that_have_come_further_wait_for_the_others() {
    struct Once(std::sync::atomic::AtomicBool);
    impl Control for Once {
        fn between(&self, _: &Film) -> bool {
            !self.0.swap(true, std::sync::atomic::Ordering::Relaxed)
        }
    }
    let p = compiled(SCENE, Some(Rect { x0: 0, y0: 24, x1: 40, y1: 30 }));
    let (whole, _) = expose(&p, 0..12);
    let mut film = Film::new(p.film.clone());
    let (ahead, _) = expose(&p, 0..5);
    film.tiles[1] = ahead.tiles[1].clone();
    p.renderer(64).render(&mut film, 0..12, &Undisturbed);
    assert!(film == whole);
    let mut film = Film::new(p.film.clone());
    p.renderer(64).render(&mut film, 0..12, &Once(false.into()));
    p.renderer(64).render(&mut film, 0..12, &Undisturbed);
    assert!(film == whole);
}

#[test]
fn every_accelerator_finds_what_brute_force_finds() {
    for toml in variants() {
        let by = |name: &str| {
            let toml = format!("{toml}\n[accelerator]\ntype = \"{name}\"\n");
            expose(&compiled(&toml, None), 0..3)
        };
        let (expected, by_force) = by("brute_force");
        let accelerators = catalog().types.into_iter().filter(|t| t.kind == Kind::Accelerator);
        for name in accelerators.map(|t| t.name).filter(|name| *name != "brute_force") {
            let (film, stats) = by(name);
            assert!(film == expected, "{name}");
            assert!(stats.search != by_force.search, "{name} ran the same search");
        }
    }
}

#[test]
fn another_seed_is_another_picture_of_the_same_scene() {
    let (a, _) = expose(&compiled(SCENE, Some(CORNER)), 0..16);
    let (b, _) = expose(&compiled(&variant(&[("seed = 7", "seed = 8")]), Some(CORNER)), 0..16);
    assert!(a != b);
    let mean = |f: &Film| pixels(f).iter().map(|p| p[1]).sum::<f64>();
    assert!((mean(&a) / mean(&b) - 1.0).abs() < 0.05, "{} {}", mean(&a), mean(&b));
}

/// Every intensity with its sign changed by `change`, light by light.
fn with_intensities(change: impl Fn(&str, f64) -> f64) -> String {
    let mut section = String::new();
    let mut out = String::new();
    for line in SCENE.lines() {
        if line.starts_with('[') && !line.starts_with("[[") {
            section = line.to_string();
        }
        match line.strip_prefix("intensity = ") {
            Some(number) => out += &format!("intensity = {:?}\n", change(&section, number.parse().expect("a number"))),
            None => out += &format!("{line}\n"),
        }
    }
    out
}

/// Powers of two scale without rounding, so only the film rounds: by half a unit for each contribution.
#[test]
fn twice_the_light_is_twice_the_picture() {
    let dark = |t: String| t.replace("stops = [[-1.0", "stops = [[-1.0, [0, 0, 0]], [1.0, [0, 0, 0]]] # [[-1.0");
    let (once, s) = expose(&compiled(&dark(SCENE.to_string()), None), 0..2);
    let (twice, t) = expose(&compiled(&dark(with_intensities(|_, x| 2.0 * x)), None), 0..2);
    assert_eq!(s, t, "the same rays");
    let mut light = 0;
    for (a, b) in once.tiles.iter().zip(&twice.tiles) {
        for (a, b) in a.sums.iter().flatten().zip(b.sums.iter().flatten()) {
            assert!((2 * a - b).abs() <= 2000, "{a} {b}");
            light += b;
        }
    }
    assert!(light > 0);
}

/// Lights do not know of each other: what one adds is the same whether the others are lit or not, bit for bit.
#[test]
fn the_picture_of_all_lights_is_the_sum_of_their_pictures() {
    let is_first = |section: &str| ["point", "sun", "panel", "ambient"].iter().any(|n| section.contains(n));
    let sky = "color = [0, 0, 0]";
    let dark = |t: String| t.replace("type = \"gradient\"\nstops", &format!("{sky}\n# stops"));
    let (all, _) = expose(&compiled(SCENE, None), 0..2);
    let first = with_intensities(|s, x| if is_first(s) { x } else { 0.0 });
    let (first, _) = expose(&compiled(&dark(first), None), 0..2);
    let (second, _) = expose(&compiled(&with_intensities(|s, x| if is_first(s) { 0.0 } else { x }), None), 0..2);
    assert!(pixels(&first) != pixels(&second));
    for ((a, b), c) in all.tiles.iter().zip(&first.tiles).zip(&second.tiles) {
        for ((a, b), c) in a.sums.iter().flatten().zip(b.sums.iter().flatten()).zip(c.sums.iter().flatten()) {
            assert_eq!(*a, b + c);
        }
    }
}

#[test]
fn light_groups_sum_to_the_picture_without_them() {
    let (grouped, _) = expose(&compiled(SCENE, None), 0..2);
    let (plain, _) = expose(&compiled(&variant(&[("light_groups = true", "")]), None), 0..2);
    let groups = ["background", "ambient", "point", "old", "spot", "sun", "panel", "dish", "bulb"];
    let mut kept = grouped.layout.groups.clone();
    kept.sort_unstable();
    let mut expected = groups.map(String::from).to_vec();
    expected.sort_unstable();
    assert_eq!(kept, expected);
    for (a, b) in grouped.tiles.iter().zip(&plain.tiles) {
        for (planes, sum) in a.sums.chunks(groups.len()).zip(&b.sums) {
            let total = planes.iter().fold([0; 3], |t: [i128; 3], p| [t[0] + p[0], t[1] + p[1], t[2] + p[2]]);
            assert_eq!(total, *sum);
        }
        assert_eq!((&a.squares, &a.counts, &a.aovs), (&b.squares, &b.counts, &b.aovs));
    }
}
