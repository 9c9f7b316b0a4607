//! The project's chores: `cargo xtask help` lists them.

mod bench;
mod both;
mod dist;
mod fuzz;
mod gallery;
mod leaks;
mod long;
mod mutants;
mod povray;
mod sanitize;
mod sh;
mod test;
mod tidy;

use std::process::ExitCode;

/// One chore.
struct Chore {
    name: &'static str,
    doc: &'static str,
    run: fn(&[String]) -> sh::Outcome,
}

/// Every chore.
const CHORES: &[Chore] = &[
    Chore { name: "test", doc: "everything that must hold: tidy, wasm check, all tests", run: test::run },
    Chore { name: "tidy", doc: "floors, manual heads, lists, words, sizes of files", run: tidy::run },
    Chore { name: "gallery", doc: "render every lecture scene into docs/gallery [NAME...]", run: gallery::run },
    Chore { name: "bless", doc: "accept new snapshots and reference hashes", run: test::bless },
    Chore { name: "povray", doc: "six scenes beside POV-Ray, picture against picture", run: povray::run },
    Chore {
        name: "bench",
        doc: "renders against POV-Ray and Mitsuba [renders] [--quick] [--json FILE]; `bench kernel`: rays against Embree; `bench converge`: time to an error",
        run: bench::run,
    },
    Chore { name: "fuzz", doc: "run every fuzz target [SECONDS each, 600]", run: fuzz::run },
    Chore { name: "mutants", doc: "mutation-test optics and the integrators [COUNT, 100]", run: mutants::run },
    Chore { name: "sanitize", doc: "unsafe code under Miri and AddressSanitizer", run: sanitize::run },
    Chore { name: "leaks", doc: "rays out of closed meshes, hits lost by a structure [COUNT, 10^8]", run: leaks::run },
    Chore { name: "bias", doc: "the bias of adaptive sampling on rare light [SEEDS, 1000]", run: long::bias },
    Chore { name: "hostile", doc: "random scenes: no number that is none [SCENES, 10000]", run: long::hostile },
    Chore { name: "dist", doc: "a stripped binary archive for people without a toolchain", run: dist::run },
    Chore { name: "docs", doc: "write the manual and the schema cut from the tables", run: dist::docs },
];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let Some(chore) = args.first().and_then(|a| CHORES.iter().find(|c| c.name == a)) else {
        println!("cargo xtask CHORE\n");
        for c in CHORES {
            println!("  {:9} {}", c.name, c.doc);
        }
        return if args.first().is_none_or(|a| a == "help") { ExitCode::SUCCESS } else { ExitCode::from(2) };
    };
    match (chore.run)(&args[1..]) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask {}: {why}", chore.name);
            ExitCode::FAILURE
        }
    }
}
