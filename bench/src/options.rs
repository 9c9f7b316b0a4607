//! What is measured: the command line of `kernel`.

use kirkas_accel::AccelKind;
use kirkas_accel::ray_sets::{DEFAULT_SIDE, RaySet};
use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
The ray kernel beside Embree 3: identical rays, one process, one thread.

  --scene NAME[,NAME]   sphere-N (N triangles: 1000, 20k, 1m...), stadium, bunny, coffee, staircase2
                        [sphere-1m,sphere-5m,stadium,bunny,coffee,staircase2]
  --set NAME[,NAME]     primary, ao, diff1, diff2, diff2any, random [all]
  --accel NAME[,NAME]   structures [the default, bvh8 and bvh8_best, those there are; all for builds]
  --quick               3 passes of 65,536 rays over fewer scenes, one build each
  --passes N            passes to take the median of [7]
  --side N              rays on a side of a set, a power of two [512]
  --only rays|builds    one half of the work
  --sizes 1e3..1e7      how time grows: spheres of these sizes instead of the scenes
  --isa NAME            what Embree may use: sse2, avx, avx2, avx512 [all the machine has]
  --no-embree           leave Embree's columns empty
  --json FILE           write the rows; those of the builds to FILE with the ending .builds.json
";

/// What to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// Names of scenes.
    pub scenes: Vec<String>,
    /// The sets of rays.
    pub sets: Vec<(RaySet, &'static str)>,
    /// The structures that are traced.
    pub accels: Vec<AccelKind>,
    /// The structures of which the build is timed.
    pub built: Vec<AccelKind>,
    /// Passes to take the median of.
    pub passes: usize,
    /// Builds to take the median of.
    pub build_passes: usize,
    /// Rays on a side of a set.
    pub side: u32,
    /// Measure rays.
    pub rays: bool,
    /// Measure builds.
    pub builds: bool,
    /// Numbers of triangles, for the growth; empty to measure the scenes.
    pub sizes: Vec<usize>,
    /// Instruction set for Embree, as it names them.
    pub isa: Option<String>,
    /// Load Embree.
    pub embree: bool,
    /// Where the rows go.
    pub json: Option<PathBuf>,
}

impl Default for Options {
    fn default() -> Self {
        let scenes = ["sphere-1m", "sphere-5m", "stadium", "bunny", "coffee", "staircase2"];
        let mut accels = vec![AccelKind::default()];
        for kind in ["bvh8", "bvh8_best"].into_iter().filter_map(AccelKind::parse) {
            if !accels.contains(&kind) {
                accels.push(kind);
            }
        }
        let all = AccelKind::ALL.map(|(kind, _)| kind);
        Options {
            scenes: scenes.map(str::to_string).to_vec(),
            sets: RaySet::ALL.to_vec(),
            accels,
            built: all.into_iter().filter(|kind| *kind != AccelKind::BruteForce).collect(),
            passes: 7,
            build_passes: 3,
            side: DEFAULT_SIDE,
            rays: true,
            builds: true,
            sizes: Vec::new(),
            isa: None,
            embree: true,
            json: None,
        }
    }
}

impl Options {
    /// Read the command line, without the program's name.
    pub fn parse(args: &[String]) -> Result<Options, String> {
        let mut o = Options::default();
        if args.iter().any(|a| a == "--quick") {
            o.scenes = ["sphere-1m", "stadium", "coffee"].map(str::to_string).to_vec();
            (o.passes, o.build_passes, o.side) = (3, 1, 256);
        }
        let mut args = args.iter();
        while let Some(arg) = args.next() {
            let mut value = || args.next().ok_or(format!("`{arg}` needs a value"));
            match arg.as_str() {
                "--quick" => {}
                "--scene" => o.scenes = value()?.split(',').map(str::to_string).collect(),
                "--set" => o.sets = value()?.split(',').map(set).collect::<Result<_, _>>()?,
                "--accel" => {
                    o.accels = value()?.split(',').map(accel).collect::<Result<_, _>>()?;
                    o.built.clone_from(&o.accels);
                }
                "--passes" => o.passes = number(value()?)?,
                "--side" => o.side = number(value()?)? as u32,
                "--only" => {
                    let what = value()?;
                    (o.rays, o.builds) = (what == "rays", what == "builds");
                    if o.rays == o.builds {
                        return Err(format!("`--only {what}`: rays or builds"));
                    }
                }
                "--sizes" => o.sizes = sizes(value()?)?,
                "--isa" => o.isa = Some(value()?.clone()),
                "--no-embree" => o.embree = false,
                "--json" => o.json = Some(value()?.into()),
                _ => return Err(format!("what is `{arg}`? `--help` lists the options")),
            }
        }
        if !o.side.is_power_of_two() || o.side > 4096 {
            return Err("`--side`: a power of two, at most 4096".into());
        }
        Ok(o)
    }
}

fn set(name: &str) -> Result<(RaySet, &'static str), String> {
    let known = || RaySet::ALL.map(|(_, n)| n).join(", ");
    RaySet::ALL.into_iter().find(|(_, n)| *n == name).ok_or_else(|| format!("no set `{name}`: {}", known()))
}

fn accel(name: &str) -> Result<AccelKind, String> {
    AccelKind::parse(name).ok_or_else(|| format!("no structure `{name}`: {}", AccelKind::NAMES.join(", ")))
}

fn number(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|n| *n > 0).ok_or_else(|| format!("`{text}` is not a number above 0"))
}

/// `1e3..1e6`: the powers of ten from the first to the last.
fn sizes(text: &str) -> Result<Vec<usize>, String> {
    let bad = || format!("`--sizes {text}`: two numbers, like 1e3..1e7");
    let (first, last) = text.split_once("..").ok_or_else(bad)?;
    let read = |t: &str| t.parse::<f64>().ok().filter(|n| (8.0..=1e9).contains(n)).ok_or_else(bad);
    let (first, last) = (read(first)?, read(last)?);
    Ok(std::iter::successors(Some(first), |n| Some(n * 10.0)).take_while(|n| *n <= last).map(|n| n as usize).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Options, String> {
        Options::parse(&line.split(' ').map(str::to_string).collect::<Vec<_>>())
    }

    #[test]
    fn what_is_said_wins_over_quick() {
        let o = parse("--side 64 --quick --set ao,random").expect("sound");
        assert_eq!((o.side, o.passes, o.sets[1].1), (64, 3, "random"));
        assert_eq!(parse("--sizes 1e3..1e5").expect("sound").sizes, [1000, 10_000, 100_000]);
    }

    #[test]
    fn mistakes_are_named() {
        for (line, word) in [("--fast", "--fast"), ("--set x", "`x`"), ("--side 3", "power"), ("--json", "--json")] {
            assert!(parse(line).expect_err("an error").contains(word), "{line}");
        }
    }
}
