//! The command line: reads files and arguments, shows progress and problems, writes pictures.
//!
//! All knowledge of light, formats and pixels lives below; only this crate knows of terminals, clocks, signals and exit codes:
//! 0 done, 1 failed, 2 bad usage or bad input, 3 `diff` over `--max`.

mod commands;

mod aov_args;
mod aov_picture;
mod bench_table;
mod checkpoint;
mod conductor;
mod denoise;
mod disk_files;
mod frames;
mod header;
mod input;
mod job;
mod light_mix;
mod output;
mod parts;
mod pictures;
mod places;
mod problem;
mod progress;
mod ranges;
mod report;
mod scene_file;
mod settings;
mod stats;

use clap::Parser;
use std::process::ExitCode;
use std::time::Instant;

/// A ray tracer that is fast, physically right, and can explain every pixel it draws.
#[derive(Debug, Parser)]
#[command(name = "kirkas", bin_name = "kirkas", version, arg_required_else_help = true, max_term_width = 100)]
struct Kirkas {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Render(Box<commands::render::Render>),
    Check(commands::check::Check),
    Convert(commands::convert::Convert),
    Diff(commands::diff::Diff),
    Explain(commands::explain::Explain),
    Merge(commands::merge::Merge),
    Relight(commands::relight::Relight),
    Bench(commands::bench::Bench),
    Brdf(commands::brdf::Brdf),
    Schema(commands::schema::Schema),
    Completions(commands::completions::Completions),
}

fn main() -> ExitCode {
    let started = Instant::now();
    let done = match &Kirkas::parse().command {
        Command::Render(args) => commands::render::run(args, started),
        Command::Check(args) => commands::check::run(args),
        Command::Convert(args) => commands::convert::run(args),
        Command::Diff(args) => commands::diff::run(args),
        Command::Explain(args) => commands::explain::run(args),
        Command::Merge(args) => commands::merge::run(args),
        Command::Relight(args) => commands::relight::run(args),
        Command::Bench(args) => commands::bench::run(args),
        Command::Brdf(args) => commands::brdf::run(args),
        Command::Schema(args) => commands::schema::run(args),
        Command::Completions(args) => commands::completions::run(args),
    };
    match done {
        Ok(outcome) => ExitCode::from(outcome.code()),
        Err(problem) => {
            report::print(&problem.failure.sources, &problem.failure.diagnostics);
            ExitCode::from(problem.code)
        }
    }
}
