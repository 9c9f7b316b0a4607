//! Every file in `tests/damaged` gives at least one clear error. What a fuzzer finds goes there.

use kirkas_formats::load;
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use std::path::Path;

#[test]
fn every_damaged_file_gives_a_clear_error() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/damaged");
    let mut names: Vec<_> =
        std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert!(names.len() >= 19);
    for name in names {
        let content = std::fs::read(folder.join(&name)).unwrap();
        let files = FileAccess::new(Box::new(MemoryFiles([(name.clone(), content)].into())), Limits::default());
        let failure = load(&files, &name).expect_err(&name);
        let shown = crate::show::failure(&failure);
        assert!(failure.diagnostics.iter().any(|d| d.is_error()), "{name}");
        assert!(failure.diagnostics.iter().all(|d| d.message.len() < 400 && d.help.is_some()), "{name}: {shown:.2000}");
    }
}
