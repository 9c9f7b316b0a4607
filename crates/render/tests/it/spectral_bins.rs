//! Spectral bins: they hold the same light as the colours, to the bit however the work is cut.

use crate::support::{assert_agree, expose, pixel, prepared, prepared_with};
use kirkas_images::{ExrCompression, read_exr, write_exr};
use kirkas_optics::spectrum::observer::observer;
use kirkas_render::film::SpectralBins;
use kirkas_render::film::image::Depth;
use kirkas_render::film::part::{read_part, write_part};
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

/// Coloured lamps of all kinds, a prism's glass, fog, and light groups.
fn scene(bins: u32, samples: u32) -> String {
    format!(
        "[film]\nwidth = 12\nheight = 9\ncolor = \"spectral\"\nspectral_bins = {bins}\nlight_groups = true\n\
         [sampler]\nsamples = {samples}\n[integrator]\ntype = \"path\"\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = [0, 1, 5]\nlook_at = [0, 0, 0]\n[background]\ncolor = [0.1, 0.2, 0.4]\n\
         [lights.lamp]\ntype = \"point\"\nposition = [2, 4, 3]\nintensity = 20\ncolor = {{ blackbody = 2700 }}\n\
         [lights.tube]\ntype = \"point\"\nposition = [-2, 4, 3]\nintensity = 20\ncolor = {{ illuminant = \"F2\" }}\n\
         [materials.floor]\ntype = \"lambert\"\nreflectance = [0.2, 0.7, 0.3]\n\
         [materials.glass]\ntype = \"dielectric\"\nior = {{ material = \"N-SF11\" }}\nabsorption = [0.1, 0.2, 0.9]\n\
         [materials.hull]\ntype = \"hull\"\ninterior = \"fog\"\n[media.fog]\ntype = \"homogeneous\"\nscattering = [0.2, 0.3, 0.5]\n\
         [objects.floor]\ntype = \"rectangle\"\nmaterial = \"floor\"\ncenter = [0, -1, 0]\nedge_u = [9, 0, 0]\nedge_v = [0, 0, -9]\n\
         [objects.ball]\ntype = \"sphere\"\nmaterial = \"glass\"\n\
         [objects.fog]\ntype = \"sphere\"\nmaterial = \"hull\"\ncenter = [1.8, 0, 0]\nradius = 0.7\n"
    )
}

/// The colour that the observer sees in the bins of a pixel.
fn color_of_bins(film: &Film, x: u32, y: u32) -> [f64; 3] {
    const STEPS: u32 = 64;
    let bins = film.layout.bins.expect("bins");
    let (_, _, tile, i) = film.pixels().find(|p| (p.0, p.1) == (x, y)).expect("a pixel of the film");
    let mut sum = [0.0; 3];
    for bin in 0..bins.count {
        let radiance = f64::from(tile.bin_mean(i, bin as usize));
        for k in 0..STEPS {
            let nm = bins.center(bin) + bins.width() * ((f64::from(k) + 0.5) / f64::from(STEPS) - 0.5);
            let bars = observer().film(nm as f32).map(f64::from);
            (0..3).for_each(|c| sum[c] += radiance * bars[c] * bins.width() / f64::from(STEPS));
        }
    }
    sum
}

/// The root mean square of what the bins' colours miss, over that of the colours.
fn miss(bins: u32) -> f64 {
    let p = prepared(&scene(bins, 64));
    let film = expose(&p, 0..64).0;
    let (mut missed, mut all) = (0.0, 0.0);
    for (x, y, ..) in film.pixels() {
        let (seen, truth) = (color_of_bins(&film, x, y), pixel(&film, x, y));
        for c in 0..3 {
            missed += (seen[c] - truth[c]).powi(2);
            all += truth[c] * truth[c];
        }
    }
    (missed / all).sqrt()
}

#[test]
fn what_the_observer_sees_in_the_bins_is_the_picture() {
    let misses = [10, 40, 400].map(miss);
    println!("rms {misses:?} of the picture");
    assert!(misses[0] < 0.3 && misses[1] < 0.05 && misses[2] < 0.003, "{misses:?}");
    assert!(misses[0] > 2.0 * misses[1] && misses[1] > 4.0 * misses[2], "{misses:?}");
}

#[test]
fn the_bins_of_light_that_has_equal_energy_are_flat() {
    let toml = "[film]\nwidth = 8\nheight = 8\ncolor = \"spectral\"\nspectral_bins = 16\n[sampler]\nsamples = 256\n\
                [cameras.eye]\ntype = \"perspective\"\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nfov = 10\n\
                [materials.m]\ntype = \"emitter\"\nradiance = { spectrum = \"even.spd\" }\nintensity = 2\n\
                [objects.card]\ntype = \"rectangle\"\nmaterial = \"m\"\nedge_u = [4, 0, 0]\nedge_v = [0, 4, 0]\n";
    let p = prepared_with(toml, &[("even.spd", b"370 1\n790 1\n")], &Options::default());
    let film = expose(&p, 0..p.samples).0;
    let means: Vec<f64> = (0..16)
        .map(|bin| film.spectral_bin(bin).iter().map(|v| f64::from(*v)).sum::<f64>() / film.layout.crop.area() as f64)
        .collect();
    // Its luminance is 2, and the integral of y-bar is 106.857 nm.
    for (bin, mean) in means.iter().enumerate() {
        assert!((mean * 106.857 / 2.0 - 1.0).abs() < 1e-2, "bin {bin}: {mean}, all {means:?}");
    }
}

