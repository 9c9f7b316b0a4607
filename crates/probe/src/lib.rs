//! One small picture with every effect, as one number: whatever machine computes it, the number is the same.
//!
//! The tests compare it with a stored one, and with what the same code gives as WebAssembly. To try another machine, run
//! its tests there.

use kirkas_formats::{FormatAssets, load};
use kirkas_render::film::AovSet;
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

const FILES: [(&str, &[u8]); 3] = [
    ("everything.toml", include_bytes!("../../render/tests/it/scenes/everything.toml")),
    ("gem.obj", include_bytes!("../../render/tests/it/scenes/gem.obj")),
    ("leaf.png", include_bytes!("../../render/tests/it/scenes/leaf.png")),
];

/// Enough to use every dimension twice, and quick in an interpreter.
const SAMPLES: u32 = 2;

/// The picture: all its integers.
///
/// # Panics
///
/// If the scene does not compile, which its tests would tell.
pub fn film() -> Film {
    let files = MemoryFiles(FILES.map(|(name, bytes)| (name.to_string(), bytes.to_vec())).into());
    let access = FileAccess::new(Box::new(files), Limits::default());
    let description = load(&access, "everything.toml").expect("a sound scene");
    let assets = FormatAssets::new(&access, &description.sources);
    let options = Options { aovs: AovSet(0xff), ..Options::default() };
    let prepared = prepare(&description, &assets, &options).expect("a scene that compiles");
    let mut film = Film::new(prepared.film.clone());
    prepared.renderer(16).render(&mut film, 0..SAMPLES, &Undisturbed);
    film
}

/// All integers of [`film`] as one (FNV-1a over their bytes, lowest first).
pub fn film_hash() -> u64 {
    let mut h = Fnv(0xcbf2_9ce4_8422_2325);
    let film = film();
    for tile in &film.tiles {
        tile.sums.iter().chain(&tile.squares).flatten().for_each(|v| h.add(&v.to_le_bytes()));
        tile.counts.iter().for_each(|c| h.add_numbers(&[c.taken, c.invalid]));
        let Some(aovs) = &tile.aovs else { continue };
        aovs.values.iter().flatten().for_each(|v| h.add(&v.to_le_bytes()));
        h.add_numbers(&aovs.hits);
        aovs.ids.iter().for_each(|i| h.add_numbers(&[i.sample, i.object, i.material]));
    }
    h.0
}

struct Fnv(u64);

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3));
    }
    fn add_numbers(&mut self, numbers: &[u32]) {
        numbers.iter().for_each(|n| self.add(&n.to_le_bytes()));
    }
}

/// [`film_hash`] for hosts of WebAssembly.
// SAFETY: no other symbol of this name exists in the module.
#[unsafe(no_mangle)]
pub extern "C" fn kirkas_film_hash() -> u64 {
    film_hash()
}
