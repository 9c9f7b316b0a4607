//! Any bytes as a mesh.
#![no_main]

use kirkas_formats::ply;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    if let Ok(mesh) = ply::read(data, "t.ply") {
        mesh.validate().expect("a mesh that was read is sound");
    }
});