#[test]
fn bins_have_the_same_bits_for_all_threads_parts_and_resumes() {
    for integrator in ["path", "path_simple", "photon"] {
        let p = prepared(&scene(30, 24).replace("\"path\"", &format!("\"{integrator}\"")));
        let with = |threads: usize, flock: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut film = Film::new(p.film.clone());
            pool.install(|| p.renderer(flock).render(&mut film, 0..24, &Undisturbed));
            film
        };
        let whole = with(1, 64);
        assert!(whole.tiles.iter().flat_map(|t| &t.bins).any(|b| *b != 0));
        assert!(with(2, 7) == whole && with(3, 1) == whole, "{integrator}");
        let mailed = |film: &Film| {
            let mut image = film.to_image(Depth::Half);
            write_part(film, &mut image);
            let bytes = write_exr(&image, ExrCompression::Zip).expect("an image");
            read_part(&read_exr(&bytes).expect("it was just written")).expect("a part")
        };
        let (mut first, second) = (mailed(&expose(&p, 0..9).0), expose(&p, 9..24).0);
        let mut merged = mailed(&second);
        merged.merge(&first).expect("they fit");
        assert!(merged == whole, "{integrator}: merged");
        p.renderer(64).render(&mut first, 0..24, &Undisturbed);
        assert!(first == whole, "{integrator}: resumed");
    }
}

#[test]
fn the_picture_with_bins_is_the_picture_without_but_for_noise() {
    let film = |bins| {
        let toml = scene(bins, 256).replace("samples = 256\n", "samples = 256\ntype = \"independent\"\n");
        expose(&prepared(&toml), 0..256).0
    };
    assert_agree("bins", &film(40), &film(0));
}

/// Fichet, Pacanowski & Wilkie (2021): `S0.` for radiance, the wavelength with a decimal comma, attributes for version and units.
#[test]
fn layers_stand_beside_the_colours_as_the_layout_says() {
    let p = prepared(&scene(4, 1).replace("spectral_bins = 4", "spectral_bins = 4\nspectral_range = [589, 590]"));
    let film = expose(&p, 0..1).0;
    let bytes = write_exr(&film.to_image(Depth::Half), ExrCompression::Zip).expect("an image");
    let image = read_exr(&bytes).expect("it was just written");
    let spectral: Vec<&str> = image.channels.iter().map(|c| c.name.as_str()).filter(|n| n.starts_with('S')).collect();
    assert_eq!(spectral, ["S0.589,1250nm", "S0.589,3750nm", "S0.589,6250nm", "S0.589,8750nm"]);
    assert_eq!(image.text("spectralLayoutVersion"), Some("1.0"));
    assert_eq!(image.text("emissiveUnits"), Some("W.m^-2.sr^-1"));
    assert!(image.rgb().is_some(), "the usual reader still finds a picture");
}

#[test]
fn films_with_other_bins_are_no_parts_of_each_other() {
    let film = |bins| Film::new(prepared(&scene(bins, 1)).film);
    let told = film(10).merge(&film(20)).expect_err("they differ").to_string();
    assert!(told.contains("spectral bins"), "{told}");
    let mut image = film(10).to_image(Depth::Float);
    write_part(&film(10), &mut image);
    for text in ["0", "400:380..780", "x"] {
        image.attributes.insert("kirkas.spectral_bins".into(), kirkas_images::Attribute::Text(text.into()));
        assert!(read_part(&image).is_err(), "{text}");
    }
}

#[test]
fn bins_that_cannot_be_are_refused_with_a_cure() {
    let told = |toml: &str| {
        let mut all = MemoryFiles::default();
        all.0.insert("scene.toml".into(), toml.as_bytes().to_vec());
        let access = FileAccess::new(Box::new(all), Limits::default());
        let description = kirkas_formats::load(&access, "scene.toml").unwrap_or_else(|e| panic!("{e:?}"));
        let assets = kirkas_formats::FormatAssets::new(&access, &description.sources);
        let errors = prepare(&description, &assets, &Options::default()).err().expect("it is wrong");
        errors
            .iter()
            .map(|e| format!("{} {}", e.code, e.help.as_deref().unwrap_or_default()))
            .collect::<Vec<_>>()
            .join("; ")
    };
    let film = |rows: &str| format!("[film]\n{rows}\n[cameras.eye]\ntype = \"perspective\"\n");
    for (rows, part) in [
        ("spectral_bins = 40", "--color spectral"),
        ("color = \"spectral\"\nspectral_bins = 40\nspectral_range = [500, 400]", "lower wavelength first"),
        ("color = \"spectral\"\nspectral_bins = 401", "out-of-range"),
        ("color = \"spectral\"\nspectral_bins = 400\nwidth = 8192\nheight = 8192", "--crop"),
    ] {
        let errors = told(&film(rows));
        assert!(errors.contains(part), "{part}: {errors}");
    }
    assert_eq!(SpectralBins::new(40, [400.0, 300.0]), None);
}
