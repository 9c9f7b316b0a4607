//! Values of every model at 1000 pairs of directions, against formulas written apart from this code in double precision:
//! `tests/reference/NAME.py` writes `NAME.txt`.

use crate::models::{build, cases, set};
use kirkas_geometry::Vec3;
use kirkas_optics::{LobeSet, Mode, SPECS};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/");
const PAIRS: usize = 1000;
const RELATIVE: f64 = 1e-4;
/// Values below this (1/sr) are as good as none.
const FLOOR: f64 = 1e-7;

fn rows(text: &str) -> impl Iterator<Item = Vec<f64>> + '_ {
    let numbers = |line: &str| line.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    text.lines().filter(|line| !line.starts_with('#')).map(numbers)
}

fn pairs() -> Vec<(Vec3, Vec3)> {
    let text = std::fs::read_to_string(format!("{FOLDER}pairs.txt")).expect("pairs.txt");
    let vector = |x: &[f64]| Vec3::new(x[0] as f32, x[1] as f32, x[2] as f32);
    rows(&text).map(|row| (vector(&row[..3]), vector(&row[3..]))).collect()
}

/// A model that is more than mirrors and panes, and so has values.
fn has_values(name: &str) -> bool {
    let scatters = |c: &crate::models::Case| c.bsdf.lobes() & LobeSet::NON_DELTA != LobeSet::NONE;
    cases().iter().any(|c| c.model.spec().name == name && scatters(c))
}

#[test]
fn every_model_meets_its_reference_at_a_thousand_pairs_of_directions() {
    let pairs = pairs();
    assert_eq!(pairs.len(), PAIRS);
    for spec in SPECS.iter().filter(|s| has_values(s.name)) {
        let file = format!("{FOLDER}{}.txt", spec.name);
        let text = std::fs::read_to_string(&file).unwrap_or_else(|_| {
            panic!("`{0}` has no reference: write tests/reference/{0}.py and run make.py {0}", spec.name)
        });
        let sets: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("# set ")).collect();
        assert!(!sets.is_empty() && rows(&text).count() == PAIRS, "{file}");
        for (column, line) in sets.into_iter().enumerate() {
            let (params, outside) = set(line);
            let case = build(spec.name, &params, outside);
            let mut worst = (0.0, 0);
            let mut lit = 0;
            for (i, (row, &(wo, wi))) in rows(&text).zip(&pairs).enumerate() {
                let f = f64::from(case.bsdf.eval(wo, wi, LobeSet::ALL, Mode::Radiance)[i % 3]);
                let off = (f - row[column]).abs() / row[column].max(FLOOR / RELATIVE);
                lit += usize::from(row[column] > FLOOR);
                worst = if off > worst.0 || off.is_nan() { (off, i) } else { worst };
            }
            println!("{}: {line}: {:.1e} at {} of {lit} lit pairs", spec.name, worst.0, worst.1);
            let (wo, wi) = pairs[worst.1];
            assert!(
                worst.0 <= RELATIVE,
                "{}: {line}: off by {:.1e} at {wo} {wi} (line {})",
                spec.name,
                worst.0,
                worst.1
            );
            assert!(lit > PAIRS / 10, "{}: {line}: only {lit} pairs are lit", spec.name);
        }
    }
}

/// The tables are what their scripts say, where there is a Python with NumPy (`KIRKAS_PYTHON`, else `python3`).
#[test]
fn the_references_are_what_their_scripts_write() {
    let python = std::env::var("KIRKAS_PYTHON").unwrap_or_else(|_| "python3".into());
    let run = |arguments: &[&str]| std::process::Command::new(&python).arg("-B").args(arguments).output();
    if !run(&["-c", "import numpy"]).is_ok_and(|o| o.status.success()) {
        println!("skipped: no `{python}` with NumPy");
        return;
    }
    let made = run(&[&format!("{FOLDER}make.py"), "--check"]).unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
}
