//! Any bytes as a mesh; after a line `===` comes its material library.
#![no_main]

use kirkas_formats::obj;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let cut = data.windows(5).position(|w| w == b"\n===\n");
    let (mesh, library) = cut.map_or((data, &b""[..]), |at| (&data[..at], &data[at + 5..]));
    if let Ok(mesh) = obj::read(mesh, "t.obj", &mut |_| Ok(library.into())) {
        mesh.validate().expect("a mesh that was read is sound");
    }
});
