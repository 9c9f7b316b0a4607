//! Any bytes as a native scene; what is read must be written and read back equal. A first line is tried as an override.
#![no_main]

use kirkas_formats::toml::{apply_override, read, write};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use libfuzzer_sys::fuzz_target;

fn files(text: &[u8]) -> FileAccess {
    let other = b"include = 's.toml'\n[film]\nwidth = 2\n[objects.a]\ntype = 'sphere'".to_vec();
    let files = MemoryFiles([("s.toml".to_string(), text.to_vec()), ("b.toml".to_string(), other)].into());
    FileAccess::new(Box::new(files), Limits { include_depth: 4, ..Limits::default() })
}

fuzz_target!(|data: &[u8]| {
    match read(&files(data), "s.toml") {
        Ok(mut scene) => {
            let again = read(&files(write(&scene).as_bytes()), "s.toml").expect("what was written is read");
            // Debug texts, because nan differs from itself.
            assert_eq!(format!("{:?}", again.without_spans()), format!("{:?}", scene.clone().without_spans()));
            if let Some(line) = data.split(|&b| b == b'\n').next().and_then(|l| std::str::from_utf8(l).ok()) {
                let _ = apply_override(&mut scene, line.trim_start_matches('#'));
            }
        }
        Err(failure) => {
            assert!(!failure.diagnostics.is_empty());
            for (span, _) in failure.diagnostics.iter().flat_map(|d| &d.labels) {
                let text = &failure.sources.get(span.source).expect("a known source").text;
                assert!(text.get(span.start as usize..span.end as usize).is_some(), "a span outside its text");
            }
        }
    }
});
