//! The command line: reads files and arguments, shows progress and problems, writes pictures.
//!
//! All knowledge of light, formats and pixels lives below; only this crate knows of terminals, clocks, signals and exit codes.

mod commands;
mod disk_files;
mod output;
mod problem;
mod report;
mod scene_file;

use clap::Parser;
use std::process::ExitCode;

/// A ray tracer that is fast, physically right, and can explain every pixel it draws.
#[derive(Debug, Parser)]
#[command(name = "kirkas", version, arg_required_else_help = true, max_term_width = 100)]
struct Kirkas {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Render(commands::render::Render),
}

fn main() -> ExitCode {
    let kirkas = Kirkas::parse();
    let done = match &kirkas.command {
        Command::Render(args) => commands::render::run(args),
    };
    match done {
        Ok(outcome) => ExitCode::from(outcome.code()),
        Err(problem) => {
            report::print(&problem.failure.sources, &problem.failure.diagnostics);
            ExitCode::from(problem.code)
        }
    }
}
