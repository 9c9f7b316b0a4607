//! Any bytes as a scene of MIT 6.837.
#![no_main]

use kirkas_formats::{mit6837, toml};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mesh = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec();
    let files = MemoryFiles([("s.txt".to_string(), data.to_vec()), ("t.obj".to_string(), mesh)].into());
    let files = FileAccess::new(Box::new(files), Limits::default());
    if let Ok(scene) = mit6837::read(&files, "s.txt") {
        let files = MemoryFiles([("s.toml".to_string(), toml::write(&scene).into_bytes())].into());
        let files = FileAccess::new(Box::new(files), Limits::default());
        assert!(toml::read(&files, "s.toml").is_ok(), "what was read can be converted");
    }
});
